//! A server that stands still for a while: what came meanwhile moves nothing when it goes on, and stops do.

use crate::page::{Page, Server};
use crate::{EXE, WAIT, standing};
use harness::{Signal, Site, shared_turn};
use messages::GaitState;
use realtime::clock;
use serde_json::{Value, json};

/// Stops the server, has the page send this, and live on, and lets the server go on a second later.
fn while_it_stands_still(server: &Server, page: &mut Page, messages: &[Value]) {
    server.running.signal_supervisor(Signal::STOP);
    let end = clock::now() + clock::SECOND;
    messages.iter().for_each(|message| page.send(message));
    while clock::now() < end {
        page.receive();
    }
    server.running.signal_supervisor(Signal::CONT);
}

/// Answer to the message of that number: whether it was accepted, and the text.
fn answer(page: &mut Page, id: u64) -> (bool, String) {
    let answer = page.told("answer", |v| v["type"] == "answer" && v["id"] == id);
    (answer["accepted"].as_bool().unwrap(), answer["text"].as_str().unwrap().to_owned())
}

/// She walked by an order that was seconds old: the broker was told of it as one of now.
#[test]
fn what_came_while_the_server_stood_still_moves_nothing_and_stops_do() {
    let _turn = shared_turn();
    let site = Site::patient(EXE);
    let (_run, server, mut page) = standing(&site);
    let velocity =
        |id: u64| json!({"type": "command", "id": id, "name": "walk/velocity", "values": {"forward": 0.3}});
    let stop = json!({"type": "command", "id": 902, "name": "walk/stop", "values": {}});
    page.pulse = true;
    while_it_stands_still(&server, &mut page, &[velocity(901), stop]);
    let (accepted, why) = answer(&mut page, 901);
    assert!(!accepted && why.contains("stood still"), "{why}");
    let (accepted, why) = answer(&mut page, 902);
    assert!(accepted, "{why}");
    let begun = page.entry("time")[0];
    page.until_entry("time", |time| time[0] > begun + 2.0);
    assert_eq!(page.entry("gait"), [GaitState::Standing as u64 as f32]);
    // It serves as ever.
    assert_eq!(page.order(velocity(0)), (true, "planner".into()));
    page.until_entry("gait", |gait| gait[0] == GaitState::Walking as u64 as f32);
}

/// A start is an order to walk, too.
#[test]
fn a_start_that_came_while_the_server_stood_still_starts_nothing() {
    let _turn = shared_turn();
    let site = Site::patient(EXE);
    site.scene("wait", 100_000.0, WAIT);
    let server = Server::start_with(&site, &["--start"]);
    let mut page = server.page();
    page.text("run");
    while_it_stands_still(&server, &mut page, &[json!({"type": "start", "id": 901, "scene": "wait"})]);
    let (accepted, why) = answer(&mut page, 901);
    assert!(!accepted && why.contains("stood still"), "{why}");
}
