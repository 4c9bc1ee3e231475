//! Thread that reads the gamepad: what hands do goes to the pilot, an emergency stop to its own thread at once.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::mpsc::Sender;

use config::joystick::{ButtonFunction, Control, Joystick};
use realtime::clock::{SECOND, now, sleep_until};

use crate::find::{self, DEV, Gamepad, SYS};
use crate::pad::{AxisRange, Hands, Pad};

/// Between two looks whether a gamepad is plugged in \[ns\].
const SEARCH: u64 = SECOND / 2;
/// Type of the event that ends a report.
const EV_SYN: u16 = 0;
/// Bytes of a `struct input_event`: two longs of time, type, code, value.
const EVENT: usize = 16 + 8;

/// News of the gamepad.
#[derive(Clone, Debug, PartialEq)]
pub enum PadNews {
    /// It is there: its name.
    Here(String),
    /// Hands from now on, and buttons that were pressed since the last time, at this time \[ns\].
    Hands(Hands, Vec<ButtonFunction>, u64),
    /// It is gone, and why.
    Gone(String),
    /// It cannot be read, and why.
    Missing(String),
}

/// Source of events.
#[derive(Clone, Debug)]
pub enum Source {
    /// The only gamepad that is plugged in.
    Search,
    /// A device.
    Device(PathBuf),
    /// Raw events of a file or pipe instead of a device, as one with sticks of 16 bits and triggers of 10 sends them; its end is
    /// that of the device.
    Recorded(PathBuf),
}

/// A device that is open.
enum Events {
    Device(Box<evdev::Device>),
    Recorded(File),
}

impl Source {
    /// Reads the gamepad until nobody listens: waits for it, and for the next one when it is gone. Presses of the emergency stop go
    /// to `stops`.
    pub fn read(&self, layout: &Joystick, news: &Sender<PadNews>, stops: &Sender<()>) {
        loop {
            let ended = match self.open() {
                Ok((gamepad, mut events, mut pad)) => {
                    let missing = missing(&pad, layout);
                    let here = format!("gamepad: {gamepad}{missing}");
                    if news.send(PadNews::Here(here)).is_err() {
                        return;
                    }
                    match listen(&mut events, &mut pad, layout, news, stops) {
                        Ok(()) => return,
                        Err(e) => PadNews::Gone(format!("gamepad {gamepad} is gone ({e}); it is waited for")),
                    }
                }
                Err(why) => PadNews::Missing(why),
            };
            // A recording is played once; a pipe waits for its next writer.
            let over = matches!((self, &ended), (Self::Recorded(file), PadNews::Gone(_)) if file.is_file());
            if news.send(ended).is_err() || over {
                return;
            }
            sleep_until(now() + SEARCH);
        }
    }

    /// Opens the gamepad.
    ///
    /// # Errors
    /// There is none, or it cannot be opened: what to do.
    fn open(&self) -> Result<(Gamepad, Events, Pad), String> {
        let gamepad = match self {
            Self::Search => find::only(find::gamepads(Path::new(SYS), Path::new(DEV)))?,
            Self::Device(node) => Gamepad { name: "device".into(), node: node.clone() },
            Self::Recorded(file) => Gamepad { name: "recorded events".into(), node: file.clone() },
        };
        let refused = |e: io::Error| find::unopened(&gamepad, &e);
        if let Self::Recorded(file) = self {
            let events = File::open(file).map_err(refused)?;
            return Ok((gamepad, Events::Recorded(events), recorded()));
        }
        let device = evdev::Device::open(&gamepad.node).map_err(refused)?;
        let pad = pad_of(&device).map_err(refused)?;
        let name = device.name().unwrap_or("gamepad").to_owned();
        Ok((Gamepad { name, node: gamepad.node }, Events::Device(Box::new(device)), pad))
    }

    /// Presence of a gamepad, for the start of a program.
    ///
    /// # Errors
    /// There is none, or it cannot be opened: what to do.
    pub fn check(&self) -> Result<(), String> {
        // Opening a pipe waits for who writes it.
        if matches!(self, Self::Recorded(_)) { Ok(()) } else { self.open().map(drop) }
    }
}

