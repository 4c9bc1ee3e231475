//! VRML 97 (ISO/IEC 14772-1): the indexed face sets of a file, the format of the thesis beside STL.
//!
//! Read: `Transform` (translation, rotation, scale), `Group` and its like, `Shape` with `IndexedFaceSet` (`coord`,
//! `coordIndex`, `ccw`, `convex`). Names given by `DEF` are passed over, fields and nodes that do not concern the surface
//! are skipped by the grammar. Refused, since the surface would be another one: `USE` of a shape, `PROTO`, `Inline`.

use nalgebra::{Matrix4, Point3, Rotation3, Unit, Vector3};

use super::{FileFault, Soup, upright};

/// One word, bracket or string, with its line.
type Token<'a> = (&'a str, usize);
/// Levels of nodes.
const DEEPEST: usize = 64;

pub(super) fn read(bytes: &[u8]) -> Result<Soup, FileFault> {
    let text = String::from_utf8_lossy(bytes);
    if !text.starts_with("#VRML V2.0 utf8") {
        return Err(FileFault::at("line 1", "is not `#VRML V2.0 utf8`; export as VRML 97"));
    }
    let mut reader = VrmlReader { tokens: tokens(&text), at: 0, soup: Soup::default() };
    while reader.peek().is_some() {
        reader.node(&Matrix4::identity(), DEEPEST)?;
    }
    Ok(reader.soup)
}

/// Commas are white space, `#` begins a comment, strings are one token.
fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let mut rest = line;
        while let Some(start) = rest.find(|c: char| !c.is_whitespace() && c != ',') {
            rest = &rest[start..];
            let end = match rest.as_bytes()[0] {
                b'#' => break,
                b'{' | b'}' | b'[' | b']' => 1,
                b'"' => rest[1..].find('"').map_or(rest.len(), |n| n + 2),
                _ => rest.find(|c: char| c.is_whitespace() || ",{}[]#\"".contains(c)).unwrap_or(rest.len()),
            };
            tokens.push((&rest[..end], i + 1));
            rest = &rest[end..];
        }
    }
    tokens
}

struct VrmlReader<'a> {
    tokens: Vec<Token<'a>>,
    at: usize,
    soup: Soup,
}

/// Content of an `IndexedFaceSet`.
#[derive(Default)]
struct FaceSet {
    points: Vec<f64>,
    /// With the line of each.
    numbers: Vec<(i64, usize)>,
    clockwise: bool,
    concave: bool,
}

