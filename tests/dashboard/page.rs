//! A page without a browser: the socket of `docs/dashboard.md` as tests speak it, and a server to speak with.

use harness::{Running, Site, doze};
use realtime::clock;
use serde_json::{Value, json};
use std::collections::VecDeque;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::Duration;
use tungstenite::client::IntoClientRequest;
use tungstenite::protocol::CloseFrame;
use tungstenite::{Message, WebSocket};

/// Limit for everything that a test waits for.
pub(crate) const PATIENCE: u64 = 60 * clock::SECOND;
/// Period of a page's heartbeats \[ns\].
const PULSE: u64 = clock::SECOND / 10;

/// A running `gangwerk dashboard`.
pub(crate) struct Server {
    pub(crate) running: Running,
    /// `127.0.0.1:PORT`.
    pub(crate) host: String,
    pub(crate) token: String,
}

impl Server {
    pub(crate) fn start(site: &Site) -> Self {
        Self::start_with(site, &[])
    }

    /// The same with more arguments.
    pub(crate) fn start_with(site: &Site, more: &[&str]) -> Self {
        let dir = site.run_dir();
        let file = dir.join("dashboard.url");
        let _ = std::fs::remove_file(&file);
        let dir = dir.display().to_string();
        let all = ["dashboard", "--dir", &dir, "--listen", "127.0.0.1:0", "--no-open"];
        let mut running = site.start(&[&all[..], more].concat());
        let begun = clock::now();
        let url = loop {
            if let Ok(url) = std::fs::read_to_string(&file) {
                break url;
            }
            assert!(running.is_alive() && clock::now() - begun < PATIENCE, "{}", running.err());
            doze(0.01);
        };
        let (host, token) = url.trim().strip_prefix("http://").unwrap().split_once("/#").unwrap();
        Self { running, host: host.into(), token: token.into() }
    }

    /// Answer of HTTP to these lines.
    pub(crate) fn ask(&self, lines: &[&str]) -> String {
        let mut stream = TcpStream::connect(&self.host).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
        stream.write_all((lines.join("\r\n") + "\r\n\r\n").as_bytes()).unwrap();
        let mut answer = Vec::new();
        let mut chunk = [0; 65536];
        // Until it closes, or has said all of what it announced.
        loop {
            let n = stream.read(&mut chunk).unwrap_or(0);
            answer.extend_from_slice(&chunk[..n]);
            let text = String::from_utf8_lossy(&answer);
            let length = text
                .to_lowercase()
                .split_once("content-length: ")
                .map(|(_, rest)| rest.split_whitespace().next().unwrap().parse::<usize>().unwrap());
            let body = text.split_once("\r\n\r\n").map(|(head, _)| answer.len() - head.len() - 4);
            if n == 0 || body.is_some_and(|body| body >= length.unwrap_or(usize::MAX)) {
                return String::from_utf8_lossy(&answer).into_owned();
            }
        }
    }

    /// Status of the attempt to open a socket.
    pub(crate) fn knock(&self, host: &str, origin: Option<&str>, query: &str) -> u16 {
        let (host, origin) = (format!("Host: {host}"), origin.map(|origin| format!("Origin: {origin}")));
        let named: Vec<&str> = std::iter::once(host.as_str()).chain(origin.as_deref()).collect();
        knock(&self.host, &format!("/socket{query}"), &named)
    }

    /// A page, or the status with which it was refused.
    pub(crate) fn try_page(&self) -> Result<Page, u16> {
        let address = format!("ws://{}/socket?token={}", self.host, self.token);
        let mut request = address.into_client_request().unwrap();
        request.headers_mut().insert("Origin", format!("http://{}", self.host).parse().unwrap());
        let stream = TcpStream::connect(&self.host).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
        match tungstenite::client(request, stream) {
            Ok((socket, _)) => Ok(Page::new(socket)),
            Err(tungstenite::HandshakeError::Failure(tungstenite::Error::Http(answer))) => {
                Err(answer.status().as_u16())
            }
            Err(e) => panic!("{e}"),
        }
    }

    #[track_caller]
    pub(crate) fn page(&self) -> Page {
        self.try_page().unwrap_or_else(|status| panic!("refused with {status}"))
    }
}

