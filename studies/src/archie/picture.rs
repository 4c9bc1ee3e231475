//! The map: what is borne of every cause, open loop beside stabilizer and prediction.

use drawing::color::{BLACK, BLUE, GREEN, GREY};
use drawing::{Chart, Figure, Pen};

use super::Borne;

/// Where names begin, to the left of all bars.
const LEFT: f64 = -2.2;
/// Pixels of a cause.
const ROW: f32 = 44.0;

/// All causes, each to the scale of what it bears most.
pub(super) fn map(all: &[Borne]) -> Figure {
    let mut chart = Chart::new(
        "Each bar to the scale of the most that is known to be borne of its cause",
        "share, less than nothing to the left",
        "",
    )
    .height(ROW * all.len() as f32);
    let top = all.len() as f64;
    chart.dots("", vec![[LEFT, top], [1.05, top]], 0.1, GREY);
    for (k, cause) in all.iter().enumerate() {
        let y = top - k as f64;
        let reach = |x: Option<f64>, tried: f64| x.unwrap_or(tried);
        let known = |s: &super::BorneSide| [s.predicted, s.open_loop, s.stabilized].into_iter().flatten();
        let most = cause.sides.iter().flat_map(known).fold(0.0_f64, |m, x| m.max(x.abs()));
        let most = if most > 0.0 { most } else { cause.sides[0].tried.abs() };
        for side in &cause.sides {
            let share = |x: f64| (x / most).clamp(-1.0, 1.0);
            let bar = |x: f64, low: f64, high: f64| {
                vec![[0.0, y + low], [x, y + low], [x, y + high], [0.0, y + high]]
            };
            chart.area(
                "open loop",
                bar(share(reach(side.open_loop, side.tried)), 0.05, 0.3),
                BLUE.faint(0x90),
            );
            if side.cured {
                let x = share(reach(side.stabilized, side.tried));
                chart.area("with stabilizer", bar(x, -0.2, 0.05), GREEN.faint(0x90));
            }
            let x = share(reach(side.predicted, side.tried));
            let mark = vec![[x, y - 0.02], [x, y + 0.36]];
            chart.styled("predicted, open loop", mark, Pen { color: BLACK, width: 2.5, dashed: false });
        }
        chart.styled(
            "",
            vec![[0.0, y - 0.4], [0.0, y + 0.4]],
            Pen { color: GREY, width: 1.0, dashed: false },
        );
        chart.label([LEFT, y - 0.1], &format!("{} [{}]: {}", cause.name, cause.unit, cause.open_loop), BLACK);
    }
    Figure::new("What Archie's walk bears", "open loop with motors and elastic gears; under the stabilizer")
        .with(chart)
}
