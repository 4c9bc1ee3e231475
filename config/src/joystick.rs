//! Layout of a gamepad: what its sticks and buttons command, `joystick.toml`. One file for `gangwerk joystick` and the page.

use std::path::Path;

use crate::error::ConfigError;
use crate::file::{self, ConfigReader};
use crate::section::{self, Section, listed};

/// Name of the file in a configuration directory.
pub const FILE: &str = "joystick.toml";
/// The shipped layout, for configurations that have none.
const SHIPPED: &str = include_str!("../joystick.toml");
/// Most names for one function.
const MOST: usize = 4;

/// A button or axis by the kernel's name for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Control {
    /// As in `linux/input-event-codes.h`.
    pub name: &'static str,
    /// Code of the event.
    pub code: u16,
    /// Axis (EV_ABS), or button (EV_KEY).
    pub is_axis: bool,
}

/// A stick's axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stick {
    /// Which axis.
    pub control: Control,
    /// Direction: true if its lower end is the greatest command.
    pub reverse: bool,
    /// \[1\] Share of the gait's range that its end commands, 0 to 1.
    pub share: f64,
}

/// Function of a button.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ButtonFunction {
    /// She moves only while it is held.
    DeadMan,
    /// Motors off, latched.
    EmergencyStop,
    /// Come to a stand.
    Stop,
    /// Walk on the spot.
    Walk,
    /// Take the walking pose.
    Stand,
    /// Do the next step of the start-up.
    Next,
}

impl ButtonFunction {
    /// All, in the order of their keys in the file.
    pub const ALL: [Self; 6] =
        [Self::DeadMan, Self::EmergencyStop, Self::Stop, Self::Walk, Self::Stand, Self::Next];

    /// Key in the file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::DeadMan => "dead_man",
            Self::EmergencyStop => "emergency_stop",
            Self::Stop => "stop",
            Self::Walk => "walk",
            Self::Stand => "stand",
            Self::Next => "next",
        }
    }
}

/// Names of the sticks' tables, in the order of [`Joystick::sticks`].
pub const STICKS: [&str; 3] = ["forward", "left", "turn"];

/// `joystick.toml`.
#[derive(Clone, Debug, PartialEq)]
pub struct Joystick {
    /// \[1\] Share of a stick's way around its centre that commands nothing.
    pub dead_zone: f64,
    /// Axes of forward, left and turn.
    pub sticks: [Stick; 3],
    /// Controls of each function, in the order of [`ButtonFunction::ALL`]; any of them does it.
    pub buttons: [Vec<Control>; 6],
}

impl Joystick {
    /// Reads a layout file.
    ///
    /// # Errors
    /// Mistakes in it: key, value, what it takes.
    pub fn load(path: &Path) -> Result<Self, ConfigError> {
        let text = file::text(path, &mut ConfigReader::default())?;
        section::read(path, &text, Self::build)
    }

    /// Layout of the configuration directory `root`; the shipped one if it has none.
    ///
    /// # Errors
    /// Mistakes in it.
    pub fn of_config(root: &Path) -> Result<Self, ConfigError> {
        let path = root.join(FILE);
        if file::exists(&path) { Self::load(&path) } else { section::read(&path, SHIPPED, Self::build) }
    }

    /// Controls of a function.
    pub fn button(&self, function: ButtonFunction) -> &[Control] {
        &self.buttons[function as usize]
    }

    fn build(top: &Section<'_, '_>) -> Self {
        let dead_zone = top.number("dead_zone", "", 0.0..=0.9);
        let sticks = STICKS.map(|name| top.table(name, Stick::build).unwrap_or(Stick::NONE));
        let buttons = top
            .table("buttons", |table| ButtonFunction::ALL.map(|function| controls(table, function.name())));
        let joystick = Self { dead_zone, sticks, buttons: buttons.unwrap_or_default() };
        if top.is_sound() {
            joystick.check(top);
        }
        joystick
    }

