//! Bricks and the pad made of them: patch test, rigid motions, bars of closed form, locking, refinement.

use contact::hexahedron::{CORNERS, LinearElasticity, Stiffness, Volume, stiffness};
use contact::mesh::BrickMesh;
use contact::{Layer, Material};
use nalgebra::{DMatrix, DVector, Matrix3, SVector, Vector3};

const RUBBER: LinearElasticity = LinearElasticity { modulus: 5e5, poisson: 0.3 };
const KINDS: [Volume; 2] = [Volume::Full, Volume::Mean];

fn pad(bricks: [usize; 3], poisson: f64, volume: Volume) -> Layer {
    let elasticity = LinearElasticity { modulus: 5e5, poisson };
    let size = [0.06, 0.04, 0.012];
    Layer::new(&Material { size, bricks, elasticity, volume, damping_time: 0.008 }).unwrap()
}

/// A brick with crooked sides.
fn crooked() -> [Vector3<f64>; 8] {
    let mut k = 0.0f64;
    CORNERS.map(|c| {
        k += 1.0;
        Vector3::from(c) * 0.01 + Vector3::new((3.0 * k).sin(), (5.0 * k).sin(), (7.0 * k).sin()) * 0.002
    })
}

fn field(corners: &[Vector3<f64>; 8], gradient: &Matrix3<f64>) -> SVector<f64, 24> {
    SVector::from_fn(|k, _| (gradient * corners[k / 3])[k % 3])
}

#[test]
fn a_brick_has_six_rigid_motions_and_no_other_soft_one() {
    for volume in KINDS {
        let k = stiffness(&crooked(), &RUBBER, volume).unwrap();
        assert!((k - k.transpose()).amax() < 1e-10 * k.amax());
        let mut values: Vec<f64> = k.symmetric_eigenvalues().iter().copied().collect();
        values.sort_by(f64::total_cmp);
        assert!(values[5].abs() < 1e-10 * values[23], "{values:?}");
        assert!(values[6] > 1e-3 * values[23], "a soft motion of {volume:?}: {values:?}");
        for g in [Matrix3::zeros(), Vector3::new(0.3, -0.2, 0.5).cross_matrix()] {
            let shift = SVector::<f64, 24>::from_fn(|k, _| [0.1, -0.3, 0.2][k % 3]);
            assert!((k * (field(&crooked(), &g) + shift)).norm() < 1e-9 * k.amax());
        }
    }
}

/// The energy of a homogeneous strain is that of the strain times the volume, whatever the shape of the brick.
#[test]
fn homogeneous_strain_has_its_energy() {
    let corners = crooked();
    let volume_of = |corners: &[Vector3<f64>; 8]| -> f64 {
        // Trilinear map: the 2 x 2 x 2 rule is exact for its volume; here by six tetrahedra of each of the two splits.
        let tetrahedra = [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]];
        let other = [[1, 2, 3, 7], [1, 3, 0, 7], [1, 0, 4, 7], [1, 4, 5, 7], [1, 5, 6, 7], [1, 6, 2, 7]];
        let third = [[2, 3, 0, 4], [2, 0, 1, 4], [2, 1, 5, 4], [2, 5, 6, 4], [2, 6, 7, 4], [2, 7, 3, 4]];
        let fourth = [[3, 0, 1, 5], [3, 1, 2, 5], [3, 2, 6, 5], [3, 6, 7, 5], [3, 7, 4, 5], [3, 4, 0, 5]];
        let size = |t: &[usize; 4]| {
            let [a, b, c] = [1, 2, 3].map(|k| corners[t[k]] - corners[t[0]]);
            a.cross(&b).dot(&c) / 6.0
        };
        // Each diagonal cuts the six curved faces one way; all four together cut every face both ways equally often.
        [tetrahedra, other, third, fourth].iter().flatten().map(size).sum::<f64>() / 4.0
    };
    let g = Matrix3::new(0.01, 0.004, -0.002, 0.0, -0.02, 0.006, 0.003, -0.001, 0.015);
    let strain = (g + g.transpose()) * 0.5;
    let shear = [strain[(0, 1)], strain[(1, 2)], strain[(2, 0)]].map(|s| 2.0 * s);
    let e = SVector::<f64, 6>::from([
        strain[(0, 0)],
        strain[(1, 1)],
        strain[(2, 2)],
        shear[0],
        shear[1],
        shear[2],
    ]);
    let want = 0.5 * (e.transpose() * RUBBER.matrix() * e)[0] * volume_of(&corners);
    for volume in KINDS {
        let u = field(&corners, &g);
        let k: Stiffness = stiffness(&corners, &RUBBER, volume).unwrap();
        let energy = 0.5 * (u.transpose() * k * u)[0];
        assert!((energy / want - 1.0).abs() < 1e-12, "{volume:?}: {energy} J, not {want} J");
    }
}

