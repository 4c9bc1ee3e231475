//! A contact pad of finite elements on a segment: rates of its nodes, force and moment on the segment (thesis 2.3.1).
//!
//! The layer is massless: `B d' + K d = f` (2.37, corrected), f the force of the ground on the nodes, handed on to the
//! segment. All vectors have the axes of the segment; places are from its origin.
//!
//! | symbol | name | unit | shape |
//! |---|---|---|---|
//! | d | displacement of the free nodes from rest; the first ones are those of the sole | m | 3m |
//! | d' | its rate | m/s | 3m |
//! | v, omega | velocity of the segment's origin and angular velocity, relative to the ground | m/s, rad/s | 3 |
//! | g_N | height of a deformed node above the ground | m | |
//! | n | normal of the ground there, out of it, length 1 | 1 | 3 |
//! | F, T | force on the segment, moment about its origin (2.38), (2.39) | N, N m | 3 |

use std::sync::Arc;

use nalgebra::Vector3;

use crate::law::{Settings, SolverReport, TOUCHING};
use crate::layer::Layer;
use crate::memory::Memory;
use crate::solver;

/// The ground at a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// \[m\] g_N of the deformed node; negative inside the ground.
    pub gap: f64,
    /// \[1\] n, in the axes of the segment.
    pub normal: Vector3<f64>,
}

/// Motion of the segment relative to the ground.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SegmentMotion {
    /// \[m/s\] @segment Velocity of the segment's origin.
    pub linear: Vector3<f64>,
    /// \[rad/s\] @segment
    pub angular: Vector3<f64>,
}

/// Effect of a pad on its segment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PadLoad {
    /// \[N\] @segment (2.38)
    pub force: Vector3<f64>,
    /// \[N m\] @segment About the segment's origin (2.39).
    pub moment: Vector3<f64>,
    /// End of the solver.
    pub report: SolverReport,
}

/// A pad: a layer, which equal pads share, and where it is bonded.
#[derive(Clone, Debug)]
pub struct Pad {
    layer: Arc<Layer>,
    at: Vector3<f64>,
}

impl Pad {
    /// A pad whose sole has its middle at `at` \[m\] in the segment; its axes are the segment's.
    pub fn new(layer: Arc<Layer>, at: Vector3<f64>) -> Self {
        Self { layer, at }
    }

    /// The layer.
    pub fn layer(&self) -> &Layer {
        &self.layer
    }

    /// A memory for this pad, cold.
    pub fn memory(&self) -> Memory {
        Memory::new(&self.layer.coupling)
    }

    /// \[m\] @segment Place of a free node at rest; the first [`Layer::contacts`] are those of the sole.
    pub fn place(&self, node: usize) -> Vector3<f64> {
        self.at + self.layer.places[node]
    }

    /// Rates `dd` of the displacements `d` (both 3 numbers per free node) and the force on the segment. `ground` has one
    /// entry per node of the sole, `None` where the ground is far.
    ///
    /// With data that are not finite the pad relaxes freely as far as it can be told, carries nothing and reports an
    /// infinite residual.
    pub fn solve(
        &self,
        memory: &mut Memory,
        d: &[f64],
        ground: &[Option<Ground>],
        twist: &SegmentMotion,
        settings: &Settings,
        dd: &mut [f64],
    ) -> PadLoad {
        debug_assert!(d.len() == 3 * self.layer.nodes() && dd.len() == d.len(), "3 numbers per free node");
        debug_assert!(ground.len() == self.layer.contacts(), "one ground per node of the sole");
        let finite = self.load(memory, d, ground, twist, settings);
        if !finite {
            memory.clear();
            self.relax(d, dd);
            let report = SolverReport { residual: f64::INFINITY, ..SolverReport::default() };
            return PadLoad { report, ..PadLoad::default() };
        }
        // In the air: forces of the last touchdown are no guess for the next one.
        if memory.active.is_empty() {
            memory.clear();
            self.relax(d, dd);
            return PadLoad {
                report: SolverReport { converged: true, unique: true, ..SolverReport::default() },
                ..PadLoad::default()
            };
        }
        let report = solver::solve(&self.layer.coupling, memory, settings);
        self.rates(memory, d, dd);
        let (force, moment) = self.sum(memory, d);
        PadLoad { force, moment, report }
    }

    /// Outermost ones of these nodes of the sole along its diagonals, each once: of a pad that lies flat its corners.
    pub fn outermost(&self, of: impl Fn(usize) -> bool) -> impl Iterator<Item = usize> {
        let far = |i: usize, [x, y]: [f64; 2]| x * self.place(i).x + y * self.place(i).y;
        let corners = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]].map(|along| {
            let all = (0..self.layer.contacts()).filter(|&i| of(i));
            all.max_by(|&a, &b| far(a, along).total_cmp(&far(b, along)))
        });
        (0..4).filter_map(move |k| corners[k].filter(|_| !corners[..k].contains(&corners[k])))
    }

    /// c, active nodes, normals; whether all of it is finite.
    fn load(
        &self,
        memory: &mut Memory,
        d: &[f64],
        ground: &[Option<Ground>],
        twist: &SegmentMotion,
        settings: &Settings,
    ) -> bool {
        memory.begin();
        let mut sum = 0.0;
        for (i, ground) in ground.iter().enumerate().take(self.layer.contacts()) {
            let own = Vector3::new(d[3 * i], d[3 * i + 1], d[3 * i + 2]);
            let w = twist.linear + twist.angular.cross(&(self.place(i) + own));
            let mut c = w - own / self.layer.alpha;
            let mut normal = None;
            if let Some(ground) = ground.filter(|ground| ground.gap < TOUCHING) {
                c += ground.normal * (settings.recovery * ground.gap.min(0.0));
                normal = Some(ground.normal);
            }
            // A gap that is NaN must not pass for a distance.
            sum += ground.map_or(0.0, |ground| ground.gap) + c.x + c.y + c.z;
            memory.set(i, c, normal);
        }
        sum.is_finite()
    }

    /// The free layer: d' = -d/alpha.
    fn relax(&self, d: &[f64], dd: &mut [f64]) {
        for (dd, d) in dd.iter_mut().zip(d) {
            *dd = -d / self.layer.alpha;
            if !dd.is_finite() {
                *dd = 0.0;
            }
        }
    }

    /// d' = y - d/alpha, the nodes inside by those of the sole.
    fn rates(&self, memory: &Memory, d: &[f64], dd: &mut [f64]) {
        let n = 3 * self.layer.contacts();
        let (sole, inside) = dd.split_at_mut(n);
        for (dd, y) in sole.chunks_exact_mut(3).zip(&memory.y) {
            dd.copy_from_slice(&y[..3]);
        }
        inside.fill(0.0);
        for (k, y) in sole.iter().enumerate() {
            for (at, m) in inside.iter_mut().zip(self.layer.inside.column(k).iter()) {
                *at += m * y;
            }
        }
        for (dd, d) in dd.iter_mut().zip(d) {
            *dd -= d / self.layer.alpha;
        }
    }

    /// (2.38), (2.39) with the deformed places of the nodes.
    fn sum(&self, memory: &Memory, d: &[f64]) -> (Vector3<f64>, Vector3<f64>) {
        let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
        for &i in &memory.active {
            let f = memory.f[i];
            let r = self.place(i) + Vector3::new(d[3 * i], d[3 * i + 1], d[3 * i + 2]);
            force += f; // (2.38)
            moment += r.cross(&f); // (2.39)
        }
        (force, moment)
    }
}
