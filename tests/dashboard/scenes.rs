//! Runs that a page starts: the scenes that there are, start, walk, end, refusals, and what becomes of a run whose dashboard ends; a page that a
//! run brings.

use crate::page::{Page, Server};
use crate::{EXE, WAIT};
use harness::{Signal, Site, WALK, doze, shared_turn};
use ipc::Space;
use messages::topics::CONTROLLER_STATE;
use messages::{ControllerState, GaitState, Process};
use realtime::clock;
use serde_json::{Value, json};
use std::net::TcpStream;

fn start(scene: &str) -> Value {
    json!({"type": "start", "scene": scene})
}

fn end() -> Value {
    json!({"type": "end"})
}

/// Waits until the run is told to be in this state.
#[track_caller]
fn until_run(page: &mut Page, state: &str) -> Value {
    page.told(state, |v| v["type"] == "run" && v["state"] == state)
}

#[track_caller]
fn until_walking(page: &mut Page) {
    page.until("hello", |page, _| page.hello.is_object().then_some(()));
    page.until_entry("gait", |gait| gait[0] == GaitState::Walking as u64 as f32);
}

/// Lola walks as long as nobody ends it.
fn site() -> Site {
    let site = Site::patient(EXE);
    site.scene("walk", 100_000.0, WALK);
    site
}

#[test]
fn a_page_starts_a_scene_sees_her_walk_and_ends_it() {
    let _turn = shared_turn();
    let site = site();
    site.scene("broken", 10.0, "dept = 2\n");
    let server = Server::start_with(&site, &["--start"]);
    let mut page = server.page();
    let scenes = page.told("scenes", |v| v["type"] == "scenes");
    let list = scenes["list"].as_array().unwrap();
    let scene = |name: &str| list.iter().find(|scene| scene["name"] == name).unwrap();
    assert_eq!(list.len(), config::scenes::list(&site.path("config")).unwrap().len());
    assert!(scene("demo")["about"].as_str().unwrap().contains("Lola"), "{}", scene("demo"));
    assert!(scene("broken")["problem"].as_str().unwrap().contains("dept"), "{}", scene("broken"));
    until_run(&mut page, "none");
    // What is on the list, and nothing else; a name is no path and no flag.
    for (order, why) in [
        (start("wolk"), "did you mean walk"),
        (start("../scenes/walk"), "there is no scene"),
        (start("--bus"), "there is no scene"),
        (json!({"type": "start", "scene": "walk", "depth": 6}), "1 to 5"),
        (json!({"type": "start", "scene": "walk", "integrator": "--no-robot"}), "no integrator"),
        (end(), "no run was started here"),
    ] {
        let (accepted, text) = page.order(order.clone());
        assert!(!accepted && text.contains(why), "{order}: {text}");
    }
    // A start that fails says why, and the next one is free to come.
    let useless = json!({"type": "start", "scene": "walk", "depth": 4, "integrator": "bdf"});
    assert!(page.order(useless).0);
    until_run(&mut page, "starting");
    let why = until_run(&mut page, "none")["why"].as_str().unwrap().to_owned();
    assert!(why.starts_with("walk ended (exit status: 1)") && why.contains("bdf"), "{why}");
    assert_eq!(ipc::supervisor(&site.run_dir()), None);

    let deeper = json!({"type": "start", "scene": "walk", "depth": 2, "integrator": null});
    assert_eq!(page.order(deeper), (true, "walk is starting".into()));
    until_run(&mut page, "starting");
    let running = until_run(&mut page, "running");
    assert_eq!((&running["scene"], &running["why"]), (&json!("walk"), &json!("")));
    until_walking(&mut page);
    let hello = &page.hello;
    assert_eq!((&hello["scene"]["name"], &hello["mode"]), (&json!("walk"), &json!("lockstep")));
    assert_eq!(hello["scene"]["model"], "type 2, semi_implicit x 4");
    let begin = page.entry("torso_truth")[0];
    page.until_entry("torso_truth", |torso| torso[0] > begin + 0.1);
    // One at a time, for every page.
    let mut other = server.page();
    until_run(&mut other, "running");
    let (accepted, text) = other.order(start("demo"));
    assert!(!accepted && text.contains("walk runs"), "{text}");
    // Ended from any page; she stands before the supply goes.
    assert!(other.order(end()).0);
    let (accepted, text) = page.order(end());
    assert!(!accepted && text.contains("is ending"), "{text}");
    until_run(&mut page, "stopping");
    assert_eq!(until_run(&mut page, "none")["why"], "", "it ended in order");
    assert_eq!(page.entry("fallen"), [0.0]);
    assert_eq!(ipc::supervisor(&site.run_dir()), None);
    // The next one, with the scene's own model.
    page.hello = Value::Null;
    assert!(page.order(start("walk")).0);
    until_walking(&mut page);
    assert_eq!((&page.hello["scene"]["model"], &page.hello["run"]), (&json!("type 1"), &json!(2)));
    server.running.interrupt();
    server.running.end().well();
    assert!(!site.run_dir().exists(), "it leaves nothing");
}

