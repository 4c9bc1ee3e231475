//! Layouts from DBC files: the shipped ones carry everything, and a broken one says what is wrong with it.

use codec::frames::{DriveCommand, decode_sensors, decode_targets, encode_sensors, encode_targets};
use codec::interpreter::{BG, MP, PT, QP, SAMPLING, ST, Telegram, WS};
use codec::layout::{Carries, FrameLayout};
use config::database::Database;
use config::{Robot, dbc};
use drives::cia402::{self, DriveFault, DriveState, REFERENCED, VOLTAGE, WARNING};
use messages::{BusFrames, JointTargets, Sensors};

fn robots() -> Vec<Robot> {
    let load = |name| Robot::load(&config::root(None).join("robots").join(name)).unwrap();
    ["lola", "johnnie", "archie"].map(load).into()
}

/// Numbers without a pattern, from -1 to 1.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

fn sensors(robot: &Robot, tick: u64) -> Sensors {
    let mut noise = Noise(tick);
    let mut s = Sensors { power: 1, ..Sensors::default() };
    s.header.tick = tick;
    for j in 0..robot.joints.len() {
        s.joint_angle[j] = 3.0 * noise.next();
        s.joint_speed[j] = 10.0 * noise.next();
        s.motor_angle[j] = 3.0 * noise.next();
        s.motor_speed[j] = 10.0 * noise.next();
        s.motor_current[j] = 50.0 * noise.next();
        s.drive_status[j] = (30000.0 * (1.0 + noise.next())) as u32;
        s.drive_error[j] = (30000.0 * (1.0 + noise.next())) as u32;
        s.temperature[j] = 60.0 + 80.0 * noise.next();
    }
    for foot in &mut s.foot_wrench {
        foot.force = [0; 3].map(|_| 1500.0 * noise.next());
        foot.moment = [0; 3].map(|_| 200.0 * noise.next());
    }
    s.imu.orientation = [0; 4].map(|_| noise.next());
    s.imu.angular_velocity = [0; 3].map(|_| 5.0 * noise.next());
    s.imu.acceleration = [0; 3].map(|_| 30.0 * noise.next());
    s
}

/// Half a unit of the signal that carries it, or 0 if none does.
fn unit(layout: &FrameLayout, carries: Carries) -> Option<f64> {
    let signals = layout.messages.iter().flat_map(|m| &m.signals);
    signals.filter(|s| s.carries == carries).map(|s| 0.5 * s.scale * (1.0 + 1e-9)).next()
}

#[test]
fn whatever_is_sent_comes_back_within_half_a_unit() {
    for robot in robots() {
        for layout in [robot.classic.as_ref().unwrap(), &robot.layout] {
            for tick in [1, 255, 256, 0x1_0007] {
                let sent = sensors(&robot, tick);
                let (mut frames, mut got) = (BusFrames::default(), Sensors::default());
                encode_sensors(layout, &sent, &mut frames);
                assert_eq!(decode_sensors(layout, &frames, &mut got).missed(), 0);
                assert_eq!(got.power, 1);
                let near = |carries, a: f64, b: f64| {
                    if let Some(unit) = unit(layout, carries) {
                        assert!((a - b).abs() <= unit, "{}: {carries:?}: {a} and {b}", robot.name);
                    }
                };
                for j in 0..robot.joints.len() {
                    near(Carries::Angle(j), sent.joint_angle[j], got.joint_angle[j]);
                    near(Carries::Speed(j), sent.joint_speed[j], got.joint_speed[j]);
                    near(Carries::Motor(j), sent.motor_angle[j], got.motor_angle[j]);
                    near(Carries::MotorSpeed(j), sent.motor_speed[j], got.motor_speed[j]);
                    near(Carries::Current(j), sent.motor_current[j], got.motor_current[j]);
                    near(Carries::Temperature(j), sent.temperature[j], got.temperature[j]);
                    near(Carries::Status(j), sent.drive_status[j].into(), got.drive_status[j].into());
                    near(Carries::Error(j), sent.drive_error[j].into(), got.drive_error[j].into());
                }
                for k in 0..3 {
                    for foot in 0..2 {
                        let (a, b) = (&sent.foot_wrench[foot], &got.foot_wrench[foot]);
                        near(Carries::Force(foot, k), a.force[k], b.force[k]);
                        near(Carries::Moment(foot, k), a.moment[k], b.moment[k]);
                    }
                    near(Carries::Rate(k), sent.imu.angular_velocity[k], got.imu.angular_velocity[k]);
                    near(Carries::Acceleration(k), sent.imu.acceleration[k], got.imu.acceleration[k]);
                }
                for k in 0..4 {
                    near(Carries::Orientation(k), sent.imu.orientation[k], got.imu.orientation[k]);
                }
            }
        }
    }
}

