//! How a robot walks (planner) and how it is stabilized (controller).

use std::path::Path;

use crate::error::ConfigError;
use crate::file::{self, ConfigReader};
use crate::pattern::Pattern;
use crate::section::{self, NOT_NEGATIVE, POSITIVE, Section};

/// `gaits/NAME.toml`.
#[derive(Clone, Debug, Default)]
pub struct Gait {
    /// Steps.
    pub step: StepSettings,
    /// Model the centre-of-gravity trajectory is planned with.
    pub model: GaitModel,
    /// What may be commanded.
    pub limits: CommandLimits,
    /// Steps over obstacles and onto platforms; none: the robot stays on level ground.
    pub obstacles: Option<Obstacles>,
    /// Steps that react to pushes; none: footholds and times are as planned, whatever happens.
    pub reaction: Option<Reaction>,
    /// Stabilizing control.
    pub control: StabilizerGains,
    /// Walking pattern with fixed parameters, which nobody stabilizes; it then says what the steps, limits and heights
    /// above are. None: walks are balanced (thesis 4.6).
    pub pattern: Option<Pattern>,
    /// \[1\] How far an arm's centre of gravity moves with that of the opposite leg; none: arms hang still.
    pub arm_swing: Option<f64>,
    /// How far the toe joints bend when the heel leaves the ground; none: toes stay straight.
    pub toes: Option<Bend>,
    /// How far the toes point up when the heel touches the ground; none: it lands flat.
    pub heel_strike: Option<Bend>,
}

/// An angle that grows with the length of a step (4.29).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bend {
    /// \[rad\] Largest bend.
    pub angle: f64,
    /// \[m\] Step lengths up to which the bend is zero, and from which it is largest.
    pub length: [f64; 2],
}

impl Bend {
    /// \[rad\] After a step of `length` \[m\]; zero for a step backwards (4.29), clamped above as well.
    pub fn at(&self, length: f64) -> f64 {
        let [none, all] = self.length;
        self.angle * ((length - none) / (all - none)).clamp(0.0, 1.0)
    }

    fn build(table: &Section<'_, '_>) -> Self {
        let bend = Self {
            angle: table.number("angle", "rad", 0.0..=1.5),
            length: table.interval("length", "m", NOT_NEGATIVE),
        };
        let [none, all] = bend.length;
        if all - none < 1e-6 {
            table.problem("length", format!("[{none}, {all}] m: the second one must be larger"));
        }
        bend
    }
}

/// Steps and feet.
#[derive(Clone, Debug, Default)]
pub struct StepSettings {
    /// \[m\] Lateral distance of the sole frames W_step.
    pub width: f64,
    /// \[m\] Least lateral distance of the sole frames W_step,min, feet parallel.
    pub width_min: f64,
    /// \[m\] Height of the swing foot z_swing.
    pub swing_height: f64,
    /// \[1\] Share of a step that is double support.
    pub double_support: f64,
    /// \[s\] Double support of the first step out of standing, and after the last one until rest.
    pub start_time: f64,
    /// \[s\] Time from lift-off until the swing foot begins to move horizontally.
    pub swing_lag: f64,
    /// \[s\] Time from the end of the swing foot's horizontal motion to landing.
    pub swing_lead: f64,
    /// \[m\] Longest first and last step.
    pub first_length: f64,
    /// \[m, m, rad\] Largest change of (length, side, turn) from one step to the next.
    pub change: [f64; 3],
    /// \[s\] Largest change of the duration from one step to the next.
    pub change_duration: f64,
    /// Step lengths and durations of forward walking by speed, ascending in speed: \[m/s, m, s\].
    pub by_speed: Vec<[f64; 3]>,
}

/// \[s\] Spacing of the knots of the centre-of-gravity trajectory: with half of it plans differ by less than a millimetre.
pub const KNOT_SPACING: f64 = 0.08;

