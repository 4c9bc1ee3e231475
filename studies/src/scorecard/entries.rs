//! What is walked, and what is demanded of it: the one table of the scorecard.
//!
//! A scene is walked with the type of model and the bus cycle that stand here, whatever its file says. Commands that
//! stand here take the place of those to walk in the file. "G": appendix G of the thesis, with motor-side sensing.

use messages::Command;
use messages::command::{StepCommand, VelocityCommand};

use super::demand::{Demand, What};
use crate::ground::GroundKind;

/// One walk.
pub(super) struct ScorecardEntry {
    /// Its name in the table, for `--only`.
    pub(super) name: &'static str,
    /// File in `scenes/`.
    pub(super) scene: &'static str,
    /// Commands to walk, instead of those of the scene if there are any.
    pub(super) told: &'static [Command],
    /// Type of the model.
    pub(super) depth: u8,
    /// \[s\] Bus cycles with which it is walked.
    pub(super) cycles: &'static [f64],
    /// What is demanded.
    pub(super) demands: &'static [Demand],
}

/// \[s\] The robot with Sercos III, and the one with CAN (thesis 9.3).
const LOLA: &[f64] = &[0.001, 0.0035];
/// \[s\] Thesis 5.5.1.
const JOHNNIE: &[f64] = &[0.0015];

/// \[s\] 25 of them for a point of the drives' tables.
const ARCHIE: &[f64] = &[0.0032];
const ARCHIE_WALKED: &str = "Daniali 6.2: 0.25 m in 12 s";

/// \[rad\] Thesis 8.1.1, at 2 km/h; sideways 8.1.2.
const UPRIGHT: Demand = Demand::most(What::Inclination, 0.03, "thesis 8.2, 2 km/h: 0.03 rad");
const UPRIGHT_SIDEWAYS: Demand = Demand::most(What::Inclination, 0.025, "thesis 8.7: 0.025 rad");
const TRACKS: Demand = Demand::most(What::HipKneeTracking, 8e-3, "thesis 8.5, 2 km/h: 8e-3 rad");
const OVER_DESIRED: Demand =
    Demand::shown(What::LandingExcess, "thesis 8.3: \"very close to the reference\"");
const NO_PEAK: Demand = Demand::most(What::LandingPeak, 1.0, "thesis 8.3: no force peak");

const fn speed(kmh: f64, published: &'static str) -> Demand {
    Demand::near(What::Speed, kmh, published)
}

const fn length(m: f64, published: &'static str) -> Demand {
    Demand::near(What::StepLength, m, published)
}

const fn duration(s: f64, published: &'static str) -> Demand {
    Demand::near(What::StepDuration, s, published)
}

const fn turn(rad: f64) -> Demand {
    Demand::near(What::StepTurn, rad, "thesis 8.1: \"around corners\"")
}

const fn lola(name: &'static str, scene: &'static str, demands: &'static [Demand]) -> ScorecardEntry {
    ScorecardEntry { name, scene, told: &[], depth: 3, cycles: LOLA, demands }
}

/// Steps of appendix G, which are not those that the gait takes at this speed by itself.
const fn of_appendix_g(
    name: &'static str,
    scene: &'static str,
    told: &'static [Command],
    demands: &'static [Demand],
) -> ScorecardEntry {
    ScorecardEntry { told, ..lola(name, scene, demands) }
}

const fn steps(length: f64, duration: f64) -> Command {
    Command::Step(StepCommand { length, side: 0.0, turn: 0.0, duration })
}

/// To the end of its way, which only who gets over what lies on it reaches.
const fn gets_to(m: f64, published: &'static str) -> Demand {
    Demand::least(What::Forward, m, published)
}

const fn johnnie(name: &'static str, depth: u8) -> ScorecardEntry {
    const DEMANDS: &[Demand] = &[
        speed(2.5, "thesis 5.6: the gait optimized for it"),
        length(0.457, "thesis 5.6"),
        duration(0.658, "0.457 m at 2.5 km/h"),
        UPRIGHT,
        NO_PEAK,
    ];
    ScorecardEntry { name, scene: "johnnie_25kmh", told: &[], depth, cycles: JOHNNIE, demands: DEMANDS }
}