/// Axes and buttons of a device, with their present values.
fn pad_of(device: &evdev::Device) -> io::Result<Pad> {
    let range = |info: evdev::AbsInfo| AxisRange {
        minimum: info.minimum(),
        maximum: info.maximum(),
        flat: info.flat(),
    };
    let axes: Vec<_> =
        device.get_absinfo()?.map(|(axis, info)| (axis.0, range(info), info.value())).collect();
    let buttons: Vec<u16> =
        device.supported_keys().into_iter().flat_map(evdev::AttributeSetRef::iter).map(|key| key.0).collect();
    let mut pad = Pad::new(axes.iter().map(|(code, range, _)| (*code, *range)), buttons);
    axes.iter().for_each(|(code, _, value)| pad.take(crate::pad::EV_ABS, *code, *value));
    device.get_key_state()?.iter().for_each(|key| pad.take(crate::pad::EV_KEY, key.0, 1));
    Ok(pad)
}

/// The device of [`Source::Recorded`]: an Xbox gamepad of the driver xpad.
fn recorded() -> Pad {
    let range = |minimum, maximum, flat| AxisRange { minimum, maximum, flat };
    let sticks = [0, 1, 3, 4].map(|code| (code, range(-32768, 32767, 128)));
    let triggers = [2, 5].map(|code| (code, range(0, 1023, 0)));
    let hat = [0x10, 0x11].map(|code| (code, range(-1, 1, 0)));
    Pad::new(sticks.into_iter().chain(triggers).chain(hat), 0x130..=0x13e)
}

/// Functions of the layout that this device has not, as the end of a line.
fn missing(pad: &Pad, layout: &Joystick) -> String {
    let has = |controls: &[Control]| controls.iter().any(|control| pad.has(control));
    let names = |controls: &[Control]| controls.iter().map(|c| c.name).collect::<Vec<_>>().join(", ");
    let sticks = config::joystick::STICKS
        .iter()
        .zip(&layout.sticks)
        .map(|(name, stick)| (*name, std::slice::from_ref(&stick.control)));
    let buttons = ButtonFunction::ALL.iter().map(|f| (f.name(), layout.button(*f)));
    let lost: Vec<String> = sticks
        .chain(buttons)
        .filter(|(_, controls)| !has(controls))
        .map(|(name, controls)| format!("{name} ({})", names(controls)))
        .collect();
    match lost.is_empty() {
        true => String::new(),
        false => format!("; it has no {}: give them others in joystick.toml, or with --map", lost.join(", ")),
    }
}

/// Passes on what hands do, until nobody listens.
///
/// # Errors
/// The device is gone.
fn listen(
    events: &mut Events,
    pad: &mut Pad,
    layout: &Joystick,
    news: &Sender<PadNews>,
    stops: &Sender<()>,
) -> io::Result<()> {
    let mut before = pad.hands(layout);
    if news.send(PadNews::Hands(before, Vec::new(), now())).is_err() {
        return Ok(());
    }
    // A change is told; false: nobody listens.
    let mut tell = |hands: Hands| {
        let new = |f: &ButtonFunction| hands.held[*f as usize] && !before.held[*f as usize];
        let pressed: Vec<ButtonFunction> = ButtonFunction::ALL.into_iter().filter(new).collect();
        // First of all, and past everything that may wait for something.
        if pressed.contains(&ButtonFunction::EmergencyStop) {
            let _ = stops.send(());
        }
        let changed = hands != before;
        before = hands;
        !changed || news.send(PadNews::Hands(hands, pressed, now())).is_ok()
    };
    loop {
        let mut heard = true;
        // Report by report: a button that was tapped is up again in the last one.
        events.some(&mut |kind, code, value| match kind {
            EV_SYN => heard &= tell(pad.hands(layout)),
            _ => pad.take(kind, code, value),
        })?;
        if !heard {
            return Ok(());
        }
    }
}

impl Events {
    /// Waits for one report at least, and hands out its events: type, code, value.
    ///
    /// # Errors
    /// The device is gone.
    fn some(&mut self, take: &mut dyn FnMut(u16, u16, i32)) -> io::Result<()> {
        match self {
            // After events that were lost, the crate asks for the present state and tells it as events.
            Self::Device(device) => {
                device
                    .fetch_events()?
                    .for_each(|event| take(event.event_type().0, event.code(), event.value()));
                Ok(())
            }
            Self::Recorded(file) => loop {
                let mut bytes = [0; EVENT];
                file.read_exact(&mut bytes)?;
                let [.., a, b, c, d, e, f, g, h] = bytes;
                let (kind, code) = (u16::from_ne_bytes([a, b]), u16::from_ne_bytes([c, d]));
                take(kind, code, i32::from_ne_bytes([e, f, g, h]));
                if kind == EV_SYN {
                    return Ok(());
                }
            },
        }
    }
}