/// The three-mass model (4.38).
#[derive(Clone, Copy, Debug, Default)]
pub struct GaitModel {
    /// \[m\] Height of the centre of gravity while walking.
    pub com_height: f64,
    /// \[m\] Where the centre of gravity stands in x, in front of the middle of the sole frames.
    pub com_forward: f64,
    /// \[1\] Mass of one leg point over the robot's mass.
    pub leg_mass: f64,
    /// \[m\] Height of a leg's mass point above its sole frame.
    pub leg_height: f64,
    /// \[m\] Distance the planned zero-moment point keeps from the edges of the support polygon.
    pub zmp_margin: f64,
    /// Method for the trajectory of the centre of gravity.
    pub cog_method: CogMethod,
    /// \[s\] Largest spacing of its knots: [`KNOT_SPACING`], but in studies of accuracy.
    pub spacing: f64,
    /// \[1\] Most friction a plan may ask of the ground.
    pub friction: f64,
}

/// Methods for the trajectory of the centre of gravity (thesis 4.6.5).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CogMethod {
    /// Spline collocation (4.50): three masses, any heights.
    #[default]
    Collocation,
    /// Closed form (4.44), exact for one mass at constant height: `leg_mass` must be 0, and there is no `[obstacles]`.
    ClosedForm,
}

impl CogMethod {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Collocation, Self::ClosedForm];
    /// Their names in a gait file, in the same order.
    pub const WORDS: [&str; 2] = ["collocation", "closed_form"];
}

/// Ranges of walking commands (thesis 4.6.1); outside of them a command is refused.
#[derive(Clone, Copy, Debug, Default)]
pub struct CommandLimits {
    /// \[m\] Step length.
    pub length: [f64; 2],
    /// \[m\] Step to the side.
    pub side: [f64; 2],
    /// \[rad\] Turn per step.
    pub turn: [f64; 2],
    /// \[s\] Step duration.
    pub duration: [f64; 2],
    /// \[s\] Shortest step over all of the range to the side.
    pub side_duration: f64,
}

impl CommandLimits {
    /// \[1\] How much of the ranges a step of this length, side and turn \[m, m, rad\] in `duration` \[s\] uses; it can be walked
    /// up to 1.
    ///
    /// A range holds for steps that do nothing else. Length, side and turn come out of the same reach of legs, hips and ankles: what
    /// one of them uses is not left to the others, so shares add up. A step to the side accelerates the body by as much as it
    /// is far and by the square of its haste, so that short ones go less far.
    pub fn used(&self, step: [f64; 3], duration: f64) -> f64 {
        let haste = (self.side_duration / duration).max(1.0);
        let parts = [step[0], step[1] * haste * haste, step[2]].into_iter();
        let parts = parts.zip([self.length, self.side, self.turn]).map(|(x, [low, high])| {
            // A range may be zero, as are side and turn of a walking pattern.
            if x == 0.0 { 0.0 } else { x / if x < 0.0 { low } else { high } }
        });
        parts.sum()
    }
}

/// Steps over obstacles and onto platforms (thesis 4.3.3, 4.3.4).
#[derive(Clone, Copy, Debug, Default)]
pub struct Obstacles {
    /// \[m\] Distance of a foothold from an obstacle or an edge.
    pub distance: f64,
    /// \[m\] Clearance of the swing foot over the obstacle.
    pub clearance: f64,
    /// \[m\] Highest obstacle that is stepped over, and highest platform.
    pub height: f64,
    /// \[m\] Longest step over an obstacle or onto a platform.
    pub length: f64,
    /// \[rad\] Pitch, toes down, of a foot that is lifted high while it is still far behind: its ankle bends less.
    pub tilt: f64,
    /// \[s\] Duration of a step over an obstacle or onto a platform.
    pub duration: f64,
}

/// Room for steps that react to a push (Khadiv et al. 2016), out of standing too: boxes of the landing and of its time.
#[derive(Clone, Copy, Debug, Default)]
pub struct Reaction {
    /// \[m\] Landing forward of the stance foot.
    pub length: [f64; 2],
    /// \[m\] Landing to the side of the stance foot: feet do not cross.
    pub width: [f64; 2],
    /// \[s\] Shortest swing from lift-off to landing.
    pub swing: f64,
    /// \[s\] Shortest rest of a swing in which its foothold may still be changed.
    pub rest: f64,
    /// \[s\] By how much a swing may last longer, until a body that was pushed over its stance foot comes back.
    pub wait: f64,
    /// \[m/s\] Fastest mean speed of the swing foot over the ground.
    pub speed: f64,
    /// \[m\] Least error of the divergent component to which a step reacts.
    pub error: f64,
    /// \[m\] Errors of the divergent component at landing, forward and to the side, that the next support compensates.
    pub tolerance: [f64; 2],
}

