//! Answer to an unknown name: the names that were probably meant.

use strsim::damerau_levenshtein as edits;

/// Most names that are offered.
const MOST: usize = 6;

/// The known name nearest to `name`, by letters inserted, deleted, replaced or swapped; none if nothing is known.
pub fn nearest<'k>(name: &str, known: &'k [impl AsRef<str>]) -> Option<&'k str> {
    known.iter().map(AsRef::as_ref).min_by_key(|known| edits(name, known))
}

/// "there is no KIND `name`; did you mean ...? HINT" with the names that are near, or that hold it; the hint says where all
/// of them stand.
pub fn unknown(kind: &str, name: &str, known: &[&str], hint: &str) -> String {
    // `velocity` is near to `walk/velocity`, and `swing_hieght` to `planner.swing_height`.
    let tail = |s: &str| s.rsplit(['/', '.']).next().unwrap_or(s).to_owned();
    // A third of the letters is a slip; more is another word.
    let slip = |a: &str, b: &str| Some(edits(a, b)).filter(|edits| *edits <= 1 + a.chars().count() / 3);
    let distance = |k: &str| [slip(name, k), slip(&tail(name), &tail(k))].into_iter().flatten().min();
    let best = known.iter().filter_map(|k| distance(k)).min();
    let near = |k: &&str| match best {
        Some(best) => distance(k) == Some(best),
        None => name.len() > 2 && (k.contains(name) || name.contains(*k)),
    };
    let near: Vec<&str> = known.iter().copied().filter(near).take(MOST).collect();
    match near.is_empty() {
        true => format!("there is no {kind} `{name}`; {hint}"),
        false => format!("there is no {kind} `{name}`; did you mean {}? {hint}", near.join(" or ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_a_part_and_nonsense_are_told_apart() {
        let known = ["planner.swing_height", "walk_1kmh", "walk_2kmh", "stand"];
        let said = |name: &str| unknown("thing", name, &known, "all: X");
        assert_eq!(said("walk_1km"), "there is no thing `walk_1km`; did you mean walk_1kmh? all: X");
        assert_eq!(
            said("walk_3kmh"),
            "there is no thing `walk_3kmh`; did you mean walk_1kmh or walk_2kmh? all: X"
        );
        assert_eq!(said("stadn"), "there is no thing `stadn`; did you mean stand? all: X");
        assert_eq!(said("swing"), "there is no thing `swing`; did you mean planner.swing_height? all: X");
        assert_eq!(
            said("swing_hieght"),
            "there is no thing `swing_hieght`; did you mean planner.swing_height? all: X"
        );
        assert_eq!(
            unknown("command", "walk/fly", &["walk/stop", "system/end"], "all: X"),
            "there is no command `walk/fly`; all: X"
        );
        assert_eq!(said("zzzzzzzz"), "there is no thing `zzzzzzzz`; all: X");
        assert_eq!(unknown("thing", "x", &[], "none"), "there is no thing `x`; none");
    }
}
