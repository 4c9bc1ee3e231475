//! One solid in every format, and files that are none.

use std::path::PathBuf;

use environment::{Mesh, ReadError};

/// A wedge: asymmetric in every axis, so that an exchanged axis shows.
const VERTICES: [[f64; 3]; 6] = [
    [0.0, 0.0, 0.0],
    [0.5, 0.0, 0.0],
    [0.0, 0.25, 0.0],
    [0.0, 0.0, 0.125],
    [0.5, 0.0, 0.125],
    [0.0, 0.25, 0.125],
];
const TRIANGLES: [[u32; 3]; 8] =
    [[0, 2, 1], [3, 4, 5], [0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]];

fn file(name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("environment-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

fn read(name: &str, bytes: impl AsRef<[u8]>) -> Result<Mesh, ReadError> {
    Mesh::read(&file(name, bytes), 1.0)
}

/// The same distances at points all around.
fn is_the_wedge(mesh: &Mesh) {
    let wedge = Mesh::new(&VERTICES, &TRIANGLES).unwrap();
    assert_eq!(mesh.len(), 8);
    for i in 0..1000 {
        let p = [11, 7, 5].map(|k| f64::from(i * k % 97) / 97.0 - 0.3);
        let [a, b] = [mesh, &wedge].map(|m| m.nearest(&p.into()).unwrap());
        assert!((a.gap - b.gap).abs() < 1e-15 && (a.normal - b.normal).norm() < 1e-12, "{p:?}: {a:?} {b:?}");
    }
}

fn corners() -> impl Iterator<Item = [[f64; 3]; 3]> {
    TRIANGLES.iter().map(|t| t.map(|i| VERTICES[i as usize]))
}

fn text_stl() -> String {
    let facet = |t: [[f64; 3]; 3]| {
        let v = t.map(|[x, y, z]| format!("vertex {x} {y} {z}\n")).concat();
        format!("facet normal 0 0 0\nouter loop\n{v}endloop\nendfacet\n")
    };
    format!("solid wedge\n{}endsolid wedge\n", corners().map(facet).collect::<String>())
}

fn binary_stl(header: &str) -> Vec<u8> {
    let mut bytes = header.as_bytes().to_vec();
    bytes.resize(80, b' ');
    bytes.extend(8u32.to_le_bytes());
    for t in corners() {
        bytes.extend([0; 12]);
        bytes.extend(t.iter().flatten().flat_map(|x| (*x as f32).to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

fn obj() -> String {
    let v = VERTICES.map(|[x, y, z]| format!("v {x} {y} {z}\n")).concat();
    let f = TRIANGLES.map(|[a, b, c]| format!("f {} {} {}\n", a + 1, b + 1, c + 1)).concat();
    format!("# wedge\n{v}{f}")
}

/// z up to y up.
fn fallen([x, y, z]: [f64; 3]) -> [f64; 3] {
    [x, z, -y]
}

/// JSON part and binary part; the node lies 1 m along x, its vertices 1 m before that.
fn gltf(uri: &str) -> (String, Vec<u8>) {
    let mut data: Vec<u8> = VERTICES
        .iter()
        .flat_map(|v| fallen(*v))
        .enumerate()
        .flat_map(|(i, x)| (if i % 3 == 0 { x - 1.0 } else { x } as f32).to_le_bytes())
        .collect();
    data.extend(TRIANGLES.iter().flatten().flat_map(|i| (*i as u16).to_le_bytes()));
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
        "nodes":[{{"children":[1]}},{{"mesh":0,"translation":[1,0,0]}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
        "buffers":[{{{uri}"byteLength":120}}],
        "bufferViews":[{{"buffer":0,"byteLength":72}},{{"buffer":0,"byteOffset":72,"byteLength":48}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":6,"type":"VEC3","min":[-1,0,-0.25],"max":[-0.5,0.125,0]}},
                     {{"bufferView":1,"componentType":5123,"count":24,"type":"SCALAR"}}]}}"#
    );
    (json, data)
}

fn glb() -> Vec<u8> {
    let (mut json, data) = gltf("");
    while json.len() % 4 != 0 {
        json.push(' ');
    }
    let length = 12 + 8 + json.len() + 8 + data.len();
    let word = |n: usize| (n as u32).to_le_bytes();
    [
        &b"glTF"[..],
        &word(2),
        &word(length),
        &word(json.len()),
        b"JSON",
        json.as_bytes(),
        &word(data.len()),
        b"BIN\0",
        &data,
    ]
    .concat()
}

/// With everything that may be skipped; the wedge is scaled, turned by a quarter about y, moved, and mirrored twice.
fn vrml() -> String {
    // world = (1, 2, 3) + R_y(90 deg) S p, S = diag(-2, 2, 2), so p = S^-1 R^T (world - (1, 2, 3)); R^T (x, y, z) = (-z, y, x).
    let local = |v: [f64; 3]| {
        let [x, y, z] = fallen(v);
        let [x, y, z] = [x - 1.0, y - 2.0, z - 3.0];
        [z / 2.0, y / 2.0, x / 2.0]
    };
    let points =
        VERTICES.map(|v| format!("{:?} {:?} {:?},\n", local(v)[0], local(v)[1], local(v)[2])).concat();
    let faces = TRIANGLES.map(|[a, b, c]| format!("{a}, {c}, {b}, -1,")).concat();
    format!(
        "#VRML V2.0 utf8\nWorldInfo {{ title \"a {{ wedge # no comment\" }}\nDEF all Group {{ children [\n\
         DEF moved Transform {{ children [ Shape {{ appearance Appearance {{ material DEF m Material {{ diffuseColor 1 0 0 }} }}\n\
         geometry IndexedFaceSet {{ solid TRUE creaseAngle 0.5 ccw TRUE # turned by the mirror\n\
         coord DEF c Coordinate {{ point [ {points} ] }}\n normal Normal {{ vector [ 0 0 1 ] }} coordIndex [ {faces} ] }} }} ]\n\
         translation 1 2 3 rotation 0 1 0 1.5707963267948966 scale -2 2 2 bboxCenter 0 0 0 }} ] }}\nROUTE a.b TO c.d\n"
    )
}

#[test]
fn every_format_is_the_same_solid() {
    is_the_wedge(&read("wedge.stl", text_stl()).unwrap());
    is_the_wedge(&read("nameless.stl", text_stl().replace(" wedge", "")).unwrap());
    is_the_wedge(&read("binary.stl", binary_stl("wedge")).unwrap());
    is_the_wedge(&read("solid.stl", binary_stl("solid wedge")).unwrap());
    is_the_wedge(&read("wedge.obj", obj()).unwrap());
    is_the_wedge(&read("wedge.glb", glb()).unwrap());
    let (json, data) = gltf(r#""uri":"wedge.bin","#);
    file("wedge.bin", data);
    is_the_wedge(&read("wedge.gltf", json).unwrap());
    is_the_wedge(&read("wedge.wrl", vrml()).unwrap());
}

/// A buffer in the file itself; the alphabet of base64 written down a second time.
#[test]
fn gltf_with_base64() {
    let (_, data) = gltf("");
    let alphabet = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for three in data.chunks(3) {
        let word = three.iter().fold(0usize, |w, b| w << 8 | usize::from(*b));
        (0..4).rev().for_each(|k| text.push(char::from(alphabet[word >> (6 * k) & 63])));
    }
    let (json, _) = gltf(&format!(r#""uri":"data:application/octet-stream;base64,{text}","#));
    is_the_wedge(&read("base64.gltf", json).unwrap());
}

#[test]
fn scaled() {
    let large = obj().replace("v 0.5 0 0\n", "v 500 0 0\n");
    let large = large.replace("0.25", "250").replace("0.125", "125").replace("v 0.5", "v 500");
    is_the_wedge(&Mesh::read(&file("large.obj", large), 1e-3).unwrap());
}

/// What is put right is counted: a triangle without area, and normals that all point inwards.
#[test]
fn put_right() {
    let degenerate = text_stl().replacen("facet normal", "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 0\nvertex 0.5 0 0\nendloop\nendfacet\nfacet normal", 1);
    let mesh = read("degenerate.stl", degenerate).unwrap();
    is_the_wedge(&mesh);
    assert_eq!((mesh.repairs().degenerate, mesh.repairs().inside_out), (1, false));
    let turned: Vec<[u32; 3]> = TRIANGLES.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    let mesh = Mesh::new(&VERTICES, &turned).unwrap();
    is_the_wedge(&mesh);
    assert!(mesh.repairs().inside_out);
}

#[test]
fn what_is_wrong_is_named_with_its_place() {
    let (json, _) = gltf(r#""uri":"../wedge.bin","#);
    let (short, _) = gltf(r#""uri":"short.bin","#);
    file("short.bin", [0; 50]);
    let cases: Vec<(&str, Vec<u8>, &[&str])> = vec![
        ("a.xyz", b"".to_vec(), &["`.xyz` is no format", ".stl"]),
        ("b.stl", b"".to_vec(), &["too short"]),
        ("c.stl", binary_stl("x")[..400].to_vec(), &["announces 8 triangles, 484 bytes", "400"]),
        (
            "d.stl",
            text_stl().replacen("vertex 0.5 0 0\n", "vertex 0.5 nan 0\n", 1).into_bytes(),
            &["line 6", "finite"],
        ),
        ("e.stl", text_stl().replacen("endloop", "endlop", 1).into_bytes(), &["line 7", "endlop"]),
        ("f.stl", text_stl().as_bytes()[..300].to_vec(), &["line"]),
        (
            "g.obj",
            obj().replacen("f 4 5 6", "f 4 5 60", 1).into_bytes(),
            &["object up to line 15", "vertex index"],
        ),
        ("h.obj", obj().replacen("v 0.5 0 0\n", "v 0.5 zero 0\n", 1).into_bytes(), &["line 3"]),
        ("i.obj", obj().replacen("v 0.5 0 0\n", "v 0.5 NaN 0\n", 1).into_bytes(), &["no place"]),
        (
            "j.obj",
            obj().replacen("f 4 5 6\n", "", 1).into_bytes(),
            &["belongs to one triangle only", "close"],
        ),
        ("k.obj", obj().replacen("f 4 5 6\n", "f 4 6 5\n", 1).into_bytes(), &["same direction", "unify"]),
        ("l.obj", obj().replace("0.5", "5000000").into_bytes(), &["units"]),
        ("m.obj", b"# nothing\n".to_vec(), &["no volume"]),
        ("n.gltf", json.into_bytes(), &["buffer 0", "../wedge.bin"]),
        ("o.gltf", short.into_bytes(), &["buffer 0", "50 bytes of the 120"]),
        ("p.glb", replace(glb(), b"\"count\":24", b"\"count\":99"), &["accessor 1", "beyond its buffer"]),
        ("q.glb", replace(glb(), b"[1]},{", b"[0]},{"), &["node 0", "itself"]),
        ("r.glb", replace(glb(), b"\"SCALAR\"", b"\"VEC2\"  "), &["accessor 1", "type"]),
        ("s.wrl", b"#VRML V1.0 ascii\n".to_vec(), &["line 1", "VRML 97"]),
        ("t.wrl", vrml().replace("Shape {", "USE other {").into_bytes(), &["line 4", "USE"]),
        (
            "u.wrl",
            vrml().replace("0, 1, 2, -1", "0, 1, 9, -1").into_bytes(),
            &["line 13", "point 9", "only 6"],
        ),
        ("v.wrl", vrml().replace("translation 1 2", "translation 1 two").into_bytes(), &["line 14", "`two`"]),
        ("w.wrl", vrml().as_bytes()[..300].to_vec(), &["ends within a node"]),
        ("x.wrl", vrml().replace("scale -2", "center 1 0 0 scale -2").into_bytes(), &["line 14", "`center`"]),
    ];
    for (name, bytes, parts) in cases {
        let message = read(name, bytes).expect_err(name).to_string();
        for part in parts.iter().chain(&[name]) {
            assert!(message.contains(part), "{name}: `{part}` is not in: {message}");
        }
    }
    let missing = Mesh::read("no/such.stl".as_ref(), 1.0).unwrap_err().to_string();
    assert!(missing.contains("no/such.stl: cannot be read"), "{missing}");
}

fn replace(bytes: Vec<u8>, old: &[u8], new: &[u8]) -> Vec<u8> {
    assert_eq!(old.len(), new.len());
    let at = bytes.windows(old.len()).position(|w| w == old).expect("text to be replaced");
    [&bytes[..at], new, &bytes[at + new.len()..]].concat()
}

/// Whatever happens to the bytes of a file, the answer is a mesh or an error.
#[test]
fn damaged_files_are_errors() {
    let files = [
        ("z.stl", text_stl().into_bytes()),
        ("y.stl", binary_stl("w")),
        ("z.obj", obj().into_bytes()),
        ("z.glb", glb()),
        ("z.wrl", vrml().into_bytes()),
    ];
    let mut state = 1u64;
    let mut random = |n: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % n
    };
    for (name, bytes) in files {
        for _ in 0..2000 {
            let mut bytes = bytes.clone();
            for _ in 0..=random(4) {
                let at = random(bytes.len());
                match random(3) {
                    0 => bytes[at] = random(256) as u8,
                    1 => bytes[at] = b"0123456789-.{}[]\" "[random(18)],
                    _ => bytes.truncate(at.max(1)),
                }
            }
            if let Ok(mesh) = read(name, &bytes) {
                let found = mesh.nearest(&[0.1, 0.2, 0.3].into()).unwrap();
                assert!(found.gap.is_finite());
            }
        }
    }
}
