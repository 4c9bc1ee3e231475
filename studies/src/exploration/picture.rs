//! Rooms from above, with the way through each.

use drawing::color::{BLUE, GREY, VERMILION};
use drawing::{Chart, Figure};

use super::Row;
use super::room::Room;
use super::session::Explored;

/// One chart for each exploration.
pub(super) fn ways(explored: &[(&Row, &(Room, Explored))]) -> Figure {
    let mut figure =
        Figure::new("Rooms explored", "way of the torso; walls and boxes as they stand, people not drawn");
    for (row, (room, explored)) in explored {
        let title = format!(
            "room {}, type {}, {:?} network: {:.0} m in {:.1} min, {:.0} % of the floor",
            row.seed,
            row.depth,
            row.network,
            row.way_m,
            row.minutes,
            100.0 * row.share
        );
        // Room, way, and the place of a touch, after which she walked on.
        let mut chart = Chart::new(&title, "x [m]", "y [m]").equal();
        for rectangle in &room.standing {
            chart.area("", rectangle.corners().to_vec(), GREY);
        }
        chart.line("", explored.way.clone(), BLUE);
        if let Some(touch) = &explored.touched {
            chart.dots("touched", vec![touch.at], 6.0, VERMILION);
        }
        figure = figure.with(chart);
    }
    figure
}
