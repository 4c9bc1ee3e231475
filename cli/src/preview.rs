//! `gangwerk preview`: a walk as pictures, before any mass moves (Daniali 2013, 4.3, 4.4, 6.2).
//!
//! | picture | figures |
//! |---|---|
//! | `sticks.png`: the robot at nine instants of a stride, from the side, from the front, from above, in space | 4.31-4.39, 6.26, 6.27 |
//! | `legs.png`: both legs over a stride | 4.40, 4.41 |
//! | `trajectories.png`: feet and torso over time | 4.11-4.17, 6.11-6.16 |
//! | `planes.png`: their ways in three planes | 4.18-4.23, 6.17-6.19 |
//! | `joints.png`: angles of the joints | 4.24-4.29, 6.20-6.25 |
//!
//! The walk is a pattern, solved in closed form, or a balanced gait, whose plans the controller follows.

mod closed_form;
mod followed;

use config::{Gait, Robot};
use drawing::color::{BLACK, BLUE, GREEN, VERMILION};
use drawing::{Chart, Color, Figure, Point};
use messages::{LEFT, RIGHT};
use nalgebra::Vector3;
use std::path::{Path, PathBuf};

/// Instants of a stride at which curves are drawn.
const POINTS: usize = 600;
/// \[m\] Distance of the stick figures from one another.
const APART: f64 = 0.7;
/// Right foot, left foot.
const COLORS: [Color; 2] = [BLUE, VERMILION];
const SIDES: [&str; 2] = ["right", "left"];

/// Pictures of a walk, and what it breaks.
pub struct Preview {
    /// Files that were written.
    pub files: Vec<PathBuf>,
    /// First rule that is broken, if the robot cannot walk it.
    pub fault: Option<String>,
}

/// Draws the walk of a gait, a name or the path of a file, on a robot of the configuration `root`; see [`preview`].
///
/// # Errors
/// As there, and files that cannot be read.
pub fn of_files(
    root: &Path,
    gait: &Path,
    robot: &str,
    speed: Option<f64>,
    out: &Path,
) -> Result<Preview, String> {
    let file =
        if gait.is_file() { gait.to_owned() } else { config::gait_path(root, &gait.to_string_lossy()) };
    let of_gait = Gait::load(&file).map_err(|e| e.to_string())?;
    let of = Robot::load(&root.join("robots").join(robot)).map_err(|e| e.to_string())?;
    preview(&of_gait, &of, speed, &format!("{}, {robot}", gait.display()), out)
}

/// Draws the walk of `gait` on `robot` into the directory `out`: at `speed` \[m/s\], or with the gait's longest steps.
///
/// # Errors
/// The gait is a pattern and the robot has no legs in closed form, there are no steps for the speed, or a file cannot be
/// written.
pub fn preview(
    gait: &Gait,
    robot: &Robot,
    speed: Option<f64>,
    about: &str,
    out: &Path,
) -> Result<Preview, String> {
    let (stride, fault) = match (&gait.pattern, speed) {
        (None, _) => followed::stride(gait, robot, speed)?,
        (Some(_), None) => closed_form::stride(gait, robot).map_err(|fault| fault.to_string())?,
        (Some(_), Some(_)) => return Err("a pattern has a speed of its own: leave out --speed".to_owned()),
    };
    let note = fault.as_ref().map_or_else(|| about.to_owned(), |fault| format!("{about}. {fault}"));
    std::fs::create_dir_all(out).map_err(|e| format!("{}: {e}", out.display()))?;
    let mut files = Vec::new();
    for (name, figure) in [
        ("sticks.png", stride.sticks(&note)),
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
    /// Double support, single support and end of each of its steps \[s\].
    steps: [[f64; 3]; 2],
    /// Names of the joints that are drawn.
    joints: Vec<String>,
    /// The robot at a time \[s\].
    pose: Box<dyn Fn(f64) -> Pose + 'a>,
}

/// The robot at an instant. Positions in the frame of the stride \[m\].
#[derive(Clone)]
struct Pose {
    /// Ankles.
    ankles: [Vector3<f64>; 2],
    /// \[rad\] Pitch of the soles.
    pitch: [f64; 2],
    torso: Vector3<f64>,
    /// Heel, toe, then the chain from the ankle to the torso; NaN where a leg cannot take its pose.
    chains: [Vec<Vector3<f64>>; 2],
    /// \[rad\] Angles of the joints that are drawn, of each side; NaN where there is none.
    angles: [Vec<f64>; 2],
}

impl Stride<'_> {
    /// \[s\] Its end.
    fn end(&self) -> f64 {
        self.steps[1][2]
    }

    /// Begin, middle and end of the double supports, middle and end of the single ones.
    fn instants(&self) -> [f64; 9] {
        let [[a, b, c], [d, e, f]] = self.steps;
        [a, 0.5 * (a + b), b, 0.5 * (b + c), d, 0.5 * (d + e), e, 0.5 * (e + f), f]
    }

    /// Poses of a fine grid, with their times.
    fn all(&self) -> Vec<(f64, Pose)> {
        let at = |i: usize| self.end() * i as f64 / POINTS as f64;
        (0..POINTS).map(|i| (at(i), (self.pose)(at(i)))).collect()
    }

    /// Stick figures side by side, in three planes and in space.
    fn sticks(&self, note: &str) -> Figure {
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
            for (k, t) in self.instants().into_iter().enumerate() {
                let pose = (self.pose)(t);
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
                let pose = (self.pose)(self.end() * f64::from(k) / 40.0);
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

    /// Joint angles; gaps where a leg cannot take its pose.
    fn joints(&self, note: &str) -> Figure {
        let all = self.all();
        let mut figure = Figure::new("Joint angles", note);
        for (k, name) in self.joints.iter().enumerate() {
            let mut chart = Chart::new(name, "time [s]", "angle [deg]").at_least(1.0);
            let of = |foot: usize| all.iter().map(move |(t, p)| [*t, p.angles[foot][k].to_degrees()]);
            let bends = [RIGHT, LEFT].map(|foot| of(foot).any(|p| p[1].is_finite()));
            for foot in [RIGHT, LEFT].into_iter().filter(|&foot| bends[foot]) {
                let name = if bends[1 - foot] { SIDES[foot] } else { "" };
                chart.line(name, of(foot).collect(), COLORS[foot]);
            }
            figure = figure.with(chart);
        }
        figure
    }
}