/// Killed or asked to end: the robot comes to a stand, and the run ends; without its watchdog no supply stays on.
#[test]
fn a_run_ends_with_the_dashboard_that_started_it() {
    let _turn = shared_turn();
    for signal in [Signal::KILL, Signal::INT] {
        let site = site();
        let server = Server::start_with(&site, &["--start", "walk"]);
        let mut page = server.page();
        until_walking(&mut page);
        let space = Space::open(&site.run_dir(), Process::Observer).unwrap();
        let mut states = space.reader::<ControllerState>(&CONTROLLER_STATE).unwrap();
        server.running.signal_supervisor(signal);
        let begun = clock::now();
        let alive = || Process::ALL.into_iter().any(|process| ipc::owner(&site.run_dir(), process).is_some());
        // Every state that differs from the one before.
        let mut gaits = vec![GaitState::Walking as u64];
        while ipc::supervisor(&site.run_dir()).is_some() || alive() {
            gaits.extend(states.newer().map(|state| state.gait));
            gaits.dedup();
            assert!(clock::now() - begun < 30 * clock::SECOND, "{signal:?}: the run goes on, {gaits:?}");
            doze(0.002);
        }
        // At the end of a run the supply goes off: a robot that stands is idle then, one that still walks would have fallen.
        let [walking, stopping, standing, idle] =
            [GaitState::Walking, GaitState::Stopping, GaitState::Standing, GaitState::Idle].map(|g| g as u64);
        gaits.retain(|gait| *gait != idle);
        assert_eq!(gaits, [walking, stopping, standing], "{signal:?}");
    }
}

#[test]
fn nothing_is_started_unless_it_is_allowed_and_nothing_beside_another_run() {
    let _turn = shared_turn();
    let site = Site::patient(EXE);
    {
        let server = Server::start(&site);
        let mut page = server.page();
        for order in [start("demo"), end()] {
            let (accepted, text) = page.order(order);
            assert!(!accepted && text.contains("gangwerk dashboard --start"), "{text}");
        }
        assert!(page.texts.iter().all(|text| text["type"] != "scenes" && text["type"] != "run"));
    }
    // Somebody else's run is neither joined by another one nor ended.
    site.scene("wait", 100_000.0, WAIT);
    let mut run = site.run("wait", &["--lockstep", "--paced", "--no-log"]);
    drop(run.space());
    let server = Server::start_with(&site, &["--start"]);
    let mut page = server.page();
    until_run(&mut page, "elsewhere");
    let (accepted, text) = page.order(start("demo"));
    assert!(!accepted && text.contains(&format!("process {}", run.id())), "{text}");
    let (accepted, text) = page.order(end());
    assert!(!accepted && text.contains("no run was started here"), "{text}");
    // Without the token nobody comes so far.
    let (host, origin) = (server.host.as_str(), format!("http://{}", server.host));
    for query in ["", "?token=", &format!("?token={}", "0".repeat(32))] {
        assert_eq!(server.knock(host, Some(&origin), query), 403, "{query}");
    }
    server.running.interrupt();
    server.running.end().well();
    assert!(run.is_alive());
}

#[test]
fn a_scene_to_start_that_is_not_there_is_refused_before_anything_is_served() {
    let site = Site::patient(EXE);
    let dir = site.run_dir().display().to_string();
    let said = site.gangwerk(&["dashboard", "--dir", &dir, "--listen", "127.0.0.1:0", "--start", "dmo"]);
    assert!(said.code == Some(1) && said.err.contains("--start dmo: there is no scene `dmo`"), "{said:#?}");
    let said = site.gangwerk(&["dashboard", "--dir", &dir, "--replay", "walk.mcap", "--start"]);
    assert!(said.code == Some(2) && said.err.contains("--start"), "{said:#?}");
    assert!(!site.run_dir().exists(), "it leaves nothing");
}

/// `gangwerk run --desk`: the page is there with the run, and goes with it, ended or killed.
#[test]
fn the_page_of_a_run_goes_with_it() {
    let _turn = shared_turn();
    for signal in [Signal::INT, Signal::KILL] {
        let site = Site::patient(EXE);
        site.scene("desk", 2.0, WAIT);
        let mut run = site.run("desk", &["--lockstep", "--paced", "--no-log", "--stay", "--desk"]);
        drop(run.space());
        let file = site.run_dir().join(dashboard::daemon::URL_FILE);
        let read = || std::fs::read_to_string(&file).unwrap_or_default();
        let within = |seconds: f64, done: &dyn Fn() -> bool| {
            let begun = clock::now();
            while !done() && clock::now() - begun < (seconds * 1e9) as u64 {
                doze(0.02);
            }
            assert!(done(), "within {seconds} s, {signal:?}; {}: {}", file.display(), read());
        };
        within(10.0, &|| read().ends_with('\n'));
        let url = read();
        let host = url.trim_start_matches("http://").split('/').next().unwrap();
        assert!(TcpStream::connect(host).is_ok(), "{url}");
        // Beyond the scene's end both are there.
        doze(3.0);
        assert!(run.is_alive() && TcpStream::connect(host).is_ok());
        run.signal_supervisor(signal);
        within(20.0, &|| TcpStream::connect(host).is_err());
        drop(run);
    }
}
