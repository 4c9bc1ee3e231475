//! The centre of gravity and the feet from above, with footprints.

use super::walk::WalkData;
use drawing::color::{BLACK, BLUE, GREEN, VERMILION};
use drawing::{Chart, Figure, Pen};

pub(super) fn draw(walk: &WalkData) -> Result<Figure, String> {
    let mut chart = map("From above");
    draw_footprints(&mut chart, walk);
    for (foot, name, color) in [(0, "right sole", VERMILION), (1, "left sole", BLUE)] {
        let pen = Pen { color: color.faint(0xc0), width: 2.0, dashed: false };
        let sole = |c: &super::walk::CycleData| c.place([c.state.feet[foot][0], c.state.feet[foot][1]]);
        chart.styled(name, walk.path(sole), pen);
    }
    chart.line("centre of gravity", walk.path(|c| c.place([c.state.com[0], c.state.com[1]])), GREEN);
    let desired = |c: &super::walk::CycleData| c.place([c.state.com_desired[0], c.state.com_desired[1]]);
    chart.dashed("planned", walk.path(desired), BLACK);

    let mut height =
        Chart::new("Height of the centre of gravity", "time [s]", "z [m]").height(220.0).at_least(0.01);
    height.line("measured", walk.over_time(|c| c.state.com[2]), GREEN);
    height.dashed("planned", walk.over_time(|c| c.state.com_desired[2]), BLACK);

    let mut soles = Chart::new("Height of the soles", "time [s]", "z [m]").height(220.0).at_least(0.01);
    soles.line("right", walk.over_time(|c| c.state.feet[0][2]), VERMILION);
    soles.line("left", walk.over_time(|c| c.state.feet[1][2]), BLUE);
    Ok(Figure::new("Paths of the centre of gravity and the feet", &walk.about)
        .with(chart)
        .with(height)
        .with(soles))
}

/// Axes of a map.
pub(super) fn map(title: &str) -> Chart {
    Chart::new(title, "x, forward [m]", "y, left [m]").equal()
}

/// The rectangles on which the feet stood.
pub(super) fn draw_footprints(chart: &mut Chart, walk: &WalkData) {
    for print in walk.footprints() {
        let (name, color) = [("right foot", VERMILION), ("left foot", BLUE)][print.foot];
        chart.area(name, print.corners.to_vec(), color.faint(0x30));
        let mut edge = print.corners.to_vec();
        edge.push(print.corners[0]);
        chart.styled("", edge, Pen { color: color.faint(0x90), width: 1.2, dashed: false });
    }
}
