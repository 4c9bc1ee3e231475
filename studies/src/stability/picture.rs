//! Pictures of the stability studies.

use drawing::color::{BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION};
use drawing::{Chart, Color, Figure, Pen};
use recording::polygon::Point;

use super::log::MARGINS;
use super::viability::{Pushes, Survived};
use super::walk::Instant;

const COLORS: [Color; 6] = [BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY];

/// Margins over time, and the points from above: names and pictures.
pub(super) fn of_log(instants: &[Instant], about: &str) -> [(&'static str, Figure); 2] {
    [("stability.png", over_time(instants, about)), ("points.png", from_above(instants, about))]
}

fn over_time(instants: &[Instant], about: &str) -> Figure {
    let line = |value: &dyn Fn(&Instant) -> f64| instants.iter().map(|i| [i.time, value(i)]).collect();
    let (first, last) = (instants.first().map_or(0.0, |i| i.time), instants.last().map_or(1.0, |i| i.time));
    let border = vec![[first, 0.0], [last, 0.0]];
    let panel = |title: &str, label: &str, chosen: &[usize]| {
        let mut chart = Chart::new(title, "time [s]", label).height(300.0).at_least(0.02);
        for &k in chosen {
            chart.line(MARGINS[k].0, line(&MARGINS[k].2), COLORS[k]);
        }
        chart.styled("", border.clone(), Pen { color: BLACK, width: 1.5, dashed: false });
        chart
    };
    let mut rate =
        Chart::new("Rate of the angular momentum about the centre of gravity", "time [s]", "[N m]");
    for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
        rate.line(name, line(&|i| i.momentum_rate[k]), COLORS[k]);
    }
    Figure::new("Distance to the limits of the contact: below zero is beyond", about)
        .with(panel("What must hold while a foot stands", "distance to the edge [m]", &[0, 1]))
        .with(panel("Share of the contact-wrench cone that is left", "[1]", &[2, 3]))
        .with(panel("What need not hold", "distance to the edge [m]", &[4, 5]))
        .with(rate.height(300.0).at_least(1.0))
}

fn from_above(instants: &[Instant], about: &str) -> Figure {
    let mut chart = Chart::new("From above", "x, forward [m]", "y, left [m]").equal();
    let same = |a: &Instant, b: &Instant| a.loaded == b.loaded;
    for stance in instants.chunk_by(same).filter(|s| s[0].loaded != [true; 2] && s.len() > 100) {
        let foot = usize::from(stance[0].loaded[1]);
        let (name, color) = [("right sole", VERMILION), ("left sole", BLUE)][foot];
        chart.area(name, stance[stance.len() / 2].support.clone(), color.faint(0x30));
    }
    let path = |of: fn(&Instant) -> Point| instants.iter().map(of).collect();
    chart.line("point of zero rate", path(|i| i.zram), SKY);
    chart.line("capture point", path(|i| i.capture), ORANGE);
    chart.line("foot rotation indicator", path(|i| i.fri), GREEN);
    chart.line("zero-moment point", path(|i| i.zmp), GREY);
    Figure::new("Points on the ground", about).with(chart)
}

/// What is survived: pushes around the robot, errors as bars over what was tried.
pub(super) fn of_viability(scene: &str, all: &Pushes, errors: &[Survived]) -> Figure {
    Figure::new("What the gait survives, each disturbance alone", scene).with(pushes(all)).with(bars(errors))
}

fn pushes(all: &Pushes) -> Chart {
    let mut chart = Chart::new(
        "Pushes of 0.1 s, by instant of the stride",
        "impulse forward [N s]",
        "impulse to the left [N s]",
    )
    .equal();
    let around = |impulses: &[f64]| -> Vec<Point> {
        let at = |(d, x): (usize, &f64)| {
            let turn = std::f64::consts::TAU * d as f64 / impulses.len() as f64;
            [x * turn.cos(), x * turn.sin()]
        };
        let mut line: Vec<Point> = impulses.iter().enumerate().map(at).collect();
        line.extend(line.first().copied());
        line
    };
    chart.area("always", around(&all.always_n_s), GREEN.faint(0x50));
    for (k, at) in all.impulse_n_s.iter().enumerate() {
        let name = format!("{k}/{}", all.impulse_n_s.len());
        let pen = Pen { color: COLORS[k % COLORS.len()], width: 2.0, dashed: k >= COLORS.len() };
        chart.styled(&name, around(at), pen);
    }
    chart
}

fn bars(errors: &[Survived]) -> Chart {
    let title = "Errors: green is survived, the whole bar was tried";
    let n = errors.len() as f64;
    let mut chart = Chart::new(title, "share of what was tried", "").height(44.0 * n as f32);
    for (k, e) in errors.iter().enumerate() {
        let y = n - k as f64;
        // Factors are drawn by their logarithms.
        let place = |x: f64| if e.tried[0] > 0.0 { x.ln() } else { x };
        let share = |side: usize| {
            let most = place(e.tried[side]);
            if most == 0.0 { 0.0 } else { place(e.interval[side].unwrap_or(e.tried[side])) / most.abs() }
        };
        let tried = [0, 1].map(|side| if place(e.tried[side]) == 0.0 { 0.0 } else { [-1.0, 1.0][side] });
        let rectangle = |[a, b]: [f64; 2], h: f64| vec![[a, y - h], [b, y - h], [b, y + h], [a, y + h]];
        chart.area("tried", rectangle(tried, 0.3), GREY.faint(0x30));
        chart.area("survived", rectangle([share(0), share(1)], 0.3), GREEN.faint(0x90));
        let [from, to] = e.interval.map(|x| x.map_or("no border".into(), |x| format!("{x:.2}")));
        let text = format!("{}: {from} to {to} {}", e.name, e.unit);
        chart.label([-0.98, y - 0.25], &text, BLACK);
    }
    chart
}