#[test]
fn targets_come_back_too_and_a_motor_side_that_nobody_sends_is_the_link_side() {
    for robot in robots() {
        for layout in [robot.classic.as_ref().unwrap(), &robot.layout] {
            let from = sensors(&robot, 9);
            let mut sent = DriveCommand::default();
            (sent.targets.header.tick, sent.targets.mode) = (9, 2);
            (sent.targets.angle, sent.targets.speed) = (from.joint_angle, from.joint_speed);
            sent.control = [15; messages::MAX_JOINTS];
            let (mut frames, mut got) = (BusFrames::default(), DriveCommand::default());
            encode_targets(layout, &sent, &mut frames);
            assert_eq!(decode_targets(layout, &frames, &mut got).missed(), 0);
            assert_eq!((got.targets.mode, got.control[0]), (2, 15));
            for j in 0..robot.joints.len() {
                let half = unit(layout, Carries::Target(j)).unwrap();
                assert!((got.targets.angle[j] - sent.targets.angle[j]).abs() <= half);
                let half = unit(layout, Carries::Feed(j)).unwrap();
                assert!((got.targets.speed[j] - sent.targets.speed[j]).abs() <= half);
            }
            let mut seen = Sensors::default();
            encode_sensors(layout, &from, &mut frames);
            decode_sensors(layout, &frames, &mut seen);
            let same = seen.motor_angle == seen.joint_angle;
            assert_eq!(same, unit(layout, Carries::Motor(0)).is_none(), "{}", robot.name);
        }
    }
}

#[test]
fn old_repeated_short_foreign_and_error_frames_are_counted_and_move_nothing() {
    let robot = &robots()[0];
    for layout in [robot.classic.as_ref().unwrap(), &robot.layout] {
        let mut frames = BusFrames::default();
        encode_sensors(layout, &sensors(robot, 9), &mut frames);
        let all = frames.count as usize;
        frames.frames[1].data[0] ^= 1; // another cycle's counter
        frames.frames[2].len -= 1; // cut short
        frames.frames[3].id = 0x7ff; // nobody's
        frames.frames[4].id |= messages::ERROR_FLAG;
        frames.frames[5].line += 1; // on the wrong line
        let twice = frames.frames[0];
        assert!(frames.push(&twice));
        let mut got = Sensors::default();
        let received = decode_sensors(layout, &frames, &mut got);
        assert_eq!((received.missed(), received.stale, received.wrong_length), (5, 1, 1));
        assert_eq!((received.unknown, received.errors, received.repeated), (2, 1, 1));
        assert!(received.complete(8) && !received.complete(0), "of {all} frames");
    }
}

/// Up to one cycle less than the narrowest counter counts.
#[test]
fn a_frame_of_the_cycle_before_is_late() {
    for robot in robots() {
        for layout in [robot.classic.as_ref().unwrap(), &robot.layout] {
            let counts = layout.messages.iter().all(|message| message.counter().is_some());
            assert!(counts || robot.name == "archie", "{}: only bought drives have none", robot.name);
            for tick in [300, 256, 0x1_0000].into_iter().filter(|_| counts) {
                let (mut seen, mut told) = (Sensors::default(), DriveCommand::default());
                let (mut from, mut to) = (BusFrames::default(), BusFrames::default());
                for late in [1, 2, 20, 255] {
                    encode_sensors(layout, &sensors(&robot, tick - late), &mut from);
                    let command = DriveCommand {
                        targets: JointTargets { header: from.header, ..JointTargets::default() },
                        control: [15; messages::MAX_JOINTS],
                        ..DriveCommand::default()
                    };
                    encode_targets(layout, &command, &mut to);
                    (from.header.tick, to.header.tick) = (tick, tick);
                    let came = decode_sensors(layout, &from, &mut seen);
                    assert_eq!((u64::from(came.stale), came.missed()), (from.count, from.count as u32));
                    let came = decode_targets(layout, &to, &mut told);
                    assert_eq!((u64::from(came.stale), came.missed()), (to.count, to.count as u32));
                }
                let nothing = (Sensors::default().joint_angle, [0; messages::MAX_JOINTS]);
                assert_eq!(
                    (seen.joint_angle, told.control),
                    nothing,
                    "{}: nothing of them is used",
                    robot.name
                );
            }
        }
    }
}

