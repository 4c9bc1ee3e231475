//! `gangwerk dashboard` at a robot that runs: what a page sees is what the log says, what it commands moves her, and nothing that
//! it does or leaves undone changes a bit of her walk.

#[path = "dashboard/book.rs"]
mod book;
#[path = "dashboard/foxglove.rs"]
mod foxglove;
#[path = "dashboard/measured.rs"]
mod measured;
#[path = "dashboard/page.rs"]
mod page;
#[path = "dashboard/replay.rs"]
mod replay;
#[path = "dashboard/scenes.rs"]
mod scenes;
#[path = "dashboard/standstill.rs"]
mod standstill;

use harness::{Running, Signal, Site, WALK, doze, shared_turn};
use measured::number_of;
use messages::topics::{CONTROLLER_STATE, JOINT_TARGETS, SENSORS};
use messages::{ControllerState, GaitState, JointTargets, Sensors};
use page::{Page, PageFrame, Received, Server};
use realtime::clock;
use recording::{Log, payload_hashes};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::Path;

const EXE: &str = harness::executable!();
/// Lola stands up and waits for what she is told.
const WAIT: &str = "
[[command]]
time = 0.2
topic = \"walk/stand\"
";

/// A robot in simulated time, no faster than real time, that stands; its server, and a page that has seen its hello.
fn standing(site: &Site) -> (Running, Server, Page) {
    site.scene("wait", 100_000.0, WAIT);
    let mut run = site.run("wait", &["--lockstep", "--paced", "--no-log"]);
    let space = run.space();
    drop(space);
    let server = Server::start(site);
    let mut page = server.page();
    page.text("hello");
    page.until_entry("time", |time| time[0] > 3.0);
    page.until_entry("gait", |gait| gait[0] == GaitState::Standing as u64 as f32);
    (run, server, page)
}

/// A method that was chosen by its error: a page is told the number that the run said in its first line.
#[test]
fn the_estimated_error_of_a_method_is_told() {
    /// \[rad\] What the scene allows.
    const TOLERANCE: f64 = 0.5;
    let _turn = shared_turn();
    let site = Site::patient(EXE);
    site.scene("auto", 100_000.0, &format!("{WAIT}[tolerance]\ntrial = 0.4\ninclination = {TOLERANCE}\n"));
    let file = site.path("config/scenes/auto.toml");
    let scene = std::fs::read_to_string(&file).unwrap();
    let left_open = scene.replace("depth = 1\nintegrator = \"euler\"\nsubsteps = 4\n", "depth = \"auto\"\n");
    std::fs::write(&file, left_open).unwrap();

    let mut run = site.run("auto", &["--lockstep", "--paced", "--no-log"]);
    drop(run.space());
    let server = Server::start(&site);
    let told = server.page().text("processes")["estimated_error"].as_f64().unwrap();
    let said = run.err();
    let number =
        said.split_once("estimated error: inclination ").map(|(_, rest)| rest.split(' ').next().unwrap());
    let error: f64 = number.and_then(|number| number.parse().ok()).unwrap_or_else(|| panic!("{said}"));
    assert!((told * TOLERANCE - error).abs() <= 0.01 * error, "{told} of {TOLERANCE}, but {said}");
}

