//! What docs say of speed against accuracy is what was measured: the gallery is made from its `accuracy.json`, and the tables of
//! docs/accuracy.md have its numbers.

use std::path::{Path, PathBuf};

use serde_json::Value;
use studies::accuracy::gallery;

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs")
}

fn measured() -> Value {
    let text = std::fs::read_to_string(docs().join("gallery/accuracy.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

#[test]
fn the_gallery_is_that_of_its_figures() {
    let page = std::fs::read_to_string(docs().join("gallery/README.md")).unwrap();
    let now = gallery::page(&measured(), |picture| docs().join("gallery").join(picture).exists());
    let kept = Path::new(env!("CARGO_TARGET_TMPDIR")).join("gallery.md");
    std::fs::write(&kept, &now).unwrap();
    assert!(page == now, "docs/gallery/README.md is not made from its accuracy.json: {} is", kept.display());
    for picture in page.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
        assert!(docs().join("gallery").join(picture).exists(), "docs/gallery/{picture} is not there");
    }
}

/// Cells of the Markdown tables of docs/accuracy.md whose heading row begins with `head`.
fn table(head: &str) -> Vec<Vec<String>> {
    let page = std::fs::read_to_string(docs().join("accuracy.md")).unwrap();
    let rows = page.lines().skip_while(|line| !line.starts_with(&format!("| {head}"))).skip(2);
    let cells = |line: &str| line.split('|').map(|cell| cell.trim().to_owned()).collect();
    rows.take_while(|line| line.starts_with('|')).map(cells).collect()
}

/// The numbers in a cell, with half of the last digit that each is written with.
fn numbers(cell: &str) -> Vec<(f64, f64)> {
    let cell = cell.replace('−', "-");
    let number = |word: &str| {
        let word = word.trim_end_matches(',');
        let (mantissa, exponent) = word.split_once('e').unwrap_or((word, "0"));
        let decimals = mantissa.split_once('.').map_or(0, |(_, decimals)| decimals.len() as i32);
        let exponent: i32 = exponent.parse().ok()?;
        Some((word.parse().ok()?, 0.5 * 10f64.powi(exponent - decimals)))
    };
    cell.split_whitespace().filter_map(number).collect()
}

/// Error and cost of the point of a chart with this model, method and step \[ms\].
fn point(json: &Value, chart: &str, of: impl Fn(&Value) -> bool) -> (f64, f64) {
    let points = json["points"].as_array().unwrap();
    let found: Vec<&Value> = points.iter().filter(|p| p["chart"] == chart && of(p)).collect();
    assert_eq!(found.len(), 1, "{chart}: {found:?}");
    (found[0]["error"].as_f64().unwrap_or(f64::NAN), found[0]["cpu_s_per_s"].as_f64().unwrap_or(f64::NAN))
}

fn step_is(p: &Value, ms: f64) -> bool {
    p["step"].as_f64().is_some_and(|h| (1e3 * h / ms - 1.0).abs() < 1e-6)
}

/// Types beside type 5: inclination and normal force of every row, and costs, which move by some 10 % from run to run.
#[test]
fn the_table_of_types_has_the_numbers_measured() {
    let json = measured();
    let mut compared = 0;
    for row in table("scene walk_1kmh, 4 s to 8 s") {
        let Some((model, step)) = row[1].split_once(", ") else { continue };
        let Ok(ms) = step.trim_start_matches("Euler ").trim_end_matches(" ms").parse::<f64>() else {
            continue;
        };
        let of = |p: &Value| p["model"] == model && step_is(p, ms);
        for (chart, cell, unit) in
            [("depth_walk_1kmh.inclination", &row[3], 1e3), ("depth_walk_1kmh.force", &row[4], 1.0)]
        {
            let (error, cost) = point(&json, chart, of);
            let (written, half) = numbers(cell)[0];
            assert!((written - unit * error).abs() <= 1.01 * half, "{}: {cell}, measured {error}", row[1]);
            let (written, half) = numbers(&row[2])[0];
            assert!((written - cost).abs() <= half + 0.15 * cost, "{}: cost {written}, {cost}", row[1]);
            compared += 1;
        }
    }
    assert_eq!(compared, 16, "rows that were compared");
}
