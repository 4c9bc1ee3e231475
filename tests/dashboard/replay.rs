//! Replay of a log: what a page sees of it is the log as others read it, whatever became of the file; and nobody makes the
//! server grow.

use crate::page::{Page, PageFrame, Received, Server};
use crate::{EXE, by_tick};
use dashboard::replay::{Film, side_by_side};
use harness::{Site, WALK, doze, turn};
use messages::topics::{CONTROLLER_STATE, JOINT_TARGETS, SENSORS};
use messages::{ControllerState, JointTargets, Sensors};
use realtime::clock;
use recording::Log;
use serde_json::{Value, json};
use std::collections::{BTreeMap, HashMap};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Walk of these tests \[s\]; `GANGWERK_REPLAY_LENGTH` takes a longer one.
fn length() -> f64 {
    std::env::var("GANGWERK_REPLAY_LENGTH").ok().and_then(|text| text.parse().ok()).unwrap_or(6.0)
}

/// SplitMix64; `GANGWERK_SEED` chooses other places.
struct Random(u64);

impl Random {
    fn new(seed: u64) -> Self {
        let more: u64 = std::env::var("GANGWERK_SEED").ok().and_then(|text| text.parse().ok()).unwrap_or(0);
        Self(seed.wrapping_add(more << 20))
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: u64) -> u64 {
        self.next() % n
    }
}

/// Log of a walk in one process.
fn walk(site: &Site, name: &str) -> PathBuf {
    site.scene(name, length(), WALK);
    let (scene, path) = (site.config(&format!("scenes/{name}.toml")), site.path(&format!("{name}.mcap")));
    let [scene, log] = [&scene, &path].map(|path| path.display().to_string());
    site.gangwerk(&["sim", &scene, "--log", &log]).well();
    path
}

fn replay(site: &Site, log: &Path, more: &[&str]) -> Server {
    Server::start_with(site, &[&["--replay", &log.display().to_string()], more].concat())
}

/// Films of a log as the server has them, in this process.
fn film(log: &Path) -> Result<Film, String> {
    let recorded = cli::film::recorded(log, None, None).map_err(|e| e.to_string())?;
    Ok(side_by_side(recorded, None)?.remove(0))
}

/// Table of a topic as `gangwerk log export` prints it: tick, and its columns.
fn table(site: &Site, log: &Path, topic: &str, fields: &[&str]) -> HashMap<u64, Vec<f64>> {
    let log = log.display().to_string();
    let mut arguments = vec!["log", "export", &log, topic, "--field", "header.tick"];
    fields.iter().for_each(|field| arguments.extend(["--field", field]));
    let out = site.gangwerk(&arguments).well().out;
    let row = |line: &str| -> Vec<f64> { line.split(',').map(|cell| cell.parse().unwrap()).collect() };
    let rows = out.lines().skip(1).map(row);
    rows.map(|row| (row[0] as u64, row[1..].to_vec())).collect()
}

impl Page {
    /// Seeks, and waits for the state of that tick.
    fn seek(&mut self, time: f64, kind: u8) -> PageFrame {
        let other = if kind == 3 { json!(time) } else { Value::Null };
        self.send(&json!({"type": "seek", "time": time, "other": other}));
        self.until("a state", |_, received| match received {
            Received::Frame(frame) if frame.kind == kind => Some(frame.clone()),
            _ => None,
        })
    }

    /// Rows of a stretch, all of them.
    fn window(&mut self, from: f64, to: f64) -> Vec<(f64, Vec<f32>)> {
        self.send(&json!({"type": "window", "log": 0, "from": from, "to": to}));
        let mut rows = Vec::new();
        let told = self.until("end of the stretch", |_, received| match received {
            Received::Frame(frame) if frame.kind == 2 => {
                rows.extend(frame.rows());
                None
            }
            Received::Text(value) if value["type"] == "window" => Some(value.clone()),
            _ => None,
        });
        assert_eq!((told["from"].as_f64(), told["to"].as_f64()), (Some(from), Some(to)));
        assert_eq!(told["rows"].as_u64(), Some(rows.len() as u64));
        rows
    }
}