const fn fastest(name: &'static str, demands: &'static [Demand]) -> ScorecardEntry {
    const TOLD: &[Command] =
        &[Command::Velocity(VelocityCommand { forward: 3.34 / 3.6, left: 0.0, turn: 0.0 })];
    ScorecardEntry { name, scene: "walk_3kmh", told: TOLD, depth: 3, cycles: LOLA, demands }
}

/// Walks, in the order of the table.
pub(super) const ENTRIES: &[ScorecardEntry] = &[
    of_appendix_g(
        "0 km/h",
        "walk_in_place",
        &[steps(0.0, 1.2), Command::Start],
        &[duration(1.2, "G: 1.2 s"), UPRIGHT, TRACKS, NO_PEAK],
    ),
    of_appendix_g(
        "1 km/h",
        "walk_1kmh",
        &[steps(0.34, 1.2), Command::Start],
        &[
            speed(1.02, "G: 1.0"),
            length(0.34, "G: 34 cm"),
            duration(1.2, "G: 1.2 s"),
            UPRIGHT,
            TRACKS,
            NO_PEAK,
        ],
    ),
    of_appendix_g(
        "2 km/h",
        "walk_2kmh",
        &[steps(0.5, 0.9), Command::Start],
        &[
            speed(2.0, "G: 2.0"),
            length(0.5, "G: 50 cm"),
            duration(0.9, "G: 0.9 s"),
            UPRIGHT,
            TRACKS,
            NO_PEAK,
            OVER_DESIRED,
        ],
    ),
    lola("2 km/h, sensors that err", "walk_2kmh_sensors", &[speed(2.0, "G: 2.0"), UPRIGHT, NO_PEAK]),
    lola(
        "3 km/h",
        "walk_3kmh",
        &[
            speed(2.98, "G: 3.0"),
            length(0.58, "G: 58 cm"),
            duration(0.7, "G: 0.7 s"),
            UPRIGHT,
            NO_PEAK,
            OVER_DESIRED,
        ],
    ),
    fastest("3.34 km/h", &[speed(3.34, "thesis 8.1: Lola's fastest"), UPRIGHT, NO_PEAK]),
    fastest(
        "starts and stops at 3.34 km/h",
        &[
            Demand::most(What::StepsToSpeed, 4.0, "thesis 8.1: approximately four"),
            Demand::most(What::StepsToRest, 4.0, "thesis 8.1: \"just as rapidly\""),
        ],
    ),
    lola(
        "sideways",
        "walk_sideways",
        &[
            speed(0.7, "G: 0.7"),
            length(0.194, "G: 20 cm"),
            duration(1.0, "G: 1.0 s"),
            UPRIGHT_SIDEWAYS,
            TRACKS,
            NO_PEAK,
        ],
    ),
    lola("backwards", "walk_backwards", &[speed(0.54, "thesis 8.1: no speed"), UPRIGHT, TRACKS, NO_PEAK]),
    lola(
        "curve, 1.1 m in radius",
        "walk_curve",
        &[speed(0.72, "none"), turn(0.144), UPRIGHT, TRACKS, NO_PEAK],
    ),
    lola("turning on the spot", "walk_turn", &[turn(0.16), UPRIGHT, TRACKS, NO_PEAK]),
    lola(
        "fixed distance of 3 m",
        "distance",
        &[Demand::near(What::Forward, 3.0, "thesis 4.3.4: a skill"), UPRIGHT],
    ),
    lola("over a known bar of 10 cm", "obstacle", &[gets_to(3.0, "thesis 4.3.3: algorithm 3"), UPRIGHT]),
    lola("onto and off a platform of 15 cm", "platform", &[gets_to(2.3, "thesis 4.3.4: a skill"), UPRIGHT]),
    lola("over an unknown board of 2 cm", "board_2cm", &[gets_to(3.0, "thesis 9.2: about 2 cm")]),
    lola("over holes of 10 x 3 x 2 cm", "holes", &[gets_to(3.0, "thesis 8.2: holes 1-2 cm deep")]),
    lola("over an unknown board of 8 mm", "board", &[gets_to(3.0, "thesis 9.2: about 2 cm"), UPRIGHT]),
    johnnie("Johnnie 2.5 km/h, type 1", 1),
    johnnie("Johnnie 2.5 km/h, type 2", 2),
    johnnie("Johnnie 2.5 km/h, type 3", 3),
    ScorecardEntry {
        name: "Archie's own walk, open loop",
        scene: "archie_static",
        told: &[],
        depth: 3,
        cycles: ARCHIE,
        demands: &[
            // 2.08 cm/s within 1 %.
            Demand::least(What::Speed, 0.074_25, ARCHIE_WALKED),
            Demand::most(What::Speed, 0.075_75, ARCHIE_WALKED),
            Demand::near(What::StepLength, 0.25, "Daniali 6.2: D_s"),
            Demand::most(What::MotorSide, 1e-3, "none"),
        ],
    },
];

