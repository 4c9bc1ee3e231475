//! Commands as bytes and as text, candump logs, DBC files, and the file that tells processes which run they are in.

use broker::message::{MAX_BYTES, Message, write_command};
use config::BusAddress;
use fieldbus::candump;
use messages::command_text::COMMANDS;
use messages::{Command, Stamp, wire};
use std::path::Path;
use std::sync::OnceLock;

fn shipped(name: &str) -> Vec<u8> {
    std::fs::read(config::root(None).join(name)).expect("shipped configuration")
}

/// What is taken for a command encodes to the same bytes.
pub(crate) fn command(bytes: &[u8]) {
    if let Ok(command) = wire::decode(bytes) {
        let mut buffer = [0; wire::MAX_BYTES];
        assert_eq!(wire::encode(&command, &mut buffer).expect("it was decoded"), bytes);
        let _ = command.check();
    }
    if let Ok(message) = Message::parse(bytes)
        && let Ok(command) = message.command()
    {
        assert_eq!(command.check(), Ok(()));
        let mut buffer = [0; MAX_BYTES];
        let again = write_command(&command, message.priority, &message.stamp, &mut buffer);
        assert_eq!(again.expect("it was decoded"), bytes);
    }
}

pub(crate) fn command_seeds() -> Vec<Vec<u8>> {
    let mut seeds = Vec::new();
    for command in COMMANDS.iter().map(|info| info.example()) {
        let mut buffer = [0; MAX_BYTES];
        seeds.push(wire::encode(&command, &mut buffer).expect("room").to_vec());
        let stamp = Stamp { sequence: 1, ..Stamp::default() };
        seeds.push(write_command(&command, command.priority(), &stamp, &mut buffer).expect("room").to_vec());
    }
    seeds
}

/// `NAME FIELD=VALUE ...`: what is taken is in range.
pub(crate) fn command_text(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let (name, fields) = text.split_once(' ').unwrap_or((text, ""));
    if let Ok(command) = Command::parse(name, fields) {
        assert_eq!(command.check(), Ok(()));
    }
}

pub(crate) fn command_text_seeds() -> Vec<Vec<u8>> {
    let line = |info: &messages::command_text::CommandInfo| {
        let command = info.example();
        let fields = info.fields.iter().enumerate();
        let fields = fields.map(|(i, f)| format!(" {}={}", f.name, command.value(i))).collect::<String>();
        format!("{}{fields}", info.name).into_bytes()
    };
    COMMANDS.iter().map(line).collect()
}

/// What is taken, written and taken again is written the same.
pub(crate) fn candump(bytes: &[u8]) {
    let (mut capture, broken) = candump::parse(bytes).expect("reading memory does not fail");
    assert!(capture.frames.len() + broken.count <= broken.of);
    let written = |capture| {
        let mut text = Vec::new();
        candump::write(&mut text, capture).expect("writing to memory does not fail");
        text
    };
    let first = written(&capture);
    let (again, broken) = candump::parse(&first[..]).expect("reading memory does not fail");
    assert_eq!((broken.count, again.frames.len()), (0, capture.frames.len()), "{broken}");
    assert_eq!(written(&again), first);
    capture.sort();
}

pub(crate) fn candump_seeds() -> Vec<Vec<u8>> {
    let lines = "(1436509052.249713) vcan0 044#2A366C2BBA\n(1436509052.650004) vcan0 00000123#\n\
                 (1436509052.850002) vcan0 123#R8\n(1436509053.000000) vcan1 7FF#1122334455667788_E\n\
                 (1436509053.200000) vcan0 1FFFFFFF##5000102030405060708090A0B\n\
                 (1436509053.300000) vcan0 20000004#000C000000000000\n(1436509053.400000000) can 100#DEADBEEF R\n";
    lines.split_inclusive('\n').chain([lines]).map(|text| text.as_bytes().to_vec()).collect()
}

/// A layout that is taken has its signals within their messages.
pub(crate) fn dbc(bytes: &[u8]) {
    static JOINTS: OnceLock<Vec<String>> = OnceLock::new();
    let joints = JOINTS.get_or_init(|| {
        let robot = config::Robot::load(&config::root(None).join("robots/lola")).expect("shipped robot");
        robot.joints.iter().map(|joint| joint.name.clone()).collect()
    });
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let joints: Vec<&str> = joints.iter().map(String::as_str).collect();
    if let Ok(layout) = config::dbc::read(text, &joints) {
        for message in &layout.messages {
            assert!(message.len <= 64 && message.signals.iter().all(|s| s.start + s.bits <= 8 * message.len));
        }
    }
}

pub(crate) fn dbc_seeds() -> Vec<Vec<u8>> {
    let small = "VERSION \"\"\nNS_ :\nBS_:\nBU_: PC leg\nBO_ 1 sync: 1 PC\n SG_ counter : 0|8@1+ (1,0) [0|255] \"\" leg\n\
                 BO_ 2 back: 8 leg\n SG_ hip_angle : 0|16@1- (0.001,-1) [-3|3] \"rad\" PC\nCM_ BO_ 1 \"text\";\n\
                 VAL_ 1 counter 0 \"zero\" 1 \"one\";\n";
    vec![small.into(), shipped("robots/lola/can/lola.dbc"), shipped("robots/lola/can/lola_fd.dbc")]
}

/// What is taken, written and taken again is the same run.
pub(crate) fn run_file(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let dir = Path::new("/nowhere");
    if let Ok(run) = ipc::Run::parse(dir, text) {
        let _ = run.bus.parse::<BusAddress>();
        let _ = run.method.as_deref().map(str::parse::<config::method::Method>);
        assert_eq!(ipc::Run::parse(dir, &run.to_text()).expect("it was written"), run);
    }
}

pub(crate) fn run_file_seeds() -> Vec<Vec<u8>> {
    let bare = ipc::Run::bare(Path::new("/nowhere"));
    let method = Some("type 2, semi_implicit x 4".into());
    let mut seeds = vec![bare.to_text().into_bytes()];
    for bus in ["can:vcan0-8", "canfd:vcan0,vcan3", "sercos:n1,n2/f1,f2"] {
        let run = ipc::Run {
            bus: bus.into(),
            method: method.clone(),
            method_error: Some(0.41),
            log: Some("w.mcap".into()),
            ..bare.clone()
        };
        seeds.push(run.to_text().into_bytes());
    }
    seeds
}
