//! Every number of a record with its name and unit: `joint_angle.right_knee_flexion`, rad.

use crate::{Field, MAX_JOINTS, Visit};

/// A number of a record.
#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    /// Name with those of the parts around it: `imu.orientation[3]`, `foot_wrench.left.force[2]`.
    pub name: String,
    /// Unit; empty: none.
    pub unit: &'static str,
    /// The number.
    pub value: FieldValue,
    /// Place among all numbers of the record, those of joints that the robot does not have included: for [`pick`].
    pub place: usize,
}

/// Name and unit of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FieldValue {
    /// Measured or computed.
    Real(f64),
    /// Counted, or a code.
    Whole(u64),
}

impl FieldValue {
    /// Bits of the number: NaN is equal to itself, and 0 is not -0.
    fn bits(self) -> u64 {
        match self {
            Self::Real(x) => x.to_bits(),
            Self::Whole(n) => n,
        }
    }

    /// All digits.
    pub fn exact(self) -> String {
        match self {
            Self::Real(x) => format!("{x:?}"),
            Self::Whole(n) => n.to_string(),
        }
    }

    /// Six digits at most, for people.
    pub fn short(self) -> String {
        match self {
            Self::Real(x) if x == 0.0 || !x.is_finite() => x.to_string(),
            Self::Real(x) if x.abs() < 1e-4 || x.abs() >= 1e7 => format!("{x:.3e}"),
            Self::Real(x) => {
                let before = x.abs().log10().floor().max(0.0) as usize + 1;
                let text = format!("{x:.*}", 6usize.saturating_sub(before).max(1));
                text.trim_end_matches('0').trim_end_matches('.').to_owned()
            }
            Self::Whole(n) => n.to_string(),
        }
    }
}

/// Every number of a record, in the order of declaration. Arrays of joints hold the robot's, by their names; without names all
/// places of the array, by their numbers.
pub fn numbers<T: Field>(record: &T, joints: &[String]) -> Vec<Number> {
    let mut walk = FieldVisitor { joints, open: Vec::new(), about: "", found: Vec::new(), place: 0 };
    record.visit(&mut walk);
    walk.found
}

/// The numbers at these places of a record, ascending, behind those that `out` holds: without names, for every cycle.
pub fn pick<T: Field>(record: &T, places: &[usize], out: &mut Vec<f64>) {
    record.visit(&mut PlacePicker { places, place: 0, out });
}

struct PlacePicker<'a> {
    /// Those still to come.
    places: &'a [usize],
    place: usize,
    out: &'a mut Vec<f64>,
}

impl PlacePicker<'_> {
    fn number(&mut self, value: f64) {
        if let [first, rest @ ..] = self.places
            && *first == self.place
        {
            self.places = rest;
            self.out.push(value);
        }
        self.place += 1;
    }
}

impl Visit for PlacePicker<'_> {
    fn f64(&mut self, value: f64) {
        self.number(value);
    }
    fn u64(&mut self, value: u64) {
        self.number(value as f64);
    }
    fn u32(&mut self, value: u32) {
        self.number(value.into());
    }
    fn i32(&mut self, value: i32) {
        self.number(value.into());
    }
    fn u8(&mut self, value: u8) {
        self.number(value.into());
    }
}

/// The first number whose bits differ: its name, and its value in both.
pub fn first_difference<T: Field>(a: &T, b: &T) -> Option<(String, String, String)> {
    // Names take a hundred times as long as numbers, and most records are equal.
    if bits(a) == bits(b) {
        return None;
    }
    let (a, b) = (numbers(a, &[]), numbers(b, &[]));
    let differs = a.iter().zip(&b).find(|(a, b)| a.name != b.name || a.value.bits() != b.value.bits());
    differs.map(|(a, b)| (a.name.clone(), a.value.exact(), b.value.exact()))
}

