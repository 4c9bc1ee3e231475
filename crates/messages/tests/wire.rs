//! Bytes of commands: golden vectors, an independent decoder, hostile bytes.

use messages::command::{
    BoxCommand, Command, DistanceCommand, FixateCommand, GoneCommand, HeadJointsCommand, LowerCommand,
    ParameterCommand, PlatformCommand, PushCommand, StepCommand, VelocityCommand,
};
use messages::wire::{MAX_BYTES, decode, encode};
use proptest::prelude::*;

/// The wire format written down a second time, for wincode.
#[derive(Debug, Clone, Copy, PartialEq, wincode::SchemaRead, wincode::SchemaWrite)]
enum Peer {
    EmergencyStop,
    Reset,
    Enable,
    End,
    Stand,
    Start,
    Stop,
    Step { length: f64, side: f64, turn: f64, duration: f64 },
    Velocity { forward: f64, left: f64, turn: f64 },
    Push { force: [f64; 3], duration: f64 },
    Parameter { number: u32, value: f64 },
    Fixate { point: [f64; 3] },
    HeadJoints { pan: f64, tilt: f64 },
    HeadRest,
    Distance { distance: f64, speed: f64, acceleration: f64 },
    Platform { distance: f64, height: f64 },
    Home,
    ZeroForce,
    Lower { distance: f64 },
    WalkParameter { number: u32, value: f64 },
    Box { id: u32, base: [f64; 3], yaw: f64, size: [f64; 3], lifetime: f64 },
    Gone { id: u32 },
}

impl From<Command> for Peer {
    fn from(c: Command) -> Self {
        match c {
            Command::EmergencyStop => Self::EmergencyStop,
            Command::Reset => Self::Reset,
            Command::Enable => Self::Enable,
            Command::End => Self::End,
            Command::Stand => Self::Stand,
            Command::Start => Self::Start,
            Command::Stop => Self::Stop,
            Command::Step(StepCommand { length, side, turn, duration }) => {
                Self::Step { length, side, turn, duration }
            }
            Command::Velocity(VelocityCommand { forward, left, turn }) => {
                Self::Velocity { forward, left, turn }
            }
            Command::Push(PushCommand { force, duration }) => Self::Push { force, duration },
            Command::Parameter(ParameterCommand { number, value }) => Self::Parameter { number, value },
            Command::Fixate(FixateCommand { point }) => Self::Fixate { point },
            Command::HeadJoints(HeadJointsCommand { pan, tilt }) => Self::HeadJoints { pan, tilt },
            Command::HeadRest => Self::HeadRest,
            Command::Distance(DistanceCommand { distance, speed, acceleration }) => {
                Self::Distance { distance, speed, acceleration }
            }
            Command::Platform(PlatformCommand { distance, height }) => Self::Platform { distance, height },
            Command::Home => Self::Home,
            Command::ZeroForce => Self::ZeroForce,
            Command::Lower(LowerCommand { distance }) => Self::Lower { distance },
            Command::WalkParameter(ParameterCommand { number, value }) => {
                Self::WalkParameter { number, value }
            }
            Command::Box(BoxCommand { id, base, yaw, size, lifetime }) => {
                Self::Box { id, base, yaw, size, lifetime }
            }
            Command::Gone(GoneCommand { id }) => Self::Gone { id },
        }
    }
}

fn any_command() -> impl Strategy<Value = Command> {
    let f = any::<f64>;
    prop_oneof![
        prop::sample::select(vec![
            Command::EmergencyStop,
            Command::Reset,
            Command::Enable,
            Command::End,
            Command::Stand,
            Command::Start,
            Command::Stop,
            Command::HeadRest,
            Command::Home,
            Command::ZeroForce,
        ]),
        f().prop_map(|distance| Command::Lower(LowerCommand { distance })),
        (any::<u32>(), f())
            .prop_map(|(number, value)| Command::Parameter(ParameterCommand { number, value })),
        (any::<u32>(), f())
            .prop_map(|(number, value)| Command::WalkParameter(ParameterCommand { number, value })),
        prop::array::uniform3(f()).prop_map(|point| Command::Fixate(FixateCommand { point })),
        (f(), f()).prop_map(|(pan, tilt)| Command::HeadJoints(HeadJointsCommand { pan, tilt })),
        (f(), f()).prop_map(|(distance, height)| Command::Platform(PlatformCommand { distance, height })),
        (f(), f(), f()).prop_map(|(distance, speed, acceleration)| Command::Distance(DistanceCommand {
            distance,
            speed,
            acceleration
        })),
        (f(), f(), f(), f()).prop_map(|(length, side, turn, duration)| Command::Step(StepCommand {
            length,
            side,
            turn,
            duration
        })),
        (f(), f(), f()).prop_map(|(forward, left, turn)| Command::Velocity(VelocityCommand {
            forward,
            left,
            turn
        })),
        (any::<u32>(), prop::array::uniform3(f()), f(), prop::array::uniform3(f()), f()).prop_map(
            |(id, base, yaw, size, lifetime)| Command::Box(BoxCommand { id, base, yaw, size, lifetime })
        ),
        any::<u32>().prop_map(|id| Command::Gone(GoneCommand { id })),
        (prop::array::uniform3(f()), f())
            .prop_map(|(force, duration)| Command::Push(PushCommand { force, duration })),
    ]
}