/// Patch test: of seven crooked bricks round an inner one, nodes on the boundary follow a linear field; the nodes inside
/// must find it by themselves.
#[test]
fn a_patch_of_crooked_bricks_reproduces_every_linear_field() {
    let mut mesh = BrickMesh::block([0.03, 0.03, 0.03], [3, 3, 3]);
    let inside: Vec<usize> =
        (0..64).filter(|k| [k % 4, k / 4 % 4, k / 16].iter().all(|i| (1..3).contains(i))).collect();
    for &k in &inside {
        let x = k as f64;
        mesh.nodes[k] += Vector3::new((2.0 * x).sin(), (3.0 * x).sin(), (5.0 * x).sin()) * 0.002;
    }
    let g = Matrix3::new(0.01, 0.004, -0.002, 0.0, -0.02, 0.006, 0.003, -0.001, 0.015);
    for (volume, poisson) in [(Volume::Full, 0.3), (Volume::Full, 0.49), (Volume::Mean, 0.49)] {
        let material = LinearElasticity { poisson, ..RUBBER };
        let mut k = DMatrix::<f64>::zeros(192, 192);
        for brick in &mesh.bricks {
            let local = stiffness(&brick.map(|i| mesh.nodes[i]), &material, volume).unwrap();
            for (a, b) in (0..24).flat_map(|a| (0..24).map(move |b| (a, b))) {
                k[(3 * brick[a / 3] + a % 3, 3 * brick[b / 3] + b % 3)] += local[(a, b)];
            }
        }
        let u = DVector::<f64>::from_iterator(192, mesh.nodes.iter().flat_map(|x| (g * x).data.0[0]));
        let free: Vec<usize> = inside.iter().flat_map(|i| 3 * i..3 * i + 3).collect();
        let mut held = u.clone();
        free.iter().for_each(|i| held[*i] = 0.0);
        let load = -(&k * held);
        let a = DMatrix::from_fn(24, 24, |i, j| k[(free[i], free[j])]);
        let found = a.cholesky().unwrap().solve(&DVector::from_fn(24, |i, _| load[free[i]]));
        let error = (0..24).map(|i| (found[i] - u[free[i]]).abs()).fold(0.0, f64::max);
        assert!(error < 1e-14, "{volume:?} at nu = {poisson}: {error:e} m of {:e} m", u.amax());
    }
}

/// A bar pulled along z with free sides: F = E A/l times the way, sides drawn in by nu. One that cannot draw in has the
/// modulus of the confined layer.
#[test]
fn bars_have_their_closed_forms() {
    for volume in KINDS {
        let [a, b, l] = [0.02, 0.03, 0.04];
        let corners = CORNERS.map(|c| Vector3::new(c[0] * a, c[1] * b, c[2] * l) * 0.5);
        let k = stiffness(&corners, &RUBBER, volume).unwrap();
        let pull = |lateral: f64| {
            let g = Matrix3::from_diagonal(&Vector3::new(-lateral, -lateral, 1.0));
            let f = k * field(&corners, &g);
            let of = |axis: usize, side: f64| -> f64 {
                (0..8).filter(|n| CORNERS[*n][axis] == side).map(|n| f[3 * n + axis]).sum()
            };
            (of(0, 1.0), of(2, 1.0))
        };
        let (side, end) = pull(RUBBER.poisson);
        assert!(side.abs() < 1e-9 * end && (end / (RUBBER.modulus * a * b) - 1.0).abs() < 1e-12);
        let nu = RUBBER.poisson;
        let confined = RUBBER.modulus * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
        assert!((pull(0.0).1 / (confined * a * b) - 1.0).abs() < 1e-12);
    }
}

/// The matrix of the free nodes is definite, and a layer too wide to notice its sides has the confined modulus per area.
#[test]
fn a_wide_layer_is_confined() {
    let elasticity = RUBBER;
    let material = Material {
        size: [1.0, 1.0, 0.01],
        bricks: [8, 8, 1],
        elasticity,
        volume: Volume::Full,
        damping_time: 0.01,
    };
    let layer = Layer::new(&material).unwrap();
    let confined = 5e5 * 0.7 / (1.3 * 0.4) / 0.01;
    let shear = 5e5 / 2.6 / 0.01;
    assert!(
        (layer.block_stiffness(2) / confined - 1.0).abs() < 0.02,
        "{}",
        layer.block_stiffness(2) / confined
    );
    assert!((layer.block_stiffness(0) / shear - 1.0).abs() < 0.02, "{}", layer.block_stiffness(0) / shear);
}

