//! Brick with eight nodes and trilinear displacements: its stiffness, by 2 x 2 x 2 Gauss points.
//!
//! Small displacements, linear isotropic material. Fully integrated bricks lock: where the material is nearly
//! incompressible (nu towards 1/2), or a brick is bent, the trilinear field cannot follow and the brick is too stiff.
//! [`Volume::Mean`] takes the change of volume as constant over the brick (mean dilatation), which removes the first
//! kind: a pad of 5 x 5 x 1 bricks of nu = 0.49 that may slide on the ground is 226 % too stiff fully integrated, and 8 %
//! so (`tests/block.rs`).
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | N | shape functions | 1 |
//! | J | derivative of the place by the coordinates of the brick, xi in -1..1 | m |
//! | b | strain by node displacements: xx, yy, zz, xy, yz, zx (engineering shear) | 1/m |
//! | C | stress by strain | N/m^2 |

use nalgebra::{Matrix3, SMatrix, Vector3};

/// 3 x 8 rows and columns: x, y, z of node 0, of node 1, ...
pub type Stiffness = SMatrix<f64, 24, 24>;
type Strain = SMatrix<f64, 6, 24>;

/// Linear isotropic elasticity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearElasticity {
    /// \[N/m^2\] E, Young's modulus.
    pub modulus: f64,
    /// \[1\] nu, Poisson's ratio; above -1 and below 1/2.
    pub poisson: f64,
}

/// Treatment of the change of volume.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Volume {
    /// At every Gauss point: the textbook element.
    Full,
    /// As its mean over the brick.
    #[default]
    Mean,
}

/// Place of the nodes in the brick's own coordinates: counter-clockwise below, then above.
pub const CORNERS: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

impl LinearElasticity {
    /// C
    pub fn matrix(&self) -> SMatrix<f64, 6, 6> {
        let (e, nu) = (self.modulus, self.poisson);
        let shear = e / (2.0 * (1.0 + nu));
        let lambda = e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
        SMatrix::from_fn(|i, j| match (i < 3, j < 3) {
            (true, true) => lambda + if i == j { 2.0 * shear } else { 0.0 },
            (false, false) if i == j => shear,
            _ => 0.0,
        })
    }
}

/// \[N/m\] Stiffness of a brick with these corners \[m\]; `None` if it is turned inside out or flat somewhere.
pub fn stiffness(
    corners: &[Vector3<f64>; 8],
    material: &LinearElasticity,
    volume: Volume,
) -> Option<Stiffness> {
    let c = material.matrix();
    let points = gauss_points();
    let mut strains = [(Strain::zeros(), 0.0); 8];
    for (at, point) in strains.iter_mut().zip(&points) {
        *at = strain(corners, point)?;
    }
    if volume == Volume::Mean {
        make_mean(&mut strains);
    }
    Some(strains.iter().fold(Stiffness::zeros(), |k, (b, size)| k + b.transpose() * c * b * *size))
}

fn gauss_points() -> [Vector3<f64>; 8] {
    CORNERS.map(|corner| Vector3::from(corner) / 3f64.sqrt())
}

/// b at a point, and the volume \[m^3\] that the point stands for.
fn strain(corners: &[Vector3<f64>; 8], xi: &Vector3<f64>) -> Option<(Strain, f64)> {
    let slopes = CORNERS.map(|a| {
        let f: [f64; 3] = std::array::from_fn(|k| 1.0 + a[k] * xi[k]);
        Vector3::new(a[0] * f[1] * f[2], a[1] * f[0] * f[2], a[2] * f[0] * f[1]) / 8.0
    });
    // From the unit cube to the brick; one turned inside out has no volume.
    let j: Matrix3<f64> = corners.iter().zip(&slopes).map(|(x, n)| x * n.transpose()).sum();
    let size = j.determinant();
    if !(size > 0.0) {
        return None;
    }
    let to_place = j.try_inverse()?.transpose();
    let mut b = Strain::zeros();
    // Strains xx, yy, zz, xy, yz, zx by the displacements of corner k.
    for (k, slope) in slopes.iter().enumerate() {
        let n = to_place * slope;
        for (row, [x, y, z]) in [
            [n.x, 0.0, 0.0],
            [0.0, n.y, 0.0],
            [0.0, 0.0, n.z],
            [n.y, n.x, 0.0],
            [0.0, n.z, n.y],
            [n.z, 0.0, n.x],
        ]
        .into_iter()
        .enumerate()
        {
            (b[(row, 3 * k)], b[(row, 3 * k + 1)], b[(row, 3 * k + 2)]) = (x, y, z);
        }
    }
    Some((b, size))
}

/// Replaces the volumetric part of every strain by its mean over the brick.
fn make_mean(strains: &mut [(Strain, f64); 8]) {
    let dilatation = |b: &Strain| b.row(0) + b.row(1) + b.row(2);
    let size: f64 = strains.iter().map(|(_, size)| size).sum();
    let sum = strains.iter().fold(SMatrix::<f64, 1, 24>::zeros(), |sum, (b, w)| sum + dilatation(b) * *w);
    for (b, _) in strains {
        let change = (sum / size - dilatation(b)) / 3.0;
        for i in 0..3 {
            let row = b.row(i) + change;
            b.set_row(i, &row);
        }
    }
}
