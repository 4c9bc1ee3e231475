//! Local controllers as they are built (thesis 5.5.2): the motor's angle in counts of its encoder, and where the motor is to
//! be by a look-up table of the linkage, in integers. Only drives that ask for it, by [`drives::Resolution`], have this.
//!
//! ```text
//! exact    e = c(q) (q_d - q)                 w_d = c(q) q'_d
//! here     e = f(q_d) - delta floor(f/delta)  w_d = c_T(q_d) q'_d
//! ```
//!
//! f: angle of the motor over the angles of its joints; f(q_d), c_T by the table, or by the linkage itself where only counts
//! are asked for. A controller that sees the link's side has f(q) by the same table instead of counts.

use std::f64::consts::TAU;

use config::robot::{Drive, Joint};
use drives::{FixedTable, GearSide, OutOfDomain, Resolution, Transmission};

/// \[rad\] How far a table goes beyond the ranges of the joints: targets end there, and what follows them may overshoot.
const MARGIN: f64 = 0.02;

/// Angle of a motor, and its reference, as a drive with counts and tables has them.
#[derive(Clone)]
pub(crate) struct Coarse {
    table: Option<FixedTable>,
    /// \[rad\] Of the motor, one count; 0: all of the angle.
    count: f64,
    /// True if the law needs the link's side.
    link: bool,
    /// \[rad\], \[1\] Where the motor is to be, and the ratios there.
    wanted: (f64, [f64; 3]),
    /// \[rad\] Where it is, seen on the link's side and on the motor's.
    angle: [f64; 2],
    /// \[rad\] The same at the last sample.
    last: Option<f64>,
}

/// Angles of the joints of a drive \[rad\].
pub(crate) struct Angles {
    /// References.
    pub(crate) reference: [f64; 3],
    /// Readings, on the link's side and on the motor's.
    pub(crate) measured: [[f64; 3]; 2],
}

impl Coarse {
    /// For a drive of `joints`, if it is to have it.
    ///
    /// # Errors
    /// Its linkage has no table: it reaches a dead point near the ranges of its joints, or these go beyond ±4 rad.
    pub(crate) fn new(drive: &Drive, joints: &[Joint]) -> Result<Option<Self>, String> {
        let resolution = drive.control.resolution;
        if resolution == Resolution::default() {
            return Ok(None);
        }
        let linkage = !matches!(drive.transmission, Transmission::Harmonic { .. });
        let table = resolution.table_points.filter(|_| linkage).map(|n| table(drive, joints, n as usize));
        let link = drive.control.law.position_side() == GearSide::Link;
        Ok(Some(Self {
            table: table.transpose()?,
            count: resolution.encoder_counts.map_or(0.0, |counts| TAU / f64::from(counts)),
            link,
            wanted: (0.0, [0.0; 3]),
            angle: [0.0; 2],
            last: None,
        }))
    }

    /// Looks at the joints; what cannot be found stays as it was.
    pub(crate) fn look(&mut self, transmission: &Transmission, at: &Angles) -> Result<(), OutOfDomain> {
        let by_linkage = |q: [f64; 3]| transmission.at(q, [0.0; 3]).map(|gear| (gear.angle, gear.ratio));
        let find = |q: [f64; 3]| self.table.as_ref().map_or_else(|| by_linkage(q), |t| t.at_angles(q));
        let wanted = find(at.reference)?;
        let link = if self.link { find(at.measured[GearSide::Link as usize])?.0 } else { 0.0 };
        let motor = by_linkage(at.measured[GearSide::Motor as usize])?.0;
        self.wanted = wanted;
        self.angle = [link, self.counted(motor)];
        Ok(())
    }

    /// \[rad\] How far the motor is from where it is to be, by side.
    pub(crate) fn error(&self) -> [f64; 2] {
        self.angle.map(|angle| self.wanted.0 - angle)
    }

    /// \[1\] Ratios by which the speed of the motor is found from those of its joints.
    pub(crate) fn ratio(&self) -> [f64; 3] {
        self.wanted.1
    }

    /// \[rad/s\] Speed of the motor from its counts of two samples, `cycle` \[s\] apart; 0 at the first one.
    pub(crate) fn speed(&mut self, cycle: f64) -> f64 {
        let now = self.angle[GearSide::Motor as usize];
        (now - self.last.replace(now).unwrap_or(now)) / cycle
    }

    fn counted(&self, angle: f64) -> f64 {
        if self.count > 0.0 { (angle / self.count).floor() * self.count } else { angle }
    }
}

/// The table of a linkage, over the ranges of its joints and a little more.
fn table(drive: &Drive, joints: &[Joint], points: usize) -> Result<FixedTable, String> {
    let range = |i: usize| {
        let [lo, hi] = drive.joints.get(i).map_or([0.0; 2], |j| joints[*j].range);
        [lo - MARGIN, hi + MARGIN]
    };
    FixedTable::new(&drive.transmission, [0, 1, 2].map(range), [points; 2]).map_err(|why| {
        let name = &drive.name;
        format!(
            "drive `{name}`: no look-up table over the ranges of its joints and {MARGIN} rad more: {why}; draw in \
             range_deg, or leave out table_points"
        )
    })
}