/// Bits of all numbers of a record, in their order.
fn bits<T: Field>(record: &T) -> Vec<u64> {
    let mut bits = BitList(Vec::new());
    record.visit(&mut bits);
    bits.0
}

struct BitList(Vec<u64>);

impl Visit for BitList {
    fn f64(&mut self, value: f64) {
        self.0.push(value.to_bits());
    }
    fn u64(&mut self, value: u64) {
        self.0.push(value);
    }
    fn u32(&mut self, value: u32) {
        self.0.push(value.into());
    }
    fn i32(&mut self, value: i32) {
        self.0.push(value as u64);
    }
    fn u8(&mut self, value: u8) {
        self.0.push(value.into());
    }
}

/// A part that has begun.
enum OpenPart {
    /// A field: its name, and the units and the text of its documentation.
    Field(&'static str, &'static str),
    /// An array: how many elements it has, how many came, and the name with which each of them begins.
    Array { length: usize, count: usize, first: Option<&'static str> },
}

struct FieldVisitor<'a> {
    joints: &'a [String],
    open: Vec<OpenPart>,
    about: &'static str,
    found: Vec<Number>,
    place: usize,
}

impl FieldVisitor<'_> {
    fn number(&mut self, value: FieldValue) {
        self.element(None);
        if let Some(name) = self.name() {
            self.found.push(Number { name, unit: self.unit(), value, place: self.place });
        }
        self.place += 1;
    }

    /// The name of the number that is there now; none: it is of a joint that the robot does not have.
    fn name(&self) -> Option<String> {
        let mut name = String::new();
        let mut feet = false;
        for part in &self.open {
            match *part {
                OpenPart::Field(part, about) => {
                    name += if name.is_empty() { "" } else { "." };
                    name += part;
                    feet = about.contains("right, left");
                }
                // Of joints, but for contact points, of which there is room for as many.
                OpenPart::Array { length: MAX_JOINTS, count, .. }
                    if !self.joints.is_empty() && !name.starts_with("contact") =>
                {
                    name += &format!(".{}", self.joints.get(count - 1)?);
                }
                OpenPart::Array { length: 2, count, .. } if feet => {
                    name += [".right", ".left"].get(count - 1).unwrap_or(&"");
                    feet = false;
                }
                OpenPart::Array { count, .. } => name += &format!("[{}]", count - 1),
            }
        }
        Some(name)
    }

    /// Unit of the innermost field that has one. Of "m, rad" the last element of an array takes the last.
    fn unit(&self) -> &'static str {
        let field = |part: &OpenPart| match part {
            OpenPart::Field(_, about) => {
                about.trim_start().strip_prefix("\\[")?.split_once("\\]").map(|(unit, _)| unit)
            }
            OpenPart::Array { .. } => None,
        };
        let units = self.open.iter().rev().find_map(field).unwrap_or("");
        let place = match self.open.last() {
            Some(OpenPart::Array { length, count, .. }) => length - count.min(length),
            _ => 0,
        };
        let all: Vec<&'static str> = units.split(',').map(str::trim).collect();
        let unit = all[(all.len() - 1).saturating_sub(place)];
        if unit == "1" { "" } else { unit }
    }

    /// In an array, a number or an array is an element of its own; a struct begins with the same field every time.
    fn element(&mut self, name: Option<&'static str>) {
        if let Some(OpenPart::Array { count, first, .. }) = self.open.last_mut() {
            let begins =
                name.is_none() || *first.get_or_insert(name.unwrap_or_default()) == name.unwrap_or_default();
            *count += usize::from(begins);
        }
    }
}