/// Entries of which pictures are drawn: those of the thesis's figures.
pub(super) const PICTURED: &[&str] = &["0 km/h", "1 km/h", "2 km/h", "3 km/h", "sideways"];

/// The scene that is walked faster and faster, and what is demanded.
pub(super) const FASTEST: (&str, Demand) = (
    "walk_5kmh",
    Demand::least(What::Speed, 4.0, "thesis: 3.34, designed for 5; in a public test 1.05 m/s = 3.78"),
);

/// The scene in which the robot is pushed.
pub(super) const PUSHED: &str = "walk_1kmh";

/// A direction in the world's axes in which it is pushed.
pub(super) struct PushedAlong {
    pub(super) name: &'static str,
    pub(super) axis: [f64; 2],
    /// \[N s/kg\] Impulses that are to be survived whenever they come, walking and standing.
    pub(super) walking: f64,
    pub(super) standing: f64,
    /// The largest impulse that a public test asserts.
    pub(super) published: &'static str,
}

/// All of them.
pub(super) const PUSHES: [PushedAlong; 4] = [
    PushedAlong {
        name: "forward",
        axis: [1.0, 0.0],
        walking: 0.6,
        standing: 0.5,
        published: "0.98, Valkyrie, mid-swing; with step adjustment",
    },
    PushedAlong {
        name: "backward",
        axis: [-1.0, 0.0],
        walking: 0.35,
        standing: 0.5,
        published: "0.49, Atlas; with step adjustment",
    },
    PushedAlong {
        name: "left",
        axis: [0.0, 1.0],
        walking: 0.22,
        standing: 0.3,
        published: "0.22 (inwards), Atlas; with step adjustment",
    },
    PushedAlong {
        name: "right",
        axis: [0.0, -1.0],
        walking: 0.22,
        standing: 0.3,
        published: "0.25 (outwards), Atlas; with step adjustment",
    },
];

/// The scene that walks over unknown ground, and the one whose sensors err while commands come at random.
pub(super) const OVER_GROUND: &str = "walk_2kmh";
pub(super) const COMMANDED: &str = "walk_2kmh_sensors";

/// Unknown ground with its size in the unit of its kind, and \[1\] the share of random places that are to be walked over.
pub(super) const GROUND: [(GroundKind, f64, f64); 8] = [
    (GroundKind::Board, 0.02, 1.0),
    (GroundKind::Board, 0.04, 0.95),
    (GroundKind::StepUp, 0.04, 0.95),
    (GroundKind::StepDown, 0.04, 1.0),
    (GroundKind::StepDown, 0.08, 0.95),
    (GroundKind::Slope, 5.0, 0.95),
    (GroundKind::HeightField, 0.03, 0.95),
    (GroundKind::LowFriction, 0.3, 0.95),
];