#[test]
fn hello_is_complete_and_frames_and_samples_are_the_log() {
    let _turn = shared_turn();
    let site = Site::patient(EXE);
    site.scene("walk", 6.0, WALK);
    let server = Server::start(&site);
    let mut page = server.page();
    let link = page.text("link");
    assert_eq!((&link["robot"], &link["broker"]), (&json!(false), &json!(false)));
    assert!(link["why"].as_str().unwrap().contains("gangwerk run"), "{link}");
    let run = site.run("walk", &["--lockstep", "--paced"]);
    let hello = page.text("hello");
    // Counts that belong together.
    let joints = hello["robot"]["joints"].as_array().unwrap();
    assert_eq!((hello["version"].as_u64(), hello["run"].as_u64()), (Some(1), Some(1)));
    assert_eq!(joints.len(), config::Robot::load(&site.config("robots/lola")).unwrap().joints.len());
    let list = |key: &str| hello[key].as_array().unwrap().len();
    assert!(list("fields") > 500 && list("parameters") > 50, "{} {}", list("fields"), list("parameters"));
    assert_eq!(list("commands"), messages::command_text::COMMANDS.len());
    assert_eq!((hello["scene"]["name"].as_str(), hello["cycle"].as_f64()), (Some("walk"), Some(0.001)));
    let (gait, pad) = (&hello["gait"], &hello["joystick"]);
    assert_eq!(
        (gait["velocity"]["forward"][1].as_f64(), gait["on_the_spot"].as_f64()),
        (Some(0.94), Some(0.8))
    );
    assert_eq!(
        (&pad["sticks"]["turn"]["axis"], &pad["buttons"]["dead_man"]),
        (&json!("ABS_RX"), &json!(["BTN_TL"]))
    );
    let numbers: u64 = hello["state"].as_array().unwrap().iter().map(|e| e["count"].as_u64().unwrap()).sum();
    // Two topics, one number that is a count, one that comes ten times a second.
    let knee = format!("sensors.joint_angle.{}", joints[4]["name"].as_str().unwrap());
    let target = format!("joint_targets.angle.{}", joints[4]["name"].as_str().unwrap());
    let height = "controller_state.com[2]";
    // In another order than in the record, of which a page sees its own.
    let fields = json!([knee, height, "controller_state.origin[0]", target, "cycle_stats/planner.cycles"]);
    page.send(&json!({"type": "plot", "fields": fields, "rate": 500}));
    let plotting = page.text("plotting");
    assert_eq!((&plotting["fields"], plotting["rate"].as_f64()), (&fields, Some(500.0)));
    page.send(&json!({"type": "plot", "fields": [knee.replace("angle", "angel")], "rate": 500}));
    let refused = page.text("plotting");
    assert!(refused["why"].as_str().unwrap().contains(&knee), "{refused}");
    assert_eq!(refused["fields"], fields, "what was plotted before goes on");

    // Everything until the robot's end.
    let (mut states, mut samples): (Vec<PageFrame>, Vec<PageFrame>) = (Vec::new(), Vec::new());
    page.until("end of the run", |_, received| {
        match received {
            Received::Frame(frame) if frame.kind == 1 => states.push(frame.clone()),
            Received::Frame(frame) => samples.push(frame.clone()),
            Received::Text(value) if value["type"] == "link" && value["robot"] == false => return Some(()),
            _ => {}
        }
        None
    });
    run.end().well();
    let log = Log::open(&site.path("walk.mcap")).unwrap();
    let sensors: BTreeMap<u64, Sensors> = by_tick(log.records(&SENSORS).unwrap());
    let controller: BTreeMap<u64, ControllerState> = by_tick(log.records(&CONTROLLER_STATE).unwrap());
    let targets: BTreeMap<u64, JointTargets> = by_tick(log.records(&JOINT_TARGETS).unwrap());
    assert!(states.len() > 200, "{} states in 6 s", states.len());
    assert!(states.windows(2).all(|pair| pair[0].tick <= pair[1].tick));
    let (angles, time, wrench) = (page.place("joint_angle"), page.place("time"), page.place("wrench"));
    for state in &states {
        let (numbers_of_it, logged) = (state.numbers(), &sensors[&state.tick]);
        assert_eq!((numbers_of_it.len() as u64, state.lost), (numbers, 0));
        let logged_angles = logged.joint_angle[..joints.len()].iter().map(|x| *x as f32);
        assert!(numbers_of_it[angles.clone()].iter().copied().eq(logged_angles), "tick {}", state.tick);
        assert_eq!(numbers_of_it[time.clone()], [(state.tick as f64 * 0.001) as f32]);
        assert_eq!(numbers_of_it[wrench.start + 8], logged.foot_wrench[1].force[2] as f32);
    }
    // She is where the estimate and the truth say, and they are near each other.
    let last = states.last().unwrap().numbers();
    let [x, truth] = ["torso", "torso_truth"].map(|name| last[page.place(name).start]);
    assert!(truth > 0.5 && (x - truth).abs() < 0.1, "torso at {x} m, in truth {truth} m");
    // Every second cycle from the first row on, each with the numbers of its own cycle.
    let rows: Vec<(f64, Vec<f32>)> = samples.iter().flat_map(PageFrame::rows).collect();
    assert!(rows.len() > 1000, "{} rows", rows.len());
    let ticks: Vec<u64> = rows.iter().map(|(time, _)| (time * 1000.0).round() as u64).collect();
    // An observer that has no processor for a quarter of a second loses what the rings do not hold, and nothing else.
    assert!(ticks.windows(2).all(|pair| pair[1] > pair[0] && (pair[1] - pair[0]).is_multiple_of(2)));
    let missing = ticks.windows(2).filter(|pair| pair[1] != pair[0] + 2).count();
    assert!(missing < 5, "{missing} gaps");
    for (tick, (_, cells)) in ticks.iter().zip(&rows) {
        let (state, angle) = (&controller[tick], sensors[tick].joint_angle[4]);
        let expected = [angle, state.com[2], state.origin[0], targets[tick].angle[4]].map(|x| x as f32);
        assert_eq!(cells[..4], expected, "tick {tick}");
    }
    let cycles: Vec<f32> = rows.iter().map(|(_, cells)| cells[4]).filter(|x| x.is_finite()).collect();
    assert!(cycles.windows(2).all(|pair| pair[0] <= pair[1]) && cycles.last() > cycles.first());
}

