//! Writes the meshes shipped in `config/objects`: `cargo run -p environment --example objects -- config/objects`.

use std::fmt::Write;

/// Vertices \[m\] and triangles.
type Solid = (Vec<[f64; 3]>, Vec<[usize; 3]>);

fn main() -> std::io::Result<()> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| ".".to_owned());
    let folder = std::path::Path::new(&folder);
    let stairs =
        "Three steps of 0.1 m, treads 0.3 m deep, a landing of 0.9 m, 1.2 m wide; x up the stairs from 0.";
    std::fs::write(folder.join("stairs.obj"), obj(stairs, &stairs_of(3, 0.1, 0.3, 0.9, 1.2)))?;
    let uneven = "Smooth hills up to 15 mm on 2 m x 1 m, x from 0; its rim lies in the ground.";
    std::fs::write(folder.join("uneven.obj"), obj(uneven, &hills(40, 20, 0.05, 0.015, 7)))?;
    let holes = "A deck 20 mm high, 3.1 m x 1.2 m, x from 0, ramps of 0.3 m; holes of 0.1 m x 0.03 m down to the ground.";
    std::fs::write(folder.join("holes.obj"), obj(holes, &deck(10, 15, 0.02)))
}

/// Steps along x from 0, extruded over y.
fn stairs_of(steps: usize, rise: f64, tread: f64, landing: f64, width: f64) -> Solid {
    let length = (steps - 1) as f64 * tread + landing;
    // From the far lower corner every other point of the profile is in sight, so the side is a fan around it.
    let mut profile = vec![[length, 0.0], [0.0, 0.0]];
    for i in 0..steps {
        let end = if i + 1 < steps { (i + 1) as f64 * tread } else { length };
        profile.push([i as f64 * tread, (i + 1) as f64 * rise]);
        profile.push([end, (i + 1) as f64 * rise]);
    }
    let n = profile.len();
    let side = |y: f64| profile.iter().map(move |[x, z]| [*x, y, *z]);
    let vertices = side(-width / 2.0).chain(side(width / 2.0)).collect();
    let mut triangles = Vec::new();
    for i in 1..n - 1 {
        triangles.push([0, i + 1, i].map(|k| k + n));
        triangles.push([0, i, i + 1]);
    }
    for i in 0..n {
        let j = (i + 1) % n;
        triangles.extend([[i, i + n, j], [j, i + n, j + n]]);
    }
    // The profile runs clockwise seen from -y.
    (vertices, triangles.into_iter().map(|[a, b, c]| [a, c, b]).collect())
}

