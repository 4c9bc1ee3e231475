//! All scratch of the algorithms, made once.

use nalgebra::DMatrix;

use crate::body::{Body, Composite, JointKernel};
use crate::gyro::Spin;
use crate::model::Model;
use crate::space::{Mat3, Sym3, Twin, V3, ZERO, v3};
use crate::trigonometry::sin_cos;

/// Results and scratch for one [`Model`]. Nothing allocates after [`Data::new`].
///
/// Each function says in its documentation what it leaves here; a query reads what the last update left.
#[derive(Clone, Debug)]
pub struct Data {
    pub(crate) sin: Vec<f64>,
    pub(crate) cos: Vec<f64>,
    pub(crate) joints: Vec<Position>,
    /// parent_from_body of joints about oblique axes; others unused.
    pub(crate) oblique: Vec<Mat3>,
    /// Attitude and origin of the base.
    pub(crate) base: Mat3,
    pub(crate) origin: V3,
    pub(crate) places: Vec<BodyPlace>,
    pub(crate) motions: Vec<BodyMotion>,
    /// First moments of mass of the carried bodies, about the world's origin, world axes.
    pub(crate) moments: Vec<V3>,
    pub(crate) locals: Vec<Local>,
    pub(crate) composites: Vec<Composite>,
    /// Momentum and moment of momentum of each composite, on its way to the base.
    pub(crate) momenta: Vec<Twin>,
    pub(crate) articulated: Vec<Articulated>,
    pub(crate) spins: Vec<Spin>,
    /// Mass matrix and its factors as rows of [`crate::sparsity::Paths`].
    pub(crate) m: Vec<f64>,
    pub(crate) l: Vec<f64>,
    pub(crate) mass_matrix: DMatrix<f64>,
}

/// A joint in its position: cosine, sine, and the body's origin in the parent's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Position {
    pub c: f64,
    pub s: f64,
    pub r: V3,
    /// False if r is zero for good, as where the axes of a hip meet.
    pub apart: bool,
}

impl Position {
    /// r, none where it is zero: the kernels then save all that it would be multiplied with.
    #[inline(always)]
    pub(crate) fn offset(&self) -> Option<V3> {
        self.apart.then_some(self.r)
    }
}

/// A body in the world: rotation world_from_body, origin, axis of its joint along the coordinate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BodyPlace {
    pub a: Mat3,
    pub r: V3,
    pub e: V3,
}

/// A body's motion, world axes: angular velocity, velocity of the origin, and both accelerations at v' = 0.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct BodyMotion {
    pub w: V3,
    pub v: V3,
    pub dw: V3,
    pub dv: V3,
}

/// A body in its own axes: angular velocity, angular acceleration, the matrix k with which a point r of the body is
/// accelerated by a + k r, acceleration a of the origin less gravity, and the force and the moment about the origin that give them to the body and all it carries.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Local {
    pub w: V3,
    pub dw: V3,
    pub k: Mat3,
    pub a: V3,
    pub f: V3,
    pub n: V3,
}

/// Articulated inertia about the body's origin and what the elimination of the joint leaves for the second sweep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Articulated {
    /// n = i dw + h a + n0, f = h^T dw + m a + f0
    pub i: Sym3,
    pub h: Mat3,
    pub m: Sym3,
    pub n: V3,
    pub f: V3,
    /// Column of the joint's axis.
    pub un: V3,
    pub uf: V3,
    /// 1/D and joint force left over.
    pub d: f64,
    pub u: f64,
    /// Velocity products: angular and linear.
    pub cw: V3,
    pub ca: V3,
}

impl Model {
    /// Takes a configuration without computing more than sines and cosines. The functions whose names end in `_here`
    /// work at the configuration that was taken last, by this function or by any other that is given q: so several of
    /// them share the work of one.
    pub fn set_position(&self, data: &mut Data, q: &[f64]) {
        data.take(self, q);
    }
}