/// Archie's drives that play tables: no targets, an interpreter in each, counts as in every cycle; room for 25 telegrams in 8 ms.
#[test]
fn frames_of_tables_have_interpreters_instead_of_targets() {
    let mut robot = robots().remove(2);
    let classic = robot.classic.clone().unwrap();
    robot.play_tables().unwrap();
    let layout = &robot.layout;
    for j in 0..12 {
        assert_eq!((layout.count(j), classic.interpreter(true, j)), (classic.count(j), None));
        let id = |to_drives| layout.interpreter(to_drives, j).map(|m| (m.node, m.id));
        assert_eq!((id(true), id(false)), (Some((j / 6, 0x301 + j as u32)), Some((j / 6, 0x281 + j as u32))));
    }
    let target =
        |m: &codec::layout::BusMessage| m.signals.iter().any(|s| matches!(s.carries, Carries::Target(_)));
    assert!(!layout.messages.iter().any(target));
    // Six PDOs of 135 us, SYNC of 65 us; a controlword of 75 us, a heartbeat of 65 us; telegram and answer 270 us.
    assert_eq!([0, 1].map(|line| codec::room::cyclic_bits(layout, line)), [875; 2]);
    assert_eq!([0.008, 0.0032].map(|cycle| codec::room::telegrams_per_cycle(layout, cycle)), [25, 8]);
    // 10 cycles of checking, 74 of loading, 10 to spare, 20 of announcing.
    assert_eq!(robot.tables.as_ref().unwrap().lead(layout, 0.008, 300), 114);
    let refused = robots().remove(0).play_tables().unwrap_err();
    assert_eq!(refused, "robot lola has no [can.tables]: its drives take a point in every cycle");
}

#[test]
fn what_is_wrong_with_frames_of_tables_is_said() {
    let path = config::root(None).join("robots/archie/can/archie_tables.dbc");
    let text = std::fs::read_to_string(path).unwrap();
    let joints: Vec<String> = robots()[2].joints.iter().map(|joint| joint.name.clone()).collect();
    let joints: Vec<&str> = joints.iter().map(String::as_str).collect();
    let problems = |text: &str| -> Vec<String> {
        let problems = dbc::read(text, &joints).err().unwrap_or_default();
        problems.iter().map(|p| format!("{}: {}", p.key, p.text)).collect()
    };
    assert_eq!(problems(&text), Vec::<String>::new());
    // The knee's interpreter in every cycle, and its controlword gone.
    let cyclic = text.replace("BA_ \"GenMsgCycleTime\" BO_ 772 0;", "");
    assert_eq!(
        problems(&cyclic),
        [
            "right_knee_flexion: one message to its drive must hold _letters, _index, _query, _float and _value in 8 bytes, with a GenMsgCycleTime of 0"
        ]
    );
    let renamed = text.replace("right_knee_flexion_control", "right_knee_flexion_error");
    assert!(problems(&renamed).iter().any(|p| p.contains("nothing of that name goes this way")));
    let without: String =
        text.split("\n\n").filter(|part| !part.contains("_rpdo1: 2 PC")).collect::<Vec<_>>().join("\n\n");
    assert!(problems(&without).contains(&"right_knee_flexion_control: is missing".to_owned()));
}

