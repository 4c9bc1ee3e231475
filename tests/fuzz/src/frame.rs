//! A connection of the broker's from its first byte to its end, with the broker behind it. The bytes are a script:
//! pieces of a stream, and frames made rightly, with a proof and tags where the broker has asked for them.

use std::cell::{Cell, OnceCell, RefCell};
use std::os::unix::fs::OpenOptionsExt;
use std::sync::Arc;
use std::time::Duration;

use broker::connection::{Rights, serve};
use broker::exchange::{Exchange, FIRST_STREAM};
use broker::inlet::{Gate, gate};
use broker::keys::{self, Half, Key, NONCE};
use broker::message::{HEAD, MAX_BYTES, Message, SERVICE, VERSION, service, service_message, write_command};
use ipc::Space;
use messages::Stamp;
use messages::command_text::COMMANDS;
use realtime::clock::now;
use tokio::io::{AsyncReadExt, AsyncWriteExt, DuplexStream};

use crate::{byte, chunk, own_directory};

/// State from one script to the next.
struct Broker {
    gate: Gate,
    exchange: RefCell<Exchange<'static>>,
    keys: Arc<Vec<Key>>,
    token: Cell<u32>,
}

impl Broker {
    fn new() -> Self {
        let dir = own_directory();
        let space = Box::leak(Box::new(Space::create(&dir.join("run")).expect("space")));
        let (gate, inlet) = gate();
        let path = dir.join("keys");
        let mut file = std::fs::OpenOptions::new();
        let file = file.write(true).create(true).truncate(true).mode(0o600).open(&path).expect("key file");
        std::io::Write::write_all(&mut &file, format!("op all {}\n", "7a".repeat(32)).as_bytes())
            .expect("room");
        let keys = Arc::new(keys::load(&path).expect("a key"));
        let exchange = RefCell::new(Exchange::new(space, inlet, now()).expect("queues"));
        Self { gate, exchange, keys, token: Cell::new(FIRST_STREAM) }
    }
}

thread_local! {
    static BROKER: OnceCell<Broker> = const { OnceCell::new() };
}

pub(crate) fn frame(script: &[u8]) {
    BROKER.with(|broker| {
        let broker = broker.get_or_init(Broker::new);
        let runtime = tokio::runtime::Builder::new_current_thread().enable_time().start_paused(true).build();
        runtime.expect("run-time").block_on(connection(broker, script));
    });
}

async fn connection(broker: &Broker, mut script: &[u8]) {
    let rights = byte(&mut script).unwrap_or(0);
    broker.token.set(broker.token.get().wrapping_add(1) | FIRST_STREAM);
    let rights = Rights {
        peer: "fuzzer".into(),
        may: if rights & 1 == 0 { 0 } else { u32::MAX >> 24 },
        reads: rights & 2 == 0,
        only_stops: rights & 0x1c == 0x1c,
        rate: 100,
        keys: broker.keys.clone(),
    };
    let (client, server) = tokio::io::duplex(1 << 20);
    let (read, write) = tokio::io::split(server);
    let gate = broker.gate.clone();
    let served = async {
        let _ = serve(read, write, gate, broker.token.get(), rights).await;
    };
    let turns = async {
        loop {
            broker.exchange.borrow_mut().turn(now(), &mut |_| {});
            tokio::time::sleep(Duration::from_millis(50)).await;
        }
    };
    let talk = async { tokio::join!(served, Client::new(client).play(broker, script)) };
    tokio::select! {
        _ = tokio::time::timeout(Duration::from_secs(600), talk) => {}
        () = turns => {}
    }
    // The connection's leave.
    broker.exchange.borrow_mut().turn(now(), &mut |_| {});
}

struct Client {
    stream: DuplexStream,
    sequence: u64,
    halves: Option<[Half; 2]>,
    sealed: bool,
}

impl Client {
    fn new(stream: DuplexStream) -> Self {
        Self { stream, sequence: 0, halves: None, sealed: false }
    }