fn bytes(c: &Command) -> Vec<u8> {
    encode(c, &mut [0; MAX_BYTES]).expect("every command fits").to_vec()
}

/// Variant as u32, then the numbers, little endian, nothing between: what bincode 1 wrote. The bytes were put
/// together by hand from the format's description, not by a program.
#[test]
fn golden_vectors() {
    let velocity = Command::Velocity(VelocityCommand { forward: 0.5, left: -2.0, turn: 0.0 });
    #[rustfmt::skip]
    let golden: [(Command, &[u8]); 4] = [
        (Command::EmergencyStop, &[0, 0, 0, 0]),
        (Command::Stop, &[6, 0, 0, 0]),
        (velocity, &[
            8, 0, 0, 0,
            0, 0, 0, 0, 0, 0, 0xe0, 0x3f,
            0, 0, 0, 0, 0, 0, 0, 0xc0,
            0, 0, 0, 0, 0, 0, 0, 0,
        ]),
        (Command::Push(PushCommand { force: [1.0, 0.0, -0.0], duration: 0.1 }), &[
            9, 0, 0, 0,
            0, 0, 0, 0, 0, 0, 0xf0, 0x3f,
            0, 0, 0, 0, 0, 0, 0, 0,
            0, 0, 0, 0, 0, 0, 0, 0x80,
            0x9a, 0x99, 0x99, 0x99, 0x99, 0x99, 0xb9, 0x3f,
        ]),
    ];
    for (command, expected) in golden {
        assert_eq!(bytes(&command), expected, "{command:?}");
        assert_eq!(decode(expected).unwrap(), command);
    }
}

#[test]
fn every_cut_and_every_surplus_is_an_error() {
    let whole = bytes(&Command::Step(StepCommand { length: 0.3, side: 0.0, turn: 0.1, duration: 0.8 }));
    for n in 0..whole.len() {
        assert!(decode(&whole[..n]).is_err(), "cut to {n} bytes");
    }
    for n in 1..600 {
        let mut longer = whole.clone();
        longer.resize(whole.len() + n, 0);
        let error = decode(&longer).unwrap_err().to_string();
        assert!(error.contains(&format!("{n} bytes too many")), "{error}");
    }
}

#[test]
fn unknown_commands_are_named_as_such() {
    for n in [22u32, 255, 1 << 16, u32::MAX] {
        let error = decode(&n.to_le_bytes()).unwrap_err().to_string();
        assert!(error.starts_with("not a command") && error.contains(&n.to_string()), "{error}");
    }
}

#[test]
fn a_small_buffer_is_an_error() {
    let push = Command::Push(PushCommand { force: [0.0; 3], duration: 1.0 });
    for n in 0..36 {
        assert!(encode(&push, &mut vec![0; n]).is_err(), "{n} bytes");
    }
    assert_eq!(encode(&push, &mut [0; 36]).unwrap().len(), 36);
}

proptest! {
    #[test]
    fn wincode_writes_and_reads_the_same_bytes(command in any_command()) {
        let ours = bytes(&command);
        prop_assert_eq!(&ours, &wincode::serialize(&Peer::from(command)).unwrap());
        let theirs: Peer = wincode::deserialize(&ours).unwrap();
        // Compared as bytes: NaN must come through with its bits.
        prop_assert_eq!(&ours, &wincode::serialize(&theirs).unwrap());
        prop_assert_eq!(bytes(&decode(&ours).unwrap()), ours);
    }

    #[test]
    fn hostile_bytes_never_panic(noise in prop::collection::vec(any::<u8>(), 0..600)) {
        if let Ok(command) = decode(&noise) {
            prop_assert_eq!(bytes(&command), noise);
        }
    }

    #[test]
    fn flipped_bits_are_refused_or_another_command(command in any_command(), bit in 0usize..576) {
        let mut damaged = bytes(&command);
        let bit = bit % (8 * damaged.len());
        damaged[bit / 8] ^= 1 << (bit % 8);
        if let Ok(other) = decode(&damaged) {
            prop_assert_eq!(bytes(&other), damaged);
            let _ = other.check();
        }
    }
}
