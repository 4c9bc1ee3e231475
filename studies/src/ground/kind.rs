//! Kinds of what a robot is not told of, ground and its own weight, what their size is, and which sizes are tried.

use serde::Serialize;

/// What is not as the robot believes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, clap::ValueEnum)]
#[serde(rename_all = "snake_case")]
pub enum GroundKind {
    /// The ground is higher from an edge on.
    StepUp,
    /// The ground is lower from an edge on.
    StepDown,
    /// A board on the ground, 10 to 60 cm long and 20 to 120 cm wide, at any angle, under some part of a sole.
    Board,
    /// A hole of 10 cm under a part of one sole, whose edge runs in any direction.
    HalfFoothold,
    /// A slope in any direction, 2 m of it, which begins and ends within 0.5 m.
    Slope,
    /// Heights at random every 30 cm, straight between them, for 3 m.
    HeightField,
    /// A patch with another coefficient of friction, 30 to 150 cm long and 60 to 150 cm wide, at any angle.
    LowFriction,
    /// No other ground: the mass of each body by itself up to that share lighter or heavier.
    Masses,
    /// No other ground: all bodies that share lighter, or heavier.
    Weight,
    /// No other ground: the torso's centre of gravity up to that far off in each of its axes.
    TorsoCog,
    /// No other ground: a payload at the front or the back of the torso.
    Payload,
}

/// A kind, as [`TABLE`] has it.
type KindRow = (GroundKind, &'static str, &'static str, f64, &'static [f64], f64);

/// All kinds, what one is called in a table, and its size: unit, times of that in SI, sizes tried by default, largest one.
const TABLE: &[KindRow] = &[
    (GroundKind::StepUp, "step up", "m", 1.0, &[0.02, 0.04], 1.0),
    (GroundKind::StepDown, "step down", "m", 1.0, &[0.04, 0.08], 1.0),
    (GroundKind::Board, "board", "m", 1.0, &[0.02, 0.04], 1.0),
    (GroundKind::HalfFoothold, "half foothold", "1", 1.0, &[0.5], 1.0),
    (GroundKind::Slope, "slope", "deg", std::f64::consts::PI / 180.0, &[2.0, 5.0], 45.0),
    (GroundKind::HeightField, "height field", "m", 1.0, &[0.01, 0.03], 1.0),
    (GroundKind::LowFriction, "low friction", "1", 1.0, &[0.3], 10.0),
    (GroundKind::Masses, "masses, each", "1", 1.0, &[0.2], 0.9),
    (GroundKind::Weight, "masses, all", "1", 1.0, &[0.2], 0.9),
    (GroundKind::TorsoCog, "torso's CoG", "m", 1.0, &[0.03], 0.5),
    (GroundKind::Payload, "payload", "kg", 1.0, &[8.0], 100.0),
];

impl GroundKind {
    /// All kinds.
    pub(super) fn all() -> impl Iterator<Item = Self> {
        TABLE.iter().map(|row| row.0)
    }

    fn row(self) -> &'static KindRow {
        TABLE.iter().find(|row| row.0 == self).expect("every kind has its row")
    }

    /// In tables and charts.
    pub(super) fn name(self) -> &'static str {
        self.row().1
    }

    /// Unit of its size.
    pub(super) fn unit(self) -> &'static str {
        self.row().2
    }

    /// Itself with a size in its unit: `board of 0.02 m`.
    pub(crate) fn of(self, size: f64) -> String {
        let unit = if self.unit() == "1" { String::new() } else { format!(" {}", self.unit()) };
        format!("{} of {size}{unit}", self.name())
    }

    /// A size in its unit, in SI.
    pub(super) fn in_si(self, size: f64) -> f64 {
        self.row().3 * size
    }

    /// Refuses a size, in its unit, of which there is none, or no place to walk over.
    pub(super) fn check(self, size: f64) -> Result<(), String> {
        let (name, unit, most) = (self.name(), self.unit(), self.row().5);
        (size <= most).then_some(()).ok_or(format!("--size {size}: {name} takes a size up to {most} {unit}"))
    }

    /// Sizes tried unless told otherwise, in its unit.
    pub(super) fn sizes(self) -> &'static [f64] {
        self.row().4
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::ValueEnum;

    #[test]
    fn every_kind_has_its_row() {
        for kind in GroundKind::value_variants() {
            assert!(
                !kind.sizes().is_empty() && kind.sizes().iter().all(|&size| kind.check(size).is_ok()),
                "{kind:?}"
            );
        }
        assert!(GroundKind::Slope.check(180.0).is_err(), "as level as 0 deg");
        assert_eq!(GroundKind::all().collect::<Vec<_>>(), GroundKind::value_variants());
    }
}
