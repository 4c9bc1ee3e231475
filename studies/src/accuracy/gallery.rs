//! Gallery: every picture with its question, and below it the cheapest method for each accuracy, made from `accuracy.json`.

use std::fmt::Write;

use serde_json::Value;

use super::order::in_ms;

/// Decades of accuracy in a table, from the best that is reached on.
const DECADES: i32 = 5;

/// The page, as Markdown. `json`: what `accuracy.json` holds; `drawn`: whether a picture of this name lies beside the page.
pub fn page(json: &Value, drawn: impl Fn(&str) -> bool) -> String {
    let mut page = String::from(
        "# Gallery: speed against accuracy\n\n\
         Made by `gangwerk study accuracy` from its `accuracy.json`, which lies beside this page; a test makes it again. For each\n\
         question: the cheapest of its methods that stays within an error, and within its limit of stability. Pictures of the\n\
         others: `gangwerk study accuracy --from docs/gallery/accuracy.json`. What they say together: [accuracy](../accuracy.md).\n",
    );
    let charts = json["charts"].as_array().map_or(&[][..], Vec::as_slice);
    for together in charts.chunk_by(|a, b| file(a) == file(b)) {
        let (first, file) = (&together[0], file(&together[0]));
        let (title, about) = (text(first, "title"), text(first, "about"));
        _ = write!(page, "\n## {title}\n\n{about}\n\n");
        let picture = format!("{file}.png");
        if drawn(&picture) {
            _ = write!(page, "![{title}]({picture})\n\n");
        }
        page += "| error | at most | cheapest: model | method | cost |\n|---|---|---|---|---|\n";
        for chart in together {
            for (most, point) in cheapest(chart, json) {
                let step = point["step"].as_f64().map_or(String::new(), |h| format!(" {}", in_ms(h)));
                let solver = point["solver"].as_str().map_or(String::new(), |s| format!(" {s}"));
                let (model, method) = (text(point, "model"), text(point, "method"));
                let (measure, cost) = (text(chart, "measure"), cost_in_words(point));
                _ = writeln!(page, "| {measure} | 1e{most} | {model} | {method}{step}{solver} | {cost} |");
            }
        }
    }
    page
}

/// Cheapest points within powers of ten of the error; one that is no cheaper than a more accurate one is left out.
fn cheapest<'a>(chart: &Value, json: &'a Value) -> Vec<(i32, &'a Value)> {
    let all = json["points"].as_array().map_or(&[][..], Vec::as_slice);
    let unstable = |p: &Value| p["note"].as_str().is_some_and(|note| note.starts_with("beyond"));
    let error = |p: &Value| p["error"].as_f64().filter(|_| p["diverged"] != true && !unstable(p));
    let cost = |p: &Value| number_of_cost(p).map_or(f64::INFINITY, |(cost, _)| cost);
    let of_chart: Vec<&Value> =
        all.iter().filter(|p| p["chart"] == chart["name"] && error(p).is_some() && cost(p) > 0.0).collect();
    let errors = of_chart.iter().filter_map(|p| error(p)).filter(|e| *e > 0.0);
    let best = errors.fold(f64::INFINITY, f64::min);
    if !best.is_finite() {
        return Vec::new();
    }
    let first = best.log10().ceil() as i32;
    let mut found: Vec<(i32, &Value)> = Vec::new();
    for most in first..first + DECADES {
        let within = of_chart.iter().filter(|p| error(p).is_some_and(|e| e <= 10f64.powi(most)));
        let Some(point) = within.min_by(|a, b| cost(a).total_cmp(&cost(b))) else { continue };
        if found.last().is_none_or(|(_, last)| cost(point) < cost(last)) {
            found.push((most, point));
        }
    }
    found
}

/// Cost of a point, and its unit.
fn number_of_cost(point: &Value) -> Option<(f64, &'static str)> {
    let of = |key: &str, unit| point[key].as_f64().map(|cost| (cost, unit));
    of("cpu_us", "us").or_else(|| of("cpu_s_per_s", "s/s")).or_else(|| of("calls_per_s", "calls/s"))
}

fn cost_in_words(point: &Value) -> String {
    number_of_cost(point).map_or(String::new(), |(cost, unit)| {
        let digits = (1 - cost.log10().floor() as i32).clamp(0, 6) as usize;
        format!("{cost:.digits$} {unit}")
    })
}

fn file(chart: &Value) -> &str {
    text(chart, "name").split('.').next().unwrap_or_default()
}

fn text<'a>(value: &'a Value, key: &str) -> &'a str {
    value[key].as_str().unwrap_or_default()
}
