//! `gangwerk can` where no CAN is needed: recordings of the bus in shared memory, held against logs, looked at, written
//! in other forms; bad input of every kind.

use harness::{Said, Site};
use std::fs;
use std::path::PathBuf;

const EXE: &str = harness::executable!();

/// Standing up and one step.
const WALK: &str = "
[[command]]
time = 0.06
topic = \"walk/stand\"
[[command]]
time = 2.2
topic = \"walk/velocity\"
forward = 0.278
";

struct Walk {
    site: Site,
    log: String,
    traffic: String,
}

impl Walk {
    /// A walk of some seconds, or a robot that keeps its pose for less, with its log and the traffic of its bus.
    fn new(seconds: f64) -> Self {
        let site = Site::new(EXE);
        site.scene("walk", seconds, if seconds > 2.2 { WALK } else { "" });
        let path = |name: &str| site.path(name).display().to_string();
        let (log, traffic) = (path("walk.mcap"), path("walk.log"));
        site.gangwerk(&["sim", "walk", "--log", &log, "--can", &traffic]).well();
        Self { site, log, traffic }
    }

    fn can(&self, arguments: &[&str]) -> Said {
        self.site.gangwerk(&[&["can"], arguments].concat())
    }

    fn check(&self, traffic: &str) -> Said {
        self.can(&["check", traffic, "--against", &self.log])
    }

    fn text(&self) -> String {
        fs::read_to_string(&self.traffic).unwrap()
    }

    /// A recording of this text.
    fn other(&self, text: &str) -> String {
        let path: PathBuf = self.site.path("other.log");
        fs::write(&path, text).unwrap();
        path.display().to_string()
    }
}

#[track_caller]
fn refused(said: &Said, texts: &[&str]) {
    assert_eq!(said.code, Some(1), "{said:#?}");
    assert_eq!(said.err.matches("error:").count(), 1, "one error: {}", said.err);
    assert!(!said.err.contains("panicked"), "{}", said.err);
    for text in texts {
        assert!(said.err.contains(text), "`{text}` in: {}", said.err);
    }
}

/// The frames of a recorded walk give the logged sensor data, and its logged targets the recorded frames; from a
/// candump log and from MCAP.
#[test]
fn recorded_traffic_gives_the_sensors_of_the_log_and_its_targets_the_traffic() {
    let walk = Walk::new(3.0);
    let said = walk.check(&walk.traffic).well();
    // Lola on CAN FD: what is sent in each of 3000 cycles; the answer to the last one comes after its end.
    let lines = walk.text().lines().count() as u64;
    assert!(said.out.starts_with("3000 of the log's 3000 cycles: "), "{}", said.out);
    let numbers: Vec<u64> = said.out.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    let (answers, told) = (numbers[2], numbers[3]);
    assert_eq!(answers / 3000 * 3001 + told, lines, "every frame was compared, but the last answers");
    let mcap = walk.site.path("traffic.mcap").display().to_string();
    walk.can(&["convert", &walk.traffic, &mcap]).well();
    assert_eq!(walk.check(&mcap).well().out, said.out);
    let back = walk.site.path("back.log").display().to_string();
    walk.can(&["convert", &mcap, &back]).well();
    assert_eq!(fs::read_to_string(back).unwrap().replace(' ', ""), walk.text().replace(' ', ""));
}

/// Classic frames, and no other, in the cycle of the CAN lines; they give the logged sensor data like those of a run do.
#[test]
fn a_simulation_writes_the_traffic_of_classic_can() {
    let site = Site::new(EXE);
    let path = |name: &str| site.path(name).display().to_string();
    let (log, traffic) = (path("walk.mcap"), path("walk.log"));
    site.gangwerk(&["sim", "can_2kmh", "--classic", "--log", &log, "--can", &traffic]).well();
    let text = fs::read_to_string(&traffic).unwrap();
    assert!(text.lines().count() > 10_000 && !text.contains("##"), "{}", &text[..200]);
    let said = site.gangwerk(&["can", "check", &traffic, "--against", &log]).well();
    assert!(said.out.contains("the same, bit for bit"), "{}", said.out);
    let stat = site.gangwerk(&["can", "stat", &traffic, "--robot", "lola", "--json"]).well().out;
    let json: serde_json::Value = serde_json::from_str(&stat).unwrap();
    let most =
        json["lines"].as_array().unwrap().iter().map(|l| l["load"].as_f64().unwrap()).fold(0.0, f64::max);
    assert!((0.3..0.62).contains(&most), "the worst case is 61.9 %: {most}");
}