fn by_tick<T: messages::Record>(records: Vec<T>) -> BTreeMap<u64, T> {
    records.into_iter().map(|record| (record.header().tick, record)).collect()
}

#[test]
fn a_page_walks_her_and_she_stands_when_it_lives_no_more() {
    let _turn = shared_turn();
    let site = Site::patient(EXE);
    let (_run, server, mut page) = standing(&site);
    let begin = page.entry("torso_truth")[0];
    page.pulse = true;
    let velocity =
        |forward: f64| json!({"type": "command", "name": "walk/velocity", "values": {"forward": forward}});
    let (accepted, text) = page.order(velocity(9.0));
    assert!(!accepted && text.contains("[-2, 2]"), "{text}");
    assert_eq!(page.order(velocity(0.3)), (true, "planner".into()));
    page.told("lease", |v| v["type"] == "lease" && v["mine"] == true);
    page.until_entry("gait", |gait| gait[0] == GaitState::Walking as u64 as f32);
    // Another page sees who holds the lease, and does not get past it.
    let mut other = server.page();
    let lease = other.text("lease");
    assert!(
        lease["mine"] == false && lease["holder"].as_str().unwrap().contains("dashboard page 1 "),
        "{lease}"
    );
    page.until_entry("torso_truth", |torso| torso[0] > begin + 0.3);
    let (accepted, text) = other.order(velocity(0.1));
    assert!(!accepted && text.contains("dashboard page 1"), "{text}");
    // A parameter, as another page is told.
    let set = json!({"type": "set", "name": "planner.swing_height", "value": 0.071});
    assert_eq!(page.order(set), (true, "planner".into()));
    let told = other.text("parameter");
    assert_eq!((&told["name"], &told["value"]), (&json!("planner.swing_height"), &json!(0.071)));
    let set = json!({"type": "set", "name": "planner.swing_height", "value": 9.0});
    assert!(!page.order(set).0);
    // The page is hidden: it reads, but gives no heartbeat.
    page.texts.clear();
    page.pulse = false;
    let quiet = clock::now();
    page.told("LeaseLost", |v| v["name"] == "LeaseLost");
    let seconds = (clock::now() - quiet) as f64 * 1e-9;
    assert!((0.3..2.0).contains(&seconds), "the lease ended after {seconds} s");
    page.until_entry("gait", |gait| gait[0] == GaitState::Standing as u64 as f32);
    // Closed, while it holds the lease: she stops at once.
    page.pulse = true;
    assert!(page.order(velocity(0.3)).0);
    page.until_entry("gait", |gait| gait[0] == GaitState::Walking as u64 as f32);
    let walking = page.state.as_ref().unwrap().tick;
    // One that has just come: who did not read for so long is let go.
    let mut other = server.page();
    other.text("hello");
    drop(page);
    other.told("LeaseLost", |v| v["name"] == "LeaseLost" && v["tick"].as_u64() > Some(walking));
    other.until_entry("gait", |gait| gait[0] == GaitState::Standing as u64 as f32);
    assert_eq!((other.entry("fallen"), other.entry("supply")), (vec![0.0], vec![1.0]));
    // What the lease leaves free.
    let push = json!({"type": "command", "name": "sim/push", "values": {"force.y": 30, "duration": 0.2}});
    assert!(other.order(push).0);
    assert_eq!(other.until_entry("push", |push| push[0].abs() + push[1].abs() > 0.0)[1], 30.0);
}

