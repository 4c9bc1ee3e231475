//! Decoded frames of a robot.

use std::error::Error;
use std::fmt::Write;
use std::path::Path;

use codec::interpreter::Telegram;
use codec::layout::{BusMessage, Carries, FrameLayout};
use config::Robot;
use fieldbus::capture::{Captured, FrameType};
use fieldbus::owners::Owners;

use super::Only;

/// The layouts of a robot, and which node is behind which interface.
pub(super) struct FrameDecoder {
    pub(super) robot: Robot,
    /// The same with drives that play tables, until a frame of theirs was seen.
    tables: Option<Box<Robot>>,
    /// Whether a frame of CAN FD was seen: then the layout is that of CAN FD, also for frames of up to 8 bytes.
    fd: bool,
    pub(super) owners: Owners,
}

/// The layout of classic CAN or CAN FD; a robot without frames of classic CAN has just one.
fn layout(robot: &Robot, fd: bool) -> &FrameLayout {
    robot.classic.as_ref().ok().filter(|_| !fd).unwrap_or(&robot.layout)
}

impl FrameDecoder {
    /// The robot of that name.
    pub(super) fn load(config: &Path, name: &str) -> Result<Self, Box<dyn Error>> {
        let place = config.join("robots").join(name);
        let robot = Robot::load(&place)?;
        let mut tables = Box::new(robot.clone());
        let tables = tables.play_tables().is_ok().then_some(tables);
        Ok(Self { robot, tables, fd: false, owners: Owners::default() })
    }

    /// Learns from frames: all of a recording before it is looked at, or each as it comes.
    pub(super) fn learn(&mut self, frame: &Captured) {
        self.fd |= matches!(frame.form, FrameType::Fd { .. });
        let has = |layout: &FrameLayout| {
            layout.messages.iter().any(|m| m.id == frame.id && m.len == u32::from(frame.len))
        };
        if !has(self.layout())
            && let Some(tables) = self.tables.take_if(|tables| has(&tables.layout))
        {
            self.robot = *tables;
        }
        self.owners.learn(layout(&self.robot, self.fd), frame);
    }

    /// The layout in use.
    pub(super) fn layout(&self) -> &FrameLayout {
        layout(&self.robot, self.fd)
    }

    /// The message of a frame.
    pub(super) fn message(&self, frame: &Captured) -> Option<&BusMessage> {
        self.owners.message(self.layout(), frame)
    }

    /// Name of the message of an identifier on a line.
    pub(super) fn name(&self, line: u32, id: u32) -> Option<String> {
        let layout = self.layout();
        let node = self.owners.nodes(layout, line, id).next()?;
        layout.find(node as u32, id).map(|i| layout.messages[i].name.clone())
    }

    /// Whether a frame goes the way asked for; error frames and unknown ones come from the line.
    pub(super) fn goes(&self, frame: &Captured, only: Option<Only>) -> bool {
        let to_drives = self.message(frame).is_some_and(|m| m.to_drives);
        only.is_none_or(|only| (only == Only::ToDrives) == to_drives)
    }
}

/// Unit of what a signal carries; empty for numbers without one.
pub(super) fn unit(carries: Carries) -> &'static str {
    match carries {
        Carries::Target(_) | Carries::Angle(_) | Carries::Motor(_) => "rad",
        Carries::Feed(_) | Carries::Speed(_) | Carries::MotorSpeed(_) | Carries::Rate(_) => "rad/s",
        Carries::Current(_) => "A",
        Carries::Temperature(_) => "deg C",
        Carries::Force(..) => "N",
        Carries::Moment(..) => "N m",
        Carries::Acceleration(_) => "m/s^2",
        Carries::Counter
        | Carries::Mode
        | Carries::Control(_)
        | Carries::Supply
        | Carries::Status(_)
        | Carries::Error(_)
        | Carries::Orientation(_)
        | Carries::Interpreter(_)
        | Carries::NetworkCommand
        | Carries::NetworkNode
        | Carries::NetworkState(_) => "",
    }
}

/// One line for each signal: name, value, unit; words of bits in hex digits.
pub(super) fn signals(message: &BusMessage, frame: &Captured) -> String {
    let mut text = String::new();
    let joint = |name: &str| name.rsplit_once('_').map_or(name, |(joint, _)| joint).to_owned();
    // A telegram of an interpreter, as it is written at the drive's terminal.
    if let (Some(_), Some(telegram)) = (message.interpreter(), Telegram::read(frame.payload())) {
        return format!("    {}: {telegram}\n", joint(&message.signals[0].name));
    }
    for signal in &message.signals {
        let raw = signal.get(&frame.data);
        let value = match signal.carries {
            Carries::Control(_) | Carries::Status(_) | Carries::Error(_) => format!("0x{raw:04X}"),
            _ => signal.value(raw).to_string(),
        };
        let _ = writeln!(text, "    {} = {value} {}", signal.name, unit(signal.carries));
    }
    text.lines().map(|line| format!("{}\n", line.trim_end())).collect()
}
