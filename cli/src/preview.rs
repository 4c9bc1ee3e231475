//! `gangwerk preview`: a pattern as pictures, before any mass moves (Daniali 2013, 4.3, 4.4, 6.2).
//!
//! | picture | figures |
//! |---|---|
//! | `sticks.png`: the robot at nine instants of a stride, from the side, from the front, from above, in space | 4.31-4.39, 6.26, 6.27 |
//! | `legs.png`: both legs over a stride | 4.40, 4.41 |
//! | `trajectories.png`: feet and torso over time | 4.11-4.17, 6.11-6.16 |
//! | `planes.png`: their ways in three planes | 4.18-4.23, 6.17-6.19 |
//! | `joints.png`: angles of the joints | 4.24-4.29, 6.20-6.25 |

use config::{Gait, Robot};
use drawing::color::{BLACK, BLUE, GREEN, VERMILION};
use drawing::{Chart, Color, Figure, Point};
use messages::{LEFT, RIGHT};
use nalgebra::{Matrix3, Rotation3, Vector3};
use planner::Planner;
use planner::pattern_check::{PatternFault, WalkedPlan, walk_of};
use std::path::{Path, PathBuf};

/// Instants of a stride at which curves are drawn.
const POINTS: usize = 600;
/// \[m\] Distance of the stick figures from one another.
const APART: f64 = 0.7;
/// Right foot, left foot.
const COLORS: [Color; 2] = [BLUE, VERMILION];
const SIDES: [&str; 2] = ["right", "left"];

/// Pictures of a pattern, and what it breaks.
pub struct Preview {
    /// Files that were written.
    pub files: Vec<PathBuf>,
    /// First rule that is broken, if the robot cannot walk it.
    pub fault: Option<PatternFault>,
}

/// Draws the pattern of a gait, a name or the path of a file, on a robot of the configuration `root`; see [`preview`].
///
/// # Errors
/// As there, and files that cannot be read.
pub fn of_files(root: &Path, gait: &Path, robot: &str, out: &Path) -> Result<Preview, String> {
    let file =
        if gait.is_file() { gait.to_owned() } else { root.join("gaits").join(gait).with_extension("toml") };
    let pattern = Gait::load(&file).map_err(|e| e.to_string())?;
    let of = Robot::load(&root.join("robots").join(robot)).map_err(|e| e.to_string())?;
    preview(&pattern, &of, &format!("{}, {robot}", gait.display()), out)
}

/// Draws the pattern of `gait` on `robot` into the directory `out`.
///
/// # Errors
/// The gait has no pattern, the robot no legs in closed form, or a file cannot be written.
pub fn preview(gait: &Gait, robot: &Robot, about: &str, out: &Path) -> Result<Preview, String> {
    let plans = walk_of(gait, robot).map_err(|fault| fault.to_string())?;
    let fault = Planner::of(gait, robot).err();
    let pattern = gait.pattern.ok_or("no pattern")?;
    let stride = Stride { robot, plans: &plans[plans.len() - 2..], step: pattern.step_time };
    let note = fault.as_ref().map_or_else(|| about.to_owned(), |fault| format!("{about}. {fault}"));
    std::fs::create_dir_all(out).map_err(|e| format!("{}: {e}", out.display()))?;
    let (double, step) = (pattern.double_support, pattern.step_time);
    let middle = 0.5 * (double + step);
    let instants = [
        0.0,
        0.5 * double,
        double,
        middle,
        step,
        step + 0.5 * double,
        step + double,
        step + middle,
        2.0 * step,
    ];
    let mut files = Vec::new();
    for (name, figure) in [
        ("sticks.png", stride.sticks(&instants, &note)),
        ("legs.png", stride.legs(&note)),
        ("trajectories.png", stride.trajectories(&note)),
        ("planes.png", stride.planes(&note)),
        ("joints.png", stride.joints(&note)),
    ] {
        let file = out.join(name);
        figure.save(&file)?;
        files.push(file);
    }
    Ok(Preview { files, fault })
}

/// The periodic stride: right foot first, its frame where that foot leaves.
struct Stride<'a> {
    robot: &'a Robot,
    /// One plan for each of its steps.
    plans: &'a [WalkedPlan],
    /// \[s\] Time of a step.
    step: f64,
}

