//! Figures of the thesis that compare two walks: drawn again, and held against what the text says.
//!
//! | figure | with | without | the text says |
//! |---|---|---|---|
//! | 5.2 | normal forces in the stabilization (5.10)-(5.16) | moments of the feet alone | peak error more than 50 % smaller, Lola, 2.2 km/h, type 2 |
//! | 4.17 | three masses in planning (4.38) | a point mass, m_l = 0 | sagittal sway more than 45 % smaller, Johnnie, 2.5 km/h |
//! | 9.1 | a steel torus of 10 kg, 0.5 m in diameter, on the upper body | the robot as it is | smaller oscillation; no figure, no speed |
//!
//! Both walks of a figure are the same but for that one thing. Peak and sway (half of the distance from the least to the
//! greatest error) are taken over ten seconds of periodic walking, as is the cost (5.54).

use std::path::{Path, PathBuf};

use config::Setup;
use config::method::Integrator;
use drawing::color::{BLACK, GREY, VERMILION};
use drawing::{Chart, Figure};
use messages::Command;
use multibody::{Data, Model};
use serde_json::{Value, json};

use chain::Chain;

use crate::sheet::{self, Column, fixed, plain, scientific};
use crate::{Error, Given, Sheet, Study};

/// \[s\] The gait is periodic by then ...
const SETTLED: f64 = 10.0;
/// \[s\] ... and is looked at for that long, the T of (5.54).
const SPAN: f64 = 10.0;
/// \[s\] Of which the last ones are drawn.
const DRAWN: f64 = 4.0;

/// \[s\] Step of the models with motors.
const MOTOR_STEP: f64 = 1e-4;

/// \[kg\], \[m\] The torus of figure 9.1.
const TORUS: (f64, f64) = (10.0, 0.25);

/// What makes one walk of a figure differ from the other.
type Change = fn(&mut Setup) -> Result<(), Error>;

