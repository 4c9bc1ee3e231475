//! STL: triangles with three corners each, as text or binary.
//!
//! Binary files may begin with `solid`, too, and a wrong count in a binary header may ask for any amount of memory. So a
//! file is binary if its length is the one its header announces, text if it begins with `solid`, and refused otherwise.

use super::lines::LineReader;
use super::{FileFault, Soup};

/// \[byte\] Header with the number of triangles; one triangle.
const HEADER: usize = 84;
const TRIANGLE: usize = 50;

pub(super) fn read(bytes: &[u8]) -> Result<Soup, FileFault> {
    let announced =
        bytes.get(HEADER - 4..HEADER).map(|n| u32::from_le_bytes([n[0], n[1], n[2], n[3]]) as usize);
    if announced.is_some_and(|n| bytes.len() == HEADER + TRIANGLE * n) {
        return binary(bytes);
    }
    if bytes.starts_with(b"solid") {
        return text(bytes);
    }
    Err(FileFault::whole(match announced {
        Some(n) => format!(
            "is neither text (it does not begin with `solid`) nor binary: its header announces {n} triangles, {} bytes, \
             but it has {}; export it again",
            HEADER + TRIANGLE * n,
            bytes.len()
        ),
        None => "is too short for STL; export it again".to_owned(),
    }))
}

fn binary(bytes: &[u8]) -> Result<Soup, FileFault> {
    let mut cursor = std::io::Cursor::new(bytes);
    // The library takes what begins with `solid ` for text; here that is known not to be so.
    let mut renamed;
    if bytes.starts_with(b"solid") {
        renamed = bytes.to_vec();
        renamed[0] = b'S';
        cursor = std::io::Cursor::new(&renamed);
    }
    let mut reader = stl_io::create_stl_reader(&mut cursor).map_err(|e| FileFault::whole(e.to_string()))?;
    collect(&mut *reader).map_err(|(triangle, e)| FileFault::at(format!("triangle {triangle}"), e))
}

fn text(bytes: &[u8]) -> Result<Soup, FileFault> {
    // A nameless solid lacks the space that the library looks for.
    let nameless = bytes.get(5).is_some_and(|b| matches!(b, b'\n' | b'\r'));
    let named = nameless.then(|| [b"solid mesh", &bytes[5..]].concat());
    let mut lines = LineReader::new(named.as_deref().unwrap_or(bytes));
    let result = match stl_io::create_stl_reader(&mut lines) {
        Ok(mut reader) => collect(&mut *reader).map_err(|(_, e)| e),
        Err(e) => Err(e.to_string()),
    };
    result.map_err(|e| FileFault::at(format!("line {}", lines.line), format!("{e}; export it again")))
}

type Triangles<'a> = dyn stl_io::TriangleIterator<Item = std::io::Result<stl_io::Triangle>> + 'a;

/// All triangles, or the number of the first bad one.
fn collect(reader: &mut Triangles<'_>) -> Result<Soup, (usize, String)> {
    let mut soup = Soup::default();
    for (i, triangle) in reader.enumerate() {
        let corners = triangle.map_err(|e| (i, e.to_string()))?.vertices;
        for corner in corners {
            if !corner.0.iter().all(|x| x.is_finite()) {
                return Err((
                    i,
                    format!("a corner is at {:?}, which is no place; export it again", corner.0),
                ));
            }
            soup.vertices.push(corner.0.map(f64::from));
        }
        let first = 3 * i as u32;
        soup.push([first, first + 1, first + 2]).map_err(|fault| (i, fault.text))?;
    }
    Ok(soup)
}
