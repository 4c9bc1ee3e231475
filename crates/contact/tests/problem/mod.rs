//! Random problems of coupled nodes, the law written out, and two solvers of another kind.

use contact::Memory;
use contact::frame::frame;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

pub(crate) struct Problem {
    pub(crate) s: DMatrix<f64>,
    pub(crate) c: Vec<Vector3<f64>>,
    pub(crate) normals: Vec<Vector3<f64>>,
    pub(crate) mu: f64,
}

/// Numbers in -1..1, the same for a seed.
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut x = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    move || {
        x ^= x << 13;
        x ^= x >> 7;
        x ^= x << 17;
        (x >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

impl Problem {
    /// `tilt` is how far normals and mobilities are from level and isotropic.
    pub(crate) fn random(seed: u64, nodes: usize, tilt: f64) -> Self {
        let mut next = numbers(seed + 17);
        let n = 3 * nodes;
        let a = DMatrix::from_fn(n, n, |_, _| tilt * next());
        let s = (&a * a.transpose() + DMatrix::identity(n, n)) * 50.0;
        let c = (0..nodes).map(|_| Vector3::new(next(), next(), next() - 0.2)).collect();
        let normals =
            (0..nodes).map(|_| Vector3::new(tilt * next(), tilt * next(), 1.0).normalize()).collect();
        Self { s, c, normals, mu: 0.5 }
    }

    pub(crate) fn set(&self, memory: &mut Memory) {
        memory.begin();
        for (i, (c, n)) in self.c.iter().zip(&self.normals).enumerate() {
            memory.set(i, *c, Some(*n));
        }
    }

    /// Signorini, Coulomb and the balance f = S y, from the answer alone.
    pub(crate) fn check(&self, memory: &Memory, tolerance: f64) {
        let y = DVector::from_iterator(
            3 * self.c.len(),
            (0..self.c.len()).flat_map(|i| memory.rate(i).data.0[0]),
        );
        let balance = &self.s * &y;
        for (i, f) in memory.forces().iter().enumerate() {
            let own = Vector3::new(balance[3 * i], balance[3 * i + 1], balance[3 * i + 2]);
            assert!((own - f).norm() < tolerance * 10.0, "balance: {own} {f}");
            let e = frame(&self.normals[i]);
            let (lambda, u) = (e.tr_mul(f), e.tr_mul(&(memory.rate(i) + self.c[i])));
            assert!(
                lambda.z >= -1e-12
                    && u.z > -tolerance
                    && (lambda.z * u.z).abs() < tolerance * (1.0 + lambda.z)
            );
            let (t, slip) = (lambda.xy(), u.xy());
            assert!(t.norm() <= self.mu * lambda.z * (1.0 + 1e-12) + 1e-12);
            assert!(
                (slip.norm() * t + self.mu * lambda.z * slip).norm() < tolerance * (1.0 + lambda.z) * 3.0
            );
        }
    }

    /// Normal forces without friction: of all sets of closed nodes the one that holds.
    pub(crate) fn enumerated(&self) -> Vec<f64> {
        let n = self.c.len();
        let w = self.s.clone().cholesky().unwrap().inverse();
        let block = |i: usize, j: usize| -> f64 {
            (self.normals[i].transpose() * w.fixed_view::<3, 3>(3 * i, 3 * j) * self.normals[j])[0]
        };
        for set in 0..1usize << n {
            let closed: Vec<_> = (0..n).filter(|i| set >> i & 1 == 1).collect();
            let a = DMatrix::from_fn(closed.len(), closed.len(), |i, j| block(closed[i], closed[j]));
            let free =
                DVector::from_fn(closed.len(), |i, _| -self.normals[closed[i]].dot(&self.c[closed[i]]));
            let force = if closed.is_empty() { free } else { a.lu().solve(&free).unwrap() };
            let of = |i: usize| closed.iter().position(|k| *k == i).map_or(0.0, |k| force[k]);
            let opens = |i: usize| {
                let u: f64 =
                    (0..n).map(|j| block(i, j) * of(j)).sum::<f64>() + self.normals[i].dot(&self.c[i]);
                closed.contains(&i) || u >= 0.0
            };
            if force.iter().all(|f| *f >= 0.0) && (0..n).all(opens) {
                return (0..n).map(of).collect();
            }
        }
        panic!("a linear complementarity problem with a positive definite matrix has a solution");
    }
}

/// Forces by a semismooth Newton method with line search on the natural map of all nodes at once, dense, to 1e-12.
pub(crate) fn exact(problem: &Problem) -> Option<Vec<Vector3<f64>>> {
    let n = problem.c.len();
    let w = problem.s.clone().cholesky()?.inverse();
    let mut e = DMatrix::zeros(3 * n, 3 * n);
    for (i, normal) in problem.normals.iter().enumerate() {
        e.fixed_view_mut::<3, 3>(3 * i, 3 * i).copy_from(&frame(normal));
    }
    let a = e.transpose() * w * &e;
    let c = e.transpose() * DVector::from_iterator(3 * n, problem.c.iter().flat_map(|c| c.data.0[0]));
    let mut x = DVector::zeros(3 * n);
    let value = |x: &DVector<f64>| natural(&a, &c, x, problem.mu).0;
    for _ in 0..300 {
        let (f, slope) = natural(&a, &c, &x, problem.mu);
        if f.norm() < 1e-12 {
            return Some((0..n).map(|i| frame(&problem.normals[i]) * x.fixed_rows::<3>(3 * i)).collect());
        }
        let step = slope.lu().solve(&f)?;
        let better = |t: &f64| value(&(&x - *t * &step)).norm() < f.norm() * (1.0 - 1e-4 * t);
        let t = (0..12).map(|k| 0.5f64.powi(k)).find(better).unwrap_or(0.1);
        x -= t * step;
    }
    None
}

/// x - prox(x - r u(x)) of all nodes, r = 50, and its derivative.
fn natural(a: &DMatrix<f64>, c: &DVector<f64>, x: &DVector<f64>, mu: f64) -> (DVector<f64>, DMatrix<f64>) {
    let r = 50.0;
    let size = x.len();
    let z = x - r * (a * x + c);
    let dz = DMatrix::identity(size, size) - r * a;
    let (mut value, mut slope) = (x.clone(), DMatrix::identity(size, size));
    for i in (0..size).step_by(3) {
        let (t, n) = (z.fixed_rows::<2>(i).into_owned(), z[i + 2].max(0.0));
        // Derivative of prox by z of this node.
        let mut p = Matrix3::zeros();
        if z[i + 2] > 0.0 {
            p[(2, 2)] = 1.0;
        }
        let inside = t.norm() <= mu * n;
        let direction = if t.norm() > 0.0 { t / t.norm() } else { t };
        let tangent = if inside { t } else { direction * mu * n };
        if inside {
            p.fixed_view_mut::<2, 2>(0, 0).fill_with_identity();
        } else {
            let turn = nalgebra::Matrix2::identity() - direction * direction.transpose();
            p.fixed_view_mut::<2, 2>(0, 0).copy_from(&(turn * (mu * n / t.norm())));
            if z[i + 2] > 0.0 {
                p.fixed_view_mut::<2, 1>(0, 2).copy_from(&(direction * mu));
            }
        }
        let prox = Vector3::new(tangent.x, tangent.y, n);
        let rows = p * dz.fixed_rows::<3>(i);
        let mut at = slope.fixed_rows_mut::<3>(i);
        at -= rows;
        let mut at = value.fixed_rows_mut::<3>(i);
        at -= prox;
    }
    (value, slope)
}