impl Visit for FieldVisitor<'_> {
    fn f64(&mut self, value: f64) {
        self.number(FieldValue::Real(value));
    }
    fn u64(&mut self, value: u64) {
        self.number(FieldValue::Whole(value));
    }
    fn u32(&mut self, value: u32) {
        self.number(FieldValue::Whole(value.into()));
    }
    fn i32(&mut self, value: i32) {
        self.number(FieldValue::Real(value.into()));
    }
    fn u8(&mut self, value: u8) {
        self.number(FieldValue::Whole(value.into()));
    }
    fn about(&mut self, text: &'static str) {
        self.about = text;
    }
    fn field(&mut self, name: &'static str) {
        self.element(Some(name));
        self.open.push(OpenPart::Field(name, std::mem::take(&mut self.about)));
    }
    fn array(&mut self, length: usize) {
        self.element(None);
        self.open.push(OpenPart::Array { length, count: 0, first: None });
    }
    fn end(&mut self) {
        self.open.pop();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BusFrames, ControllerState, Frame, Sensors};

    /// 32 places for 24 joints, without names and units.
    #[test]
    fn numbers_have_the_robots_names_and_units() {
        let joints: Vec<String> = ["hip", "knee"].map(String::from).to_vec();
        let sensors = numbers(&Sensors::default(), &joints);
        let unit = |all: &[Number], name: &str| {
            all.iter().find(|n| n.name == name).map(|n| n.unit).unwrap_or_else(|| panic!("{name} of {all:?}"))
        };
        assert_eq!(sensors.iter().filter(|n| n.name.starts_with("joint_angle")).count(), 2);
        assert_eq!((unit(&sensors, "joint_angle.knee"), unit(&sensors, "joint_speed.hip")), ("rad", "rad/s"));
        assert_eq!((unit(&sensors, "header.stamp_ns"), unit(&sensors, "header.tick")), ("ns", ""));
        let (force, moment) = ("foot_wrench.right.force[2]", "foot_wrench.left.moment[0]");
        assert_eq!((unit(&sensors, force), unit(&sensors, moment)), ("N", "N m"));
        assert_eq!(unit(&sensors, "temperature.hip"), "deg C");
        let state = numbers(&ControllerState::default(), &joints);
        assert_eq!((unit(&state, "origin[1]"), unit(&state, "origin[2]")), ("m", "rad"));
        assert_eq!((unit(&state, "feet[1][2]"), unit(&state, "feet[1][3]")), ("m", "rad"));
    }

    /// Every number by its place is the one that has its name, on a robot with fewer joints than a record has room for.
    #[test]
    fn picked_numbers_are_those_with_the_names() {
        let joints: Vec<String> = ["hip", "knee"].map(String::from).to_vec();
        let record = ControllerState {
            tracking_error: std::array::from_fn(|j| j as f64),
            com: [0.1, 0.2, 0.9],
            limited: 7,
            phase: [3, 8],
            ..ControllerState::default()
        };
        let all = numbers(&record, &joints);
        let places: Vec<usize> = all.iter().map(|n| n.place).collect();
        let mut picked = Vec::new();
        pick(&record, &places, &mut picked);
        assert_eq!(picked.len(), all.len());
        for (number, picked) in all.iter().zip(picked) {
            let value = match number.value {
                FieldValue::Real(x) => x,
                FieldValue::Whole(n) => n as f64,
            };
            assert_eq!(value.to_bits(), picked.to_bits(), "{}", number.name);
        }
        // Two of them, behind what is there already.
        let knee = all.iter().find(|n| n.name == "tracking_error.knee").unwrap().place;
        let last = all.iter().find(|n| n.name == "limited").unwrap().place;
        let mut two = vec![f64::NAN];
        pick(&record, &[knee, last], &mut two);
        assert_eq!(two[1..], [1.0, 7.0]);
    }

    #[test]
    fn six_digits_are_shown() {
        let short = |x: f64| FieldValue::Real(x).short();
        assert_eq!(short(0.930_000_1), "0.93");
        assert_eq!(short(-9.812_345_678), "-9.81235");
        assert_eq!(short(1_234.567_89), "1234.57");
        assert_eq!(
            (short(1.5e-9).as_str(), short(0.0).as_str(), short(f64::NAN).as_str()),
            ("1.500e-9", "0", "NaN")
        );
    }

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