impl Data {
    /// Allocates for a model.
    pub fn new(model: &Model) -> Data {
        let (nb, nv) = (model.bodies.len(), model.nv());
        // What does not change with q is written here once: a joint's place in its parent, unless it slides.
        let position = |b: &Body| {
            let apart = b.r != ZERO || matches!(b.kind, JointKernel::Along(_));
            Position { c: 1.0, s: 0.0, r: b.r, apart }
        };
        let joints = model.bodies.iter().map(position).collect();
        let entries = model.paths.column.len();
        Data {
            sin: vec![0.0; model.n()],
            cos: vec![0.0; model.n()],
            joints,
            oblique: vec![Mat3::IDENTITY; nb],
            base: Mat3::IDENTITY,
            origin: ZERO,
            places: vec![BodyPlace { a: Mat3::IDENTITY, r: ZERO, e: v3(0.0, 0.0, 1.0) }; nb],
            motions: vec![BodyMotion::default(); nb],
            moments: vec![ZERO; nb],
            locals: vec![Local::default(); nb],
            composites: vec![Composite::default(); nb],
            momenta: vec![Twin::default(); nb],
            articulated: vec![Articulated::NONE; nb],
            spins: vec![Spin::default(); model.gyros.len()],
            m: vec![0.0; entries],
            l: vec![0.0; entries],
            mass_matrix: DMatrix::zeros(nv, nv),
        }
    }

    fn take(&mut self, model: &Model, q: &[f64]) {
        assert_eq!(q.len(), model.nq(), "length of q");
        self.origin = V3::from_slice(q);
        self.base = Mat3::from_quaternion([q[3], q[4], q[5], q[6]]);
        sin_cos(&q[7..], &mut self.sin, &mut self.cos);
        let turned = self.sin.iter().zip(&self.cos).zip(&q[7..]);
        for (k, ((body, joint), ((s, c), q))) in
            model.bodies.iter().zip(&mut self.joints).skip(1).zip(turned).enumerate()
        {
            match body.kind {
                JointKernel::Along(e) => joint.r = body.r + e * *q,
                kind => {
                    (joint.s, joint.c) = (s * body.sign, *c);
                    if let JointKernel::About(e) = kind {
                        self.oblique[k + 1] = Mat3::about(e, joint.c, joint.s);
                    }
                }
            }
        }
    }
}

impl Articulated {
    pub(crate) const NONE: Articulated = Articulated {
        i: Sym3 { xx: 0.0, yy: 0.0, zz: 0.0, xy: 0.0, xz: 0.0, yz: 0.0 },
        h: Mat3 { x: ZERO, y: ZERO, z: ZERO },
        m: Sym3 { xx: 0.0, yy: 0.0, zz: 0.0, xy: 0.0, xz: 0.0, yz: 0.0 },
        n: ZERO,
        f: ZERO,
        un: ZERO,
        uf: ZERO,
        d: 0.0,
        u: 0.0,
        cw: ZERO,
        ca: ZERO,
    };
}

/// Runs an expression with the joint's [`crate::turn::Turn`]; the kernel is compiled for each kind.
macro_rules! with_turn {
    ($body:expr, $joint:expr, $oblique:expr, $t:ident => $run:expr) => {{
        use $crate::body::JointKernel;
        use $crate::turn::{About, AboutX, AboutY, AboutZ, Along};
        match $body.kind {
            JointKernel::X => {
                let $t = AboutX($joint.c, $joint.s);
                $run
            }
            JointKernel::Y => {
                let $t = AboutY($joint.c, $joint.s);
                $run
            }
            JointKernel::Z => {
                let $t = AboutZ($joint.c, $joint.s);
                $run
            }
            JointKernel::About(e) => {
                let $t = About($oblique, e);
                $run
            }
            JointKernel::Along(e) => {
                let $t = Along(e);
                $run
            }
            JointKernel::Base => {}
        }
    }};
}
pub(crate) use with_turn;