/// A grid of `nx` times `ny` cells of this size \[m\]: waves with phases drawn from `seed`, on a slab 20 mm in the ground.
fn hills(nx: usize, ny: usize, cell: f64, height: f64, seed: u64) -> Solid {
    let mut state = seed;
    let mut phase = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64 * std::f64::consts::TAU
    };
    let waves: Vec<[f64; 3]> =
        [[7.0, 3.0], [-4.0, 9.0], [11.0, 5.0], [6.0, -8.0]].map(|[x, y]| [x, y, phase()]).to_vec();
    let at = |i: usize, j: usize| i * (ny + 1) + j;
    let mut vertices = Vec::new();
    for i in 0..=nx {
        for j in 0..=ny {
            let (x, y) = (i as f64 * cell, (j as f64 - ny as f64 / 2.0) * cell);
            let wave: f64 = waves.iter().map(|[kx, ky, p]| (kx * x + ky * y + p).sin() / 4.0).sum();
            let rim = i == 0 || i == nx || j == 0 || j == ny;
            let z = if rim { 0.0 } else { height * (0.5 + 0.5 * wave) };
            vertices.push([x, y, (z * 1e6).round() / 1e6]);
        }
    }
    let mut triangles = Vec::new();
    for i in 0..nx {
        for j in 0..ny {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    close(vertices, triangles, nx, ny)
}

/// A deck with ramps at both ends and, between strips of 0.15 m, `rows` rows of `across` holes, each 0.1 m by 0.03 m.
fn deck(rows: usize, across: usize, height: f64) -> Solid {
    let mut xs = vec![0.0, 0.3];
    for _ in 0..rows {
        let last = xs[xs.len() - 1];
        xs.extend([last + 0.15, last + 0.25]);
    }
    let last = xs[xs.len() - 1];
    xs.push(last + 0.3);
    let mut ys = vec![-0.04 * across as f64];
    for _ in 0..across {
        let last = ys[ys.len() - 1];
        ys.extend([last + 0.03, last + 0.08]);
    }
    let (nx, ny) = (xs.len() - 1, ys.len() - 1);
    let at = |i: usize, j: usize| i * (ny + 1) + j;
    let mut vertices = Vec::new();
    for (i, x) in xs.iter().enumerate() {
        let z = if i == 0 || i == nx { 0.0 } else { height };
        vertices.extend(ys.iter().map(|y| [*x, *y, z]));
    }
    let mut triangles = Vec::new();
    for i in 0..nx {
        for j in 0..ny {
            let top = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            let hole = i % 2 == 0 && i > 0 && j % 2 == 0 && j > 0;
            if !hole {
                triangles.extend([[top[0], top[1], top[2]], [top[0], top[2], top[3]]]);
                continue;
            }
            let first = vertices.len();
            vertices.extend(top.map(|k| [vertices[k][0], vertices[k][1], 0.0]));
            let low: [usize; 4] = std::array::from_fn(|k| first + k);
            triangles.extend([[low[0], low[1], low[2]], [low[0], low[2], low[3]]]);
            for k in 0..4 {
                let l = (k + 1) % 4;
                triangles.extend([[top[k], top[l], low[l]], [top[k], low[l], low[k]]]);
            }
        }
    }
    close(vertices, triangles, nx, ny)
}

/// Sides and bottom for a surface over a grid of `nx` times `ny` cells, whose points come first, row by row: 20 mm in
/// the ground.
fn close(mut vertices: Vec<[f64; 3]>, mut triangles: Vec<[usize; 3]>, nx: usize, ny: usize) -> Solid {
    let at = |i: usize, j: usize| i * (ny + 1) + j;
    // The rim counter-clockwise seen from above, and below each of its points one of the slab.
    let rim: Vec<usize> = (0..nx)
        .map(|i| at(i, 0))
        .chain((0..ny).map(|j| at(nx, j)))
        .chain((1..=nx).rev().map(|i| at(i, ny)))
        .chain((1..=ny).rev().map(|j| at(0, j)))
        .collect();
    let first = vertices.len();
    vertices.extend(rim.iter().map(|k| [vertices[*k][0], vertices[*k][1], -0.02]).collect::<Vec<_>>());
    let middle = vertices.len();
    let [a, b] = [vertices[0], vertices[at(nx, ny)]];
    vertices.push([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), -0.02]);
    for k in 0..rim.len() {
        let l = (k + 1) % rim.len();
        triangles.extend([[rim[k], first + k, first + l], [rim[k], first + l, rim[l]]]);
        triangles.push([middle, first + l, first + k]);
    }
    (vertices, triangles)
}

fn obj(about: &str, (vertices, triangles): &Solid) -> String {
    let mut text = format!("# {about}\n# Written by crates/environment/examples/objects.rs. Metres, z up.\n");
    for [x, y, z] in vertices {
        // Rounded to nanometres, as the decimals are meant.
        let [x, y, z] = [x, y, z].map(|v| (v * 1e9).round() / 1e9);
        let _ = writeln!(text, "v {x} {y} {z}");
    }
    for t in triangles {
        let [a, b, c] = t.map(|i| i + 1);
        let _ = writeln!(text, "f {a} {b} {c}");
    }
    text
}