/// Status of the attempt to open a socket at an address, with these headers besides those of every attempt.
pub(crate) fn knock(address: &str, target: &str, headers: &[&str]) -> u16 {
    let get = format!("GET {target} HTTP/1.1");
    let mut lines = vec![get.as_str(), "Connection: Upgrade", "Upgrade: websocket"];
    lines.extend(["Sec-WebSocket-Version: 13", "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ=="]);
    lines.extend(headers);
    // One that is opened says nothing more by itself: its first line is enough.
    let mut stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
    stream.write_all((lines.join("\r\n") + "\r\n\r\n").as_bytes()).unwrap();
    let mut first = [0; 12];
    stream.read_exact(&mut first).unwrap();
    std::str::from_utf8(&first[9..]).unwrap().parse().unwrap()
}

/// A frame of the server.
#[derive(Clone, Debug)]
pub(crate) struct PageFrame {
    pub(crate) kind: u8,
    pub(crate) lost: u32,
    pub(crate) tick: u64,
    pub(crate) content: Vec<u8>,
}

impl PageFrame {
    fn parse(bytes: &[u8]) -> Self {
        assert_eq!(bytes[1..4], [0; 3]);
        Self {
            kind: bytes[0],
            lost: u32::from_le_bytes(bytes[4..8].try_into().unwrap()),
            tick: u64::from_le_bytes(bytes[8..16].try_into().unwrap()),
            content: bytes[16..].to_vec(),
        }
    }

    /// Numbers of a state.
    pub(crate) fn numbers(&self) -> Vec<f32> {
        assert!(matches!(self.kind, 1 | 3) && self.content.len().is_multiple_of(4), "kind {}", self.kind);
        self.content.chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect()
    }

    /// Rows of samples: time \[s\], and one number per field.
    pub(crate) fn rows(&self) -> Vec<(f64, Vec<f32>)> {
        assert!(matches!(self.kind, 2 | 4), "kind {}", self.kind);
        let word = |at: usize| u16::from_le_bytes([self.content[at], self.content[at + 1]]) as usize;
        let (fields, rows) = (word(0), word(2));
        assert_eq!(self.content.len(), 4 + rows * (8 + 4 * fields), "{fields} fields, {rows} rows");
        let row = |bytes: &[u8]| {
            let cells = bytes[8..].chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().unwrap()));
            (f64::from_le_bytes(bytes[..8].try_into().unwrap()), cells.collect())
        };
        self.content[4..].chunks_exact(8 + 4 * fields).map(row).collect()
    }
}

/// Anything that a page receives.
#[derive(Clone, Debug)]
pub(crate) enum Received {
    Text(Value),
    Frame(PageFrame),
    /// The connection is over, with a close frame or without.
    Closed(Option<u16>),
}

/// A page.
pub(crate) struct Page {
    pub(crate) socket: WebSocket<TcpStream>,
    pub(crate) hello: Value,
    /// Heartbeats are sent while it waits.
    pub(crate) pulse: bool,
    next_pulse: u64,
    next_id: u64,
    /// The newest state.
    pub(crate) state: Option<PageFrame>,
    /// Texts that came, for a look back.
    pub(crate) texts: VecDeque<Value>,
}

impl Page {
    fn new(socket: WebSocket<TcpStream>) -> Self {
        socket.get_ref().set_read_timeout(Some(Duration::from_millis(20))).unwrap();
        let (hello, texts) = (Value::Null, VecDeque::new());
        Self { socket, hello, pulse: false, next_pulse: 0, next_id: 1, state: None, texts }
    }

    pub(crate) fn send(&mut self, message: &Value) {
        self.socket.send(Message::text(message.to_string())).unwrap();
    }

