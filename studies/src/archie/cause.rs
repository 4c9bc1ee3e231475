//! What can be wrong with robot, ground and pattern: how it gets into a scene, and how into the prediction.

use config::Setup;
use config::pattern::Pattern;
use config::sensors::PerJoint;
use config::terrain::{ObjectShape, TerrainObject, TerrainPose};
use messages::{LEFT, MAX_JOINTS};

use super::statics::{Bump, Deviation, Statics};
use super::trial::{Foothold, STEPS, repattern};

/// Landing of the predicted walk whose footprint is uneven: that of the first whole step.
const LANDING: usize = 1;
/// \[m\] How deep the boxes reach into the ground, so that a sole meets their tops.
const DEEP: f64 = 0.1;

/// Part of the study that a cause belongs to, for `--only`.
pub(super) type Part = &'static str;

type Shown = fn(f64) -> f64;
/// Changes a pattern by a number in the unit.
type Change = fn(&mut Pattern, f64);

/// One thing that can be wrong.
pub(super) struct Cause {
    pub(super) part: Part,
    pub(super) name: String,
    pub(super) unit: &'static str,
    /// Tried at most on the one and on the other side, in the unit; 0: there is no such side.
    pub(super) tried: [f64; 2],
    /// A number in the unit as it is shown.
    pub(super) shown: Shown,
    /// Where it acts.
    pub(super) acts: Acts,
}

/// Where a cause acts.
pub(super) enum Acts {
    /// \[deg\] Zero position of a joint.
    Zero(usize),
    /// \[deg\] Slope of the ground about x or y.
    Slope(usize),
    /// \[mm\] Raised ground under a part of a footprint, or in the way of the swing.
    Bump(Place),
    /// Another pattern.
    Pattern(Change),
    /// \[ms\] Drives that play their paths late: those whose names begin and end with these.
    Late(&'static str, &'static str),
}

/// Where the ground is raised.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Place {
    Heel,
    Toe,
    Outer,
    Inner,
    /// Under the whole sole that lands: contact comes early.
    Sole,
    /// Where the swinging foot is half-way.
    MidSwing,
}

impl Place {
    /// From, to \[m\], forward and outwards from the sole frame of a foot that lands; `stride` \[m\] the way it swings.
    fn area(self, stride: f64) -> [[f64; 2]; 2] {
        let (along, across) = ([-0.1, 0.16], [-0.07, 0.07]);
        match self {
            Self::Heel => [[-0.1, 0.0], across],
            Self::Toe => [[0.06, 0.16], across],
            Self::Outer => [along, [0.0, 0.07]],
            Self::Inner => [along, [-0.07, 0.0]],
            Self::Sole => [along, across],
            Self::MidSwing => [[-0.5 * stride, 0.05 - 0.5 * stride], [-0.06, 0.12]],
        }
    }

    /// The same about a footprint in the world.
    fn around(self, foot: usize, [x, y]: [f64; 2], stride: f64) -> [[f64; 2]; 2] {
        let [along, across] = self.area(stride);
        let out = if foot == LEFT { across } else { [-across[1], -across[0]] };
        [along.map(|d| x + d), out.map(|d| y + d)]
    }
}

impl Cause {
    /// Puts it into a scene whose footprint `at` is the uneven one.
    pub(super) fn apply(&self, setup: &mut Setup, x: f64, at: &Foothold) {
        match &self.acts {
            Acts::Zero(joint) => {
                let own = vec![(setup.robot.joints[*joint].name.clone(), x.to_radians())];
                setup.scene.plant_mismatch.joint_offset = PerJoint { all: None, own };
            }
            Acts::Slope(axis) => setup.scene.plant_mismatch.ground_tilt[*axis] = x.to_radians(),
            Acts::Bump(place) => {
                let swings = *place == Place::MidSwing;
                let area = place.around(at.foot, at.place, at.way);
                let appears = if swings { 0.0 } else { 0.5 * (at.lifted + at.landed) };
                setup.scene.objects.push(raised(area, 1e-3 * x, appears));
            }
            Acts::Pattern(change) => {
                if let Some(mut pattern) = setup.gait.pattern {
                    change(&mut pattern, x);
                    repattern(setup, pattern, STEPS);
                }
            }
            Acts::Late(..) => {}
        }
    }

    /// \[s\] By how much each drive is late.
    pub(super) fn lag(&self, setup: &Setup, x: f64) -> [f64; MAX_JOINTS] {
        let mut lag = [0.0; MAX_JOINTS];
        if let Acts::Late(begin, end) = self.acts {
            for (joint, lag) in setup.robot.joints.iter().zip(&mut lag) {
                if joint.name.starts_with(begin) && joint.name.ends_with(end) {
                    *lag = 1e-3 * x;
                }
            }
        }
        lag
    }

