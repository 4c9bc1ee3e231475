//! `gangwerk topic`, `param` and `log` at a robot in simulated time: fields with names and units, tables, repeated commands,
//! values in a file, logs as tables and against each other.

use harness::{Running, Site, doze, shared_turn};
use realtime::clock;
use std::fs;

const EXE: &str = harness::executable!();

/// A robot in simulated time that stands, far longer than any test.
fn standing(site: &Site) -> Running {
    site.scene("wait", 100_000.0, "[[command]]\ntime = 0.2\ntopic = \"walk/stand\"\n");
    let mut run = site.run("wait", &["--lockstep", "--no-log"]);
    let space = run.space();
    let mut state = space.reader::<messages::ControllerState>(&messages::topics::CONTROLLER_STATE).unwrap();
    let begun = clock::now();
    while state.latest().is_none_or(|s| s.header.tick <= 1000) {
        assert!(run.is_alive() && clock::now() - begun < 30 * clock::SECOND, "{}", run.err());
        doze(0.01);
    }
    run
}

fn numbers(line: &str) -> Vec<f64> {
    line.split(',').map(|cell| cell.parse().unwrap_or_else(|e| panic!("{cell}: {e}"))).collect()
}

#[test]
fn what_a_topic_is_and_says_is_told_with_names_and_units() {
    let _turn = shared_turn();
    let site = Site::patient(EXE);
    // About the table no robot is asked.
    let said = site.gangwerk(&["topic", "info", "sensors"]).well();
    for part in
        ["type        Sensors", "written by  lowlevel", "1000 Hz", "joint_speed[32]                  rad/s"]
    {
        assert!(said.out.contains(part), "`{part}` in {}", said.out);
    }
    assert_eq!(site.gangwerk(&["topic", "type", "plan"]).well().out, "Plan\n");
    assert!(site.gangwerk(&["topic", "info", "walk/velocity"]).well().out.contains("forward    [-2, 2] m/s"));
    let said = site.topic(&["echo", "sensors"]);
    assert!(
        said.code == Some(1) && said.err.contains("no robot runs here: start one with `gangwerk run"),
        "{said:?}"
    );

    let run = standing(&site);
    let refused = |arguments: &[&str], part: &str| {
        let said = site.topic(arguments);
        assert!(said.code == Some(1) && said.err.contains(part), "{said:?}");
    };
    // One field, with its unit; a table of exact numbers; several records.
    let said =
        site.topic(&["echo", "sensors", "--field", "joint_angle.right_knee_flexion", "-n", "2"]).well();
    let lines: Vec<&str> = said.out.lines().collect();
    assert_eq!(lines.len(), 2, "{}", said.out);
    assert!(
        lines.iter().all(|l| l.starts_with("joint_angle.right_knee_flexion 0.") && l.ends_with(" rad")),
        "{lines:?}"
    );
    let fields = ["--field", "header.tick", "--field", "imu"];
    let said = site.topic(&[&["echo", "sensors", "--csv", "--count", "20"], &fields[..]].concat()).well();
    let lines: Vec<&str> = said.out.lines().collect();
    assert!(lines[0].starts_with("header.tick,imu.orientation[0],"), "{}", lines[0]);
    let rows: Vec<Vec<f64>> = lines[1..].iter().map(|line| numbers(line)).collect();
    assert!(rows.len() == 20 && rows.iter().all(|row| row.len() == 11), "{}", said.out);
    // One after the other, as they were written; the first may be the one that was there before.
    assert!(rows[1..].windows(2).all(|pair| pair[1][0] == pair[0][0] + 1.0), "{}", said.out);
    refused(&["echo", "sensors", "--field", "joint_angel"], "did you mean joint_angle?");
    refused(&["echo", "sensor"], "did you mean sensors?");
    // Events of all processes, as sentences.
    let said = site.topic(&["echo", "events", "-n", "8"]).well();
    assert!(said.out.contains("0.040 s  watchdog: motor supply on\n"), "{}", said.out);
    // Rate, bytes, and no age in simulated time.
    let said = site.topic(&["hz", "sensors", "--seconds", "0.5"]).well();
    assert!(
        said.out.contains("period by the stamps: mean 1.000 ms, min 1.000, max 1.000, std 0.000"),
        "{}",
        said.out
    );
    let said = site.topic(&["bw", "sensors", "--seconds", "0.5"]).well();
    assert!(said.out.contains(" MB/s (") && said.out.contains(" bytes, "), "{}", said.out);
    refused(&["delay", "sensors"], "simulated time");
    run.interrupt();
}

#[test]
fn commands_are_repeated_as_often_as_asked() {
    let _turn = shared_turn();
    let site = Site::patient(EXE);
    let run = standing(&site);
    let push = ["pub", "sim/push", "force.y=1", "duration=0.01"];
    let begun = clock::now();
    let said = site.topic(&[&push[..], &["--times", "5", "--rate", "20"]].concat()).well();
    let seconds = (clock::now() - begun) as f64 * 1e-9;
    assert_eq!(said.out.matches("sim/push accepted by sim-backend\n").count(), 5, "{}", said.out);
    assert!(seconds > 4.0 / 20.0, "{seconds} s");
    // Once: its answer, and the end, also of a walk that would go on.
    let said = site.topic(&["pub", "walk/velocity", "forward=0.2", "-1"]).well();
    assert_eq!(said.out, "walk/velocity accepted by planner\n");
    let said = site.topic(&[&push[..], &["--rate", "0"]].concat());
    assert!(said.code == Some(1) && said.err.contains("--rate: a number above 0"), "{said:?}");
    run.interrupt();
}