/// \[N/m\] The sole pressed by a plane without friction: its nodes are free along the plane.
fn slippery_stiffness(layer: &Layer) -> f64 {
    let k = layer.stiffness();
    let (held, free): (Vec<_>, Vec<_>) = (0..k.nrows()).partition(|i| i % 3 == 2 && i / 3 < layer.contacts());
    let part = |rows: &[usize], columns: &[usize]| {
        DMatrix::from_fn(rows.len(), columns.len(), |i, j| k[(rows[i], columns[j])])
    };
    let ones = DVector::from_element(held.len(), 1.0);
    let give = part(&free, &free).cholesky().unwrap().solve(&(part(&free, &held) * &ones));
    (part(&held, &held) * ones - part(&held, &free) * give).sum()
}

/// The pad of the thesis has no nodes between sole and segment. Glued to a plane it can nowhere bulge: it is confined
/// exactly, for every brick, and that much too stiff. This is the price of the mesh, small for nu = 0.3, but at 0.45 the
/// pad is 1.8 times as stiff as rubber and at 0.49 five times.
#[test]
fn one_brick_between_glued_planes_is_confined() {
    for (poisson, excess) in [(0.3, 0.0856), (0.45, 0.759), (0.49, 4.31)] {
        for volume in KINDS {
            let nu = poisson;
            let confined = 5e5 * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)) * 0.06 * 0.04 / 0.012;
            let coarse = pad([5, 5, 1], poisson, volume).block_stiffness(2);
            assert!((coarse / confined - 1.0).abs() < 1e-12, "{coarse} {confined}");
            let fine = pad([8, 8, 3], poisson, Volume::Mean).block_stiffness(2);
            let more = coarse / fine - 1.0;
            assert!((more / excess - 1.0).abs() < 0.1, "nu {nu}: {more} too stiff");
        }
    }
}

/// Locking: pressed by a plane it slides on, the pad may bulge at its sole, and full integration hinders it where nu
/// comes near 1/2; mean dilatation does less so. Refinement brings both down to one value, from above.
#[test]
fn stiffness_falls_with_refinement_and_locks_with_nu() {
    for (poisson, full, mean) in [(0.3, 0.0400, 0.0189), (0.49, 2.257, 0.0781)] {
        let of = |bricks, volume| slippery_stiffness(&pad(bricks, poisson, volume));
        let fine = of([8, 8, 3], Volume::Mean);
        let excess = |bricks, volume| of(bricks, volume) / fine - 1.0;
        let (f, m) = (excess([5, 5, 1], Volume::Full), excess([5, 5, 1], Volume::Mean));
        let finer = [Volume::Full, Volume::Mean].map(|volume| excess([5, 5, 2], volume));
        assert!(0.0 < finer[0] && finer[0] < 0.5 * f && 0.0 < finer[1] && finer[1] < 0.5 * m, "{finer:?}");
        assert!(
            (f / full - 1.0).abs() < 0.1 && (m / mean - 1.0).abs() < 0.1,
            "nu {poisson}: {f} and {m} too stiff"
        );
    }
}

#[test]
fn bad_material_is_named() {
    let good = Material {
        size: [0.06, 0.04, 0.012],
        bricks: [5, 5, 1],
        elasticity: RUBBER,
        volume: Volume::Full,
        damping_time: 0.008,
    };
    let text = |m: Material| Layer::new(&m).unwrap_err().to_string();
    let soft = |poisson| Material { elasticity: LinearElasticity { poisson, ..RUBBER }, ..good };
    assert!(text(soft(0.5)).contains("poisson is 0.5; it must be in -0.9..=0.499"));
    assert!(text(soft(f64::NAN)).contains("poisson is NaN"));
    assert!(text(Material { size: [0.06, 0.0, 0.012], ..good }).contains("size [m] is 0"));
    assert!(text(Material { bricks: [5, 0, 1], ..good }).contains("at least one brick"));
    assert!(text(Material { bricks: [50, 50, 1], ..good }).contains("2601"));
    assert!(text(Material { damping_time: 0.0, ..good }).contains("damping_time [s] is 0"));
    assert!(
        text(Material { elasticity: LinearElasticity { modulus: -1.0, poisson: 0.3 }, ..good })
            .contains("modulus")
    );
}