/// A step of the clock costs no frame: it is told, and the rest of the figures is that of the frames.
#[test]
fn a_clock_that_was_put_back_costs_no_frame() {
    let walk = Walk::new(0.2);
    // From 0.1 s on the clock is 0.1 s behind.
    let back = |line: &str| {
        let line = line.replacen("(0000000000.1", "(0000000000.0", 1);
        format!("{}\n", line.replacen("(0000000000.2", "(0000000000.1", 1))
    };
    let file = walk.other(&walk.text().lines().map(back).collect::<String>());
    let said = walk.can(&["stat", &file, "--robot", "lola", "--json"]).well();
    assert!(said.err.contains("the clock was put back, 1 times, by up to 0.09"), "{}", said.err);
    let json: serde_json::Value = serde_json::from_str(&said.out).unwrap();
    assert_eq!(json["clock_steps"], 1);
    for m in json["messages"].as_array().unwrap() {
        assert_eq!((&m["missing"], &m["repeated"]), (&0.into(), &0.into()), "{m}");
        assert!((m["period_max"].as_f64().unwrap() - 1e-3).abs() < 1e-9, "{m}");
    }
    assert_eq!(walk.check(&file).well().out, walk.check(&walk.traffic).well().out);
}

/// `--dbc`: a robot's own file says what `--robot` says, in words; of any other file the same.
#[test]
fn frames_are_decoded_by_any_dbc_file() {
    let walk = Walk::new(0.05);
    let dbc = walk.site.config("robots/lola/can/lola_fd.dbc").display().to_string();
    let by_file = walk.can(&["dump", &walk.traffic, "--dbc", &dbc]).well().out;
    let by_robot = walk.can(&["dump", &walk.traffic, "--robot", "lola"]).well().out;
    let signals = |text: &str| -> Vec<(String, String)> {
        let lines = text.lines().filter_map(|line| line.trim().split_once(" = "));
        lines.map(|(n, v)| (n.into(), v.split_whitespace().next().unwrap().into())).collect()
    };
    let (by_file_, by_robot_) = (signals(&by_file), signals(&by_robot));
    assert_eq!(by_file_.len(), by_robot_.len());
    let words = ["_status", "_error", "_control"];
    for ((name, value), (_, wanted)) in by_file_.iter().zip(&by_robot_) {
        if !words.iter().any(|word| name.ends_with(word)) {
            assert_eq!(value, wanted, "{name}");
        }
    }
    assert!(by_file.contains("mode = 1 (hold)") && by_file.contains("_error = 0 (none)"), "{by_file:.2000}");
    assert!(by_file.contains("_status = 32") && by_file.contains("(switch on disabled"), "{by_file:.2000}");
    let stat = walk.can(&["stat", &walk.traffic, "--dbc", &dbc]).well().out;
    assert!(stat.contains("node0_targets"), "{stat}");
    refused(
        &walk.can(&["dump", &walk.traffic, "--dbc", "/nowhere/x.dbc"]),
        &["/nowhere/x.dbc: cannot be read"],
    );
    refused(
        &walk.can(&["dump", &walk.traffic, "--dbc", &walk.traffic]),
        &["walk.log: this is not a DBC file"],
    );
}

/// The load over time as a picture; the documented bit rate of CAN FD is the one it is computed with.
#[test]
fn stat_draws_the_load_over_time() {
    let walk = Walk::new(0.5);
    let png = walk.site.path("load.png").display().to_string();
    let said = walk.can(&["stat", &walk.traffic, "--json", "--png", &png]).well();
    assert!(fs::read(&png).unwrap().starts_with(b"\x89PNG"), "{said:?}");
    let json: serde_json::Value = serde_json::from_str(&said.out).unwrap();
    assert_eq!(json["data_bitrate"], 5e6, "docs/can.md");
    refused(&walk.can(&["stat", &walk.traffic, "--png", "/nowhere/x.png"]), &["/nowhere/x.png"]);
}