#[test]
fn parameters_go_to_a_file_and_back_and_all_that_is_wrong_is_told_at_once() {
    let _turn = shared_turn();
    let site = Site::patient(EXE);
    let run = standing(&site);
    let dir = site.run_dir().display().to_string();
    let param = |arguments: &[&str]| site.gangwerk(&[&["param"], arguments, &["--dir", &dir]].concat());
    let said = param(&["describe", "planner.swing_height"]).well();
    assert!(
        said.out.contains("range      [0, 0.15] m") && said.out.contains("set        while"),
        "{}",
        said.out
    );
    let said = param(&["get", "planner.swing_hieght"]);
    assert!(said.code == Some(1) && said.err.contains("did you mean planner.swing_height?"), "{said:?}");

    let (before, other) = (site.path("before.txt"), site.path("other.txt"));
    let [before, other] = [before, other].map(|path| path.display().to_string());
    param(&["dump", &before]).well();
    let text = fs::read_to_string(&before).unwrap();
    let line =
        text.lines().find(|l| l.starts_with("planner.swing_height = ")).unwrap_or_else(|| panic!("{text}"));
    assert!(text.lines().any(|l| l.starts_with("# watchdog.watchdog_missed = ")), "{text}");
    param(&["set", "planner.swing_height", "0.07"]).well();
    // Back to what it was: only that one is set.
    let said = param(&["load", &before]).well();
    assert!(said.out.starts_with("planner.swing_height = ") && said.out.contains("\n1 of "), "{}", said.out);
    param(&["dump", &other]).well();
    assert_eq!(fs::read_to_string(&other).unwrap(), text);
    // Nothing is set if one line is wrong.
    let wrong =
        text.replace(line, "planner.swing_height = 9") + "planner.swing = 1\ncontroller.height_p = 1\n";
    fs::write(&other, wrong).unwrap();
    let said = param(&["load", &other]);
    assert_eq!(said.code, Some(1), "{said:?}");
    for part in ["planner.swing_height = 9 is outside of [0, 0.15] m", "no parameter `planner.swing`"] {
        assert!(said.err.contains(part), "`{part}` in {}", said.err);
    }
    param(&["dump", &other]).well();
    assert_eq!(fs::read_to_string(&other).unwrap(), text);
    run.interrupt();
}

#[test]
fn logs_are_told_exported_and_compared() {
    let _turn = shared_turn();
    let site = Site::patient(EXE);
    let log = |name: &str, scene: &str| {
        let path = site.path(name).display().to_string();
        site.gangwerk(&["sim", scene, "--log", &path]).well();
        path
    };
    site.scene("a", 1.0, "[[command]]\ntime = 0.2\ntopic = \"walk/stand\"\n");
    site.scene("b", 1.0, "[[command]]\ntime = 0.4\ntopic = \"walk/stand\"\n");
    let [first, again, other] = [log("1.mcap", "a"), log("2.mcap", "a"), log("3.mcap", "b")];
    let said = site.gangwerk(&["log", "info", &first]).well();
    assert!(said.out.contains("scene a, robot lola") && said.out.contains("24 joints"), "{}", said.out);
    assert!(
        said.out.lines().any(|l| l.contains("/gangwerk/sensors") && l.contains(" 1000    1000.0 Hz")),
        "{}",
        said.out
    );
    // A table with the joints' names that a spreadsheet reads.
    let fields = ["--field", "header.tick", "--field", "joint_angle"];
    let said = site.gangwerk(&[&["log", "export", &first, "sensors", "--csv"], &fields[..]].concat()).well();
    let mut lines = said.out.lines();
    let head: Vec<&str> = lines.next().unwrap().split(',').collect();
    assert_eq!((head.len(), head[6]), (25, "joint_angle.right_knee_flexion"), "{head:?}");
    let rows: Vec<Vec<f64>> = lines.map(numbers).collect();
    assert!(rows.len() == 1000 && rows.iter().all(|row| row.len() == 25));
    let said = site.gangwerk(&["log", "export", &first, "sensor"]);
    assert!(said.code == Some(1) && said.err.contains("did you mean sensors?"), "{said:?}");
    // Equal, and where not.
    let said = site.gangwerk(&["log", "compare", &first, &again]).well();
    assert!(said.out.ends_with("topics are equal, bit for bit\n"), "{}", said.out);
    let said = site.gangwerk(&["log", "compare", &first, &other]);
    assert_eq!(said.code, Some(1), "{said:?}");
    let line = said
        .out
        .lines()
        .find(|l| l.starts_with("joint_targets: record "))
        .unwrap_or_else(|| panic!("{}", said.out));
    assert!(line.contains("tick 2") && line.contains(" and "), "the first cycle after 0.2 s: {line}");
    assert!(said.out.starts_with("configurations differ: "), "{}", said.out);
    // Of two beginnings that hold no record yet nothing is equal.
    let whole = std::fs::read(&first).unwrap();
    let [short, shorter] = [30_000, 29_000].map(|bytes| {
        let path = site.path(&format!("{bytes}.mcap")).display().to_string();
        std::fs::write(&path, &whole[..bytes]).unwrap();
        path
    });
    let said = site.gangwerk(&["log", "compare", &short, &shorter]);
    assert!(said.code == Some(1) && said.err.contains("neither log holds a record"), "{said:?}");
}