/// At random instants: joint angles and torso as two other readers of the log have them, bit for bit; samples of random stretches
/// are its records; no command gets anywhere; the second log is the second log.
#[test]
fn a_replayed_log_is_the_log() {
    let _turn = turn();
    let site = Site::new(EXE);
    let log = walk(&site, "walk");
    let server = replay(&site, &log, &["--against", &log.display().to_string()]);
    let mut page = server.page();
    let hello = page.text("hello");
    let about = &hello["replay"];
    let last = (about["last"].as_f64().unwrap() * 1000.0).round() as u64;
    assert!(about["complete"] == true && last.abs_diff((length() * 1000.0) as u64) < 100, "{about}");
    assert_eq!((&about["log"], &about["other"]["log"]), (&json!("walk.mcap"), &json!("walk.mcap")));
    let angles = table(&site, &log, "sensors", &["joint_angle"]);
    let truth = table(&site, &log, "sim_state", &["position", "orientation"]);
    let frames: BTreeMap<u64, recording::Transform> =
        (Log::open(&log).unwrap().frames().unwrap().into_iter())
            .filter_map(|tree| {
                Some((tree.stamp_ns / 1_000_000, tree.transforms.into_iter().find(|t| t.child == "torso")?))
            })
            .collect();
    let joints = hello["robot"]["joints"].as_array().unwrap().len();
    let mut random = Random::new(1);
    let (mut slowest, mut believed) = (0, 0);
    for k in 0..60 {
        // Every second one at an instant at which the log has the torso's pose, too.
        let tick =
            if k % 2 == 0 { 1 + random.below(last - 1) } else { 10 * (1 + random.below(last / 10 - 1)) };
        let (kind, begun) = (if k % 3 == 0 { 3 } else { 1 }, clock::now());
        let frame = page.seek(tick as f64 * 0.001, kind);
        slowest = slowest.max(clock::now() - begun);
        assert_eq!(frame.tick, tick);
        let numbers = frame.numbers();
        let logged: Vec<f32> = angles[&tick][..joints].iter().map(|x| *x as f32).collect();
        assert_eq!(numbers[page.place("joint_angle")], logged, "tick {tick}");
        let [x, y, z, qx, qy, qz, qw] = truth[&tick][..] else { panic!("{:?}", truth[&tick]) };
        let pose = [x, y, z, qw, qx, qy, qz].map(|x| x as f32);
        assert_eq!(numbers[page.place("torso_truth")], pose, "tick {tick}");
        // The log's own picture of what the robot believes; the scene puts the start of her odometry at this place.
        if let Some(torso) = frames.get(&tick) {
            let [px, py, pz] = torso.pose.position;
            let [x, y, z, qw, ..] = numbers[page.place("torso")] else { panic!() };
            let odom = Log::open(&log).unwrap().robot().odom;
            let errors = [f64::from(x) - px - odom[0], f64::from(y) - py - odom[1], f64::from(z) - pz];
            assert!(errors.iter().all(|e| e.abs() < 1e-5), "tick {tick}: {errors:?}");
            assert!((f64::from(qw).abs() - torso.pose.orientation[3].abs()).abs() < 1e-6);
            believed += 1;
        }
    }
    assert!(believed > 15, "{believed} instants with a pose in /tf");
    println!("slowest of 60 seeks: {:.1} ms", slowest as f64 * 1e-6);

    // Samples: of topics of each cycle the record of that cycle, all of them.
    let knee = format!("sensors.joint_angle.{}", hello["robot"]["joints"][4]["name"].as_str().unwrap());
    let target = knee.replace("sensors.joint_angle", "joint_targets.angle");
    page.send(&json!({"type": "plot", "fields": [knee, "controller_state.com[2]", target], "rate": 1000}));
    assert_eq!(page.text("plotting")["other"].as_array().map(Vec::len), Some(3));
    let log_of = Log::open(&log).unwrap();
    let sensors: BTreeMap<u64, Sensors> = by_tick(log_of.records(&SENSORS).unwrap());
    let controller: BTreeMap<u64, ControllerState> = by_tick(log_of.records(&CONTROLLER_STATE).unwrap());
    let targets: BTreeMap<u64, JointTargets> = by_tick(log_of.records(&JOINT_TARGETS).unwrap());
    for _ in 0..6 {
        let from = 1 + random.below(last - 1100);
        let to = from + 1 + random.below(1000);
        let rows = page.window(from as f64 * 0.001, to as f64 * 0.001);
        let ticks: Vec<u64> = rows.iter().map(|(time, _)| (time * 1000.0).round() as u64).collect();
        assert_eq!(ticks, (from..to).collect::<Vec<_>>());
        for (tick, (_, cells)) in ticks.iter().zip(&rows) {
            let logged = [sensors[tick].joint_angle[4], controller[tick].com[2], targets[tick].angle[4]];
            assert_eq!(cells[..], logged.map(|x| x as f32), "tick {tick}");
        }
    }
    // Events, as `gangwerk log show` has them.
    page = server.page();
    let events = page.text("events");
    let shown = site.gangwerk(&["log", "show", &log.display().to_string()]).well().out;
    for event in events["events"].as_array().unwrap() {
        let line = format!("{}: {}", event["process"].as_str().unwrap(), event["text"].as_str().unwrap());
        assert!(shown.contains(&line), "{line} in {shown}");
    }
    let (accepted, why) = page.order(json!({"type": "command", "name": "walk/stop", "values": {}}));
    assert!(!accepted && why.contains("recording"), "{why}");
    assert!(!page.order(json!({"type": "emergency_stop"})).0);
    assert!(!page.order(json!({"type": "set", "name": "planner.swing_height", "value": 0.06})).0);
}