/// Gains of the stabilizer (thesis chapter 5).
#[derive(Clone, Copy, Debug, Default)]
pub struct StabilizerGains {
    /// \[N m/rad\] K_P of the inclinations phi_x, phi_y (5.2), (5.3).
    pub inclination_p: [f64; 2],
    /// \[N m s/rad\] K_D of the inclinations (5.2), (5.3).
    pub inclination_d: [f64; 2],
    /// \[N/m\] K_P of the height of the centre of gravity (5.4).
    pub height_p: f64,
    /// \[N s/m\] K_D of the height (5.4).
    pub height_d: f64,
    /// \[1\] How much of the shift of normal force between the feet (5.14) is used; 0: moments of the feet alone.
    pub force_shift: f64,
    /// \[1/s\] K_lambda of normal force, moment about x, moment about y (5.26).
    pub force_gain: [f64; 3],
    /// \[1\] Feed-forward gain K_lambda,FF of the contact forces (5.31).
    pub force_feed_forward: f64,
    /// \[N\] Contact forces between which a foot is blended from position to force control.
    pub force_blend: [f64; 2],
    /// \[1/s\] K_lambda_x: how fast a modification returns to zero under position control (5.32).
    pub position_gain: f64,
    /// \[m, rad, rad\] Limits of a modification (z, s1, s0).
    pub modification_limit: [f64; 3],
    /// \[m/s, rad/s, rad/s\] Limits of the rate of a modification (z, s1, s0).
    pub modification_rate: [f64; 3],
    /// \[1\] Share of the upper body's inclination error that the swing foot compensates (4.9).
    pub inclination_compensation: f64,
    /// \[1\] Share of the soles' deformation under the planned forces that is part of the foot trajectories (4.9).
    pub planned_deformation: f64,
    /// \[1\] Feedback path of figure 5.8: 1 the joint targets of the last cycle, 2 the measured joint angles.
    pub feedback: u64,
    /// \[1/s\] K_x: drift compensation (feedback path 1) or position control (path 2) of the inverse kinematics.
    pub drift_gain: f64,
    /// \[s\] Time constant of the force sensor filter.
    pub force_filter: f64,
}

/// \[1\] How far a row of `by_speed` may be from length = speed * duration.
const SPEED_TOLERANCE: f64 = 0.05;

impl Gait {
    /// Reads a gait file.
    pub fn load(path: &Path) -> Result<Self, ConfigError> {
        Self::load_with(path, &mut ConfigReader::default())
    }

    pub(crate) fn load_with(path: &Path, reader: &mut ConfigReader) -> Result<Self, ConfigError> {
        Self::of_text(path, &file::text(path, reader)?)
    }

    /// The gait of a file with this text.
    pub(crate) fn of_text(path: &Path, text: &str) -> Result<Self, ConfigError> {
        section::read(path, text, |top| {
            if top.has("pattern") {
                return Self::of_pattern(top);
            }
            let gait = Self {
                step: top.table("step", StepSettings::build).unwrap_or_default(),
                model: top.table("model", GaitModel::build).unwrap_or_default(),
                limits: top.table("limits", CommandLimits::build).unwrap_or_default(),
                obstacles: top.has("obstacles").then(|| top.table("obstacles", Obstacles::build)).flatten(),
                reaction: top.has("reaction").then(|| top.table("reaction", Reaction::build)).flatten(),
                control: top.table("control", StabilizerGains::build).unwrap_or_default(),
                pattern: None,
                arm_swing: top.has("arm_swing").then(|| top.number("arm_swing", "", 0.0..=3.0)),
                toes: bend(top, "toes"),
                heel_strike: bend(top, "heel_strike"),
            };
            gait.check(top);
            gait
        })
    }

    /// A gait that is a pattern: `[pattern]` says what other gaits say in several tables.
    fn of_pattern(top: &Section<'_, '_>) -> Self {
        top.table("pattern", Pattern::build).map_or_else(Self::default, Self::from)
    }