/// One figure: what is walked, and what is compared.
struct ThesisCase {
    figure: &'static str,
    title: &'static str,
    scene: &'static str,
    /// \[m/s\]
    forward: f64,
    names: [&'static str; 2],
    changes: [Change; 2],
    /// Which figure of both walks is compared.
    judged: fn(&ThesisWalk) -> f64,
    judged_name: &'static str,
    /// Least reduction that the text promises.
    promised: f64,
}

const CASES: [ThesisCase; 3] = [
    ThesisCase {
        figure: "5.2",
        title: "Figure 5.2: normal forces for upper body stabilization",
        scene: "walk_2kmh",
        forward: 2.2 / 3.6,
        names: ["with normal forces", "without"],
        changes: [as_it_is, without_normal_forces],
        judged: |w| w.peak_rad[0].max(w.peak_rad[1]),
        judged_name: "peak error",
        promised: 0.5,
    },
    ThesisCase {
        figure: "4.17",
        title: "Figure 4.17: three masses or one in planning",
        scene: "johnnie_25kmh",
        forward: 2.5 / 3.6,
        names: ["three masses", "point mass"],
        changes: [as_it_is, point_mass],
        judged: |w| w.sway_rad[0],
        judged_name: "sway of φ_x",
        promised: 0.45,
    },
    ThesisCase {
        figure: "9.1",
        title: "Figure 9.1: more inertia of the upper body",
        scene: "walk_2kmh",
        forward: 2.0 / 3.6,
        names: ["with torus", "without"],
        changes: [with_torus, as_it_is],
        judged: |w| w.sway_rad[0],
        judged_name: "sway of φ_x",
        promised: 0.0,
    },
];

/// A walk of a figure.
const COLUMNS: &[Column] = &[
    plain("/name", "walk"),
    plain("/fell", "fell"),
    fixed("/peak_rad", "peak x, y [mrad]", 2).times(1e3),
    fixed("/sway_rad", "sway x, y [mrad]", 2).times(1e3),
    scientific("/cost_rad2_s", "cost [rad² s]", 2),
];

/// The study's arguments.
#[derive(clap::Args, Clone, Debug)]
pub struct Thesis {
    /// Only this figure.
    #[arg(long)]
    pub figure: Option<String>,
    /// Type of the model: 1, reduced; 2, with motors; 3, with elastic gears.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=3))]
    pub depth: u8,
    /// Directory of the pictures.
    #[arg(long, value_name = "DIR", default_value = "runs/thesis")]
    pub out: PathBuf,
}

impl Study for Thesis {
    fn run(&self, given: &Given<'_>) -> Result<Sheet, Error> {
        let only = self.figure.as_deref();
        let chosen: Vec<&ThesisCase> =
            CASES.iter().filter(|case| only.is_none_or(|figure| figure == case.figure)).collect();
        if chosen.is_empty() {
            let known = CASES.map(|case| case.figure).join(", ");
            return Err(format!("there is no figure `{}`; choose one of {known}", only.unwrap_or("")).into());
        }
        sheet::make(&self.out)?;
        let mut sheet = Sheet::default();
        let mut figures: Vec<Value> = Vec::new();
        for case in chosen {
            figures.push(compare(given.config, case, self, &mut sheet)?);
        }
        sheet.fact("figures", figures);
        Ok(sheet)
    }
}

/// One walk. Pairs are (φ_x, φ_y): forwards and backwards, to the sides; nothing but `fell` is known of one that fell.
#[derive(Clone, Debug, serde::Serialize)]
struct ThesisWalk {
    /// Which one.
    name: String,
    /// Whether the robot fell.
    fell: bool,
    /// \[rad\] Largest inclination error.
    peak_rad: [f64; 2],
    /// \[rad\] Half of its range.
    sway_rad: [f64; 2],
    /// \[rad^2 s\] Cost (5.54) over ten seconds.
    cost_rad2_s: f64,
    /// Time \[s\] and errors \[rad\].
    #[serde(skip)]
    trace: Vec<[f64; 3]>,
}

/// One figure, onto the sheet and as an object. There is no reduction if the robot falls in either walk.
fn compare(root: &Path, case: &ThesisCase, order: &Thesis, sheet: &mut Sheet) -> Result<Value, Error> {
    let setup = periodic(root, case, order.depth)?;
    let walk = |k: usize| -> Result<ThesisWalk, Error> {
        let mut setup = setup.clone();
        case.changes[k](&mut setup)?;
        walk(&setup, case.names[k])
    };
    let walks = [walk(0)?, walk(1)?];
    let [with, without] = [&walks[0], &walks[1]].map(case.judged);
    let reduction = (!walks.iter().any(|w| w.fell)).then_some(1.0 - with / without);
    let kept = reduction.is_some_and(|r| r > case.promised);
    let about =
        format!("{}, {:.1} km/h, model type {}", setup.robot.name, 3.6 * case.forward, setup.scene.depth);
    sheet.line(format!("{}: {about}", case.figure));
    sheet.table(COLUMNS, &walks);
    // The verdict in words: a figure of a robot that fell would be none.
    let change = match reduction {
        Some(r) if r < 0.0 => format!("{:.0} % larger", -100.0 * r),
        Some(r) => format!("{:.0} % smaller", 100.0 * r),
        None => {
            let fell: Vec<&str> = walks.iter().filter(|w| w.fell).map(|w| w.name.as_str()).collect();
            format!("not measured: falls {}", fell.join(" and "))
        }
    };
    let promised = 100.0 * case.promised;
    let verdict = if kept { "kept" } else { "NOT kept" };
    sheet.line(format!("{} {change}, promised more than {promised:.0} %: {verdict}", case.judged_name));
    let name = format!("figure_{}.png", case.figure.replace('.', "_"));
    let picture = sheet.draw(&order.out, &name, &draw(case, &about, &walks))?;
    Ok(json!({
        "figure": case.figure, "about": about, "walks": walks, "judged": case.judged_name,
        "reduction": reduction, "promised": case.promised, "kept": kept, "picture": picture,
    }))
}

/// Simulates a scene of type 1 with models of type `depth`.
pub(crate) fn deepen(setup: &mut Setup, depth: u8) {
    if depth > 1 {
        setup.scene.depth = depth;
        setup.scene.integrator = Integrator::SemiImplicit;
        setup.scene.substeps = (setup.scene.cycle / MOTOR_STEP).round() as u32;
    }
}

/// The scene of a case, without an end before all has been seen. Motors take shorter and semi-implicit steps.
fn periodic(root: &Path, case: &ThesisCase, depth: u8) -> Result<Setup, Error> {
    let mut setup = Setup::load(root, case.scene)?;
    deepen(&mut setup, depth);
    setup.scene.duration = SETTLED + SPAN;
    setup.scene.commands.retain(|(time, _)| *time < SETTLED);
    for (_, command) in &mut setup.scene.commands {
        if let Command::Velocity(velocity) = command {
            velocity.forward = case.forward;
        }
    }
    Ok(setup)
}

fn walk(setup: &Setup, name: &str) -> Result<ThesisWalk, Error> {
    let mut chain = Chain::new(setup)?;
    let mut walk = ThesisWalk {
        name: name.into(),
        fell: false,
        peak_rad: [f64::NAN; 2],
        sway_rad: [f64::NAN; 2],
        cost_rad2_s: f64::NAN,
        trace: Vec::new(),
    };
    let cycles = (setup.scene.duration / setup.scene.cycle).round() as u64;
    for _ in 0..cycles {
        let cycle = chain.step();
        let [x, y] = cycle.controller_state.inclination_error;
        walk.fell |= cycle.sim_state.fallen == 1;
        if cycle.sim_state.time > SETTLED {
            walk.trace.push([cycle.sim_state.time, x, y]);
        }
    }
    if !walk.fell {
        let over = |axis: usize| walk.trace.iter().map(move |row| row[axis + 1]);
        let range = [0, 1].map(|axis| {
            over(axis).fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], e| [lo.min(e), hi.max(e)])
        });
        walk.peak_rad = range.map(|[lo, hi]| hi.abs().max(lo.abs()));
        walk.sway_rad = range.map(|[lo, hi]| (hi - lo) / 2.0);
        walk.cost_rad2_s = over(0).chain(over(1)).map(|e| e * e * setup.scene.cycle).sum(); // (5.54)
    }
    Ok(walk)
}