#[test]
fn strangers_long_frames_and_nonsense_are_refused() {
    let site = Site::new(EXE);
    let server = Server::start(&site);
    let (host, origin) = (server.host.as_str(), format!("http://{}", server.host));
    let (right, wrong) = (format!("?token={}", server.token), format!("?token={}", "0".repeat(32)));
    assert_eq!(server.knock(host, Some(&origin), &right), 101);
    for (host, origin, query) in [
        (host, Some(origin.as_str()), wrong.as_str()),
        (host, Some(&origin), ""),
        (host, Some(&origin), "?token="),
        (host, Some("http://evil.example"), &right),
        (host, Some("null"), &right),
        (host, None, &right),
        ("evil.example:8720", Some("http://evil.example:8720"), &right),
    ] {
        assert_eq!(server.knock(host, origin, query), 403, "{host} {origin:?} {query}");
    }
    // Pages: what there is, for whom, and with which policy.
    let to_host = format!("Host: {host}");
    let root = server.ask(&["GET / HTTP/1.1", &to_host]);
    assert!(
        root.starts_with("HTTP/1.1 200") && root.contains("default-src 'none'; script-src 'self';"),
        "{root}"
    );
    assert!(root.contains("app.js") && !root.contains(&server.token));
    for (line, host, status) in [
        ("GET /app.js HTTP/1.1", to_host.as_str(), "200"),
        ("GET /app.css HTTP/1.1", &to_host, "200"),
        ("GET /licenses.txt HTTP/1.1", &to_host, "200"),
        ("GET /robot.urdf HTTP/1.1", &to_host, "404"),
        ("GET /meshes/../dashboard.url HTTP/1.1", &to_host, "404"),
        ("GET /../../etc/passwd HTTP/1.1", &to_host, "404"),
        ("POST / HTTP/1.1", &to_host, "405"),
        ("GET / HTTP/1.1", "Host: evil.example", "403"),
    ] {
        let answer = server.ask(&[line, host]);
        assert!(answer.starts_with(&format!("HTTP/1.1 {status}")), "{line}, {host}: {answer}");
    }
    // Frames: as long as they may be, longer, and no JSON of ours.
    let padded = |bytes: usize| format!("{{\"type\":\"pulse\",\"x\":\"{}\"}}", "x".repeat(bytes - 23));
    assert_eq!(padded(4096).len(), 4096);
    let mut page = server.page();
    page.socket.send(tungstenite::Message::text(padded(4096))).unwrap();
    let unknown = json!({"type": "command", "name": "walk/fly", "values": {}});
    assert!(page.order(unknown).1.contains("walk/"), "it is heard after a long frame");
    page.socket.send(tungstenite::Message::text(padded(5120))).unwrap();
    assert_eq!(page.closed(), Some(1009));
    for text in ["{}", "[]", "nonsense", "{\"type\":\"emergency_stop\"}", "{\"type\":\"set\",\"id\":1}"] {
        let mut page = server.page();
        page.socket.send(tungstenite::Message::text(text)).unwrap();
        assert_eq!(page.closed(), Some(1008), "{text}");
    }
    let mut page = server.page();
    (0..400).for_each(|_| _ = page.socket.send(tungstenite::Message::text("{\"type\":\"pulse\"}")));
    assert_eq!(page.closed(), Some(1008), "a flood");
    // The file with the token is its user's.
    let url = site.run_dir().join("dashboard.url");
    let mode = std::os::unix::fs::PermissionsExt::mode(&std::fs::metadata(&url).unwrap().permissions());
    assert_eq!(mode & 0o777, 0o600);
    server.running.interrupt();
    server.running.end().well();
    assert!(!url.exists() && !site.run_dir().exists(), "it leaves nothing");
}

