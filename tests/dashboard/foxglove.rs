//! The door for Foxglove without a viewer: who is refused, and that viewers cost nobody anything. What a viewer sees is checked by
//! Foxglove's own client, in `dashboard/page/checks/foxglove.test.mjs`.

use crate::page::{PATIENCE, Server, knock};
use crate::{EXE, targets};
use harness::{Site, WALK, doze, shared_turn};
use realtime::clock;
use serde_json::{Value, json};
use std::net::TcpStream;
use std::time::Duration;
use tungstenite::client::IntoClientRequest;
use tungstenite::{HandshakeError, Message, WebSocket};

const SUBPROTOCOL: &str = "foxglove.websocket.v1";
/// Longest message of a viewer \[B\].
const LONGEST: usize = 64 << 10;
/// Viewers at once.
const MOST: usize = 16;

/// A server with both doors.
struct TwoDoors {
    server: Server,
    /// `127.0.0.1:PORT` of the second one.
    host: String,
    token: String,
}

impl TwoDoors {
    fn open(site: &Site) -> Self {
        let server = Server::start_with(site, &["--foxglove", "127.0.0.1:0"]);
        let url = std::fs::read_to_string(site.run_dir().join(dashboard::daemon::FOXGLOVE_FILE)).unwrap();
        let (host, token) = url.trim().strip_prefix("ws://").unwrap().split_once("/?token=").unwrap();
        Self { server, host: host.into(), token: token.into() }
    }

    /// Status of the attempt to open a socket.
    fn knock(&self, query: &str, host: &str, more: &[&str]) -> u16 {
        let host = format!("Host: {host}");
        knock(&self.host, &format!("/{query}"), &[&[host.as_str()][..], more].concat())
    }

    /// A viewer without the token, or the status with which it was refused.
    fn viewer(&self) -> Result<WebSocket<TcpStream>, u16> {
        let mut request = format!("ws://{}/", self.host).into_client_request().unwrap();
        request.headers_mut().insert("Sec-WebSocket-Protocol", SUBPROTOCOL.parse().unwrap());
        let stream = TcpStream::connect(&self.host).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
        match tungstenite::client(request, stream) {
            Ok((socket, _)) => Ok(socket),
            Err(HandshakeError::Failure(tungstenite::Error::Http(answer))) => Err(answer.status().as_u16()),
            Err(e) => panic!("{e}"),
        }
    }
}

/// The next text with this `op`.
fn text(socket: &mut WebSocket<TcpStream>, op: &str) -> Value {
    loop {
        if let Message::Text(text) = socket.read().unwrap() {
            let value: Value = serde_json::from_str(&text).unwrap();
            if value["op"] == op {
                return value;
            }
        }
    }
}

/// Code with which the connection is closed, whatever comes before.
fn closed(mut socket: WebSocket<TcpStream>) -> Option<u16> {
    loop {
        match socket.read() {
            Ok(Message::Close(why)) => return why.map(|frame| frame.code.into()),
            Ok(_) => {}
            Err(_) => return None,
        }
    }
}