    /// Rules between tables.
    fn check(&self, top: &Section<'_, '_>) {
        // Steps and their times within what may be commanded.
        let (step, limits) = (&self.step, &self.limits);
        if step.first_length > limits.length[1] {
            let [_, most] = limits.length;
            top.problem(
                "step",
                format!("first_length {} is above limits.length {most} m", step.first_length),
            );
        }
        let [least, most] = limits.duration;
        if limits.side_duration < least || limits.side_duration > most {
            top.problem(
                "limits",
                format!(
                    "side_duration {} s lies outside of duration [{least}, {most}] s",
                    limits.side_duration
                ),
            );
        }
        let swing = least * (1.0 - step.double_support);
        if step.swing_lag + step.swing_lead >= swing {
            let sum = step.swing_lag + step.swing_lead;
            top.problem(
                "step",
                format!("swing_lag + swing_lead = {sum} s leave nothing of a swing of {swing:.3} s"),
            );
        }
        // Tables that exclude or need one another.
        if self.reaction.is_some() && self.heel_strike.is_some() {
            top.problem(
                "reaction",
                "a foot that is to land on its heel lands nowhere else: leave out [heel_strike], or this",
            );
        }
        if let Some(o) = self.obstacles.filter(|o| o.duration < least || o.duration > most) {
            let duration = o.duration;
            top.problem("obstacles", format!("duration {duration} s lies outside of limits.duration"));
        }
        let leg_mass = self.model.leg_mass;
        if self.model.cog_method == CogMethod::ClosedForm && (leg_mass > 0.0 || self.obstacles.is_some()) {
            let has = if self.obstacles.is_some() { "with" } else { "without" };
            top.problem(
                "model",
                format!(
                    "cog_method `closed_form` is for one mass at constant height: it wants leg_mass 0 and no [obstacles] \
                     (now {leg_mass}, {has}); or take `collocation`"
                ),
            );
        }
        // Rows of speeds: within the limits, and of the speed that they say.
        for (i, [speed, length, duration]) in step.by_speed.iter().enumerate() {
            if *length < limits.length[0] || *length > limits.length[1] {
                top.problem(
                    "step",
                    format!("by_speed[{i}]: length {length} m lies outside of limits.length"),
                );
            }
            if *duration < limits.duration[0] || *duration > limits.duration[1] {
                top.problem(
                    "step",
                    format!("by_speed[{i}]: duration {duration} s lies outside of limits.duration"),
                );
            }
            if (length - speed * duration).abs() > SPEED_TOLERANCE * length.abs() {
                let is = length / duration;
                top.problem(
                    "step",
                    format!("by_speed[{i}]: {length} m in {duration} s are {is:.3} m/s, not {speed}"),
                );
            }
        }
    }
}

impl From<Pattern> for Gait {
    fn from(pattern: Pattern) -> Self {
        Self {
            step: pattern.step(),
            model: pattern.model(),
            limits: pattern.limits(),
            pattern: Some(pattern),
            ..Self::default()
        }
    }
}

/// An optional table.
fn bend(top: &Section<'_, '_>, key: &str) -> Option<Bend> {
    top.has(key).then(|| top.table(key, Bend::build)).flatten()
}

impl StepSettings {
    fn build(table: &Section<'_, '_>) -> Self {
        let by_speed: Vec<[f64; 3]> = table.rows("by_speed", "[speed in m/s, length in m, duration in s]");
        if by_speed.first().is_some_and(|row| row[0] > 0.0) {
            table.problem("by_speed", "its first row must be for speed 0 m/s");
        }
        if by_speed.windows(2).any(|pair| pair[0][0] >= pair[1][0]) {
            table.problem("by_speed", "its speeds must ascend");
        }
        // Each number in its own range, and then the two widths.
        let step = Self {
            width: table.number("width", "m", POSITIVE),
            width_min: table.number("width_min", "m", POSITIVE),
            swing_height: table.number("swing_height", "m", 0.0..=0.5),
            double_support: table.number("double_support", "", 0.02..=0.9),
            start_time: table.number("start_time", "s", POSITIVE),
            swing_lag: table.number("swing_lag", "s", NOT_NEGATIVE),
            swing_lead: table.number("swing_lead", "s", NOT_NEGATIVE),
            first_length: table.number("first_length", "m", POSITIVE),
            change: table.numbers("change", "m, m, rad", POSITIVE),
            change_duration: table.number("change_duration", "s", POSITIVE),
            by_speed,
        };
        if step.width < step.width_min {
            let (width, least) = (step.width, step.width_min);
            table.problem("width", format!("{width} m must not be below width_min = {least} m"));
        }
        step
    }
}

