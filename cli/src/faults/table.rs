//! The faults, one row each: what is done, what is expected, and for those that no running robot can be given, what bounds them.

/// Procedure of a fault.
#[derive(Clone, Copy, Debug)]
pub enum Proof {
    /// At a running robot: by the scenario that names it.
    Tried,
    /// Not at a running robot: why not, and what bounds it instead.
    Bounded(&'static str),
}

/// One fault.
#[derive(Clone, Copy, Debug)]
pub struct Fault {
    /// Number, as `F3`.
    pub id: &'static str,
    /// Fault injected into the robot.
    pub name: &'static str,
    /// Expected behaviour.
    pub expected: &'static str,
    /// Evidence.
    pub proof: Proof,
}

const fn tried(id: &'static str, name: &'static str, expected: &'static str) -> Fault {
    Fault { id, name, expected, proof: Proof::Tried }
}

const fn bounded(id: &'static str, name: &'static str, expected: &'static str, why: &'static str) -> Fault {
    Fault { id, name, expected, proof: Proof::Bounded(why) }
}

/// All of them, in the order of their numbers.
pub const FAULTS: [Fault; 40] = [
    tried("F1", "planner killed", "`PlannerSilent`; the plan is walked to its end, standing, supply on"),
    tried("F2", "controller killed", "targets carried on, then controlled stop; joints at rest, supply on"),
    tried("F3", "joint loop killed", "watchdog cuts the supply"),
    tried("F4", "watchdog killed", "relay falls: its toggle stands still"),
    tried("F5", "broker killed", "walks on; another broker answers commands"),
    tried("F6", "logger killed", "walks on; another logger writes"),
    tried(
        "F7",
        "watchdog stopped for longer than the relay bears",
        "relay falls, and stays off until reset and enable",
    ),
    tried("F8", "planner hangs for ever", "named and killed by the supervisor; exit code 1"),
    bounded(
        "F9",
        "death inside a write to shared memory",
        "no torn record; another writer takes over",
        "the instant cannot be chosen from outside; writers die at random ones in `crates/ipc/tests/killed.rs`",
    ),
    tried("F10", "20 observers killed while they read", "walks on; the next one reads"),
    tried("F11", "observer stopped while it reads", "walks on, no cycle of the joint loop late"),
    tried("F12", "flood of connections and commands", "walks on; an operator is answered"),
    tried("F13", "garbage on the TCP port", "that connection is closed; walks on"),
    tried("F14", "100 connections that say nothing", "an operator is answered within 1 s"),
    tried("F15", "line of a knee shorted", "`BusOff`, supply cut"),
    tried("F16", "every tenth frame lost", "`FramesLost`; walks on"),
    tried("F17", "a tenth of all frames one cycle late, all twice", "refused, `FrameRefused`; walks on"),
    bounded(
        "F18",
        "wall clock set while walking",
        "nothing",
        "it is the whole machine's; only the supervisor reads it, to date logs and crash records (`crates/realtime/src/clock.rs`)",
    ),
    tried("F19", "machine up for 9.5 years", "stands up as ever"),
    tried("F20", "command that is no number", "refused with exit code 1; walks on"),
    tried("F21", "command out of range", "refused with exit code 1; walks on"),
    tried("F22", "unknown key in a gait file", "refuses to start"),
    tried("F23", "disk of the log full", "the robot does not notice; exit code 1"),
    tried("F24", "shared memory full at the start", "refuses to start: exit code 1, no signal"),
    tried("F25", "start after a run that was killed", "starts, ends with exit code 0, leaves nothing"),
    tried("F26", "second instance in the same place", "refused with exit code 1; the first walks on"),
    bounded(
        "F27",
        "process of another build",
        "refused",
        "needs another build; each topic's layout hash is compared, `crates/ipc/src/slot.rs`",
    ),
    tried("F28", "process dies while the run starts", "exit code 1; the supply was never on"),
    tried("F29", "emergency stop taken back by an enable alone", "off; on again by reset and enable only"),
    tried("F30", "emergency stop under a flood of connections", "answered; supply off"),
    tried(
        "F31",
        "operator killed while his walk goes on",
        "`LeaseLost`; the robot comes to a stand, supply on",
    ),
    bounded(
        "F32",
        "wrong targets from a camera over UDP",
        "refused",
        "not in these runs, which have no gateway: `tests/commands/gateway.rs` sends it wrong, old and doubled datagrams",
    ),
    tried("F33", "spinner at the joint loop's priority on its core for 100 ms", "stop or supply off"),
    tried("F34", "16 file descriptors", "refuses to start: exit code 1"),
    tried("F35", "no right to real time or locked memory", "runs, and says that it is degraded"),
    tried("F36", "SIGABRT in the planner", "as F1; the run ends with exit code 1 and keeps a crash record"),
    tried("F37", "supervisor killed", "all processes end, the supply goes off"),
    tried(
        "F38",
        "broker dies as often as it is started",
        "later and later started, the last one answers; walks on",
    ),
    tried("F39", "simulated robot dies in lockstep", "the run ends with exit code 1"),
    tried("F40", "SIGINT, SIGTERM, SIGHUP while walking", "stands, then the end; nothing left behind"),
];
