//! Rows `[[bus_fault]]` of a scene: what they take, and what a person reads who made a mistake.

use std::fs;
use std::path::PathBuf;

use config::bus_fault::{BusFault, FaultKind, FrameDirection};
use config::{ConfigError, Setup};

/// The shipped configuration with one scene of its own; gone when dropped.
struct Site(PathBuf);

impl Site {
    fn new(test: &str, rows: &str) -> Self {
        let to = std::env::temp_dir().join(format!("gangwerk-bus-faults-{test}-{}", std::process::id()));
        let shipped = config::root(None);
        fs::create_dir_all(to.join("scenes")).unwrap();
        for name in ["robots", "gaits", "system.toml"] {
            std::os::unix::fs::symlink(shipped.join(name), to.join(name)).unwrap();
        }
        let stand = fs::read_to_string(shipped.join("scenes/stand.toml")).unwrap();
        fs::write(to.join("scenes/faults.toml"), stand + rows).unwrap();
        Self(to)
    }

    fn load(&self) -> Result<Setup, ConfigError> {
        Setup::load(&self.0, "faults")
    }

    /// The error without its directory and line numbers.
    fn problems(&self) -> Vec<String> {
        let problems = self.load().unwrap_err().problems;
        problems.iter().map(|p| format!("{}: {}", p.key, p.text)).collect()
    }
}

impl Drop for Site {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn what_is_not_said_is_all_lines_both_ways_every_frame_to_the_end() {
    let rows = "
[[bus_fault]]
time = 1.0
kind = \"lost\"
[[bus_fault]]
time = 2.0
duration = 0.5
kind = \"late\"
node = \"shank_left\"
direction = \"from_drives\"
share = 0.25
cycles = 3
";
    let faults = Site::new("defaults", rows).load().unwrap().scene.bus_faults;
    let all = BusFault::new(FaultKind::Lost, 1.0, f64::INFINITY);
    let some = BusFault {
        node: Some("shank_left".into()),
        way: Some(FrameDirection::FromDrives),
        share: 0.25,
        cycles: 3,
        ..BusFault::new(FaultKind::Late, 2.0, 0.5)
    };
    assert_eq!(faults, [all, some]);
}

#[test]
fn every_mistake_is_named() {
    let rows = "
[[bus_fault]]
time = 1.0
kind = \"lots\"
[[bus_fault]]
time = 2.0
kind = \"silent\"
share = 0.5
[[bus_fault]]
time = 3.0
kind = \"late\"
[[bus_fault]]
time = 2.5
kind = \"flipped\"
share = 1.5
cycles = 2
durations = 1.0
";
    let wanted = [
        "bus_fault[0].kind: `lots` is not known; it takes one of `lost`, `late`, `duplicated`, `reordered`, `corrupted`, \
         `flipped`, `silent`, `pulled`, `shorted`",
        "bus_fault[1].share: `silent` is of a whole line, always; leave it out",
        "bus_fault[2].cycles: missing; it takes a whole number from 1 to 100",
        "share: 1.5 is not allowed; it takes a number from 0 to 1",
        "bus_fault[3].cycles: only `lost`, `late` and `duplicated` have it; leave it out",
        "bus_fault[3].durations: unknown key; the nearest known one is `duration`",
        "bus_fault: bus_fault[3]: its time 2.5 s lies before 3 s of the one above it",
    ];
    let problems = Site::new("mistakes", rows).problems();
    for line in wanted {
        assert!(problems.iter().any(|p| p.ends_with(line)), "{line}\nnot in {problems:#?}");
    }
    assert_eq!(problems.len(), wanted.len(), "{problems:#?}");
}

#[test]
fn a_node_that_the_robot_does_not_have() {
    let rows = "\n[[bus_fault]]\ntime = 1.0\nkind = \"pulled\"\nnode = \"shank_lift\"\n";
    assert_eq!(
        Site::new("node", rows).problems(),
        ["bus_fault[0].node: robot lola has no local controller `shank_lift`; the nearest is `shank_left`"]
    );
}
