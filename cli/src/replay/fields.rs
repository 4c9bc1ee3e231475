//! Every number of a record with its name.

use messages::{Field, Visit};

/// A number: name, bits, text.
type Number = (String, u64, String);

/// Names the first field whose bits differ; its value in both.
pub(super) fn first_difference<T: Field>(a: &T, b: &T) -> Option<(String, String, String)> {
    let (a, b) = (numbers(a), numbers(b));
    let differs = a.iter().zip(&b).find(|(a, b)| (&a.0, a.1) != (&b.0, b.1));
    differs.map(|(a, b)| (a.0.clone(), a.2.clone(), b.2.clone()))
}

fn numbers<T: Field>(value: &T) -> Vec<Number> {
    let mut names = Names::default();
    value.visit(&mut names);
    names.found
}

enum Part {
    Name(&'static str),
    /// Elements so far, and the name with which each of them begins.
    Index(usize, Option<&'static str>),
}

#[derive(Default)]
struct Names {
    open: Vec<Part>,
    found: Vec<Number>,
}

impl Names {
    fn number(&mut self, bits: u64, text: String) {
        self.element(None);
        let mut name = String::new();
        for part in &self.open {
            match part {
                Part::Name(part) if name.is_empty() => name += part,
                Part::Name(part) => name += &format!(".{part}"),
                Part::Index(count, _) => name += &format!("[{}]", count - 1),
            }
        }
        self.found.push((name, bits, text));
    }

    /// In an array, a number or an array is an element of its own; a struct begins with the same field every time.
    fn element(&mut self, name: Option<&'static str>) {
        if let Some(Part::Index(count, first)) = self.open.last_mut() {
            let begins =
                name.is_none() || *first.get_or_insert(name.unwrap_or_default()) == name.unwrap_or_default();
            *count += usize::from(begins);
        }
    }
}

impl Visit for Names {
    fn f64(&mut self, value: f64) {
        self.number(value.to_bits(), format!("{value:?}"));
    }
    fn u64(&mut self, value: u64) {
        self.number(value, value.to_string());
    }
    fn u32(&mut self, value: u32) {
        self.number(value.into(), value.to_string());
    }
    fn u8(&mut self, value: u8) {
        self.number(value.into(), value.to_string());
    }
    fn field(&mut self, name: &'static str) {
        self.element(Some(name));
        self.open.push(Part::Name(name));
    }
    fn array(&mut self, _: usize) {
        self.element(None);
        self.open.push(Part::Index(0, None));
    }
    fn end(&mut self) {
        self.open.pop();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::{BusFrames, Frame, Sensors};

    #[test]
    fn one_bit_is_named_wherever_it_is() {
        let a = Sensors::default();
        let mut b = a;
        b.joint_angle[7] = f64::from_bits(1);
        let (field, _, theirs) = first_difference(&a, &b).unwrap();
        assert_eq!((field.as_str(), theirs.as_str()), ("joint_angle[7]", "5e-324"));
        assert_eq!(first_difference(&a, &a), None);
        let mut c = a;
        c.header.stamp_ns ^= 1 << 40;
        assert_eq!(first_difference(&a, &c).unwrap().0, "header.stamp_ns");
        c = a;
        c.joint_angle[0] = -0.0;
        assert_eq!(first_difference(&a, &c).unwrap().0, "joint_angle[0]", "bits, not values");
    }

    #[test]
    fn elements_that_are_structs_are_counted() {
        let mut a = BusFrames::default();
        (0..3).for_each(|_| _ = a.push(&Frame::default()));
        let mut b = a;
        b.frames[2].data[5] ^= 4;
        assert_eq!(first_difference(&a, &b).unwrap().0, "frames[2].data[5]");
    }
}