/// Cut anywhere: everything before the cut is as it was, or one sentence says why nothing can be shown. Grown, shortened or
/// gone while it is open: the page goes on.
#[test]
fn a_log_that_is_cut_grows_shrinks_or_is_gone() {
    let site = Site::new(EXE);
    let whole = walk(&site, "whole");
    let bytes = std::fs::read(&whole).unwrap();
    let mut complete = film(&whole).unwrap();
    let mut random = Random::new(2);
    let (mut shown, mut refused) = (0, 0);
    let cut = site.path("cut.mcap");
    for k in 0..24 {
        // Some of them near the beginning, where there is no robot yet.
        let length = if k % 4 == 0 { random.below(200_000) } else { random.below(bytes.len() as u64) };
        std::fs::write(&cut, &bytes[..length as usize]).unwrap();
        match film(&cut) {
            Ok(mut film) => {
                shown += 1;
                let about = film.about();
                assert_eq!(about["complete"], length as usize == bytes.len());
                let [first, last] =
                    ["first", "last"].map(|end| (about[end].as_f64().unwrap() * 1000.0).round() as u64);
                for _ in 0..5 {
                    let tick = first + random.below(last - first + 1);
                    let seen = film.frame(tick).unwrap().unwrap();
                    // A cycle whose other records are beyond the cut has the ones before.
                    if tick + 100 < last {
                        assert_eq!(Some(seen), complete.frame(tick).unwrap(), "cut at {length}, tick {tick}");
                    }
                }
            }
            Err(why) => {
                refused += 1;
                assert!(why.contains("cut.mcap") && why.lines().count() == 1, "cut at {length}: {why}");
            }
        }
    }
    assert!(shown > 10 && refused > 0, "{shown} shown, {refused} refused");
    // What is no log at all: one line each, by the command itself.
    let text = site.path("text.mcap");
    std::fs::write(&text, "no log\n".repeat(100)).unwrap();
    std::fs::write(&cut, "").unwrap();
    for (path, named) in [
        (&text, "not an MCAP"),
        (&cut, "not an MCAP"),
        (&site.path(""), "directory"),
        (&site.path("none"), "No such"),
    ] {
        let said = site.gangwerk(&["dashboard", "--no-open", "--replay", &path.display().to_string()]);
        assert_eq!(said.code, Some(1), "{}", path.display());
        assert!(said.err.contains(named) && said.err.trim().lines().count() == 1, "{}", said.err);
    }

    // Half of it now, the rest while it is open; then it is unlinked, which changes nothing.
    let half = bytes.len() / 2;
    std::fs::write(&cut, &bytes[..half]).unwrap();
    let server = replay(&site, &cut, &[]);
    let mut page = server.page();
    let early = page.text("hello")["replay"]["last"].as_f64().unwrap();
    let mut file = std::fs::OpenOptions::new().append(true).open(&cut).unwrap();
    file.write_all(&bytes[half..]).unwrap();
    // It may be looked at in the middle of the writing.
    let recorded = page.told("its end", |v| v["type"] == "recorded" && v["complete"] == true);
    assert!(recorded["last"].as_f64().unwrap() > early + 1.0, "{recorded}");
    std::fs::remove_file(&cut).unwrap();
    for _ in 0..5 {
        let tick = random.below(5800);
        let frame = page.seek(tick as f64 * 0.001, 1);
        assert_eq!(Some((tick, frame.content)), complete.frame(tick).unwrap());
    }

    // Shortened: what is gone is said, and what is there is shown.
    std::fs::write(&cut, &bytes).unwrap();
    let server = replay(&site, &cut, &[]);
    let mut page = server.page();
    page.text("hello");
    std::fs::OpenOptions::new().write(true).open(&cut).unwrap().set_len(half as u64).unwrap();
    for k in 0..20 {
        // Chunks that were read before are known.
        page.send(&json!({"type": "seek", "time": 3.6 + 0.1 * f64::from(k)}));
        doze(0.02);
    }
    let told = page.told("damage", |v| v["type"] == "link" && v["why"] != "");
    assert!(told["why"].as_str().unwrap().contains("cut.mcap: damaged at byte"), "{told}");
    page.texts.clear();
    page.send(&json!({"type": "seek", "time": 0.5}));
    page.told("shown again", |v| v["type"] == "link" && v["why"] == "");
}

