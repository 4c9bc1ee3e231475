//! Material of a pad turned into matrices, once: assembly, elimination of the bonded nodes, damping, inverse.
//!
//! | symbol | name | unit | shape |
//! |---|---|---|---|
//! | K | stiffness of the free nodes | N/m | 3m x 3m |
//! | B | damping alpha K (Rayleigh, thesis 2.3.1) | N s/m | 3m x 3m |
//! | alpha | time in which a free layer relaxes | s | |
//! | n, m | nodes that can touch, free nodes; the former come first | 1 | |

use std::fmt;

use nalgebra::{DMatrix, Vector3};

use crate::coupling::Coupling;
use crate::hexahedron::{self, LinearElasticity, Volume};
use crate::mesh::BrickMesh;

/// Size, mesh and material of a pad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// \[m\] x, y, z; z from the sole up to the segment.
    pub size: [f64; 3],
    /// Bricks along x, y, z.
    pub bricks: [usize; 3],
    /// Elasticity of the rubber.
    pub elasticity: LinearElasticity,
    /// Kind of brick.
    pub volume: Volume,
    /// \[s\] alpha
    pub damping_time: f64,
}

/// Why there is no layer of this material: the value that is wrong, and what it may be.
#[derive(Clone, Debug, PartialEq)]
pub struct BadMaterial {
    field: &'static str,
    value: f64,
    allowed: &'static str,
}

impl fmt::Display for BadMaterial {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "contact pad: {} is {}; it must be {}", self.field, self.value, self.allowed)
    }
}

impl std::error::Error for BadMaterial {}

/// Largest number of free nodes: the inverse is dense.
const MOST_NODES: usize = 1500;

impl Material {
    fn check(&self) -> Result<(), BadMaterial> {
        let refuse = |field, value, allowed| Err(BadMaterial { field, value, allowed });
        let positive = |x: f64| x > 0.0 && x.is_finite();
        if let Some(x) = self.size.iter().find(|x| !positive(**x)) {
            return refuse("size [m]", *x, "positive in every direction");
        }
        // The top is glued to the foot, so its nodes are not free.
        let nodes = (self.bricks[0] + 1) * (self.bricks[1] + 1) * self.bricks[2];
        if self.bricks.contains(&0) || nodes > MOST_NODES {
            return refuse(
                "number of free nodes",
                nodes as f64,
                "1 to 1500: at least one brick in every direction",
            );
        }
        // Then the material: each number by itself.
        let LinearElasticity { modulus, poisson } = self.elasticity;
        if !positive(modulus) {
            return refuse("modulus [N/m^2]", modulus, "positive");
        }
        if !(-0.9..=0.499).contains(&poisson) {
            return refuse(
                "poisson",
                poisson,
                "in -0.9..=0.499; incompressible material has no stiffness matrix",
            );
        }
        if !positive(self.damping_time) {
            return refuse(
                "damping_time [s]",
                self.damping_time,
                "positive: a massless layer without damping has no rate",
            );
        }
        Ok(())
    }
}

/// Matrices that all pads of one material share.
#[derive(Clone, Debug)]
pub struct Layer {
    pub(crate) alpha: f64,
    /// \[m\] Places of the free nodes at rest, from the middle of the sole.
    pub(crate) places: Vec<Vector3<f64>>,
    pub(crate) coupling: Coupling,
    /// y of the free nodes that cannot touch, by y of the others; column by column.
    pub(crate) inside: DMatrix<f64>,
    stiffness: DMatrix<f64>,
}

impl Layer {
    /// Builds the matrices; takes the cube of the number of nodes in time, so once at the start.
    pub fn new(material: &Material) -> Result<Self, BadMaterial> {
        material.check()?;
        let mesh = BrickMesh::block(material.size, material.bricks);
        let not_definite = || BadMaterial {
            field: "poisson",
            value: material.elasticity.poisson,
            allowed: "further from 1/2",
        };
        let k = assemble(&mesh, material).ok_or_else(not_definite)?;
        let (n, m) = (3 * mesh.layer, 3 * mesh.free());
        // y_inside = -B_ii^-1 B_ic y_c, S = B_cc + B_ci (-B_ii^-1 B_ic)
        let b = &k * material.damping_time;
        let rows = b.view((n, n), (m - n, m - n)).into_owned();
        let inside = match rows.cholesky() {
            Some(rows) => -rows.solve(&b.view((n, 0), (m - n, n)).into_owned()),
            None => return Err(not_definite()),
        };
        let s = b.view((0, 0), (n, n)) + b.view((0, n), (n, m - n)) * &inside;
        let coupling = Coupling::new(&s).ok_or_else(not_definite)?;
        let places = mesh.nodes[..mesh.free()].to_vec();
        Ok(Self { alpha: material.damping_time, places, coupling, inside, stiffness: k })
    }

    /// Free nodes; the state d has 3 numbers for each.
    pub fn nodes(&self) -> usize {
        self.places.len()
    }

    /// Nodes of the sole, the first of the free ones.
    pub fn contacts(&self) -> usize {
        self.coupling.nodes()
    }

    /// K \[N/m\] of the free nodes.
    pub fn stiffness(&self) -> &DMatrix<f64> {
        &self.stiffness
    }

    /// Coupling of the contact nodes.
    pub fn coupling(&self) -> &Coupling {
        &self.coupling
    }

    /// \[N/m\] Force per way when a plane that nothing slides on presses the whole sole in along this axis.
    pub fn block_stiffness(&self, axis: usize) -> f64 {
        let n = self.contacts();
        // S/alpha is the stiffness against the contact nodes when all others give way.
        let shape = DMatrix::from_fn(3 * n, 1, |k, _| if k % 3 == axis { 1.0 } else { 0.0 });
        let m = self.places.len();
        let mut full = DMatrix::zeros(3 * m, 1);
        full.view_mut((0, 0), (3 * n, 1)).copy_from(&shape);
        full.view_mut((3 * n, 0), (3 * (m - n), 1)).copy_from(&(&self.inside * &shape));
        let force = &self.stiffness * full;
        (0..n).map(|i| force[3 * i + axis]).sum()
    }
}

/// K of the free nodes: the bonded ones do not move, so their rows and columns are left out.
fn assemble(mesh: &BrickMesh, material: &Material) -> Option<DMatrix<f64>> {
    let free = mesh.free();
    let mut k = DMatrix::zeros(3 * free, 3 * free);
    for brick in &mesh.bricks {
        let corners = brick.map(|node| mesh.nodes[node]);
        let local = hexahedron::stiffness(&corners, &material.elasticity, material.volume)?;
        for (a, &i) in brick.iter().enumerate().filter(|(_, i)| **i < free) {
            for (b, &j) in brick.iter().enumerate().filter(|(_, j)| **j < free) {
                let mut at = k.fixed_view_mut::<3, 3>(3 * i, 3 * j);
                at += local.fixed_view::<3, 3>(3 * a, 3 * b);
            }
        }
    }
    Some(k)
}