impl GaitModel {
    fn build(table: &Section<'_, '_>) -> Self {
        Self {
            com_height: table.number("com_height", "m", 0.1..=3.0),
            com_forward: table.number("com_forward", "m", -0.5..=0.5),
            leg_mass: table.number("leg_mass", "", 0.0..=0.4),
            leg_height: table.number("leg_height", "m", 0.0..=1.0),
            zmp_margin: table.number("zmp_margin", "m", 0.0..=0.2),
            cog_method: if table.has("cog_method") {
                CogMethod::ALL[table.word("cog_method", &CogMethod::WORDS)]
            } else {
                CogMethod::default()
            },
            spacing: KNOT_SPACING,
            friction: table.number("friction", "", POSITIVE),
        }
    }
}

impl CommandLimits {
    fn build(table: &Section<'_, '_>) -> Self {
        Self {
            length: table.interval("length", "m", -1.5..=1.5),
            side: table.interval("side", "m", -1.0..=1.0),
            turn: table.interval("turn", "rad", -1.0..=1.0),
            duration: table.interval("duration", "s", 0.2..=20.0),
            side_duration: table.number("side_duration", "s", 0.2..=20.0),
        }
    }
}

impl Obstacles {
    fn build(table: &Section<'_, '_>) -> Self {
        Self {
            distance: table.number("distance", "m", 0.0..=0.2),
            clearance: table.number("clearance", "m", 0.0..=0.2),
            height: table.number("height", "m", 0.0..=0.5),
            length: table.number("length", "m", POSITIVE),
            tilt: table.number("tilt", "rad", 0.0..=0.8),
            duration: table.number("duration", "s", POSITIVE),
        }
    }
}

impl Reaction {
    fn build(table: &Section<'_, '_>) -> Self {
        Self {
            length: table.interval("length", "m", -1.5..=1.5),
            width: table.interval("width", "m", POSITIVE),
            swing: table.number("swing", "s", POSITIVE),
            rest: table.number("rest", "s", POSITIVE),
            wait: table.number("wait", "s", NOT_NEGATIVE),
            speed: table.number("speed", "m/s", POSITIVE),
            error: table.number("error", "m", POSITIVE),
            tolerance: table.numbers("tolerance", "m, m", POSITIVE),
        }
    }
}

impl StabilizerGains {
    fn build(table: &Section<'_, '_>) -> Self {
        Self {
            inclination_p: table.numbers("inclination_p", "N m/rad", NOT_NEGATIVE),
            inclination_d: table.numbers("inclination_d", "N m s/rad", NOT_NEGATIVE),
            height_p: table.number("height_p", "N/m", NOT_NEGATIVE),
            height_d: table.number("height_d", "N s/m", NOT_NEGATIVE),
            force_shift: table.number("force_shift", "", 0.0..=1.0),
            force_gain: table.numbers("force_gain", "1/s", 0.0..=500.0),
            force_feed_forward: table.number("force_feed_forward", "", 0.0..=1.0),
            force_blend: table.interval("force_blend", "N", NOT_NEGATIVE),
            position_gain: table.number("position_gain", "1/s", 0.0..=500.0),
            modification_limit: table.numbers("modification_limit", "m, rad, rad", 0.0..=1.0),
            modification_rate: table.numbers("modification_rate", "m/s, rad/s, rad/s", 0.0..=20.0),
            inclination_compensation: table.number("inclination_compensation", "", 0.0..=1.0),
            planned_deformation: table.number("planned_deformation", "", 0.0..=1.0),
            feedback: table.integer("feedback", 1..=2),
            drift_gain: table.number("drift_gain", "1/s", 0.0..=500.0),
            force_filter: table.number("force_filter", "s", 0.0..=1.0),
        }
    }
}