/// Thousands of seeks and long stretches that nobody waits for: the newest is answered, and the server stays as it was.
#[test]
fn a_page_in_a_hurry_takes_no_memory() {
    let _turn = turn();
    let site = Site::new(EXE);
    let log = walk(&site, "walk");
    let server = replay(&site, &log, &[]);
    let mut pages: Vec<Page> = (0..8).map(|_| server.page()).collect();
    for page in &mut pages {
        let hello = page.text("hello");
        page.socket.get_ref().set_read_timeout(Some(std::time::Duration::from_millis(1))).unwrap();
        let names: Vec<&Value> =
            hello["fields"].as_array().unwrap().iter().map(|f| &f["name"]).take(64).collect();
        page.send(&json!({"type": "plot", "fields": names, "rate": 1000}));
    }
    let resident = || {
        let status = std::fs::read_to_string(format!("/proc/{}/status", server.running.id())).unwrap();
        let line = status.lines().find(|line| line.starts_with("VmRSS:")).unwrap();
        line.split_whitespace().nth(1).unwrap().parse::<u64>().unwrap()
    };
    let mut random = Random::new(3);
    let mut storm = |pages: &mut [Page], seconds: u64| {
        let begun = clock::now();
        while clock::now() - begun < seconds * clock::SECOND {
            for page in pages.iter_mut() {
                for _ in 0..3 {
                    page.send(&json!({"type": "seek", "time": random.below(6000) as f64 * 0.001}));
                }
                page.send(&json!({"type": "window", "log": 0, "from": 0, "to": 6}));
                while matches!(page.receive(), Some(received) if !matches!(received, Received::Closed(_))) {}
            }
            // Below the 200 messages a second at which a page is sent away.
            doze(0.02);
        }
    };
    // Its chunks and queues are filled once.
    storm(&mut pages, 1);
    let before = resident();
    storm(&mut pages, 2);
    let after = resident();
    println!("{before} kB before, {after} kB after");
    assert!(after < before + 8192 && after < 120_000, "{before} kB before, {after} kB after");
    let frame = pages[0].seek(3.0, 1);
    assert_eq!(frame.kind, 1);
}