/// Both ways, by each drive's interpreter: what our codec writes is what other tools read by the file.
#[test]
fn telegrams_are_those_of_the_file_of_frames() {
    let mut robot = robots().remove(2);
    robot.play_tables().unwrap();
    let path = config::root(None).join("robots/archie/can/archie_tables.dbc");
    let database = Database::load(&path).unwrap();
    let telegrams = [
        (Telegram::set(QP, 1, -7644), "QP", [1.0, 0.0, 0.0, -7644.0]),
        (Telegram::set(QP, 1024, i32::MIN), "QP", [1024.0, 0.0, 0.0, -2_147_483_648.0]),
        (Telegram::ask(WS, SAMPLING), "WS", [28.0, 1.0, 0.0, 0.0]),
        (Telegram::set(MP, 4, 250), "MP", [4.0, 0.0, 0.0, 250.0]),
        (Telegram::set(PT, 0, 513), "PT", [0.0, 0.0, 0.0, 513.0]),
        (Telegram::set(BG, 0, 255), "BG", [0.0, 0.0, 0.0, 255.0]),
        (Telegram::set(ST, 0, 0), "ST", [0.0; 4]),
    ];
    for (j, to_drives) in (0..12).flat_map(|j| [(j, true), (j, false)]) {
        let message = robot.layout.interpreter(to_drives, j).unwrap();
        for (telegram, letters, numbers) in telegrams {
            let frame = telegram.frame(message.node as u32, message.id);
            let carried = database.message(frame.id).unwrap().carries(&frame.data[..8]).collect::<Vec<_>>();
            let of = |part: &str| carried.iter().find(|c| c.name.ends_with(part)).unwrap();
            assert_eq!(of("_letters").word, Some(letters));
            let is = ["_index", "_query", "_float", "_value"].map(|part| of(part).value);
            assert_eq!(is, numbers, "{}: {telegram}", message.name);
            assert_eq!(Telegram::of(&frame), Some(telegram));
        }
    }
}