    /// No control has two functions.
    fn check(&self, top: &Section<'_, '_>) {
        let sticks = STICKS.iter().zip(&self.sticks).map(|(name, stick)| (*name, "", stick.control));
        let functions = ButtonFunction::ALL.iter().zip(&self.buttons);
        let buttons = functions.flat_map(|(f, all)| all.iter().map(move |c| ("buttons", f.name(), *c)));
        let all: Vec<(&str, &str, Control)> = sticks.chain(buttons).collect();
        for (i, (table, key, control)) in all.iter().enumerate() {
            let same = |other: &Control| (other.code, other.is_axis) == (control.code, control.is_axis);
            if let Some((first, at, other)) = all[..i].iter().find(|(.., other)| same(other)) {
                let place = |table: &str, key: &str| {
                    if key.is_empty() { table.to_owned() } else { format!("{table}.{key}") }
                };
                let (here, there, name) = (place(table, key), place(first, at), control.name);
                let also =
                    if other.name == name { String::new() } else { format!(" (there as {})", other.name) };
                top.problem(
                    table,
                    format!("{here}: {name} is that of {there} already{also}; give each its own"),
                );
            }
        }
    }
}

impl Stick {
    /// A stand-in for a table that is missing.
    const NONE: Self = Self { control: CONTROLS[0], reverse: false, share: f64::NAN };

    fn build(table: &Section<'_, '_>) -> Self {
        let axes: Vec<&str> = CONTROLS.iter().filter(|c| c.is_axis).map(|c| c.name).collect();
        let name = axes[table.word("axis", &axes)];
        Self {
            control: find(name).unwrap_or(CONTROLS[0]),
            reverse: table.flag("reverse"),
            share: table.number("share", "", 0.01..=1.0),
        }
    }
}

fn controls(table: &Section<'_, '_>, key: &str) -> Vec<Control> {
    let names = table.texts(key);
    if names.len() > MOST {
        table.problem(key, format!("has {} names; it takes 1 to {MOST}", names.len()));
    }
    let known = |name: &String| {
        let found = find(name);
        // What is no string has been named.
        if found.is_none() && !name.is_empty() {
            let all: Vec<&str> = CONTROLS.iter().map(|c| c.name).collect();
            table.problem(
                key,
                messages::unknown("control", name, &all, &format!("it takes {}", listed(&all))),
            );
        }
        found
    };
    names.iter().filter_map(known).collect()
}

fn find(name: &str) -> Option<Control> {
    CONTROLS.iter().find(|control| control.name == name).copied()
}

const fn axis(name: &'static str, code: u16) -> Control {
    Control { name, code, is_axis: true }
}

const fn button(name: &'static str, code: u16) -> Control {
    Control { name, code, is_axis: false }
}

/// Controls that a layout may name: sticks, triggers, hats and pedals; buttons of gamepads and of joysticks.
#[rustfmt::skip]
pub const CONTROLS: [Control; 55] = [
    axis("ABS_X", 0x00), axis("ABS_Y", 0x01), axis("ABS_Z", 0x02), axis("ABS_RX", 0x03), axis("ABS_RY", 0x04), axis("ABS_RZ", 0x05),
    axis("ABS_THROTTLE", 0x06), axis("ABS_RUDDER", 0x07), axis("ABS_WHEEL", 0x08), axis("ABS_GAS", 0x09), axis("ABS_BRAKE", 0x0a),
    axis("ABS_HAT0X", 0x10), axis("ABS_HAT0Y", 0x11), axis("ABS_HAT1X", 0x12), axis("ABS_HAT1Y", 0x13), axis("ABS_HAT2X", 0x14),
    axis("ABS_HAT2Y", 0x15), axis("ABS_HAT3X", 0x16), axis("ABS_HAT3Y", 0x17),
    button("BTN_TRIGGER", 0x120), button("BTN_THUMB", 0x121), button("BTN_THUMB2", 0x122), button("BTN_TOP", 0x123),
    button("BTN_TOP2", 0x124), button("BTN_PINKIE", 0x125), button("BTN_BASE", 0x126), button("BTN_BASE2", 0x127),
    button("BTN_BASE3", 0x128), button("BTN_BASE4", 0x129), button("BTN_BASE5", 0x12a), button("BTN_BASE6", 0x12b),
    button("BTN_SOUTH", 0x130), button("BTN_EAST", 0x131), button("BTN_C", 0x132), button("BTN_NORTH", 0x133),
    button("BTN_WEST", 0x134), button("BTN_Z", 0x135), button("BTN_TL", 0x136), button("BTN_TR", 0x137), button("BTN_TL2", 0x138),
    button("BTN_TR2", 0x139), button("BTN_SELECT", 0x13a), button("BTN_START", 0x13b), button("BTN_MODE", 0x13c),
    button("BTN_THUMBL", 0x13d), button("BTN_THUMBR", 0x13e),
    button("BTN_DPAD_UP", 0x220), button("BTN_DPAD_DOWN", 0x221), button("BTN_DPAD_LEFT", 0x222), button("BTN_DPAD_RIGHT", 0x223),
    // The kernel's other names for four of them.
    button("BTN_A", 0x130), button("BTN_B", 0x131), button("BTN_X", 0x133), button("BTN_Y", 0x134), button("BTN_GAMEPAD", 0x130),
];