/// Logs of other tools hold the same frames.
#[test]
fn asc_and_trc_are_read_and_blf_is_named() {
    let walk = Walk::new(0.02);
    let read = |name: &str, text: &[u8]| {
        let path = walk.site.path(name);
        fs::write(&path, text).unwrap();
        walk.can(&["dump", &path.display().to_string()])
    };
    let asc = b"date Sat Sep 30 15:06:13.191 2017\nbase hex  timestamps absolute\n 0.5 2  123  Rx   d 1 AB\n";
    assert_eq!(read("a.asc", asc).well().out, "(0000000000.500000) can1 123#AB R\n");
    let trc = b";$FILEVERSION=1.1\n 1) 500.0 Rx 0123 1 AB\n";
    assert_eq!(read("a.trc", trc).well().out, "(0000000000.500000) can0 123#AB R\n");
    refused(&read("a.blf", b"LOGG\x90\0\0\0"), &["BLF", "python3 -m can.logconvert", "a.log"]);
}

/// One flipped bit anywhere in what counts is found, and its tick, frame and signal named.
#[test]
fn a_flipped_bit_is_named_with_its_cycle_frame_and_signal() {
    let walk = Walk::new(0.5);
    let text = walk.text();
    let dump = walk.can(&["dump", &walk.traffic, "--robot", "lola"]).well().out;
    let frames: Vec<(&str, Vec<&str>)> = frames_of(&dump);
    for (way, signal) in [("to", "_target"), ("from", "right_knee_flexion_angle"), ("from", "imu_rate_y")] {
        // Some frame of cycle 300 or later with this signal.
        let (line, _) = frames
            .iter()
            .filter(|(line, _)| line.starts_with("(0000000000.3"))
            .find(|(_, signals)| signals.iter().any(|s| s.contains(signal)))
            .unwrap_or_else(|| panic!("no frame with {signal}"));
        let (time_and_name, frame) = line.split_once("  ").unwrap();
        let name = frame.split_whitespace().next().unwrap();
        let original = text.lines().find(|l| squeeze(l) == squeeze(time_and_name)).unwrap();
        // Bit 0 of byte 6: within a number, behind the counter and whatever else is short.
        let (head, data) = original.rsplit_once("##").unwrap();
        let at = 1 + 2 * 6 + 1;
        let digit = u8::from_str_radix(&data[at..=at], 16).unwrap() ^ 1;
        let broken = format!("{head}##{}{digit:X}{}", &data[..at], &data[at + 1..]);
        let said = walk.check(&walk.other(&text.replacen(original, &broken, 1)));
        refused(&said, &["cycle 30", way, &format!(" {name} of "), "signal ", "recorded is "]);
    }
}

/// Lines of frames with the signals under each.
fn frames_of(dump: &str) -> Vec<(&str, Vec<&str>)> {
    let mut frames: Vec<(&str, Vec<&str>)> = Vec::new();
    for line in dump.lines() {
        match (line.starts_with('('), frames.last_mut()) {
            (true, _) => frames.push((line, Vec::new())),
            (false, Some((_, signals))) => signals.push(line),
            _ => panic!("`{line}`"),
        }
    }
    frames
}

