//! Points of a stride in tables that drives play: the error of the cubics between them over their number, and how long
//! their upload takes. `gangwerk study points`.

use std::path::PathBuf;

use ::drives::point_table::Cubic;
use config::tables::REGISTERS;
use config::{Gait, Robot, Setup};
use drawing::color::{BLUE, GREY, VERMILION};
use drawing::{Chart, Figure};
use messages::{MAX_JOINTS, Plan};
use planner::pattern_check::walk_of;
use serde::Serialize;

use crate::sheet::{Column, fixed, plain, scientific};
use crate::{Error, Given, Sheet, Study};

/// The walk.
const SCENE: &str = "archie_tables";
/// Numbers of points.
const POINTS: [usize; 9] = [25, 50, 75, 100, 150, 200, 300, 500, 1000];
/// Instants between two points at which errors are looked for.
const BETWEEN: usize = 20;
/// Plan of a walk, counted from zero, from which on strides are periodic.
const PERIODIC: usize = 3;

const COLUMNS: &[Column] = &[
    plain("/points", "points of a stride"),
    fixed("/period_s", "apart [ms]", 1).times(1e3),
    scientific("/exact_deg", "cubics [deg]", 1),
    scientific("/counted_deg", "with counts [deg]", 1),
    fixed("/upload_s", "upload [s]", 2),
];

/// The study's arguments.
#[derive(clap::Args, Clone, Debug)]
pub struct Points {
    /// Directory of the picture.
    #[arg(long, value_name = "DIR", default_value = "runs/study/points")]
    pub out: PathBuf,
}

#[derive(Serialize)]
struct Sampled {
    points: usize,
    period_s: f64,
    exact_deg: f64,
    counted_deg: f64,
    upload_s: f64,
}

impl Study for Points {
    fn run(&self, given: &Given<'_>) -> Result<Sheet, Error> {
        let Setup { robot, gait, scene, .. } = Setup::load(given.config, SCENE)?;
        let stride = Stride::of(&gait, &robot)?;
        let tables = robot.tables.as_ref().ok_or("the scene plays no tables")?;
        let row = |points: usize| {
            let [exact_deg, counted_deg] = stride.errors_deg(points)?;
            let upload = tables.upload(&robot.layout, scene.cycle, points) as f64 * scene.cycle;
            let period_s = stride.length / points as f64;
            Ok(Sampled { points, period_s, exact_deg, counted_deg, upload_s: upload })
        };
        let rows = POINTS.into_iter().map(row).collect::<Result<Vec<_>, Error>>()?;
        let mut sheet = Sheet::default();
        sheet.rows("points", COLUMNS, &rows);
        let about = format!(
            "Archie's stride of {:.0} s, 12 joints; drives on two lines of 1 Mbit/s take {} other telegrams each. The numbers are \
             points of a stride.",
            stride.length, REGISTERS
        );
        sheet.draw(&self.out, "points.png", &Figure::new("Tables of points", &about).with(chart(&rows)))?;
        Ok(sheet)
    }
}

fn chart(rows: &[Sampled]) -> Chart {
    let mut chart = Chart::new("cubics between the points", "upload to 12 drives [s]", "largest error [deg]")
        .logarithmic()
        .height(420.0);
    let curve = |of: fn(&Sampled) -> f64| rows.iter().map(|r| [r.upload_s, of(r)]).collect::<Vec<_>>();
    let (exact, counted) = (curve(|r| r.exact_deg), curve(|r| r.counted_deg));
    chart.line("exact points", exact.clone(), BLUE).dots("", exact, 5.0, BLUE);
    chart.line("points in counts", counted.clone(), VERMILION).dots("", counted.clone(), 5.0, VERMILION);
    for (at, row) in counted.into_iter().zip(rows) {
        chart.label(at, &row.points.to_string(), GREY);
    }
    chart
}

/// A periodic stride.
struct Stride<'a> {
    robot: &'a Robot,
    plan: Box<Plan>,
    /// \[s\]
    length: f64,
}

impl<'a> Stride<'a> {
    fn of(gait: &Gait, robot: &'a Robot) -> Result<Self, Error> {
        let walked = walk_of(gait, robot)?.swap_remove(PERIODIC);
        Ok(Self { robot, plan: walked.plan, length: 2.0 * walked.end })
    }

    fn angles(&self, t: f64) -> Result<[f64; MAX_JOINTS], Error> {
        let mut angles = [0.0; MAX_JOINTS];
        let solved = self.robot.angles_of_plan(&self.plan, t, &mut angles);
        solved.map(|()| angles).map_err(|(_, why)| why.to_string().into())
    }

    /// Largest errors \[deg\] of the cubics between so many points: exact ones, and ones in counts.
    fn errors_deg(&self, points: usize) -> Result<[f64; 2], Error> {
        let period = self.length / points as f64;
        let table = (0..points).map(|i| self.angles(i as f64 * period)).collect::<Result<Vec<_>, _>>()?;
        let mut most = [0.0_f64; 2];
        for i in 0..points {
            for k in 0..BETWEEN {
                let u = k as f64 / BETWEEN as f64;
                let exact = self.angles((i as f64 + u) * period)?;
                for (j, angle) in exact.iter().enumerate().take(self.robot.joints.len()) {
                    let unit = self.robot.layout.count(j).ok_or("a motor without counts")?;
                    let errors = [1.0, unit].map(|unit| {
                        let counted = unit != 1.0;
                        let at = |ahead: usize| {
                            let angle = table[(i + points + ahead - 1) % points][j];
                            if counted { (angle / unit).round() * unit } else { angle }
                        };
                        let [p0, p1] = [at(1), at(2)];
                        let [v0, v1] = [0.5 * (p1 - at(0)), 0.5 * (at(3) - p0)];
                        (Cubic::between([p0, v0], [p1, v1]).at(u)[0] - angle).abs().to_degrees()
                    });
                    most = std::array::from_fn(|c| most[c].max(errors[c]));
                }
            }
        }
        Ok(most)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use config::pattern::{Pattern, TorsoHeight};

    /// Thesis 6.2 and, with the spline of z_h, 4.3: errors \[deg\] that a second program found for 300, 100 and 50 points.
    #[test]
    fn errors_are_the_published_ones() {
        let setup = Setup::load(&config::root(None), SCENE).unwrap();
        let quintic = setup.gait.pattern.unwrap();
        let example = Pattern {
            step_time: 2.0,
            double_support: 0.4,
            over_time: 1.2,
            low_time: 0.08,
            high_time: 1.2,
            pitch_times: [0.08, 1.9, 2.28],
            length: 0.2,
            over_length: 0.2,
            leave: 0.2,
            land: 0.3,
            end_ahead: 0.07,
            start_behind: 0.07,
            height: TorsoHeight::Spline,
            start_height: 0.542,
            ..quintic
        };
        let walks = [
            ("6.2", quintic, [0.000_93, 0.0286, 0.279], 0.0038),
            ("4.3", example, [0.0023, 0.051, 0.51], 0.0040),
        ];
        for (name, pattern, exact, counted) in walks {
            let gait = Gait::from(pattern);
            let stride = Stride::of(&gait, &setup.robot).unwrap();
            for (points, exact) in [300, 100, 50].into_iter().zip(exact) {
                let [is, with_counts] = stride.errors_deg(points).unwrap();
                // To the printed digits.
                assert!((is / exact - 1.0).abs() < 0.03, "{name}, {points} points: {is} deg");
                assert!(points < 300 || (with_counts - counted).abs() < 1e-4, "{name}: {with_counts} deg");
            }
        }
    }
}