/// What a signal can be, and its word in the DBC file.
fn words(carries: Carries) -> Vec<(u16, &'static str)> {
    let named = |pairs: &[(u16, &'static str)]| pairs.to_vec();
    match carries {
        Carries::Mode => named(&[(0, "off"), (1, "hold"), (2, "track"), (3, "stop"), (4, "home")]),
        Carries::Supply => named(&[(0, "off"), (1, "on")]),
        Carries::Control(_) => {
            let text = ["disable voltage", "quick stop", "shutdown", "enable operation", "fault reset"];
            cia402::WORDS.into_iter().zip(text).collect()
        }
        Carries::NetworkCommand => {
            named(&[(1, "start"), (2, "stop"), (128, "pre-operational"), (129, "reset")])
        }
        Carries::NetworkState(_) => {
            named(&[(0, "boot-up"), (4, "stopped"), (5, "operational"), (127, "pre-operational")])
        }
        Carries::Error(_) => {
            DriveFault::ALL.map(|f| (f as u16, f.text())).into_iter().chain([(0, "none")]).collect()
        }
        Carries::Status(_) => {
            let states = [
                (DriveState::NotReady, "not ready"),
                (DriveState::SwitchOnDisabled, "switch on disabled"),
                (DriveState::Ready, "ready"),
                (DriveState::SwitchedOn, "switched on"),
                (DriveState::OperationEnabled, "operation enabled"),
                (DriveState::QuickStop, "quick stop"),
                (DriveState::FaultReaction, "fault reaction"),
                (DriveState::Fault, "fault"),
            ];
            let bits = [0, WARNING, REFERENCED, WARNING | REFERENCED].map(|bits| bits | VOLTAGE);
            let of = |(state, text)| bits.map(|bits| (cia402::status_of(state) | bits, text));
            states.into_iter().flat_map(of).collect()
        }
        _ => Vec::new(),
    }
}

/// Tools that read DBC files show words, and know when a message is missing.
#[test]
fn shipped_files_name_modes_states_and_errors_and_say_what_messages_are_and_how_often_they_come() {
    for (robot, cycle) in robots().iter().zip([3.5e-3, 1.5e-3, 3.5e-3]) {
        let mut tables = robot.clone();
        let tables = tables.play_tables().is_ok().then_some((&tables.layout, "_tables", 8e-3));
        let layouts = [(robot.classic.as_ref().unwrap(), "", cycle), (&robot.layout, "_fd", 1e-3)];
        for (layout, file, cycle) in layouts.into_iter().chain(tables) {
            let name = &robot.name;
            let path = config::root(None).join(format!("robots/{name}/can/{name}{file}.dbc"));
            let database = Database::load(&path).unwrap();
            for m in &layout.messages {
                let described = database.message(m.id).unwrap();
                let cycle = m.cyclic.then_some(cycle);
                assert_eq!(described.cycle, cycle, "{name}{file}: {}", m.name);
                assert!(!described.comment.is_empty(), "{name}{file}: {} has no comment", m.name);
                for signal in &m.signals {
                    let fits = |value: &u16| u32::from(*value) < 1 << signal.bits.min(16);
                    for (value, word) in words(signal.carries).into_iter().filter(|(value, _)| fits(value)) {
                        let mut data = vec![0; m.len as usize];
                        for bit in 0..signal.bits.min(16) {
                            let at = (signal.start + bit) as usize;
                            data[at / 8] |= ((value >> bit & 1) as u8) << (at % 8);
                        }
                        let said = described.carries(&data).find(|c| c.name == signal.name).unwrap();
                        let begin = said.word.unwrap_or_default().split(',').next();
                        assert_eq!(begin, Some(word), "{name}{file}: {} {value:#x}", signal.name);
                    }
                }
            }
        }
    }
}

#[test]
fn every_line_carries_two_or_three_joints_and_its_sync_comes_last() {
    let robot = &robots()[0];
    let classic = robot.classic.as_ref().unwrap();
    assert_eq!(classic.nodes.len(), 9);
    assert_eq!(classic.nodes, robot.layout.nodes);
    for (node, name) in classic.nodes.iter().enumerate() {
        let joints = |layout: &FrameLayout| {
            let all = layout.messages.iter().filter(|m| m.node == node).flat_map(|m| &m.signals);
            all.filter(|s| matches!(s.carries, Carries::Target(_))).count()
        };
        assert!((2..=3).contains(&joints(classic)), "{name}");
        assert_eq!(joints(classic), joints(&robot.layout));
    }
    assert!(classic.messages.iter().all(|m| m.len <= 8));
}

fn lola() -> String {
    std::fs::read_to_string(config::root(None).join("robots/lola/can/lola.dbc")).unwrap()
}

fn problems(text: &str) -> Vec<String> {
    let robot = &robots()[0];
    let joints: Vec<&str> = robot.joints.iter().map(|j| j.name.as_str()).collect();
    dbc::read(text, &joints).unwrap_err().iter().map(ToString::to_string).collect()
}

#[test]
fn what_is_wrong_with_a_dbc_file_is_said() {
    let cases: &[(&str, &str, &str)] = &[
        ("head_pan_target :", "head_pam_target :", "no joint `head_pam`; the nearest is `head_pan`"),
        ("head_pan_target :", "head_pan_aim :", "nothing of that name goes this way; there is counter, mode"),
        ("supply : 8|8@1+", "supply : 8|8@0+", "must be Intel (@1)"),
        ("supply : 8|8@1+ (1,0)", "supply : 8|8@1+ (0,0)", "the factor must be above 0"),
        ("supply : 8|8@1+", "supply : 7|8@1+", "bit 7 belongs to another signal, too"),
        ("supply : 8|8@1+", "supply : 60|8@1+", "1 to 32 bits within 8 bytes"),
        ("BO_ 128 ", "BO_ 256 ", "identifier 256 is taken on this line"),
        ("BO_ 128 ", "BO_ 3000 ", "below 2048"),
        ("BO_ 128 ", "BO_ 2147483776 ", "29 bits"),
        (
            "BO_ 128 node0_sync: 1 PC\n SG_ counter : 0|8@1+",
            "BO_ 128 node0_sync: 1 PC\n SG_ counter : 0|8@1-",
            "a counter is unsigned",
        ),
    ];
    for (from, to, wanted) in cases {
        let text = lola();
        assert!(text.contains(from), "{from}");
        let said = problems(&text.replacen(from, to, 1));
        assert!(said.iter().any(|p| p.contains(wanted)), "{wanted}\nis not in\n{said:#?}");
    }
    let said = problems("this is no DBC");
    assert!(said.len() == 1 && said[0].contains("not a DBC file"), "{said:?}");
    let said = problems(&lola().replacen("BO_ 128 node0_sync: 1 PC", "BO_ 129 node0_sync: 1 hip_right", 1));
    assert!(said.iter().any(|p| p.contains("hip_right: the last message to it")), "{said:#?}");
    // Lines of the file are named.
    let said = problems(&lola().replacen("head_pan_target :", "head_pam_target :", 1));
    let line = lola().lines().position(|l| l.contains("SG_ head_pan_target")).unwrap() + 1;
    assert!(said[0].starts_with(&format!("line {line}: head_pan_to.head_pam_target: ")), "{}", said[0]);
}