fn squeeze(line: &str) -> String {
    line.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn frames_that_are_missing_or_do_not_belong_there_are_named() {
    let walk = Walk::new(0.2);
    let text = walk.text();
    let cycle = "(0000000000.100000)";
    let of_cycle: Vec<&str> = text.lines().filter(|line| line.starts_with(cycle)).collect();
    let (first, last) = (of_cycle[0], of_cycle[of_cycle.len() - 1]);
    refused(
        &walk.check(&walk.other(&text.replacen(&format!("{first}\n"), "", 1))),
        &["cycle 100", "is missing"],
    );
    refused(
        &walk.check(&walk.other(&text.replacen(&format!("{last}\n"), "", 1))),
        &["cycle 101", "is missing"],
    );
    // The begin of the run is not there.
    let late: String = text.lines().skip(2000).map(|line| format!("{line}\n")).collect();
    refused(&walk.check(&walk.other(&late)), &["cycle 1, from the drives"]);
    // Another robot's.
    refused(&walk.check(&walk.other("(0000000000.000000) can0 7FF#00\n")), &["no SYNC frame of lola"]);
}

#[test]
fn dump_names_signals_with_units_and_tells_what_it_does_not_know() {
    let walk = Walk::new(0.05);
    let dump = walk.can(&["dump", &walk.traffic, "--robot", "lola", "--only", "from_drives"]).well();
    assert_eq!(dump.err, "");
    let frames = frames_of(&dump.out);
    let knee =
        frames.iter().flat_map(|(_, signals)| signals).find(|s| s.contains("right_knee_flexion_angle"));
    let words: Vec<&str> = knee.unwrap().split_whitespace().collect();
    assert!(
        (words[1], words[3]) == ("=", "rad") && words[2].parse::<f64>().unwrap().is_finite(),
        "{words:?}"
    );
    assert!(!dump.out.contains("_target"), "only what comes from the drives");
    // Unknown identifiers, wrong lengths and error frames are told apart.
    let more = "(0000000009.000000) shm0 7FE##500\n(0000000009.000001) shm0 20000040#0000000000000000\n";
    let first = walk.text().lines().find(|l| l.contains("##5")).unwrap().to_owned();
    let (head, data) = first.rsplit_once("##").unwrap();
    let cut = format!("(0000000009.000002) {}##{}\n", head.split_once(") ").unwrap().1, &data[..3]);
    let said =
        walk.can(&["dump", &walk.other(&format!("{}{more}{cut}", walk.text())), "--robot", "lola"]).well();
    let tail: Vec<&str> = said.out.lines().rev().take(3).collect();
    assert!(tail[2].ends_with("unknown") && tail[1].ends_with("error frame"), "{tail:?}");
    assert!(tail[0].contains("1 bytes, but its message has"), "{tail:?}");
    assert!(
        said.err.contains("1 frames with identifiers") && said.err.contains("1 of another length"),
        "{}",
        said.err
    );
    // Without a robot: the lines as they are.
    let plain = walk.can(&["dump", &walk.traffic]).well().out;
    assert_eq!(squeeze(&plain), squeeze(&walk.text()));
}

#[test]
fn stat_counts_every_frame_and_finds_gaps() {
    let walk = Walk::new(0.2);
    // Every cycle, but for one frame of one message.
    let gone = walk.text().lines().find(|l| l.starts_with("(0000000000.100000)")).unwrap().to_owned();
    let file = walk.other(&walk.text().replacen(&format!("{gone}\n"), "", 1));
    let said = walk.can(&["stat", &file, "--robot", "lola", "--json"]).well().out;
    let json: serde_json::Value = serde_json::from_str(&said).unwrap();
    let messages = json["messages"].as_array().unwrap();
    let sum: u64 = messages.iter().map(|m| m["frames"].as_u64().unwrap()).sum();
    assert_eq!(sum, walk.text().lines().count() as u64 - 1);
    let missing: Vec<_> = messages.iter().filter(|m| m["missing"] != 0).collect();
    assert_eq!(missing.len(), 1);
    assert_eq!((&missing[0]["missing"], &missing[0]["frames"]), (&1.into(), &199.into()));
    for m in messages.iter().filter(|m| m["missing"] == 0) {
        assert!((m["period_mean"].as_f64().unwrap() - 1e-3).abs() < 1e-9, "{m}");
        assert_eq!((m["name"].as_str().unwrap().is_empty(), &m["repeated"]), (false, &0.into()));
    }
    let lines = json["lines"].as_array().unwrap();
    assert_eq!(lines.len(), 9, "one line for each local controller");
    assert!(lines.iter().all(|l| (0.01..1.0).contains(&l["load"].as_f64().unwrap())), "{lines:?}");
    let table = walk.can(&["stat", &file, "--robot", "lola"]).well().out;
    assert!(table.contains("bus load") && table.contains("over 0.200 s"), "{table}");
}

#[test]
fn broken_recordings_are_refused_by_every_command_and_nothing_is_written() {
    let walk = Walk::new(0.05);
    let broken = walk.other("(0000000000.000000) can0 123#00\n(0000000000.001000) can0 123#0\nhello\n");
    let out = walk.site.path("out.log").display().to_string();
    let texts = ["2 of 3 lines are broken", "line 2", "middle of a byte", "line 3", "--lenient"];
    refused(&walk.can(&["dump", &broken]), &texts);
    refused(&walk.can(&["stat", &broken]), &texts);
    refused(&walk.can(&["replay", &broken]), &texts);
    refused(&walk.can(&["convert", &broken, &out]), &texts);
    refused(&walk.check(&broken), &texts);
    assert!(!walk.site.path("out.log").exists());
    let said = walk.can(&["dump", &broken, "--lenient"]).well();
    assert_eq!(said.out, "(0000000000.000000) can0 123#00\n");
    assert!(said.err.contains("left out: ") && said.err.contains("2 of 3 lines"), "{}", said.err);
    // A log of a run holds no frames; a file that is not there; a robot that is not there.
    refused(&walk.can(&["dump", &walk.log]), &["no CAN frames in it"]);
    refused(&walk.can(&["dump", "/nowhere/x.log"]), &["/nowhere/x.log", "No such file"]);
    refused(&walk.can(&["dump", &walk.traffic, "--robot", "nobody"]), &["nobody"]);
    refused(&walk.can(&["replay", &walk.traffic, "--map", "can7=vcan0"]), &["nothing was recorded on can7"]);
}

/// An interface that is not there, on any kernel; a recording that was there before stays.
#[test]
fn interfaces_that_cannot_be_used_are_one_error_each() {
    let walk = Walk::new(0.05);
    let before = walk.text();
    let said = walk.can(&["record", "gangwerk_none", &walk.traffic]);
    refused(&said, &["gangwerk_none: ", "`"]);
    assert_eq!(said.out, "", "nothing was recorded");
    refused(&walk.can(&["dump", "gangwerk_none"]), &["gangwerk_none: "]);
    refused(&walk.can(&["stat", "gangwerk_none", "--seconds", "1"]), &["gangwerk_none: "]);
    refused(&walk.can(&["replay", &walk.traffic]), &["shm0: "]);
    refused(&walk.can(&["record", "vcan8-0", &walk.traffic]), &["vcan8-0"]);
    refused(&walk.can(&["record", "shm", &walk.traffic, "--dir", "/nowhere"]), &["/nowhere"]);
    assert_eq!(walk.text(), before, "the recording is as it was");
    let usage = walk.can(&["replay", &walk.traffic, "--as-fast-as-consumed"]);
    assert_eq!(usage.code, Some(2), "{usage:?}");
}

/// The bus of a robot in shared memory can be recorded while it runs, and is that of the log.
#[test]
fn the_bus_in_shared_memory_is_recorded_while_the_robot_runs() {
    let site = Site::new(EXE);
    site.scene("walk", 3.0, WALK);
    let mut run = site.run("walk", &[]);
    run.space(); // it runs
    let file = site.path("live.log").display().to_string();
    let dir = site.run_dir().display().to_string();
    let said = site.gangwerk(&["can", "record", "shm", &file, "--dir", &dir, "--seconds", "0.5"]).well();
    assert!(said.out.contains(" frames, "), "{}", said.out);
    let stat = site.gangwerk(&["can", "stat", &file, "--robot", "lola", "--json"]).well().out;
    let json: serde_json::Value = serde_json::from_str(&stat).unwrap();
    assert!(json["seconds"].as_f64().unwrap() > 0.3, "{stat}");
    assert_eq!(json["lines"].as_array().unwrap().len(), 9);
    assert!(run.is_alive());
}