#[cfg(test)]
mod tests {
    use super::*;

    fn problems(text: &str) -> Vec<String> {
        let error = section::read(Path::new("map.toml"), text, Joystick::build).unwrap_err();
        error.to_string().lines().map(str::to_owned).collect()
    }

    #[test]
    fn the_shipped_layout_is_read_and_taken_where_there_is_none() {
        let shipped = Joystick::of_config(&crate::root(None)).unwrap();
        assert_eq!(Joystick::of_config(Path::new("/nowhere")).unwrap(), shipped);
        let names = |function| shipped.button(function).iter().map(|c| c.name).collect::<Vec<_>>();
        assert_eq!(names(ButtonFunction::DeadMan), ["BTN_TL"]);
        assert_eq!(names(ButtonFunction::Stop), ["BTN_WEST", "BTN_NORTH"]);
        assert_eq!(shipped.sticks[2].control.name, "ABS_RX");
    }

    /// Each mistake is refused with key, value and what is taken.
    #[test]
    fn what_is_wrong_is_named() {
        for (from, to, named) in [
            ("dead_zone = 0.12", "dead_zone = 1.0", ["dead_zone", "1 is not allowed", "from 0 to 0.9"]),
            ("dead_zone = 0.12", "dead_zone = nan", ["dead_zone", "NaN is not allowed", "from 0 to 0.9"]),
            ("axis = \"ABS_Y\"", "axis = \"ABS_YY\"", ["forward.axis", "`ABS_YY`", "ABS_RX"]),
            ("axis = \"ABS_Y\"", "axis = \"ABS_X\"", ["left", "ABS_X is that of forward", "its own"]),
            ("share = 1.0", "share = 1.5", ["share", "1.5 is not allowed", "from 0.01 to 1"]),
            ("reverse = true", "reverse = 1", ["forward.reverse", "integer", "true or false"]),
            ("[\"BTN_TL\"]", "[]", ["buttons.dead_man", "is empty", "a list of strings"]),
            ("[\"BTN_TL\"]", "[\"BTN_TLL\"]", ["buttons.dead_man", "BTN_TLL", "BTN_TL"]),
            ("[\"BTN_TL\"]", "[\"BTN_B\"]", ["buttons", "BTN_EAST", "there as BTN_B"]),
            ("dead_man", "deadman", ["buttons.deadman", "unknown key", "dead_man"]),
            ("[turn]", "[turns]", ["turn", "missing", "a table"]),
        ] {
            assert!(SHIPPED.contains(from), "{from}");
            let text = problems(&SHIPPED.replacen(from, to, 1)).join("\n");
            assert!(
                text.starts_with("map.toml: ") && named.iter().all(|word| text.contains(word)),
                "{to}: {text}"
            );
        }
        // A list that is too long.
        let five = problems(
            &SHIPPED.replace("[\"BTN_TL\"]", "[\"BTN_TL\", \"BTN_TR\", \"BTN_Z\", \"BTN_C\", \"BTN_MODE\"]"),
        );
        assert!(five[0].contains("buttons.dead_man: has 5 names; it takes 1 to 4"), "{five:?}");
    }
}
