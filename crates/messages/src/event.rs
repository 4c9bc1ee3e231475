//! `events/PROCESS`: what happened, for the log.

use crate::event_detail::{Detail, DetailKind};
use crate::{Header, record};

macro_rules! events {
    ($($(#[$doc:meta])* $name:ident = $number:literal, $kind:ident, $what:literal, $detail:literal, $advice:literal;)*) => {
        /// Kind of event. Numbers are part of the log format: append only.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[repr(u64)]
        pub enum EventCode { $($(#[$doc])* $name = $number,)* }

        impl EventCode {
            /// All codes, in order of their numbers.
            pub const ALL: [Self; [$($number),*].len()] = [$(Self::$name),*];

            /// Kind of its detail.
            pub(crate) const fn kind(self) -> DetailKind {
                match self { $(Self::$name => DetailKind::$kind,)* }
            }

            /// Words for people: what happened, what the detail says, what to do. See [`Words`](crate::event_words::Words).
            pub const fn words(self) -> [&'static str; 3] {
                match self { $(Self::$name => [$what, $detail, $advice],)* }
            }
        }
    };
}

// Code and number, kind of its detail (`event_detail.rs`), what happened, what its detail says, what to do. Words in braces
// are those of `event_words.rs`.
events! {
    /// Nothing.
    None = 0, Nothing, "nothing", "", "";
    /// A process armed and began its cycles; detail: 0.
    Started = 1, Nothing, "ready", "", "";
    /// A process ended as asked.
    Ended = 2, Nothing, "ended as asked", "", "";
    /// Motor supply switched on.
    PowerOn = 3, Nothing, "motor supply on", "", "";
    /// Motor supply switched off; detail: the code of the reason.
    PowerOff = 4, Cause, "motor supply off", "{event}",
        "system/reset, then system/enable switch it on again";
    /// The joint loop did not reset the watchdog in time; detail: cycles missed.
    ResetMissed = 5, Cycles, "the joint loop was too late for the watchdog", "{n} cycles",
        "`gangwerk doctor` says what keeps this machine from real time; `--lockstep` needs none";
    /// Joint targets are too old; detail: age in cycles.
    TargetsStale = 6, Cycles, "joint targets are too old", "{n} cycles",
        "the stabilizer is late or gone";
    /// A target was not finite; detail: joint index.
    TargetNotFinite = 7, Joint, "a joint target is not a number; controlled stop", "{joint}",
        "`gangwerk replay` of the log shows where it comes from";
    /// A target left its range, or asked for more speed or acceleration than the joint has, and was held back; detail: joint
    /// index.
    TargetLimited = 8, Joint, "a joint target was held back to what the joint may do", "{joint}", "";
    /// A joint did not follow its target; detail: joint index.
    FollowingError = 9, Joint, "a joint did not follow its target", "{joint}",
        "look for something in its way, a weak drive, or too fast a walk";
    /// Bus frames are missing; detail: age in cycles.
    BusSilent = 10, Cycles, "nothing comes from the field bus", "for {n} cycles",
        "check cables and the supply of the drives";
    /// A cycle overran; detail: periods skipped.
    Overrun = 11, Count, "a cycle ended too late", "{n} periods skipped",
        "`gangwerk doctor` says what keeps this machine from real time; `--lockstep` needs none";
    /// Too many overruns: controlled stop.
    TooManyOverruns = 12, Nothing, "too many late cycles in a short time", "",
        "`gangwerk doctor` says what keeps this machine from real time; `--lockstep` needs none";
    /// The planner fell silent: the running plan is walked to its end.
    PlannerSilent = 13, Nothing, "the planner is silent; its last plan is walked to its end", "", "";
    /// A plan was refused; detail: the plan's id.
    PlanRefused = 14, Plan, "a plan was refused", "plan {n}", "the one before it goes on";
    /// A command was refused; detail: its message id.
    CommandRefused = 15, Message, "a command was refused", "", "its sender was told why; `gangwerk log show` names both";
    /// The robot has fallen.
    Fallen = 16, Nothing, "the robot has fallen", "",
        "what led to it stands above; `gangwerk plot` draws it";
    /// Both feet are off the ground while they should carry.
    Lifted = 17, Nothing, "both feet are off the ground while they should carry", "",
        "put the robot down; then system/reset, system/enable";
    /// Somebody asked for the emergency stop on its own line; detail: user id << 32 | process id, zeros if unknown.
    EmergencyStop = 18, Caller, "emergency stop", "{who}",
        "make the robot safe; then system/reset, system/enable";
    /// The watchdog missed cycles of its own, for so long that the supply's relay fell.
    WatchdogSilent = 19, Nothing, "the watchdog itself was too late, and the relay of the supply fell", "",
        "`gangwerk doctor` says what keeps this machine from real time; `--lockstep` needs none";
    /// Inverse kinematics or force control met a singularity or limit; detail: which.
    ControlLimited = 20, Limit, "the stabilizer meets a limit", "{limit}",
        "once in a while is normal; walk slower if it goes on";
    /// A controlled stop began; detail: the code of the reason.
    SafeStop = 21, Cause, "controlled stop", "{event}",
        "secure the robot; then system/emergency_stop, system/reset, system/enable";
    /// The controller switched to a plan; detail: its id.
    PlanActive = 22, Plan, "a plan begins", "plan {n}", "";
    /// Records were overwritten before the logger read them; detail: how many.
    LogDropped = 23, Count, "records are missing from the log", "{n}",
        "its disk is too slow: another one with --out";
    /// Messages of the command plane were lost by clients that did not keep up; detail: how many since the last time.
    MessagesLost = 24, Count, "clients of the broker did not keep up", "{n} messages lost", "";
    /// A sensor value is not finite; the last good ones are used, then a stop.
    SensorNotFinite = 25, Count, "a sensor reading is not a number; the last good ones are used, then a stop", "",
        "check the sensors and their cables";
    /// A parameter got another value; detail: its number.
    ParameterSet = 26, Number, "a parameter was set", "number {n} of its process",
        "`gangwerk param list` shows all";
    /// A simulated drive left what its model holds for; detail: its number. Its gear and friction stay as they were.
    DriveFault = 27, Number, "a simulated drive left what its model holds for", "drive {n}",
        "gear and friction stay as they were";
    /// Contact forces of the simulated soles were not found to their tolerance; detail: sweeps.
    ContactNotConverged = 28, Count, "contact forces of the simulated soles were not found to their tolerance", "{n} sweeps",
        "more substeps in the scene";
    /// An object of the scene cannot do what its schedule says, because the robot touches it; detail: its number.
    ObjectHeld = 29, Number, "an object of the scene waits, because the robot touches it", "object {n}", "";
    /// An object of the scene goes on with its schedule; detail: its number.
    ObjectResumed = 30, Number, "an object of the scene goes on with its schedule", "object {n}", "";
    /// The simulation lost its numbers: a state is not finite. The robot stays where it was last; detail: the state.
    Diverged = 31, Number, "the simulation lost its numbers; the robot stays where it was last", "state {n}",
        "more substeps, or another integrator in the scene";
    /// A simulated sensor left its range; detail: how many numbers.
    SensorClipped = 32, Count, "a simulated sensor left its range", "{n} numbers", "";
    /// The adaptive integrator met its bounds, as at dry friction; detail: the state that would not settle. The rest of the
    /// cycle was done in one semi-implicit step.
    IntegratorGaveUp = 33, Number, "the adaptive integrator met its bounds; the cycle was done in one semi-implicit step", "state {n}", "";
    /// A command to the camera head was refused: the robot has none, or the angles or the point are none it can take;
    /// detail: the message's id.
    HeadRefused = 34, Message, "a command to the camera head was refused", "{head}",
        "its sender was told why";
    /// The point to look at is out of reach: the head holds as near as it gets; detail: the joint at the end of its
    /// range, or the number of joints if the point is too near to the cameras.
    GazeHeld = 35, Joint, "the point to look at is out of reach; the head holds as near as it gets", "{joint}", "";
    /// The point to look at can be looked at again.
    GazeResumed = 36, Nothing, "the point to look at is in reach again", "", "";
    /// The head jumps to where it is to look; detail: how long it will take \[us\].
    Saccade = 37, Microseconds, "the head jumps to where it is to look", "takes {n} us", "";
    /// No plan from the next step on can be walked as commanded; the active one goes on to its end; detail: its id.
    PlanKept = 38, Plan, "what was commanded cannot be walked from the next step on; the plan goes on to its end", "plan {n}",
        "command less";
    /// Something in the way is higher than the robot steps: it stops before it; detail: height \[mm\].
    ObstacleTooHigh = 39, Millimetres, "something in the way is higher than the robot steps; it stops before it", "{n} mm",
        "lead it around";
    /// Something in the way is longer than a step: the robot stops before it; detail: length \[mm\].
    ObstacleTooLong = 40, Millimetres, "something in the way is longer than a step; the robot stops before it", "{n} mm",
        "lead it around";
    /// A step would end on something or touch it: the robot stops before it; detail: its height, or how far it would go \[mm\].
    NoFoothold = 41, Millimetres, "a step would end on something or touch it; the robot stops before it", "{n} mm",
        "lead it around";
    /// A swing foot met the ground early; the next step begins at once. Detail: the plan's id.
    EarlyContact = 42, Plan, "a swing foot met the ground early; the next step begins at once", "plan {n}", "";
    /// Frames are missing in a cycle; told at the first, second, fourth, eighth ... time; detail: the node.
    FramesLost = 43, Node, "frames are missing on the field bus", "{node}", "check its cable";
    /// A node's frames are missing for so long that its joints are no longer carried on; detail: 1000 times the node plus
    /// the cycles.
    NodeHeld = 44, NodeCycles, "frames are missing for so long that joints are no longer carried on", "{node}, {cycles} cycles",
        "check its cable";
    /// The node is heard again; detail: 1000 times the node plus the cycles it was missing.
    NodeBack = 45, NodeCycles, "a local controller is heard again", "{node}, after {cycles} cycles", "";
    /// A node's frames are missing for too long; detail: 1000 times the node plus the cycles.
    NodeSilent = 46, NodeCycles, "a local controller is silent for too long", "{node}, {cycles} cycles",
        "check its cable and supply";
    /// A frame was refused: late, sent twice, of wrong length, unknown; or a reading that cannot be. Told at the first,
    /// second, fourth ... time; detail: a [`RefusedFrame`](crate::RefusedFrame).
    FrameRefused = 47, Frame, "a frame or a reading was refused", "{refused}", "";
    /// Errors on a line: its controller warns; detail: the line.
    BusWarning = 48, Number, "errors on a line of the field bus", "line {n}",
        "check its cable and termination";
    /// More errors on a line: its controller no longer takes part in the handling of errors; detail: the line.
    BusPassive = 49, Number, "many errors on a line of the field bus; its controller no longer signals them", "line {n}",
        "check its cable and termination";
    /// The controller of a line left the bus; detail: the line.
    BusOff = 50, Number, "the controller of a line left the field bus", "line {n}",
        "look for a short circuit";
    /// The controller of a line takes part again; detail: the line.
    BusActive = 51, Number, "the controller of a line takes part again", "line {n}", "";
    /// A local controller heard no targets for so long that its drives have a fault and bring their joints to rest by
    /// themselves; detail: the node.
    NodeStopped = 52, Node, "a local controller heard no targets; its drives bring their joints to rest by themselves", "{node}",
        "system/reset after the bus is back";
    /// The ring of the field bus is open; detail: address of the station before the gap << 16 | of the one behind it; 0: the
    /// master.
    RingBroken = 53, Stations, "the ring of the field bus is open", "{stations}",
        "the bus goes on over both ends; mend it before a second cable goes";
    /// The ring of the field bus is closed again.
    RingClosed = 54, Nothing, "the ring of the field bus is closed again", "", "";
    /// A drive has a fault of its own: controlled stop, if none was before; detail: joint index + 65536 times its error code.
    DriveTripped = 55, Drive, "a drive has a fault", "{drive}",
        "mend its cause; then system/reset, system/enable";
    /// A drive was not switched on, or is off while the supply is on: nothing is followed; detail: joint index.
    DriveNotEnabled = 56, Joint, "a drive is off while the supply is on; nothing is followed", "{joint}",
        "system/reset, then system/enable";
    /// A joint does not know its angle, so no drive is switched on; detail: joint index.
    NotHomed = 57, Joint, "a joint does not know its angle, so no drive is switched on", "{joint}",
        "gangwerk topic pub joint/home";
    /// All joints know their angles; detail: cycles it took.
    Homed = 58, Cycles, "all joints know their angles", "after {n} cycles", "";
    /// The force sensors read zero from now on; detail: what was taken away at most \[N\].
    ForceZeroed = 59, Newtons, "the force sensors read zero from now on", "{n} N taken away at most", "";
    /// The force sensors cannot be set to zero: the robot does not hang still with its drives on; detail: load on its
    /// feet \[N\].
    ZeroRefused = 60, Newtons, "the force sensors cannot be set to zero, the robot does not hang still with its drives on", "{n} N on its feet",
        "lift it; then joint/zero_force";
    /// A walking command was refused: the robot does not stand on its feet yet; detail: its message id.
    NotStanding = 61, Message, "a walking command was refused, the robot does not stand on its feet yet", "{walk}",
        "system/reset, system/enable, then walk/stand";
    /// A drive that a standing robot can do without has a fault: its joint is held, the robot goes on; detail as of
    /// [`Self::DriveTripped`].
    DriveHeld = 62, Drive, "a drive that a standing robot can do without has a fault; its joint is held", "{drive}",
        "mend its cause at the next stand";
    /// Drives fell out of the operation of the field bus, after a pause of lowlevel: all are started again. That they are
    /// back is told by [`Self::NodeBack`].
    BusRestart = 63, Nothing, "drives fell out of the operation of the field bus; all are started again", "", "";
    /// The supply was measured off while it was to be on: its relay fell, or a fuse or a switch is open.
    SupplyLost = 64, Nothing, "the supply is off while it was to be on", "",
        "look for an open relay, fuse or switch; then system/reset, system/enable";
    /// The walk's operator lost the command lease, by death, silence or a closed link: the robot stops. Detail: the
    /// number of the grant.
    LeaseLost = 65, Number, "who commanded the walk is gone; the robot stops", "grant {n}", "";
    /// More happened in a process than its queue of events had room for; detail: how many are missing.
    EventsLost = 66, Count, "more happened at once than is reported", "{n} events are missing", "";
    /// A simulated speed turns round in every time step: the step is longer than the stable one; detail: the state.
    StepTooLong = 67, Number, "a simulated speed turns round in every time step, which is too long", "state {n}",
        "more substeps in the scene; explicit methods: integrator = \"semi_implicit\"";
    /// The ground pushes with more than a hundred weights of the simulated robot: its numbers say nothing from here on.
    ForceImplausible = 68, Newtons, "the ground pushes with more than a hundred weights of the robot; the simulation has lost its way",
        "{n} N", "more substeps, or another integrator in the scene";
    /// Tables of points were refused, or not taken by the drives: nothing of them is played; detail: which joint, from which
    /// point on, why.
    TablesRefused = 69, Table, "tables of points are not played", "{table}",
        "the log has them as `joint_tables`";
    /// All drives have their tables, checked answer by answer; detail: cycles that it took.
    TablesLoaded = 70, Cycles, "the drives have their tables", "after {n} cycles", "";
    /// The drives began to play tables; detail: the plan's number.
    TablesBegun = 71, Plan, "the drives play their tables", "plan {n}", "";
    /// No change towards what was commanded can be walked from the next step on: the steps stay as they were, out of standing
    /// on the spot. Detail: the plan's id.
    StepsUnchanged = 72, Plan, "no change towards what was commanded can be walked; the steps stay as they were", "plan {n}",
        "command less, or a little at a time";
    /// A foot is put down elsewhere, and earlier, than planned, to catch the body. Detail: the plan's id.
    StepAdapted = 73, Plan, "a foot is put down elsewhere than planned, to catch the body", "plan {n}", "";
    /// The same, but one step will not be enough, or its plan leaves the support. Detail: the plan's id.
    StepStretched = 74, Plan, "a foot is put down as far as it gets, to catch the body; one step may not be enough", "plan {n}", "";
    /// A command was taken, but asks for more than steps can do at once, each number being in its range: its steps are shorter, all
    /// in one proportion. Detail: the steps that are walked.
    CommandShortened = 75, Steps, "a command asks for more at once than can be walked, and its steps are shortened", "now {steps}",
        "less of length, side or turn leaves more for the others";
}

impl EventCode {
    /// The code of a number from a record.
    pub fn from_number(n: u64) -> Option<Self> {
        Self::ALL.get(n as usize).copied()
    }

    /// The detail of an event of this kind, from the number in its record.
    pub fn detail(self, n: u64) -> Detail {
        Detail::unpack(self.kind(), n)
    }
}

record! {
    /// One thing that happened. Written by the process that saw it.
    record Event {
        /// When.
        header: Header,
        /// \[1\] An [`EventCode`].
        code: u64,
        /// \[1\] Packed [`Detail`].
        detail: u64,
    }
}

impl Event {
    /// The record of an event.
    pub fn new(header: Header, code: EventCode, detail: Detail) -> Self {
        Self { header, code: code as u64, detail: detail.pack() }
    }
}