impl<'a> VrmlReader<'a> {
    fn peek(&self) -> Option<&'a str> {
        self.tokens.get(self.at).map(|t| t.0)
    }

    fn line(&self) -> usize {
        self.tokens.get(self.at).or(self.tokens.last()).map_or(1, |t| t.1)
    }

    fn fault(&self, text: impl Into<String>) -> FileFault {
        FileFault::at(format!("line {}", self.line()), text)
    }

    fn next(&mut self) -> Result<&'a str, FileFault> {
        let token = self.peek().ok_or_else(|| self.fault("the file ends within a node; export it again"))?;
        self.at += 1;
        Ok(token)
    }

    fn expect(&mut self, wanted: &str) -> Result<(), FileFault> {
        if self.peek() == Some(wanted) {
            self.at += 1;
            return Ok(());
        }
        let found = self.peek().unwrap_or("the end of the file");
        Err(self.fault(format!("`{wanted}` must stand here, not `{found}`")))
    }

    fn number(&mut self) -> Result<f64, FileFault> {
        let text = self.peek().unwrap_or("the end of the file");
        match text.parse::<f64>() {
            Ok(x) if x.is_finite() => {
                self.at += 1;
                Ok(x)
            }
            _ => Err(self.fault(format!("a number must stand here, not `{text}`"))),
        }
    }

    fn numbers<const N: usize>(&mut self) -> Result<[f64; N], FileFault> {
        let mut all = [0.0; N];
        for x in &mut all {
            *x = self.number()?;
        }
        Ok(all)
    }

    /// `[` numbers `]`, or one number.
    fn list<T>(&mut self, item: impl Fn(&mut Self) -> Result<T, FileFault>) -> Result<Vec<T>, FileFault> {
        if self.peek() != Some("[") {
            return Ok(vec![item(self)?]);
        }
        self.at += 1;
        let mut all = Vec::new();
        while self.peek() != Some("]") {
            all.push(item(self)?);
        }
        self.at += 1;
        Ok(all)
    }

    /// TRUE or FALSE.
    fn truth(&mut self) -> Result<bool, FileFault> {
        match self.next()? {
            "TRUE" => Ok(true),
            "FALSE" => Ok(false),
            other => Err(self.fault(format!("TRUE or FALSE must stand here, not `{other}`"))),
        }
    }

    /// The type of the node that begins here, with its opening bracket.
    fn open(&mut self) -> Result<&'a str, FileFault> {
        if self.peek() == Some("DEF") {
            self.at += 2;
        }
        let kind = self.next()?;
        match kind {
            "USE" => return Err(self.fault("USE of a node is not read; export it without shared nodes")),
            "PROTO" | "EXTERNPROTO" => return Err(self.fault("prototypes are not read; export plain nodes")),
            _ => self.expect("{")?,
        }
        Ok(kind)
    }

    /// Any node where a shape may stand; its triangles go through `transform`.
    fn node(&mut self, transform: &Matrix4<f64>, depth: usize) -> Result<(), FileFault> {
        if depth == 0 {
            return Err(
                self.fault(format!("more than {DEEPEST} nodes lie in one another; export it flatter"))
            );
        }
        if matches!(self.peek(), Some("ROUTE")) {
            self.at += 4; // ROUTE a.b TO c.d
            return Ok(());
        }
        match self.open()? {
            "Transform" => self.group(transform, depth),
            "Group" | "Anchor" | "Collision" => self.group(transform, depth),
            "Shape" => self.shape(transform),
            "Inline" => Err(self.fault("other files are not read; export one file")),
            "Switch" | "LOD" => Err(self.fault("alternatives are not read; export one of them")),
            _ => self.skip_fields(),
        }
    }

    fn group(&mut self, above: &Matrix4<f64>, depth: usize) -> Result<(), FileFault> {
        let (mut moved, mut turned, mut scaled) = ([0.0; 3], [0.0, 0.0, 1.0, 0.0], [1.0; 3]);
        // Fields may come in any order, so children are read when all have been seen.
        let mut children = None;
        while self.peek() != Some("}") {
            match self.next()? {
                "translation" => moved = self.numbers()?,
                "rotation" => turned = self.numbers()?,
                "scale" => scaled = self.numbers()?,
                name @ ("center" | "scaleOrientation") => {
                    let at = self.at;
                    if self.skip_value().is_ok()
                        && self.tokens[at..self.at].iter().any(|t| t.0.parse() != Ok(0.0))
                    {
                        self.at = at;
                        return Err(self.fault(format!("`{name}` is not read; export transforms without it")));
                    }
                }
                "children" => {
                    children = Some(self.at);
                    self.skip_value()?;
                }
                _ => self.skip_value()?,
            }
        }
        let end = self.at;
        if let Some(start) = children {
            self.at = start;
            let axis = Vector3::new(turned[0], turned[1], turned[2]);
            let rotation = Unit::try_new(axis, 1e-12)
                .map_or(Rotation3::identity(), |axis| Rotation3::from_axis_angle(&axis, turned[3]));
            let transform = above
                * Matrix4::new_translation(&moved.into())
                * rotation.to_homogeneous()
                * Matrix4::new_nonuniform_scaling(&scaled.into());
            self.list(|reader| reader.node(&transform, depth - 1))?;
        }
        self.at = end + 1;
        Ok(())
    }

    fn shape(&mut self, transform: &Matrix4<f64>) -> Result<(), FileFault> {
        while self.peek() != Some("}") {
            if self.next()? != "geometry" {
                self.skip_value()?;
                continue;
            }
            match self.open()? {
                "IndexedFaceSet" => {
                    let set = self.face_set()?;
                    self.add(&set, transform)?;
                }
                "IndexedLineSet" | "PointSet" | "Text" => self.skip_fields()?,
                other => return Err(self.fault(format!("`{other}` is not read; export indexed face sets"))),
            }
        }
        self.at += 1;
        Ok(())
    }

    fn face_set(&mut self) -> Result<FaceSet, FileFault> {
        let mut set = FaceSet::default();
        while self.peek() != Some("}") {
            match self.next()? {
                "coord" => {
                    self.open()?;
                    while self.peek() != Some("}") {
                        match self.next()? {
                            "point" => set.points = self.list(Self::number)?,
                            _ => self.skip_value()?,
                        }
                    }
                    self.at += 1;
                }
                "coordIndex" => {
                    set.numbers = self.list(|reader| {
                        let line = reader.line();
                        Ok((reader.number()? as i64, line))
                    })?;
                }
                // Faces are counter-clockwise and convex unless the file says otherwise.
                "ccw" => set.clockwise = !self.truth()?,
                "convex" => set.concave = !self.truth()?,
                _ => self.skip_value()?,
            }
        }
        self.at += 1;
        Ok(set)
    }

    fn add(&mut self, set: &FaceSet, transform: &Matrix4<f64>) -> Result<(), FileFault> {
        let first = self.soup.vertices.len() as u32;
        let count = set.points.len() / 3;
        for p in set.points.chunks_exact(3) {
            let p = transform.transform_point(&Point3::new(p[0], p[1], p[2]));
            self.soup.vertices.push(upright(p.into()));
        }
        // A transform that mirrors turns every face round once more.
        let turn = set.clockwise != (transform.fixed_view::<3, 3>(0, 0).determinant() < 0.0);
        for face in set.numbers.split(|(i, _)| *i == -1) {
            if set.concave && face.len() > 3 {
                let place = format!("line {}", face[0].1);
                return Err(FileFault::at(
                    place,
                    "a face of more than three corners may be concave; export triangles",
                ));
            }
            for (i, line) in face {
                if *i < 0 || *i >= count as i64 {
                    let text = format!("a face names point {i}, but there are only {count}; export it again");
                    return Err(FileFault::at(format!("line {line}"), text));
                }
            }
            // A fan: right for convex faces.
            for k in 2..face.len() {
                let mut t = [face[0].0, face[k - 1].0, face[k].0].map(|i| first + i as u32);
                if turn {
                    t.swap(1, 2);
                }
                self.soup.push(t)?;
            }
        }
        Ok(())
    }

    /// Everything up to the bracket that closes the node.
    fn skip_fields(&mut self) -> Result<(), FileFault> {
        let mut open = 1;
        while open > 0 {
            match self.next()? {
                "{" | "[" => open += 1,
                "}" | "]" => open -= 1,
                _ => {}
            }
        }
        Ok(())
    }

    /// The value of a field that is of no interest: a list, a node, or words up to the next field.
    fn skip_value(&mut self) -> Result<(), FileFault> {
        let plain = |t: &str| {
            t.starts_with(|c: char| c.is_ascii_digit() || "+-.\"".contains(c))
                || matches!(t, "TRUE" | "FALSE" | "NULL")
        };
        match self.next()? {
            "[" => self.skip_fields(),
            "USE" => self.next().map(|_| ()),
            // A name and its node: read as a node, name included.
            "DEF" => {
                self.at -= 1;
                self.open()?;
                self.skip_fields()
            }
            "{" | "}" | "]" => {
                self.at -= 1;
                Err(self.fault("the value of a field must stand here"))
            }
            value if plain(value) => {
                while self.peek().is_some_and(plain) {
                    self.at += 1;
                }
                Ok(())
            }
            // The type of a node.
            _ => {
                self.expect("{")?;
                self.skip_fields()
            }
        }
    }
}
