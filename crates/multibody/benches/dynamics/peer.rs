//! The same robot and states given to `tests/peers/pinocchio_bench`, its times and its results.

use std::error::Error;
use std::fmt::Write as _;
use std::process::{Command, Stdio};

use multibody::{Data, Model};
use urdf_rs::JointType;

use crate::robot::Robot;
use crate::{Row, State, difference};

/// Runs the peer on the same states: its times and its results.
pub(crate) fn run(
    peer: &str,
    robot: &Robot,
    states: &[State],
) -> Result<(Vec<Row>, Vec<f64>), Box<dyn Error>> {
    let folder = std::env::temp_dir().join(format!("multibody_bench_{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let (bodies, input, output) = (folder.join("robot"), folder.join("states"), folder.join("results"));
    std::fs::write(&bodies, describe(&robot.urdf)?)?;
    let mut text = format!("{}\n{}\n", robot.joints.join(" "), Robot::FEET.join(" "));
    for s in states {
        for x in s.q.iter().chain(&s.v).chain(&s.force) {
            write!(text, "{x:?} ")?;
        }
        text.push('\n');
    }
    std::fs::write(&input, text)?;
    // Its standard error tells the times of what counts only where it is fastest.
    let mut command = Command::new(peer);
    let answer = command.arg(&bodies).arg(&input).arg(&output).stderr(Stdio::inherit()).output()?;
    if !answer.status.success() {
        return Err(format!("{peer}: {}", answer.status).into());
    }
    let bytes = std::fs::read(&output)?;
    let results =
        bytes.chunks_exact(8).map(|b| f64::from_ne_bytes(b.try_into().expect("eight bytes"))).collect();
    std::fs::remove_dir_all(&folder)?;
    let mut rows = Vec::new();
    for line in String::from_utf8(answer.stdout)?.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        let time = |k: usize| words[k].parse::<f64>();
        rows.push(Row { name: words[0].into(), times: [time(1)?, time(2)?, time(3)?], error: None });
    }
    Ok((rows, results))
}

/// One line per body, as the peer wants it; only for robots whose frames are all parallel at zero, without fixed joints.
fn describe(robot: &urdf_rs::Robot) -> Result<String, Box<dyn Error>> {
    let mut lines = String::new();
    let mut links = vec!["torso"];
    writeln!(lines, "base 0 x 0 0 0 {}", inertia(robot, "torso")?)?;
    for joint in &robot.joints {
        let parent =
            links.iter().position(|l| *l == joint.parent.link).ok_or("joints are not parents first")?;
        let axis = ["x", "y", "z"]
            [joint.axis.xyz.iter().position(|a| *a == 1.0).ok_or("axis is not +x, +y or +z")?];
        if joint.origin.rpy.0 != [0.0; 3] || joint.joint_type == JointType::Fixed {
            return Err(format!("joint {} is turned or fixed", joint.name).into());
        }
        let [x, y, z] = joint.origin.xyz.0;
        writeln!(lines, "{} {parent} {axis} {x} {y} {z} {}", joint.name, inertia(robot, &joint.child.link)?)?;
        links.push(&joint.child.link);
    }
    Ok(lines)
}

fn inertia(robot: &urdf_rs::Robot, link: &str) -> Result<String, Box<dyn Error>> {
    let link = robot.links.iter().find(|l| l.name == link).ok_or("a joint names no link")?;
    let (o, i) = (&link.inertial.origin, &link.inertial.inertia);
    if o.rpy.0 != [0.0; 3] {
        return Err(format!("inertia of {} is turned", link.name).into());
    }
    let [x, y, z] = o.xyz.0;
    let m = link.inertial.mass.value;
    Ok(format!("{m} {x} {y} {z} {} {} {} {} {} {}", i.ixx, i.ixy, i.iyy, i.ixz, i.iyz, i.izz))
}

/// Largest differences from the peer's results.
pub(crate) fn print_differences(model: &Model, states: &[State], results: &[f64]) {
    let (mut d, nv) = (Data::new(model), model.nv());
    let mut worst = [0.0_f64; 4];
    let mut x = vec![0.0; nv];
    let triangle = nv * (nv + 1) / 2;
    for (s, theirs) in states.iter().zip(results.chunks_exact(triangle + 2 * nv)) {
        let m = model.mass_matrix(&mut d, &s.q);
        let lower: Vec<f64> = (0..nv).flat_map(|i| (0..=i).map(move |j| m[(i, j)])).collect();
        worst[0] = worst[0].max(difference(&lower, &theirs[..triangle]));
        model.nonlinear_terms(&mut d, &s.q, &s.v, &mut x);
        worst[1] = worst[1].max(difference(&x, &theirs[triangle..triangle + nv]));
        model.forward_dynamics(&mut d, &s.q, &s.v, &s.force, &mut x);
        worst[2] = worst[2].max(difference(&x, &theirs[triangle + nv..]));
        model.forward_dynamics_articulated(&mut d, &s.q, &s.v, &s.force, &mut x);
        worst[3] = worst[3].max(difference(&x, &theirs[triangle + nv..]));
    }
    println!(
        "differences from Pinocchio: M {:.1e}, h {:.1e}, forward dynamics {:.1e} (matrix), {:.1e} (articulated)",
        worst[0], worst[1], worst[2], worst[3]
    );
}