    /// The next thing that comes; none within some milliseconds.
    pub(crate) fn receive(&mut self) -> Option<Received> {
        if self.pulse && clock::now() >= self.next_pulse {
            self.next_pulse = clock::now() + PULSE;
            self.send(&json!({"type": "pulse"}));
        }
        match self.socket.read() {
            Ok(Message::Text(text)) => {
                let value: Value = serde_json::from_str(&text).unwrap();
                if value["type"] == "hello" {
                    self.hello = value.clone();
                }
                self.texts.push_back(value.clone());
                Some(Received::Text(value))
            }
            Ok(Message::Binary(bytes)) => {
                let frame = PageFrame::parse(&bytes);
                if frame.kind == 1 {
                    self.state = Some(frame.clone());
                }
                Some(Received::Frame(frame))
            }
            Ok(Message::Close(why)) => Some(Received::Closed(why.map(|CloseFrame { code, .. }| code.into()))),
            Ok(_) => None,
            Err(tungstenite::Error::Io(e)) if e.kind() == std::io::ErrorKind::WouldBlock => None,
            Err(_) => Some(Received::Closed(None)),
        }
    }

    /// Receives until `what` finds something.
    #[track_caller]
    pub(crate) fn until<T>(
        &mut self,
        about: &str,
        mut what: impl FnMut(&mut Self, &Received) -> Option<T>,
    ) -> T {
        let begun = clock::now();
        loop {
            assert!(clock::now() - begun < PATIENCE, "{about}: not within its time");
            let Some(received) = self.receive() else { continue };
            if let Some(found) = what(self, &received) {
                return found;
            }
            assert!(!matches!(received, Received::Closed(_)), "{about}: the connection is closed");
        }
    }

    /// A text of which `what` is true: the first one since those that were looked at or cleared.
    #[track_caller]
    pub(crate) fn told(&mut self, about: &str, what: impl Fn(&Value) -> bool) -> Value {
        while let Some(text) = self.texts.pop_front() {
            if what(&text) {
                return text;
            }
        }
        self.until(about, |page, received| match received {
            Received::Text(value) if what(value) => {
                page.texts.clear();
                Some(value.clone())
            }
            _ => None,
        })
    }

    /// The next text of this type.
    #[track_caller]
    pub(crate) fn text(&mut self, kind: &str) -> Value {
        self.until(kind, |_, received| match received {
            Received::Text(value) if value["type"] == kind => Some(value.clone()),
            _ => None,
        })
    }

    /// Sends a message with a number, and waits for its answer: whether it was accepted, and the text.
    #[track_caller]
    pub(crate) fn order(&mut self, mut message: Value) -> (bool, String) {
        let id = self.next_id;
        self.next_id += 1;
        message["id"] = id.into();
        self.send(&message);
        self.until(&message.to_string(), |_, received| match received {
            Received::Text(value) if value["type"] == "answer" && value["id"] == id => {
                Some((value["accepted"].as_bool().unwrap(), value["text"].as_str().unwrap().to_owned()))
            }
            _ => None,
        })
    }

    /// Place of an entry among the numbers of a state.
    pub(crate) fn place(&self, name: &str) -> std::ops::Range<usize> {
        let mut start = 0;
        for entry in self.hello["state"].as_array().unwrap() {
            let count = entry["count"].as_u64().unwrap() as usize;
            if entry["name"] == name {
                return start..start + count;
            }
            start += count;
        }
        panic!("no entry {name} in {}", self.hello["state"]);
    }

    /// Numbers of an entry in the newest state.
    pub(crate) fn entry(&self, name: &str) -> Vec<f32> {
        let Some(state) = &self.state else { return Vec::new() };
        state.numbers()[self.place(name)].to_vec()
    }

    /// Waits for a state in which this entry is as wanted.
    #[track_caller]
    pub(crate) fn until_entry(&mut self, name: &str, wanted: impl Fn(&[f32]) -> bool) -> Vec<f32> {
        self.until(name, |page, received| {
            let is_state = matches!(received, Received::Frame(frame) if frame.kind == 1);
            let numbers = if is_state { page.entry(name) } else { Vec::new() };
            (is_state && wanted(&numbers)).then_some(numbers)
        })
    }

    /// The reason with which the connection is closed, whatever comes before.
    #[track_caller]
    pub(crate) fn closed(&mut self) -> Option<u16> {
        self.until("close", |_, received| match received {
            Received::Closed(code) => Some(*code),
            _ => None,
        })
    }
}
