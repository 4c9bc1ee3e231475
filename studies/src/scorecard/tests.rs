use super::*;
use crate::{Given, Study, ground};

fn order(root: &Path) -> ScorecardOptions<'_> {
    ScorecardOptions { config: root, only: None, quick: true, seed: 1 }
}

/// Every entry's scene is there, and takes the model and cycles of the entry.
#[test]
fn every_entry_can_be_set_up() {
    let root = config::root(None);
    for entry in ENTRIES {
        assert!(!entry.demands.is_empty(), "{}", entry.name);
        for &cycle in entry.cycles {
            let setup = walk::set_up(&order(&root), entry.scene, entry.depth, cycle);
            let setup = setup.unwrap_or_else(|e| panic!("{}: {e}", entry.name));
            assert_eq!((setup.scene.depth, setup.scene.cycle), (entry.depth, cycle));
        }
    }
}

/// The same table twice, whatever core a walk was on; processor time apart.
#[test]
fn a_walk_is_a_row_for_each_demand_and_the_same_one_twice() {
    let root = config::root(None);
    let order = ScorecardOptions { only: Some("turning on the spot, 1 ms"), ..order(&root) };
    let (tell, told) = std::sync::mpsc::channel();
    let report = run(&order, &|done, of, name| tell.send((done, of, name.to_string())).unwrap()).unwrap();
    assert_eq!(told.recv().unwrap(), (1, 1, "turning on the spot, 1 ms".to_string()));
    assert_eq!(report.rows.len(), 4);
    assert_eq!(report.goals, 4);
    let again = run(&order, &|_, _, _| ()).unwrap();
    for (a, b) in report.rows.iter().zip(&again.rows) {
        assert_eq!((a.ours, a.goal), (b.ours, b.goal), "{}", a.what);
    }
    assert!(report.sheet().text().contains("turn per step"), "{}", report.sheet().text());
}

/// A walk that ends in a fall says so in every row, and none of them shows a figure.
#[test]
fn a_fall_is_shown() {
    let root = config::root(None);
    const DEMANDS: &[demand::Demand] = &[demand::Demand::near(demand::What::Speed, 2.0, "")];
    let entry = entries::ScorecardEntry {
        name: "too slow a controller",
        scene: "walk_2kmh",
        told: &[],
        depth: 3,
        cycles: &[0.02],
        demands: DEMANDS,
    };
    let rows = walk::rows(&order(&root), &entry, 0.02).unwrap();
    assert_eq!((rows[0].ours, rows[0].goal), (None, Goal::Missed));
    assert!(rows[0].note.contains(" at "), "{}", rows[0].note);
}

#[test]
fn a_name_that_no_entry_has_is_refused() {
    let root = config::root(None);
    let error = run(&ScorecardOptions { only: Some("moonwalk"), ..order(&root) }, &|_, _, _| ()).unwrap_err();
    assert!(error.to_string().contains("moonwalk") && error.to_string().contains("turning on the spot"));
}

/// Rate of the scorecard, its goal and its notes beside the study of the same four places, of which not all are walked.
#[test]
fn a_rate_counts_the_places_that_the_study_walks() {
    let root = config::root(None);
    let order = ScorecardOptions { only: Some("unknown step down of 0.04"), ..order(&root) };
    let card = run(&order, &|_, _, _| ()).unwrap();
    // The same places by the study, which walks them on all cores and counts for itself.
    let study = ground::GroundStudy {
        scene: "walk_2kmh".into(),
        kind: vec![ground::GroundKind::StepDown],
        size: vec![0.04],
        places: 2,
        seed: 1,
        speeds: vec![1.0, 2.0],
        types: vec![3],
        out: None,
    };
    let given = Given { config: &root, progress: &|_, _, _| () };
    let found = study.run(&given).unwrap().json();
    let walked: f64 =
        found["rows"].as_array().unwrap().iter().map(|row| row["walked"].as_f64().unwrap()).sum();
    let [row] = &card.rows[..] else { panic!("{} rows", card.rows.len()) };
    assert!(walked < 4.0, "all are walked: other places say more");
    assert_eq!((row.ours, row.demanded.as_str()), (Some(walked), "at least 4 of 4"));
    let failed = row.note.split("; ").filter(|note| !note.is_empty()).count();
    assert_eq!(failed as f64, 4.0 - walked, "{}", row.note);
    assert_eq!(row.goal == Goal::Met, walked == 4.0);
}
