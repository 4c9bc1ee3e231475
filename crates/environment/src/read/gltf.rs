//! glTF 2.0: the triangles of all meshes of the default scene, each through the transforms of the nodes above it.
//!
//! The library reads and checks the JSON part; that accessors lie inside their buffers is checked here, before a byte of
//! them is read. Buffers are the binary part of a .glb, files beside the .gltf, or base64 in it.

use std::path::Path;

use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::Source;
use nalgebra::{Matrix4, Point3};

use super::{FileFault, Soup, bytes, upright};

/// Levels of nodes; more is a node that contains itself.
const DEEPEST: usize = 64;

pub(super) fn read(file: &[u8], folder: &Path) -> Result<Soup, FileFault> {
    let (gltf, mut blob) = document(file)?;
    // All bytes first: accessors of several meshes share them.
    let mut buffers = Vec::new();
    for buffer in gltf.buffers() {
        let place = format!("buffer {}", buffer.index());
        let data = match buffer.source() {
            Source::Bin => blob.take().ok_or_else(|| FileFault::at(&place, "the binary part is missing"))?,
            Source::Uri(uri) => resource(uri, folder).map_err(|fault| FileFault::at(&place, fault.text))?,
        };
        if data.len() < buffer.length() {
            let text =
                format!("has {} bytes of the {} announced; export it again", data.len(), buffer.length());
            return Err(FileFault::at(place, text));
        }
        buffers.push(data);
    }
    let scene = gltf.default_scene().or_else(|| gltf.scenes().next());
    let scene = scene.ok_or_else(|| FileFault::whole("has no scene; export the objects with their scene"))?;
    // Then the nodes of the scene, each once and placed by all above it.
    let mut seen = vec![false; gltf.nodes().len()];
    let mut soup = Soup::default();
    for node in scene.nodes() {
        walk(&node, Matrix4::identity(), DEEPEST, &mut seen, &mut |node, transform| {
            add(node, transform, &buffers, &mut soup)
        })?;
    }
    Ok(soup)
}

/// The checked JSON part, and the binary part of a .glb.
fn document(file: &[u8]) -> Result<(gltf::Document, Option<Vec<u8>>), FileFault> {
    let fault = |e: gltf::Error| FileFault::whole(format!("{e}; export it again"));
    let gltf::Gltf { document, blob } = gltf::Gltf::from_slice_without_validation(file).map_err(fault)?;
    let json = document.into_json();
    // The library's own check (gltf-json 1.4.1) looks an accessor up before it knows that there is one.
    for (i, mesh) in json.meshes.iter().enumerate() {
        let mut named = mesh.primitives.iter().flat_map(|primitive| primitive.attributes.values());
        if let Some(index) = named.find(|index| index.value() >= json.accessors.len()) {
            let text = format!(
                "names accessor {}, but there are only {}; export it again",
                index.value(),
                json.accessors.len()
            );
            return Err(FileFault::at(format!("mesh {i}"), text));
        }
    }
    Ok((gltf::Document::from_json(json).map_err(fault)?, blob))
}

/// The bytes behind a URI: base64 in itself, or a file in `folder` or below it.
fn resource(uri: &str, folder: &Path) -> Result<Vec<u8>, FileFault> {
    if let Some(data) = uri.strip_prefix("data:") {
        let text = data.split_once(";base64,").map(|(_, text)| text);
        return text
            .and_then(base64)
            .ok_or_else(|| FileFault::whole("its data are no base64; export it again"));
    }
    let below = Path::new(uri).components().all(|part| matches!(part, std::path::Component::Normal(_)));
    if !below || uri.contains(':') {
        return Err(FileFault::whole(format!(
            "`{uri}` is no file beside this one; export with buffers included"
        )));
    }
    bytes(&folder.join(uri)).map_err(|fault| FileFault::whole(format!("`{uri}` {}", fault.text)))
}

fn base64(text: &str) -> Option<Vec<u8>> {
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3);
    let (mut bits, mut count) = (0u32, 0);
    for c in text.trim_end_matches('=').bytes() {
        let six = match c {
            b'A'..=b'Z' => c - b'A',
            b'a'..=b'z' => c - b'a' + 26,
            b'0'..=b'9' => c - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            _ => return None,
        };
        (bits, count) = (bits << 6 | u32::from(six), count + 6);
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
        }
    }
    Some(bytes)
}