/// The robot at an instant. Positions in the frame of the stride \[m\].
struct Pose {
    /// Ankles.
    ankles: [Vector3<f64>; 2],
    /// \[rad\] Pitch of the soles.
    pitch: [f64; 2],
    torso: Vector3<f64>,
    /// Heel, toe, then the chain from the ankle to the torso; NaN where a leg cannot take its pose.
    chains: [Vec<Vector3<f64>>; 2],
    /// \[rad\] Angles of the thesis, from the foot on.
    theta: [[f64; 6]; 2],
}

impl Stride<'_> {
    /// At `t` \[s\], 0 to two steps.
    fn pose(&self, t: f64) -> Pose {
        let (walked, t) = if t < self.step { (&self.plans[0], t) } else { (&self.plans[1], t - self.step) };
        let plan = &walked.plan;
        // The stride begins where the swing foot of its first plan stands.
        let first = &self.plans[0].plan;
        let begin = first.feet[RIGHT].sample(0.0).position;
        let shift = Vector3::new(
            plan.origin[0] - first.origin[0] - begin[0],
            plan.origin[1] - first.origin[1] - begin[1],
            0.0,
        );
        let body = Vector3::from(plan.body.sample(t).position);
        let upright = Matrix3::identity();
        let mut pose = Pose {
            ankles: [Vector3::zeros(); 2],
            pitch: [0.0; 2],
            torso: body + shift,
            chains: [Vec::new(), Vec::new()],
            theta: [[f64::NAN; 6]; 2],
        };
        for foot in [RIGHT, LEFT] {
            let [rear, front, ..] = self.robot.feet[foot].support;
            let ankle = -self.robot.feet[foot].sole[2];
            let (sole, pitch) = plan.sole(foot, t, [rear, front]);
            let [x, y, z, _] = sole.position;
            let turned = Rotation3::from_axis_angle(&Vector3::y_axis(), pitch.position[0]);
            let (at, of) = (Vector3::new(x, y, z), |p: Vector3<f64>| turned * p);
            pose.ankles[foot] = at + of(Vector3::new(0.0, 0.0, ankle)) + shift;
            pose.pitch[foot] = pitch.position[0];
            let mut chain =
                vec![at + of(Vector3::new(rear, 0.0, 0.0)), at + of(Vector3::new(front, 0.0, 0.0)), at];
            if let Some(leg) = self.robot.legs.as_ref().map(|legs| &legs[foot]) {
                match leg.angles((turned.matrix(), &at), (&upright, &body)) {
                    Ok(q) => {
                        pose.theta[foot] = leg.theta(&q);
                        chain.extend(leg.chain_in_sole(&q).map(|p| at + of(p)));
                    }
                    Err(_) => chain.extend([Vector3::repeat(f64::NAN); 7]),
                }
            }
            pose.chains[foot] = chain.into_iter().map(|p| p + shift).collect();
        }
        pose
    }

    /// Poses of a fine grid, with their times.
    fn all(&self) -> Vec<(f64, Pose)> {
        let at = |i: usize| 2.0 * self.step * i as f64 / POINTS as f64;
        (0..POINTS).map(|i| (at(i), self.pose(at(i)))).collect()
    }

    /// Stick figures side by side, in three planes and in space.
    fn sticks(&self, instants: &[f64], note: &str) -> Figure {
        type View = fn(Vector3<f64>) -> Point;
        let views: [(&str, &str, &str, View); 4] = [
            ("From the side", "x [m], each instant moved on", "z [m]", |p| [p.x, p.z]),
            ("From behind", "-y [m], each instant moved on", "z [m]", |p| [-p.y, p.z]),
            ("From above", "x [m], each instant moved on", "y [m]", |p| [p.x, p.y]),
            ("In space", "each instant moved on [m]", "[m]", |p| [p.x - 0.5 * p.y, p.z + 0.35 * p.y]),
        ];
        let mut figure = Figure::new("Nine instants of a stride", note);
        for (title, x, y, view) in views {
            let mut chart = Chart::new(title, x, y).equal();
            for (k, &t) in instants.iter().enumerate() {
                let pose = self.pose(t);
                let centre = view(pose.torso)[0];
                let place = |p: Vector3<f64>| {
                    let [a, b] = view(p);
                    [a - centre + APART * k as f64, b]
                };
                for foot in [RIGHT, LEFT] {
                    let name = if k == 0 { SIDES[foot] } else { "" };
                    let chain: Vec<Point> = pose.chains[foot].iter().copied().map(place).collect();
                    chart.line(name, chain.clone(), COLORS[foot]);
                    chart.dots("", chain[3..].to_vec(), 3.5, COLORS[foot]);
                }
                let [a, b] = place(pose.torso);
                chart.dots("", vec![[a, b]], 5.0, BLACK);
                chart.label([a, b], &format!("{t:.2} s"), BLACK);
            }
            figure = figure.with(chart);
        }
        figure
    }

    /// Both legs in the plane of walking.
    fn legs(&self, note: &str) -> Figure {
        let mut figure = Figure::new("Legs over a stride", note);
        for foot in [RIGHT, LEFT] {
            let mut chart = Chart::new(&format!("The {} leg", SIDES[foot]), "x [m]", "z [m]").equal();
            for k in 0..=40 {
                let pose = self.pose(2.0 * self.step * f64::from(k) / 40.0);
                chart.line(
                    "",
                    pose.chains[foot].iter().map(|p| [p.x, p.z]).collect(),
                    COLORS[foot].faint(0x90),
                );
            }
            let all = self.all();
            chart.line(
                "ankle",
                all.iter().map(|(_, p)| [p.ankles[foot].x, p.ankles[foot].z]).collect(),
                BLACK,
            );
            chart.line("torso", all.iter().map(|(_, p)| [p.torso.x, p.torso.z]).collect(), GREEN);
            figure = figure.with(chart);
        }
        figure
    }

    /// Feet and torso over time.
    fn trajectories(&self, note: &str) -> Figure {
        let all = self.all();
        let mut figure = Figure::new("Trajectories of feet and torso", note);
        type Of = fn(&Vector3<f64>) -> f64;
        let axes: [(&str, &str, Of); 3] =
            [("Forward", "x [m]", |p| p.x), ("To the left", "y [m]", |p| p.y), ("Upwards", "z [m]", |p| p.z)];
        for (title, unit, of) in axes {
            let mut chart = Chart::new(title, "time [s]", unit);
            for foot in [RIGHT, LEFT] {
                let points = all.iter().map(|(t, p)| [*t, of(&p.ankles[foot])]).collect();
                chart.line(&format!("{} ankle", SIDES[foot]), points, COLORS[foot]);
            }
            chart.line("torso", all.iter().map(|(t, p)| [*t, of(&p.torso)]).collect(), GREEN);
            figure = figure.with(chart);
        }
        let mut chart = Chart::new("Pitch of the soles, toes down", "time [s]", "pitch [rad]").at_least(0.1);
        for foot in [RIGHT, LEFT] {
            chart.line(SIDES[foot], all.iter().map(|(t, p)| [*t, p.pitch[foot]]).collect(), COLORS[foot]);
        }
        figure.with(chart)
    }

    /// Ways of feet and torso in three planes.
    fn planes(&self, note: &str) -> Figure {
        let all = self.all();
        let mut figure = Figure::new("Ways of ankles and torso", note);
        type Of = fn(&Vector3<f64>) -> Point;
        let planes: [(&str, &str, &str, Of); 3] = [
            ("Plane of walking", "x [m]", "z [m]", |p| [p.x, p.z]),
            ("Across", "-y [m]", "z [m]", |p| [-p.y, p.z]),
            ("On the ground", "x [m]", "y [m]", |p| [p.x, p.y]),
        ];
        for (title, x, y, of) in planes {
            let mut chart = Chart::new(title, x, y).equal();
            for foot in [RIGHT, LEFT] {
                let points = all.iter().map(|(_, p)| of(&p.ankles[foot])).collect();
                chart.line(&format!("{} ankle", SIDES[foot]), points, COLORS[foot]);
            }
            chart.line("torso", all.iter().map(|(_, p)| of(&p.torso)).collect(), GREEN);
            figure = figure.with(chart);
        }
        figure
    }

    /// Joint angles in the signs of the thesis; gaps where a leg cannot take its pose.
    fn joints(&self, note: &str) -> Figure {
        let all = self.all();
        let mut figure = Figure::new("Joint angles", note);
        let names =
            ["ankle adduction", "ankle flexion", "knee", "hip flexion", "hip adduction", "hip rotation"];
        for (k, name) in names.into_iter().enumerate() {
            let title = format!("theta {}: {name}", k + 1);
            let mut chart = Chart::new(&title, "time [s]", "angle [deg]").at_least(1.0);
            for foot in [RIGHT, LEFT] {
                let points = all.iter().map(|(t, p)| [*t, p.theta[foot][k].to_degrees()]).collect();
                chart.line(SIDES[foot], points, COLORS[foot]);
            }
            figure = figure.with(chart);
        }
        figure
    }
}
