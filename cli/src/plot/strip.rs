//! The walking robot as stick figures, seen from its right side.
//!
//! The figures stand at equal distances, further apart than the robot really walks between them, so that they do not
//! hide each other; the scale is the same in both directions.

use super::walk::{WalkData, seconds};
use drawing::color::{BLACK, BLUE, GREY, LIGHT, VERMILION};
use drawing::{Chart, Color, Figure, Pen, Point};
use messages::GaitState;
use recording::{FrameTree, Log, RecordedPose};
use std::collections::HashMap;

/// \[s\] Time between two figures.
const INTERVAL: f64 = 0.2;
/// \[m\] Distance between two figures.
const SPACING: f64 = 0.62;
/// Figures in a row.
const PER_ROW: usize = 14;
const ROWS: usize = 3;

pub(super) fn draw(walk: &WalkData) -> Result<Figure, String> {
    let links = walk.frames.first().map_or(0, |tree| tree.transforms.len());
    if links < 4 {
        return Err("the log has no poses of links in /tf".into());
    }
    // Standing still is not drawn: the strip begins with the first step.
    let begin = walk
        .cycles
        .iter()
        .find(|c| matches!(GaitState::from(c.state.gait), GaitState::Starting | GaitState::Walking))
        .map_or(0.0, |c| c.time);
    let chosen = every(walk, begin);
    let mut figure = Figure::new(
        &format!("Stick figures every {INTERVAL} s, seen from the right"),
        &format!("{}  ·  right leg orange, left leg blue", walk.about),
    );
    for row in chosen.chunks(PER_ROW) {
        let first = seconds(row[0].stamp_ns, walk.start_ns);
        let last = seconds(row[row.len() - 1].stamp_ns, walk.start_ns);
        let title = format!("{first:.1} s to {last:.1} s");
        let mut chart = Chart::new(&title, "distance along the strip [m]", "z [m]").equal();
        let width = SPACING * (PER_ROW as f64 - 1.0) + 0.7;
        // Ground line as wide as a full row, so that rows have the same scale.
        chart.styled(
            "",
            vec![[-0.45, 0.0], [width - 0.25, 0.0]],
            Pen { color: GREY, width: 2.0, dashed: false },
        );
        for (k, tree) in row.iter().enumerate() {
            draw_robot(&mut chart, walk, tree, SPACING * k as f64);
            let time = format!("{:.1} s", seconds(tree.stamp_ns, walk.start_ns));
            chart.note([SPACING * k as f64, -0.2], &time, GREY);
        }
        // An invisible point that makes room for the times below the ground.
        chart.styled(
            "",
            vec![[-0.45, -0.22], [-0.45, -0.22]],
            Pen { color: LIGHT, width: 0.1, dashed: false },
        );
        figure = figure.with(chart);
    }
    Ok(figure)
}

/// One tree of frames per interval, from `begin` on.
fn every(walk: &WalkData, begin: f64) -> Vec<&FrameTree> {
    let mut next = begin;
    let mut chosen = Vec::new();
    for tree in &walk.frames {
        let time = seconds(tree.stamp_ns, walk.start_ns);
        if time >= next - 1e-9 && chosen.len() < PER_ROW * ROWS {
            chosen.push(tree);
            next = begin + INTERVAL * chosen.len() as f64;
        }
    }
    chosen
}

/// Draws the tree of links as lines from parent to child: far side first.
fn draw_robot(chart: &mut Chart, walk: &WalkData, tree: &FrameTree, at: f64) {
    let skeleton = Skeleton::new(walk, tree);
    let torso = skeleton.world.get(walk.robot.torso.as_str()).copied().unwrap_or(RecordedPose::IDENTITY);
    let side_view = |[x, _, z]: [f64; 3]| -> Point { [at + x - torso.position[0], z] };
    for wanted in [BLUE, BLACK, VERMILION] {
        for (child, parent) in &skeleton.parents {
            let (Some(a), Some(b)) = (skeleton.world.get(parent), skeleton.world.get(child)) else {
                continue;
            };
            if skeleton.color(child) == wanted {
                let width = if wanted == BLACK { 3.0 } else { 5.0 };
                let pen = Pen { color: wanted, width, dashed: false };
                chart.styled("", vec![side_view(a.position), side_view(b.position)], pen);
            }
        }
        for (foot, color) in [(1, BLUE), (0, VERMILION)] {
            if let (true, Some(sole)) = (wanted == color, skeleton.world.get(["r_sole", "l_sole"][foot])) {
                let [back, front, ..] = walk.robot.feet[foot].support;
                let ends = [back, front].map(|x| side_view(sole.place([x, 0.0, 0.0])));
                chart.styled("", ends.to_vec(), Pen { color, width: 5.0, dashed: false });
            }
        }
    }
    chart.dots("", vec![side_view(torso.position)], 5.0, BLACK);
}

/// Links in the world, and who hangs on whom.
struct Skeleton<'a> {
    world: HashMap<&'a str, RecordedPose>,
    parents: Vec<(&'a str, &'a str)>,
    legs: [Vec<&'a str>; 2],
}

impl<'a> Skeleton<'a> {
    fn new(walk: &'a WalkData, tree: &'a FrameTree) -> Self {
        let mut world: HashMap<&str, RecordedPose> = HashMap::from([(Log::ODOM, RecordedPose::IDENTITY)]);
        let mut parents = Vec::new();
        for t in &tree.transforms {
            if let Some(parent) = world.get(t.parent.as_str()).copied() {
                world.insert(&t.child, parent.then(&t.pose));
                let sensor = t.child == "imu" || t.child.ends_with("_force_sensor");
                if t.parent != Log::ODOM && !sensor {
                    parents.push((t.child.as_str(), t.parent.as_str()));
                }
            }
        }
        let legs = [0, 1].map(|foot| {
            let mut leg = vec![["r_sole", "l_sole"][foot]];
            let mut link = walk.robot.feet[foot].link.as_str();
            while let Some((_, parent)) = parents.iter().find(|(child, _)| *child == link) {
                leg.push(link);
                link = parent;
            }
            leg
        });
        // What both legs hang on, such as a pelvis, belongs to the body.
        let shared: Vec<&str> = legs[0].iter().copied().filter(|link| legs[1].contains(link)).collect();
        let legs = legs.map(|leg: Vec<&str>| leg.into_iter().filter(|link| !shared.contains(link)).collect());
        Self { world, parents, legs }
    }

    /// Legs in colour, the rest in black; toes and whatever else hangs on a leg go with it.
    fn color(&self, link: &str) -> Color {
        let mut link = link;
        loop {
            for (leg, color) in self.legs.iter().zip([VERMILION, BLUE]) {
                if leg.contains(&link) {
                    return color;
                }
            }
            match self.parents.iter().find(|(child, _)| *child == link) {
                Some((_, parent)) => link = parent,
                None => return BLACK,
            }
        }
    }
}