#[test]
fn sixty_four_pages_and_no_more() {
    let site = Site::new(EXE);
    let server = Server::start(&site);
    let pages: Vec<Result<Page, u16>> = (0..200).map(|_| server.try_page()).collect();
    let open = pages.iter().filter(|page| page.is_ok()).count();
    let refused = pages.iter().filter(|page| matches!(page, Err(503))).count();
    assert_eq!((open, refused), (64, 136));
    for mut page in pages.into_iter().flatten() {
        assert_eq!(page.text("link")["robot"], false);
    }
    // All of them are gone: there is room again.
    let begun = clock::now();
    let mut page = loop {
        match server.try_page() {
            Ok(page) => break page,
            Err(status) => assert!(status == 503 && clock::now() - begun < page::PATIENCE),
        }
        doze(0.02);
    };
    page.text("link");
}

#[test]
fn who_does_not_read_is_left_and_others_go_on() {
    let _turn = shared_turn();
    let site = Site::patient(EXE);
    let (_run, server, mut page) = standing(&site);
    let names: Vec<&Value> =
        page.hello["fields"].as_array().unwrap().iter().map(|f| &f["name"]).take(64).collect();
    let plot = json!({"type": "plot", "fields": names, "rate": 1000});
    let mut deaf = server.page();
    deaf.send(&plot);
    page.send(&plot);
    // For 12 s one reads and the other does not.
    let (mut states, mut rows, begun) = (0, 0, clock::now());
    while clock::now() - begun < 12 * clock::SECOND {
        match page.receive() {
            Some(Received::Frame(frame)) => {
                assert_eq!(frame.lost, 0);
                states += usize::from(frame.kind == 1);
                rows += if frame.kind == 2 { frame.rows().len() } else { 0 };
            }
            Some(Received::Closed(code)) => panic!("closed: {code:?}"),
            _ => {}
        }
    }
    assert!(states > 300 && rows > 3000, "{states} states, {rows} rows in 12 s");
    // What waits for the other one has an end, and that is the end of its connection.
    let begun = clock::now();
    let mut last = 0;
    let mut lost = 0;
    deaf.until("close", |_, received| match received {
        Received::Closed(_) => Some(()),
        Received::Frame(frame) => {
            (last, lost) = (frame.tick, frame.lost);
            None
        }
        _ => None,
    });
    println!("read by the other one until tick {last}, {lost} lost");
    let newest = page.until_entry("time", |_| true)[0] * 1000.0;
    assert!((last as f32) < newest - 4000.0, "tick {last}, and now is {newest}");
    assert!(clock::now() - begun < 5 * clock::SECOND, "it is closed by now");
    server.page().text("hello");
}

/// Hash of the joint targets of a log.
fn targets(log: &Path) -> u64 {
    payload_hashes(log, |name| name == "/gangwerk/joint_targets").unwrap()["/gangwerk/joint_targets"]
}