    /// Whether the walk is made, by the prediction.
    pub(super) fn predicted(&self, setup: &Setup, x: f64) -> bool {
        let mut gait = setup.gait.clone();
        if let (Acts::Pattern(change), Some(pattern)) = (&self.acts, &mut gait.pattern) {
            change(pattern, x);
        }
        let Some(mut statics) = Statics::new(&setup.robot, &gait) else { return false };
        let mut wrong = Deviation { lag: self.lag(setup, x), ..Deviation::NONE };
        match &self.acts {
            Acts::Zero(joint) => wrong.zero[*joint] = x.to_radians(),
            Acts::Slope(axis) => wrong.slope[*axis] = x.to_radians(),
            Acts::Bump(place) => {
                let landing = statics.landing(LANDING);
                let area = place.around(landing.foot, landing.place, landing.way);
                let from = if *place == Place::MidSwing { 0.0 } else { landing.lifted };
                wrong.bump = Some(Bump { area, height: 1e-3 * x, from });
            }
            Acts::Pattern(_) | Acts::Late(..) => {}
        }
        statics.walks(&wrong)
    }
}

fn raised([along, across]: [[f64; 2]; 2], height: f64, appears: f64) -> TerrainObject {
    let ([x0, x1], [y0, y1]) = (along, across);
    TerrainObject {
        name: "raised".into(),
        shape: ObjectShape::Box([x1 - x0, y1 - y0, DEEP + height]),
        pose: TerrainPose {
            position: [0.5 * (x0 + x1), 0.5 * (y0 + y1), 0.5 * (height - DEEP)],
            rotation: [0.0; 3],
        },
        friction: None,
        appears,
        vanishes: f64::INFINITY,
        keeps_clear: 0.0,
        known: false,
        poses: Vec::new(),
    }
}

/// Everything that is tried.
pub(super) fn causes(setup: &Setup) -> Vec<Cause> {
    let cause = |part, name: &str, unit, tried, acts| Cause {
        part,
        name: name.into(),
        unit,
        tried,
        shown: |x| x,
        acts,
    };
    let mut all: Vec<Cause> = Vec::new();
    for (j, joint) in setup.robot.joints.iter().enumerate() {
        let name = format!("zero of {}", joint.name.replace('_', " "));
        all.push(cause("zero", &name, "deg", [-24.0, 24.0], Acts::Zero(j)));
    }
    for (axis, name) in ["right side down to left side down", "uphill to downhill"].into_iter().enumerate() {
        let name = format!("ground tilted, {name}");
        all.push(cause("ground", &name, "deg", [-5.7, 5.7], Acts::Slope(axis)));
    }
    for (name, place) in [
        ("heel", Place::Heel),
        ("toe", Place::Toe),
        ("outer edge", Place::Outer),
        ("inner edge", Place::Inner),
        ("whole sole: early contact", Place::Sole),
    ] {
        let name = format!("bump under the {name}");
        all.push(cause("ground", &name, "mm", [0.0, 64.0], Acts::Bump(place)));
    }
    let block = "block in mid-swing";
    all.push(cause("ground", block, "mm", [0.0, 128.0], Acts::Bump(Place::MidSwing)));
    let patterns: [(&str, &str, [f64; 2], Shown, Change); 5] = [
        ("q_b, a foot leaves over its toe", "rad", [0.0, 0.5], |x| x, |p, x| p.leave = x),
        ("q_f, a foot lands on its heel", "rad", [0.0, 0.5], |x| x, |p, x| p.land = x),
        ("T_d / T_c", "1", [-0.3, 0.1], |x| 0.4 + x, longer_support),
        ("w_m", "cm", [-2.0, 3.0], |x| 2.0 + x, |p, x| p.shift += 0.01 * x),
        ("D_s / T_c, all times alike", "cm/s", [0.0, 30.0], |x| SPEED + x, faster),
    ];
    for (name, unit, tried, shown, change) in patterns {
        all.push(Cause { shown, ..cause("pattern", name, unit, tried, Acts::Pattern(change)) });
    }
    for (name, begin, end) in [
        ("left leg late", "left", ""),
        ("knees late", "", "knee_flexion"),
        ("one knee late", "left", "knee_flexion"),
    ] {
        all.push(cause("clocks", name, "ms", [0.0, 4000.0], Acts::Late(begin, end)));
    }
    all
}

/// \[cm/s\] Speed of the pattern as it is.
const SPEED: f64 = 25.0 / 12.0;

/// All times shorter, `x` \[cm/s\] faster.
fn faster(p: &mut Pattern, x: f64) {
    let share = SPEED / (SPEED + x);
    for time in [&mut p.step_time, &mut p.double_support, &mut p.over_time, &mut p.low_time, &mut p.high_time]
    {
        *time *= share;
    }
    stay_flat(p);
}

/// A longer double support, by `x` of a step.
fn longer_support(p: &mut Pattern, x: f64) {
    p.double_support += x * p.step_time;
    stay_flat(p);
}

/// Times of a pitch that is none.
fn stay_flat(p: &mut Pattern) {
    p.pitch_times = [0.0, p.step_time, p.step_time + p.double_support];
}
