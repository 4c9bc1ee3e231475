//! Look-up tables as a picture: error over bytes, error over time, tracking while walking over points.

use drawing::color::{BLUE, GREEN, GREY, VERMILION};
use drawing::{Chart, Color, Figure, Pen};

use super::{Linkage, Size, TableWalk};

/// The picture.
pub(super) fn figure(linkages: &[Linkage], walks: &[TableWalk]) -> Figure {
    let about = "Lola's knee and inner ankle, whole ranges of their joints; linear interpolation, largest of 20000 errors; the \
                 numbers are points in each dimension.";
    Figure::new("Look-up tables of the linkages in 32-bit integers", about)
        .with(over_bytes(
            linkages,
            "angle of the motor",
            "error of the angle [rad]",
            |s| s.angle_rad,
            Some(|s| s.predicted_rad),
        ))
        .with(over_bytes(linkages, "ratio", "error of the ratio [1]", |s| s.ratio, None))
        .with(over_time(linkages))
        .with(over_points(walks))
}

/// A number of a walk.
type OfWalk = fn(&TableWalk) -> f64;

fn color(linkage: &Linkage) -> Color {
    if linkage.name == "knee" { BLUE } else { VERMILION }
}

fn over_bytes(
    linkages: &[Linkage],
    title: &str,
    y: &str,
    error: fn(&Size) -> [f64; 2],
    predicted: Option<fn(&Size) -> f64>,
) -> Chart {
    let mut chart = Chart::new(title, "bytes of the table in integers", y).logarithmic().height(420.0);
    for linkage in linkages {
        let points = |of: &dyn Fn(&Size) -> f64| {
            linkage.sizes.iter().map(|s| [s.bytes as f64, of(s)]).collect::<Vec<_>>()
        };
        let color = color(linkage);
        if let Some(predicted) = predicted {
            let pen = Pen { color: GREY, width: 4.0, dashed: false };
            chart.styled("predicted, at most", points(&predicted), pen);
        }
        let pen = Pen { color, width: 2.0, dashed: true };
        chart.styled(&format!("{}, f64", linkage.name), points(&|s| error(s)[1]), pen);
        let integers = points(&|s| error(s)[0]);
        chart.dots(&format!("{}, integers", linkage.name), integers.clone(), 6.0, color);
        for (at, s) in integers.into_iter().zip(&linkage.sizes).skip(1) {
            chart.label(at, &s.points.to_string(), GREY);
        }
    }
    chart
}

fn over_time(linkages: &[Linkage]) -> Chart {
    let mut chart =
        Chart::new("time", "one evaluation [ns]", "error of the angle [rad]").logarithmic().height(420.0);
    let errors = linkages.iter().flat_map(|l| &l.sizes).flat_map(|s| s.angle_rad);
    let (least, most) = errors.fold((f64::INFINITY, 0.0_f64), |(lo, hi), e| (lo.min(e), hi.max(e)));
    for linkage in linkages {
        let color = color(linkage);
        let direct = vec![[linkage.direct_ns, least], [linkage.direct_ns, most]];
        chart.line(&format!("{}, no table", linkage.name), direct, color.faint(90));
        let curve = |k: usize| linkage.sizes.iter().map(|s| [s.ns[k], s.angle_rad[k]]).collect::<Vec<_>>();
        let pen = Pen { color, width: 2.0, dashed: true };
        chart.styled(&format!("{}, f64", linkage.name), curve(1), pen);
        let pen = Pen { dashed: false, ..pen };
        chart.styled(&format!("{}, integers", linkage.name), curve(0), pen);
        chart.dots("", curve(0), 6.0, color);
        for (at, s) in curve(0).into_iter().zip(&linkage.sizes).skip(1) {
            chart.label(at, &s.points.to_string(), GREY);
        }
    }
    chart
}

fn over_points(walks: &[TableWalk]) -> Chart {
    let mut chart = Chart::new(
        "walking at 2 km/h, targets every 3.5 ms (dashed: no tables)",
        "points of the tables in each dimension",
        "tracking error [mrad]",
    )
    .logarithmic()
    .height(420.0);
    let tables = || walks.iter().filter_map(|w| w.table_points.filter(|n| *n > 0).map(|n| (n, w)));
    let ends = tables().fold([f64::INFINITY, 0.0], |[lo, hi], (n, _)| [lo.min(n.into()), hi.max(n.into())]);
    let parts: [(&str, Color, OfWalk); 3] = [
        ("hip and knee, largest", GREEN, |w| 1e3 * w.hip_knee_rad),
        ("knee, rms", BLUE, |w| 1e3 * w.rms_rad[0]),
        ("ankle, rms", VERMILION, |w| 1e3 * w.rms_rad[1]),
    ];
    for (name, color, of) in parts {
        let points: Vec<_> = tables().map(|(n, w)| [f64::from(n), of(w)]).collect();
        chart.line(name, points.clone(), color).dots("", points, 6.0, color);
        if let Some(direct) = walks.iter().find(|w| w.table_points == Some(0)).map(of) {
            let pen = Pen { color, width: 2.0, dashed: true };
            chart.styled("", ends.map(|n| [n, direct]).to_vec(), pen);
        }
    }
    chart
}
