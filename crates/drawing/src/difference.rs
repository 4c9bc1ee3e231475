//! Difference between two pictures.

use std::path::Path;
use tiny_skia::Pixmap;

/// Difference in a colour, of 255, from which a pixel counts as another one: above that of two machines' edges.
const OTHER: u8 = 48;

/// Share of the pixels that differ between two PNG files.
///
/// # Errors
/// One cannot be read, or they are not of one size.
pub fn difference(a: &Path, b: &Path) -> Result<f64, String> {
    let load = |path: &Path| Pixmap::load_png(path).map_err(|e| format!("{}: {e}", path.display()));
    let (first, second) = (load(a)?, load(b)?);
    let size = |picture: &Pixmap| (picture.width(), picture.height());
    if size(&first) != size(&second) {
        let ((w, h), (v, g)) = (size(&first), size(&second));
        return Err(format!("{} is {w} x {h} pixels, {} is {v} x {g}", a.display(), b.display()));
    }
    let pairs = first.data().chunks_exact(4).zip(second.data().chunks_exact(4));
    let count = pairs.len().max(1);
    let other = pairs.filter(|(p, q)| p.iter().zip(q.iter()).any(|(x, y)| x.abs_diff(*y) > OTHER)).count();
    Ok(other as f64 / count as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::BLUE;
    use crate::{Chart, Figure};

    #[test]
    fn a_curve_that_moved_is_noticed_and_the_same_one_is_not() {
        let directory = std::env::temp_dir();
        let draw = |name: &str, shift: f64| {
            let mut chart = Chart::new("sine", "x", "y").at_least(4.0);
            chart.line(
                "y",
                (0..500).map(|k| [f64::from(k), (f64::from(k) * 0.03).sin() + shift]).collect(),
                BLUE,
            );
            chart.line("", vec![[0.0, -2.0], [0.0, 2.0]], BLUE);
            let path = directory.join(format!("gangwerk-difference-{}-{name}.png", std::process::id()));
            Figure::new("a", "b").with(chart).save(&path).unwrap();
            path
        };
        let (a, same, moved) = (draw("a", 0.0), draw("same", 0.0), draw("moved", 0.03));
        assert_eq!(difference(&a, &same), Ok(0.0));
        assert!(difference(&a, &moved).unwrap() > 1e-3);
        assert!(difference(&a, Path::new("/nowhere.png")).is_err());
        [a, same, moved].iter().for_each(|path| std::fs::remove_file(path).unwrap());
    }
}
