//! Time of queries for the nodes of independent contact (16) and of two FEM feet (288), on more and more complex ground,
//! and where looking at every triangle stops to pay.

use std::hint::black_box;
use std::path::Path;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use environment::{Environment, Mesh, Object, Pose, Schedule};

fn object(mesh: Mesh, x: f64, z: f64) -> Object {
    Object::new("object", mesh, None, Schedule::fixed(Pose::new([x, 0.0, z], [0.0; 3])))
}

fn shipped(name: &str) -> Mesh {
    let objects = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/objects");
    Mesh::read(&objects.join(name), 1.0).expect("shipped mesh")
}

/// A closed block of hills, n x n cells on 2 m x 2 m: 2 n^2 + 12 n triangles.
fn block(n: usize) -> Mesh {
    let at = |i: usize, j: usize| (i * (n + 1) + j) as u32;
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..=n {
        for j in 0..=n {
            let [x, y] = [i, j].map(|k| 2.0 * k as f64 / n as f64);
            vertices.push([x, y - 1.0, 0.01 * ((5.0 * x).sin() * (7.0 * y).cos()) + 0.02]);
            if i < n && j < n {
                let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    let rim: Vec<u32> = (0..n)
        .map(|i| at(i, 0))
        .chain((0..n).map(|j| at(n, j)))
        .chain((1..=n).rev().map(|i| at(i, n)))
        .chain((1..=n).rev().map(|j| at(0, j)))
        .collect();
    let first = vertices.len() as u32;
    vertices.extend(
        rim.iter().map(|k| [vertices[*k as usize][0], vertices[*k as usize][1], -0.1]).collect::<Vec<_>>(),
    );
    let middle = vertices.len() as u32;
    vertices.push([1.0, 0.0, -0.1]);
    for k in 0..rim.len() {
        let l = (k + 1) % rim.len();
        let (low, next) = (first + k as u32, first + l as u32);
        triangles.extend([[rim[k], low, next], [rim[k], next, rim[l]], [middle, next, low]]);
    }
    Mesh::new(&vertices, &triangles).expect("closed block")
}

/// `n` points as under a foot of 0.26 m x 0.13 m at this place, half of them sunk 0.1 mm, half 1 mm above.
fn foot(n: usize, [x, y, z]: [f64; 3]) -> Vec<[f64; 3]> {
    (0..n)
        .map(|i| {
            let [u, v] = [i % 18, i / 18 % 8].map(|k| k as f64);
            [x + u * 0.0144, y + v * 0.0162, z + if i % 2 == 0 { -1e-4 } else { 1e-3 }]
        })
        .collect()
}

fn queries(c: &mut Criterion) {
    let board = || object(Mesh::cuboid([0.4, 0.6, 0.02]).expect("box"), 0.0, 0.01);
    let floors = [
        ("flat", Environment::flat(), [0.0; 3]),
        ("on a board", Environment::new(vec![board()]), [-0.13, 0.0, 0.02]),
        ("beside a board", Environment::new(vec![board()]), [0.5, 0.0, 0.0]),
        ("stairs", Environment::new(vec![object(shipped("stairs.obj"), 0.0, 0.0)]), [0.35, 0.0, 0.2]),
        ("uneven", Environment::new(vec![object(shipped("uneven.obj"), 0.0, 0.0)]), [0.5, 0.0, 0.008]),
        ("10k triangles", Environment::new(vec![object(block(68), 0.0, 0.0)]), [0.5, 0.0, 0.02]),
    ];
    for n in [16, 288] {
        let mut group = c.benchmark_group(format!("{n} points"));
        for (name, environment, at) in &floors {
            let points = foot(n, *at);
            group.bench_function(*name, |b| {
                b.iter(|| points.iter().map(|p| environment.query(*black_box(p)).gap).sum::<f64>());
            });
        }
    }
}

/// One query near the surface, over the number of triangles.
fn crossover(c: &mut Criterion) {
    let mut group = c.benchmark_group("one point");
    let meshes = [Mesh::cuboid([0.4, 0.6, 0.02]).expect("box"), shipped("stairs.obj")];
    for mesh in meshes.into_iter().chain([4, 8, 16, 32, 68].map(block)) {
        let top = mesh.bounds().hi;
        let points: Vec<_> =
            foot(16, [0.3 * top.x, 0.3 * top.y, top.z]).into_iter().map(Into::into).collect();
        let mut turn = 0;
        let mut next = || {
            turn = (turn + 1) % 16;
            points[turn]
        };
        group.bench_function(BenchmarkId::new("hierarchy", mesh.len()), |b| b.iter(|| mesh.nearest(&next())));
        group.bench_function(BenchmarkId::new("search", mesh.len()), |b| {
            b.iter(|| mesh.nearest_by_search(&next()));
        });
    }
}

criterion_group!(benches, queries, crossover);
criterion_main!(benches);
