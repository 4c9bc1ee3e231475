//! Pads of finite elements: how fine a mesh the stiffness of a pad needs, and what a solution costs then.

use std::error::Error;

use contact::hexahedron::{LinearElasticity, Volume};
use contact::{CouplingMethod, Layer, Material, Memory, Settings};

use super::solver::rolled;
use super::{AccuracyInput, Cost, ErrorChart, Part, Point, cost};

pub(super) const PART: Part = charts;

/// Bricks along, across and through a pad; the last one is the reference.
const MESHES: [[usize; 3]; 7] =
    [[1, 1, 1], [2, 2, 1], [3, 3, 1], [5, 5, 1], [5, 5, 2], [8, 8, 3], [12, 12, 4]];

fn charts(_: &AccuracyInput<'_>) -> Result<Vec<ErrorChart>, Box<dyn Error>> {
    let mut chart = ErrorChart::new("pads", "Mesh of a pad", "relative error of its stiffness when it is pressed [1]")
        .over(Cost::PerCall)
        .about(
            "60 x 40 x 12 mm of rubber; time of one cold solution to 1e-6, mu 0.8. Reference: 12 x 12 x 4 bricks, each of its \
             own kind of integration and Poisson's ratio.",
        );
    for poisson in [0.3, 0.45] {
        for (name, volume) in [("full", Volume::Full), ("mean volume", Volume::Mean)] {
            let layer = |bricks: [usize; 3]| {
                let elasticity = LinearElasticity { modulus: 4.643e5, poisson };
                let size = [0.06, 0.04, 0.012];
                Layer::new(&Material { size, bricks, elasticity, volume, damping_time: 0.008 })
            };
            let [meshes @ .., finest] = &MESHES;
            let exact = layer(*finest)?.block_stiffness(2);
            for bricks in meshes {
                let layer = layer(*bricks)?;
                let mut memory = Memory::new(layer.coupling());
                let settings = Settings {
                    method: CouplingMethod::Fastest,
                    tolerance: 1e-6,
                    sweeps: 3000,
                    ..Settings::of_friction(0.8)
                };
                let (report, seconds) = cost::of(|| rolled(layer.coupling(), &mut memory, &settings));
                chart.add(Point {
                    scene: "pad".into(),
                    model: format!("nu {poisson}"),
                    method: name.into(),
                    solver: Some(bricks.map(|n| n.to_string()).join(" x ")),
                    cpu_us: Some(seconds * 1e6),
                    error: (layer.block_stiffness(2) / exact - 1.0).abs(),
                    note: (!report.converged).then(|| "not converged".into()),
                    ..Point::default()
                });
            }
        }
    }
    Ok(vec![chart])
}