/// Ten pages come, plot, command what they may not, read and go, and their server is killed or stands still, all at random
/// instants, for 8 s or `GANGWERK_SOAK_SECONDS`.
#[test]
fn pages_and_servers_that_die_change_no_bit_of_the_walk() {
    let _turn = shared_turn();
    let seconds = number_of("GANGWERK_SOAK_SECONDS").unwrap_or(8) as u64;
    let walk = |site: &Site, more: &[&str]| {
        site.scene("walk", seconds as f64 + 4.0, WALK);
        site.run("walk", &[&["--lockstep"], more].concat())
    };
    let alone = Site::patient(EXE);
    let mut run = walk(&alone, &[]);
    // A long one has more time than others.
    (0..20 * seconds).take_while(|_| run.is_alive()).for_each(|_| doze(0.05));
    run.end().well();
    let site = Site::patient(EXE);
    let mut server = Server::start(&site);
    let mut run = walk(&site, &["--paced"]);
    // A visit: hello, if a robot runs, sixty fields to plot, and a command that is refused.
    let visit = |server: &Server| {
        let (mut page, begun) = (server.page(), clock::now());
        while page.hello.is_null() && clock::now() - begun < 5 * clock::SECOND {
            page.receive();
        }
        let fields = page.hello["fields"].as_array().into_iter().flatten().map(|field| &field["name"]);
        let names: Vec<&Value> = fields.step_by(9).take(60).collect();
        if !names.is_empty() {
            page.send(&json!({"type": "plot", "fields": names, "rate": 500}));
        }
        let faster = json!({"type": "command", "name": "walk/velocity", "values": {"forward": 7}});
        assert!(!page.order(faster).0);
        page
    };
    let mut pages: Vec<Page> = (0..10).map(|_| visit(&server)).collect();
    let mut state = 20_261_127u64;
    let mut draw = |below: u64| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) % below
    };
    let (mut killed, mut stopped, mut left, begun) = (0, 0, 0, clock::now());
    while clock::now() - begun < seconds * clock::SECOND {
        match draw(12) {
            0 => {
                server.running.signal_supervisor(Signal::KILL);
                doze(1e-3 * draw(500) as f64);
                server = Server::start(&site);
                pages = (0..10).map(|_| visit(&server)).collect();
                killed += 1;
            }
            1 => {
                server.running.signal_supervisor(Signal::STOP);
                doze(1e-3 * draw(1000) as f64);
                server.running.signal_supervisor(Signal::CONT);
                stopped += 1;
            }
            2..=5 => {
                pages[draw(10) as usize] = visit(&server);
                left += 1;
            }
            // Between them some read, and the others do not.
            _ => _ = (0..draw(20)).map(|_| pages[draw(10) as usize].receive()).count(),
        }
    }
    assert!(run.is_alive() && killed + stopped + left > 0);
    run.end().well();
    println!("{seconds} s: a server killed {killed} times and stopped {stopped} times, {left} pages left");
    assert_eq!(targets(&alone.path("walk.mcap")), targets(&site.path("walk.mcap")));
}

#[test]
fn each_directory_has_its_robot_and_the_next_one_is_found() {
    let _turn = shared_turn();
    let sites = [Site::patient(EXE), Site::patient(EXE)];
    let names = ["one", "two"];
    let runs: Vec<Running> = (sites.iter().zip(names))
        .map(|(site, name)| {
            site.scene(name, 100_000.0, WAIT);
            site.run(name, &["--lockstep", "--paced", "--no-log"])
        })
        .collect();
    let servers = [Server::start(&sites[0]), Server::start(&sites[1])];
    let mut pages = [servers[0].page(), servers[1].page()];
    for (page, name) in pages.iter_mut().zip(names) {
        assert_eq!(page.text("hello")["scene"]["name"], name);
        page.told("broker", |v| v["broker"] == true);
    }
    let urdf = servers[0].ask(&["GET /robot.urdf HTTP/1.1", &format!("Host: {}", servers[0].host)]);
    assert!(urdf.contains("<robot") && urdf.contains("</robot>"));
    let [mut page, mut other] = pages;
    let mut runs = runs.into_iter();
    let (first, second) = (runs.next().unwrap(), runs.next().unwrap());
    first.interrupt();
    page.told("end", |v| v["robot"] == false);
    assert_eq!(first.end().code, Some(130));
    // The other one walks on, and the next robot is shown to a page that stayed.
    other.until_entry("time", |time| time[0] > 0.0);
    sites[0].scene("three", 100_000.0, WAIT);
    let next = sites[0].run("three", &["--lockstep", "--paced", "--no-log"]);
    let hello = page.text("hello");
    assert_eq!((hello["scene"]["name"].as_str(), hello["run"].as_u64()), (Some("three"), Some(2)));
    page.until_entry("time", |time| time[0] > 0.1 && time[0] < 30.0);
    assert!(page.order(json!({"type": "command", "name": "walk/stop", "values": {}})).0);
    drop((next, second));
}