#[test]
fn strangers_long_frames_and_nonsense_are_refused_at_the_second_door() {
    let site = Site::new(EXE);
    let doors = TwoDoors::open(&site);
    let (host, page) = (doors.host.as_str(), doors.server.host.as_str());
    let local = format!("localhost:{}", host.rsplit(':').next().unwrap());
    let [right, wrong] = [&doors.token, &"0".repeat(32)].map(|token| format!("?token={token}"));
    let (protocol, from_page) =
        (format!("Sec-WebSocket-Protocol: {SUBPROTOCOL}"), format!("Origin: http://{page}"));
    let (protocol, from_page) = (protocol.as_str(), from_page.as_str());
    // Host, then Origin and token, then subprotocol.
    for (query, named, more, status) in [
        ("", host, vec![protocol], 101),
        ("", local.as_str(), vec![protocol, "Origin: file://"], 101),
        (&right, host, vec![protocol, "Origin: https://app.foxglove.dev"], 101),
        ("", host, vec![protocol, from_page], 101),
        ("", host, vec!["Sec-WebSocket-Protocol: other, foxglove.sdk.v1"], 101),
        ("", "evil.example:8765", vec![protocol], 403),
        (&right, page, vec![protocol], 403),
        (&right, host, vec![protocol, "Origin: http://evil.example"], 403),
        (&right, host, vec![protocol, "Origin: https://app.foxglove.dev.evil.example"], 403),
        (&right, host, vec![protocol, "Origin: null"], 403),
        (&wrong, host, vec![protocol], 403),
        ("?token=", host, vec![protocol], 403),
        ("", host, vec!["Sec-WebSocket-Protocol: graphql-ws"], 400),
        ("", host, vec![], 400),
        ("socket", host, vec![protocol], 404),
    ] {
        assert_eq!(doors.knock(query, named, &more), status, "{query} {named} {more:?}");
    }
    // Frames: as long as they may be, longer, and no JSON of the protocol.
    let padded = |bytes: usize| {
        let message = json!({"op": "getParameters", "parameterNames": [], "id": ""}).to_string();
        let rest = bytes - message.len();
        message.replace(r#""id":"""#, &format!(r#""id":"{}""#, "x".repeat(rest)))
    };
    assert_eq!(padded(LONGEST).len(), LONGEST);
    let mut viewer = doors.viewer().unwrap();
    let no_robot = text(&mut viewer, "status");
    assert!(no_robot["message"].as_str().unwrap().contains("gangwerk run"), "{no_robot}");
    viewer.send(Message::text(padded(LONGEST))).unwrap();
    assert_eq!(text(&mut viewer, "parameterValues")["parameters"], json!([]), "it is heard");
    viewer.send(Message::text(padded(LONGEST + 1024))).unwrap();
    assert_eq!(closed(viewer), Some(1009));
    for nonsense in [
        Message::text("nonsense"),
        Message::text("{}"),
        Message::text(r#"{"op":"subscribe"}"#),
        Message::binary(vec![1, 0, 0]),
        Message::binary(vec![2; 20]),
    ] {
        let mut viewer = doors.viewer().unwrap();
        viewer.send(nonsense.clone()).unwrap();
        assert_eq!(closed(viewer), Some(1008), "{nonsense:?}");
    }
    let mut viewer = doors.viewer().unwrap();
    (0..400).for_each(|_| _ = viewer.send(Message::text(r#"{"op":"unsubscribe","subscriptionIds":[]}"#)));
    assert_eq!(closed(viewer), Some(1008), "a flood");
    // The file with the token is its user's, and goes with the server.
    let url = site.run_dir().join(dashboard::daemon::FOXGLOVE_FILE);
    let mode = std::os::unix::fs::PermissionsExt::mode(&std::fs::metadata(&url).unwrap().permissions());
    assert_eq!(mode & 0o777, 0o600);
    doors.server.running.interrupt();
    doors.server.running.end().well();
    assert!(!site.run_dir().exists(), "it leaves nothing");
}

#[test]
fn sixteen_viewers_and_no_more() {
    let site = Site::new(EXE);
    let doors = TwoDoors::open(&site);
    let viewers: Vec<_> = (0..2 * MOST).map(|_| doors.viewer()).collect();
    let open = viewers.iter().filter(|viewer| viewer.is_ok()).count();
    let refused = viewers.iter().filter(|viewer| matches!(viewer, Err(503))).count();
    assert_eq!((open, refused), (MOST, MOST));
    for mut viewer in viewers.into_iter().flatten() {
        assert!(text(&mut viewer, "advertise")["channels"].as_array().unwrap().len() > 30);
    }
    // All of them are gone: there is room again. The page has places of its own.
    let begun = clock::now();
    let mut viewer = loop {
        match doors.viewer() {
            Ok(viewer) => break viewer,
            Err(status) => assert!(status == 503 && clock::now() - begun < PATIENCE),
        }
        doze(0.02);
    };
    assert_eq!(text(&mut viewer, "serverInfo")["name"], "Gangwerk");
    doors.server.page().text("link");
}

/// Viewers that were there before her read everything, or nothing, and she walks as without them.
#[test]
fn viewers_of_all_channels_that_do_not_read_change_no_bit_of_the_walk() {
    let _turn = shared_turn();
    let alone = Site::patient(EXE);
    alone.scene("walk", 6.0, WALK);
    alone.run("walk", &["--lockstep"]).end().well();
    let site = Site::patient(EXE);
    site.scene("walk", 6.0, WALK);
    let doors = TwoDoors::open(&site);
    let mut viewers = (0..4).map(|_| {
        let mut viewer = doors.viewer().unwrap();
        let channels = text(&mut viewer, "advertise")["channels"].as_array().unwrap().len();
        let all: Vec<Value> = (0..channels).map(|id| json!({"id": 100 + id, "channelId": id})).collect();
        viewer.send(Message::text(json!({"op": "subscribe", "subscriptions": all}).to_string())).unwrap();
        viewer
    });
    let mut reader = viewers.next().unwrap();
    let deaf: Vec<_> = viewers.collect();
    let reading = std::thread::spawn(move || {
        let mut messages = 0;
        while let Ok(message) = reader.read() {
            messages += u64::from(message.is_binary());
        }
        messages
    });
    site.run("walk", &["--lockstep", "--paced"]).end().well();
    assert_eq!(targets(&alone.path("walk.mcap")), targets(&site.path("walk.mcap")));
    // Those that did not read were let go while she walked: what they can still read is not all of it.
    let heard: Vec<u64> = deaf.into_iter().map(newest).collect();
    assert!(heard.iter().all(|&time| time > 0 && time < 5 * clock::SECOND), "{heard:?} ns");
    doors.server.running.interrupt();
    doors.server.running.end().well();
    let messages = reading.join().unwrap();
    assert!(messages > 20_000, "{messages} messages of all channels in 6 s");
}

/// Time of the newest message \[ns\] that can still be read.
fn newest(mut socket: WebSocket<TcpStream>) -> u64 {
    let mut newest = 0;
    while let Ok(message) = socket.read() {
        if let Message::Binary(bytes) = message
            && bytes[0] == 2
        {
            newest = u64::from_le_bytes(bytes[1..9].try_into().unwrap());
        }
    }
    newest
}