    async fn play(mut self, broker: &Broker, mut script: &[u8]) {
        let key = &broker.keys[0];
        while let Some(step) = byte(&mut script) {
            if step & 0x80 == 0 {
                self.sequence += 1;
            }
            match step % 8 {
                0 => {
                    let bytes = chunk(&mut script, 1);
                    let _ = self.stream.write_all(bytes).await;
                }
                1 => self.send(chunk(&mut script, 3)).await,
                2 | 3 => {
                    let id = byte(&mut script).unwrap_or(0);
                    self.service(id.into(), chunk(&mut script, 2)).await;
                }
                4 => {
                    let n = byte(&mut script).unwrap_or(0);
                    let command = COMMANDS[usize::from(n) % COMMANDS.len()].example();
                    let stamp = Stamp { sequence: self.sequence, sent_ns: now(), ..Stamp::default() };
                    let mut buffer = [0; MAX_BYTES];
                    let bytes = write_command(&command, command.priority(), &stamp, &mut buffer);
                    self.send(bytes.expect("room")).await;
                }
                5 => self.hello(b"fuzzer").await,
                6 => {
                    self.hello(b"fuzzer\0op").await;
                    self.welcome(key).await;
                }
                _ => {
                    if let Some([to_broker, _]) = &self.halves {
                        let proof = to_broker.proof();
                        self.service(service::PROVE, &proof).await;
                        self.sealed = true;
                    } else {
                        tokio::time::sleep(Duration::from_millis(500)).await;
                    }
                }
            }
        }
        let _ = self.stream.shutdown().await;
        // What the broker still says is frames to the last byte.
        while let Some(message) = self.receive().await {
            assert!(self.sealed || self.halves.is_some() || Message::parse(&message).is_ok(), "{message:?}");
        }
    }

    async fn hello(&mut self, name: &[u8]) {
        let parts = [&VERSION.to_le_bytes()[..], &[0; 8], &[3; NONCE], name].concat();
        self.service(service::HELLO, &parts).await;
    }

    /// Waits for WELCOME; the keys of this connection.
    async fn welcome(&mut self, key: &Key) {
        while let Ok(Some(bytes)) = tokio::time::timeout(Duration::from_secs(1), self.receive()).await {
            if let Ok(message) = Message::parse(&bytes)
                && (message.domain, message.id) == (SERVICE, service::WELCOME)
                && let Some(nonce) = message.payload.get(10..10 + NONCE).and_then(|n| n.try_into().ok())
            {
                self.halves = Some(keys::session(key, &[3; NONCE], nonce));
                return;
            }
        }
    }

    async fn service(&mut self, id: u16, payload: &[u8]) {
        self.send(&service_message(id, self.sequence, now(), payload)).await;
    }

    /// A frame of the right length; with a tag if the key is proved.
    async fn send(&mut self, message: &[u8]) {
        let tag = self.halves.as_mut().filter(|_| self.sealed).map(|[to_broker, _]| to_broker.seal(message));
        let tag = tag.as_ref().map_or(&[][..], |tag| &tag[..]);
        let length = ((message.len() + tag.len()) as u32).to_le_bytes();
        let _ = self.stream.write_all(&[&length[..], message, tag].concat()).await;
    }

    async fn receive(&mut self) -> Option<Vec<u8>> {
        let mut length = [0; 4];
        self.stream.read_exact(&mut length).await.ok()?;
        let length = u32::from_le_bytes(length) as usize;
        assert!((HEAD..=MAX_BYTES + keys::TAG).contains(&length), "a frame of {length} bytes");
        let mut message = vec![0; length];
        self.stream.read_exact(&mut message).await.ok()?;
        Some(message)
    }
}

pub(crate) fn seeds() -> Vec<Vec<u8>> {
    let subscribe = [2, service::SUBSCRIBE as u8, 2, 0xff, 0, 0, 0];
    let ask = [2, service::DESCRIBE as u8, 0, 2, service::STATISTICS as u8, 0];
    let lease =
        [2, service::TAKE_LEASE as u8, 1, 1, 0, 2, service::GIVE_LEASE as u8, 0, 2, service::PING as u8, 0];
    let commands: Vec<u8> = (0..COMMANDS.len() as u8).flat_map(|n| [4, n]).collect();
    let talk = [&subscribe[..], &ask, &lease, &commands].concat();
    let raw = |bytes: &[u8]| [&[0u8, 0, bytes.len() as u8][..], bytes].concat();
    vec![
        [&[1, 5][..], &talk].concat(),
        [&[2, 6, 7][..], &talk].concat(),
        [&[0][..], &commands].concat(),
        [&[0x1c][..], &commands].concat(),
        [&[2, 6, 7][..], &talk, &raw(&[40, 0, 0, 0])].concat(),
        raw(&u32::MAX.to_le_bytes()),
    ]
}