/// Calls `add` for every node at or below `node`, each with its transform to the scene.
fn walk(
    node: &gltf::Node<'_>,
    above: Matrix4<f64>,
    depth: usize,
    seen: &mut [bool],
    add: &mut impl FnMut(&gltf::Node<'_>, &Matrix4<f64>) -> Result<(), FileFault>,
) -> Result<(), FileFault> {
    let place = format!("node {}", node.index());
    if depth == 0 || std::mem::replace(&mut seen[node.index()], true) {
        let text = format!(
            "has several parents, itself among them, or more than {DEEPEST} above it; export it again"
        );
        return Err(FileFault::at(place, text));
    }
    let transform = above * Matrix4::from(node.transform().matrix()).map(f64::from);
    add(node, &transform)?;
    node.children().try_for_each(|child| walk(&child, transform, depth - 1, seen, add))
}

/// The triangles of one node.
fn add(
    node: &gltf::Node<'_>,
    transform: &Matrix4<f64>,
    buffers: &[Vec<u8>],
    soup: &mut Soup,
) -> Result<(), FileFault> {
    let place = format!("node {}", node.index());
    for primitive in node.mesh().iter().flat_map(|mesh| mesh.primitives()) {
        if primitive.mode() != gltf::mesh::Mode::Triangles {
            return Err(FileFault::at(place, format!("is made of {:?}; export triangles", primitive.mode())));
        }
        let positions = primitive.get(&gltf::Semantic::Positions);
        let positions =
            positions.ok_or_else(|| FileFault::at(&place, "has no positions; export it again"))?;
        let first = soup.vertices.len() as u32;
        let places = accessor(&positions, buffers, Dimensions::Vec3, &[DataType::F32])?;
        let vertex = |bytes: &[u8]| {
            let x = |k: usize| {
                f64::from(f32::from_le_bytes([bytes[k], bytes[k + 1], bytes[k + 2], bytes[k + 3]]))
            };
            upright(transform.transform_point(&Point3::new(x(0), x(4), x(8))).into())
        };
        soup.vertices.extend(places.map(vertex));
        let numbers: Vec<u32> = match primitive.indices() {
            Some(indices) => {
                let types = [DataType::U8, DataType::U16, DataType::U32];
                let number = |bytes: &[u8]| bytes.iter().rev().fold(0, |n, b| n << 8 | u32::from(*b));
                accessor(&indices, buffers, Dimensions::Scalar, &types)?.map(number).collect()
            }
            None => (0..soup.vertices.len() as u32 - first).collect(),
        };
        // A mirror turns the triangles inside out; they are turned back.
        let [b, c] = if transform.fixed_view::<3, 3>(0, 0).determinant() < 0.0 { [2, 1] } else { [1, 2] };
        for t in numbers.chunks_exact(3) {
            soup.push([t[0], t[b], t[c]].map(|i| first.saturating_add(i)))?;
        }
    }
    Ok(())
}

/// The elements of an accessor, each as its bytes.
fn accessor<'b>(
    accessor: &gltf::Accessor<'_>,
    buffers: &'b [Vec<u8>],
    dimensions: Dimensions,
    types: &[DataType],
) -> Result<impl Iterator<Item = &'b [u8]> + use<'b>, FileFault> {
    let fault = |text: &str| FileFault::at(format!("accessor {}", accessor.index()), text);
    if accessor.sparse().is_some() {
        return Err(fault("is sparse, which is not read; export it without morph targets"));
    }
    if accessor.dimensions() != dimensions || !types.contains(&accessor.data_type()) {
        return Err(fault("is not of the type that glTF prescribes; export it again"));
    }
    let view = accessor.view().ok_or_else(|| fault("has no data; export it without compression"))?;
    let outside = || fault("reaches beyond its buffer; export it again");
    let (size, count) = (accessor.size(), accessor.count());
    // Bounds by checked arithmetic: offsets and counts are the file's.
    let stride = view.stride().unwrap_or(size).max(size);
    let data = buffers.get(view.buffer().index()).and_then(|data| {
        let view_end = view.offset().checked_add(view.length())?;
        let data = data.get(view.offset()..view_end)?;
        let length = stride.checked_mul(count.checked_sub(1)?)?.checked_add(size)?;
        data.get(accessor.offset()..accessor.offset().checked_add(length)?)
    });
    let data = data.ok_or_else(outside)?;
    Ok(data.chunks(stride).map(move |element| &element[..size]))
}
