//! Scenes of a robot under fault.

/// Lola stands up, walks, and walks on until somebody stops her.
pub(super) const WALK: &str = "
[[command]]
time = 0.2
topic = \"walk/stand\"
[[command]]
time = 2.2
topic = \"walk/velocity\"
forward = 0.278
";

/// Lola stands up and waits.
pub(super) const WAIT: &str = "
[[command]]
time = 0.2
topic = \"walk/stand\"
";

/// [`WALK`] with three faults of the bus, each from its time on \[s\]: F16, F17, F15.
pub(super) fn bus([lost, late, shorted]: [f64; 3]) -> String {
    let fault = |kind: &str, time: f64, seconds: f64, more: &str| {
        format!("[[bus_fault]]\nkind = \"{kind}\"\ntime = {time:?}\nduration = {seconds:?}\n{more}\n")
    };
    [
        WALK.to_owned(),
        fault("lost", lost, 1.0, "share = 0.1"),
        fault("late", late, 1.0, "share = 0.1\ncycles = 1"),
        fault("duplicated", late, 1.0, "cycles = 0"),
        fault("shorted", shorted, 100.0, "node = \"shank_left\""),
    ]
    .concat()
}
