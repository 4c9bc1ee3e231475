//! Search for the gamepad among the kernel's input devices, by what `/sys/class/input` tells everybody about them: a device that
//! this user may not open is named, too.

use std::fmt;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Folder of the kernel's input devices, and of their nodes.
pub const SYS: &str = "/sys/class/input";
/// Nodes of them.
pub const DEV: &str = "/dev/input";

/// Axes of a stick: ABS_X and ABS_Y.
const STICK: [u32; 2] = [0, 1];
/// Buttons of joysticks and gamepads: BTN_JOYSTICK to BTN_THUMBR. Mice, touchpads and pens have none of them.
const BUTTONS: std::ops::RangeInclusive<u32> = 0x120..=0x13e;

/// A device with a stick and buttons.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Gamepad {
    /// Its name, as its driver tells it.
    pub name: String,
    /// Its node.
    pub node: PathBuf,
}

impl fmt::Display for Gamepad {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({})", self.name, self.node.display())
    }
}

/// Gamepads of this machine, in the order of their numbers: their descriptions are in `sys`, their nodes in `dev`.
pub fn gamepads(sys: &Path, dev: &Path) -> Vec<Gamepad> {
    let read = |path: PathBuf| fs::read_to_string(path).unwrap_or_default();
    let mut found = Vec::new();
    for entry in fs::read_dir(sys).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let Some(number) = name.to_str().and_then(|name| name.strip_prefix("event")?.parse::<u32>().ok())
        else {
            continue;
        };
        let device = entry.path().join("device");
        let (axes, keys) = (read(device.join("capabilities/abs")), read(device.join("capabilities/key")));
        if STICK.iter().all(|&bit| has(&axes, bit)) && BUTTONS.clone().any(|bit| has(&keys, bit)) {
            found.push((
                number,
                Gamepad { name: read(device.join("name")).trim().to_owned(), node: dev.join(&name) },
            ));
        }
    }
    found.sort_by_key(|(number, _)| *number);
    found.into_iter().map(|(_, gamepad)| gamepad).collect()
}

/// Bit of a bitmap of sysfs: words of a `long` in hexadecimal, the lowest one last.
fn has(bitmap: &str, bit: u32) -> bool {
    let word = bitmap.split_whitespace().rev().nth((bit / usize::BITS) as usize);
    word.and_then(|word| u64::from_str_radix(word, 16).ok())
        .is_some_and(|word| word >> (bit % usize::BITS) & 1 == 1)
}

/// The one gamepad among `found`.
///
/// # Errors
/// There is none, or there are several: what to do.
pub fn only(mut found: Vec<Gamepad>) -> Result<Gamepad, String> {
    match found.len() {
        0 => Err("no gamepad is plugged in: none of /dev/input/event* has sticks and buttons; plug one in or pair it, and name it with \
                  --device /dev/input/eventN if it is another kind of device (its user must be in the group `input`)"
            .into()),
        1 => Ok(found.remove(0)),
        _ => {
            let all: Vec<String> = found.iter().map(|pad| format!("\n  --device {}  {}", pad.node.display(), pad.name)).collect();
            Err(format!("{} gamepads are plugged in; choose one:{}", found.len(), all.concat()))
        }
    }
}

/// Why a device cannot be opened, and what to do.
pub fn unopened(gamepad: &Gamepad, e: &std::io::Error) -> String {
    let advice = match e.kind() {
        ErrorKind::PermissionDenied => {
            "; this user may not read it: `sudo usermod -aG input $USER`, then log in again".to_owned()
        }
        ErrorKind::NotFound => "; is it plugged in? Without --device it is searched for".to_owned(),
        _ => "; a device of /dev/input/event* is needed".to_owned(),
    };
    format!("gamepad {gamepad}: cannot be opened: {e}{advice}")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A device's folder as sysfs has it.
    fn device(sys: &Path, event: &str, name: &str, abs: &str, key: &str) {
        let folder = sys.join(event).join("device");
        fs::create_dir_all(folder.join("capabilities")).unwrap();
        for (file, text) in [("name", name), ("capabilities/abs", abs), ("capabilities/key", key)] {
            fs::write(folder.join(file), format!("{text}\n")).unwrap();
        }
    }

    /// Bitmaps as a kernel with 64 bits wrote them: keyboard, mouse, touchpad and motion sensors are none.
    #[test]
    fn sticks_and_buttons_make_a_gamepad() {
        let sys = std::env::temp_dir().join(format!("gangwerk-input-{}", std::process::id()));
        let _ = fs::remove_dir_all(&sys);
        let search = || gamepads(&sys, Path::new(DEV));
        assert!(only(search()).unwrap_err().contains("group `input`"), "no such folder");
        device(
            &sys,
            "event0",
            "AT keyboard",
            "0",
            "402000000 3803078f800d001 feffffdfffefffff fffffffffffffffe",
        );
        device(&sys, "event1", "Mouse", "0", "70000 0 0 0 0");
        device(&sys, "event2", "Touchpad", "260800000000003", "e520 10000 0 0 0 0");
        device(&sys, "event3", "Wireless Controller Motion Sensors", "3f", "0");
        device(&sys, "mouse0", "Mouse", "3", "7fdb000000000000 0 0 0 0");
        assert!(only(search()).unwrap_err().starts_with("no gamepad is plugged in"));
        device(&sys, "event12", "Wireless Controller", "3003f", "7fdb000000000000 0 0 0 0");
        let pad = only(search()).unwrap();
        assert_eq!(pad.to_string(), "Wireless Controller (/dev/input/event12)");
        // With a second one somebody has to choose.
        device(&sys, "event5", "Xbox Wireless Controller", "3003f", "7cdb000000000000 0 0 0 0");
        let error = only(search()).unwrap_err();
        let lines = [
            "2 gamepads are plugged in; choose one:",
            "--device /dev/input/event5  Xbox",
            "--device /dev/input/event12  Wire",
        ];
        assert!(
            error.lines().count() == 3 && error.lines().zip(lines).all(|(a, b)| a.contains(b)),
            "{error}"
        );
        fs::remove_dir_all(&sys).unwrap();
        let refused = |kind: ErrorKind| unopened(&pad, &kind.into());
        assert!(refused(ErrorKind::PermissionDenied).contains("usermod -aG input"));
        assert!(refused(ErrorKind::NotFound).contains("plugged in?"));
    }
}