#[expect(clippy::unnecessary_wraps, reason = "one of several changes")]
fn as_it_is(_: &mut Setup) -> Result<(), Error> {
    Ok(())
}

#[expect(clippy::unnecessary_wraps, reason = "one of several changes")]
fn without_normal_forces(setup: &mut Setup) -> Result<(), Error> {
    setup.gait.control.force_shift = 0.0;
    Ok(())
}

#[expect(clippy::unnecessary_wraps, reason = "one of several changes")]
fn point_mass(setup: &mut Setup) -> Result<(), Error> {
    setup.gait.model.leg_mass = 0.0;
    Ok(())
}

/// A thin ring lies around the upper body, its middle in the upper body's own centre of mass. Robot and stabilizer have
/// it, as another upper body would be had. The walk stays the same: hips as high over the ground and legs as heavy as
/// before, which takes another height of the centre of gravity and another share of the legs.
fn with_torus(setup: &mut Setup) -> Result<(), Error> {
    let model = setup.robot.model()?;
    let (mass, radius) = TORUS;
    let at = model.base_cog();
    let (across, along) = (0.5 * mass * radius * radius, mass * radius * radius);
    let torus = format!(
        "<link name=\"torus\"><inertial><origin xyz=\"0 0 0\"/><mass value=\"{mass}\"/>\
         <inertia ixx=\"{across}\" ixy=\"0\" ixz=\"0\" iyy=\"{across}\" iyz=\"0\" izz=\"{along}\"/></inertial></link>\
         <joint name=\"torus\" type=\"fixed\"><parent link=\"{}\"/><child link=\"torus\"/>\
         <origin xyz=\"{} {} {}\"/></joint></robot>",
        setup.robot.torso, at.x, at.y, at.z
    );
    let before = height(&model, setup);
    setup.robot.urdf = setup.robot.urdf.replace("</robot>", &torus);
    setup.robot.total_mass += mass;
    setup.gait.model.com_height += height(&setup.robot.model()?, setup) - before;
    setup.gait.model.leg_mass *= model.mass() / (model.mass() + mass);
    Ok(())
}

/// \[m\] Height of the centre of gravity over the origin of the upper body in the start pose.
fn height(model: &Model, setup: &Setup) -> f64 {
    let (mut data, mut q) = (Data::new(model), model.neutral());
    q[7..].copy_from_slice(&setup.robot.poses[&setup.scene.start_pose]);
    model.forward_kinematics(&mut data, &q);
    model.cog(&mut data).z
}

fn draw(case: &ThesisCase, about: &str, walks: &[ThesisWalk; 2]) -> Figure {
    let mut figure = Figure::new(case.title, &format!("{about}  ·  inclination error, desired − measured"));
    for (axis, name) in ["φ_x, forwards and backwards", "φ_y, to the sides"].into_iter().enumerate() {
        let mut chart = Chart::new(name, "time [s]", "error [rad]").height(330.0).at_least(0.002);
        let end = SETTLED + SPAN;
        chart.dashed("", vec![[end - DRAWN, 0.0], [end, 0.0]], GREY);
        for (walk, dashed) in walks.iter().zip([false, true]).filter(|(walk, _)| !walk.fell) {
            let seen = walk.trace.iter().filter(|row| row[0] > end - DRAWN);
            let points = seen.map(|row| [row[0], row[axis + 1]]).collect();
            let draw = if dashed { Chart::dashed } else { Chart::line };
            draw(&mut chart, &walk.name, points, if dashed { VERMILION } else { BLACK });
        }
        figure = figure.with(chart);
    }
    figure
}

#[cfg(test)]
mod tests {
    use super::*;

    fn case(figure: &str) -> &'static ThesisCase {
        CASES.iter().find(|case| case.figure == figure).unwrap()
    }

    /// Thesis 4.6.5: three masses instead of one take more than 45 % off Johnnie's sagittal sway.
    #[test]
    fn figure_4_17() {
        let out = std::env::temp_dir().join(format!("gangwerk-4-17-{}", std::process::id()));
        let given = Given { config: &config::root(None), progress: &|_, _, _| () };
        let study = Thesis { figure: Some("4.17".into()), depth: 1, out: out.clone() };
        let f = &study.run(&given).unwrap().json()["figures"][0];
        assert!((0..2).all(|k| f["walks"][k]["fell"] == false), "{f:#?}");
        assert!(f["kept"] == true && f["reduction"].as_f64() > Some(0.45), "{f:#?}");
        assert!(f["walks"][0]["cost_rad2_s"].as_f64() < f["walks"][1]["cost_rad2_s"].as_f64());
        assert!(Path::new(f["picture"].as_str().unwrap()).is_file());
        std::fs::remove_dir_all(out).unwrap();
    }

    /// The torus weighs what it shall and turns like a ring, hips stay where they were.
    #[test]
    fn the_torus_changes_the_upper_body_only() {
        let plain = periodic(&config::root(None), case("9.1"), 1).unwrap();
        let mut setup = plain.clone();
        with_torus(&mut setup).unwrap();
        let [before, after] = [&plain, &setup].map(|s| s.robot.model().unwrap());
        let (mass, radius) = TORUS;
        assert!((after.mass() - before.mass() - mass).abs() < 1e-9);
        assert!((after.base_cog() - before.base_cog()).norm() < 1e-12);
        // By hand: what 10 kg in the upper body's own centre lift the whole robot's centre by.
        let over = before.base_cog().z - height(&before, &plain);
        let lifted = setup.gait.model.com_height - plain.gait.model.com_height;
        assert!((lifted - over * mass / after.mass()).abs() < 1e-12, "{lifted}");
        let legs = [&plain, &setup].map(|s| s.gait.model.leg_mass * s.robot.total_mass);
        assert!((legs[0] - legs[1]).abs() < 1e-9);
        // Inertia of the whole about the upper body's origin: the ring's own, moved to its place.
        let inertia = |model: &Model| {
            let mut data = Data::new(model);
            let m = model.mass_matrix(&mut data, &model.neutral());
            [m[(3, 3)], m[(4, 4)], m[(5, 5)]]
        };
        let at = before.base_cog();
        let (b, a) = (inertia(&before), inertia(&after));
        let expected = [
            mass * (0.5 * radius * radius + at.y * at.y + at.z * at.z),
            mass * (0.5 * radius * radius + at.x * at.x + at.z * at.z),
            mass * (radius * radius + at.x * at.x + at.y * at.y),
        ];
        for k in 0..3 {
            assert!((a[k] - b[k] - expected[k]).abs() < 1e-9, "axis {k}");
        }
    }

    #[test]
    fn an_unknown_figure_is_named_with_the_known_ones() {
        let given = Given { config: &config::root(None), progress: &|_, _, _| () };
        let study = Thesis { figure: Some("5.3".into()), depth: 1, out: "nowhere".into() };
        let error = study.run(&given).unwrap_err().to_string();
        assert_eq!(error, "there is no figure `5.3`; choose one of 5.2, 4.17, 9.1");
    }
}
