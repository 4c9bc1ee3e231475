//! Drives of the simulated robot that play tables of points: interpreter, memory, clock.
//!
//! ```text
//! telegrams ──► interpreter ──► registers, points ──► read pointer, cubics ──► reference of the cycle
//!     ▲             │                                        ▲
//!     └── answers ──┘                          SYNC, or the drive's own clock
//! ```

use codec::frames::DriveReplies;
use codec::interpreter::{BG, MP, PT, QP, Refusal, SAMPLING, ST, Telegram, WS};
use codec::layout::FrameLayout;
use codec::network::{NetworkCommand, NetworkState};
use config::tables::Playback;
use config::{Robot, Scene, TableDrives};
use drives::point_table::{MOST_POINTS, MOST_SPACING};
use drives::table_player::{Piece, Played, TablePlayer};
use messages::{BusFrames, Frame, MAX_FRAMES};

use crate::drive::{JointCubic, JointMotion};

/// One of them.
#[derive(Clone)]
struct TableDrive {
    player: TablePlayer,
    /// Where its answers go: line, identifier.
    answers: (u32, u32),
    /// \[rad\] One count of its motor.
    unit: f64,
    /// \[tick\] Samples of its position controller in a bus cycle, by its own clock.
    cycle: f64,
    /// The last thing it played ended in motion.
    exhausted: bool,
    /// Error code that the bus was told last.
    told: u32,
    /// Its number on the line, and the place of its heartbeat among those of the line.
    node: u32,
    turn: u64,
    /// State that its last heartbeat said.
    said: NetworkState,
}

/// All of them.
#[derive(Clone)]
pub(crate) struct SimulatedTables {
    layout: FrameLayout,
    sampling_us: u32,
    /// \[s\] Bus cycle.
    dt: f64,
    drives: Vec<TableDrive>,
    answers: Vec<Frame>,
    /// State of each drive on the network. Before the first cycle they were started.
    network: Vec<NetworkState>,
    /// Cycles.
    cycle: u64,
}

impl SimulatedTables {
    /// The drives of a robot, if they play tables.
    pub(crate) fn new(robot: &Robot, scene: &Scene) -> Option<Self> {
        let tables = robot.tables.as_ref()?;
        let drives = (0..robot.joints.len()).map(|j| TableDrive::new(robot, scene, tables, j)).collect();
        Some(Self {
            layout: robot.layout.clone(),
            sampling_us: tables.sampling_us,
            dt: scene.cycle,
            drives,
            answers: Vec::with_capacity(MAX_FRAMES),
            network: vec![NetworkState::Operational; robot.joints.len()],
            cycle: 0,
        })
    }

    /// Takes the network management of a cycle. A drive that starts anew has lost its table, and waits to be started.
    pub(crate) fn manage(&mut self, frames: Option<&BusFrames>) {
        for frame in frames.map(BusFrames::as_slice).unwrap_or_default() {
            let message = self.layout.find(frame.line, frame.id).map(|i| &self.layout.messages[i]);
            if !message.is_some_and(|m| m.manages_network() && m.len == frame.len) {
                continue;
            }
            let [number, node] = [frame.data[0], frame.data[1]];
            let Some(command) = NetworkCommand::of(number) else { continue };
            for (drive, state) in self.drives.iter_mut().zip(&mut self.network) {
                if drive.answers.0 != frame.line || node != 0 && u32::from(node) != drive.node {
                    continue;
                }
                *state = match command {
                    NetworkCommand::Start => NetworkState::Operational,
                    NetworkCommand::Stop => NetworkState::Stopped,
                    NetworkCommand::PreOperational => NetworkState::PreOperational,
                    NetworkCommand::Reset => NetworkState::BootUp,
                };
                if *state == NetworkState::BootUp {
                    drive.player.restart();
                }
            }
        }
    }

    /// Takes back the controlwords of drives that hear none.
    pub(crate) fn deafen(&self, control: &mut [u32]) {
        let states = control.iter_mut().zip(&self.network);
        states.filter(|(_, state)| **state != NetworkState::Operational).for_each(|(word, _)| *word = 0);
    }

    /// Takes the telegrams of a cycle and answers them; `follows`: drives that have torque and no fault.
    pub(crate) fn receive(&mut self, frames: Option<&BusFrames>, follows: impl Fn(usize) -> bool) {
        self.answers.clear();
        for frame in frames.map(BusFrames::as_slice).unwrap_or_default() {
            let message = self.layout.find(frame.line, frame.id).map(|i| &self.layout.messages[i]);
            let joint = message.filter(|m| m.to_drives && m.len == frame.len).and_then(|m| m.interpreter());
            let Some((j, command)) = joint.zip(Telegram::of(frame)) else { continue };
            if self.network[j] != NetworkState::Operational {
                continue;
            }
            let drive = &mut self.drives[j];
            let answer = drive.execute(&command, self.sampling_us, follows(j));
            if self.answers.len() < self.answers.capacity() {
                self.answers.push(answer.frame(drive.answers.0, drive.answers.1));
            }
        }
    }

    /// Reference of joint `j` in this cycle: from `from` \[rad\] in its encoder's zero; none if it plays nothing. SYNC with
    /// this counter was heard, or none.
    pub(crate) fn reference(
        &mut self,
        j: usize,
        from: JointMotion,
        zero: f64,
        sync: Option<u8>,
    ) -> Option<JointCubic> {
        let (drive, dt) = (&mut self.drives[j], self.dt);
        let tick = dt / drive.cycle;
        if let Some(counter) = sync {
            let now = [(from.angle - zero) / drive.unit, from.speed * tick / drive.unit];
            drive.player.sync(counter, drive.cycle, now);
        }
        // Counts and ticks to radians and seconds.
        let cubic = |piece: &Piece| {
            let mut c = piece.c;
            let mut scale = drive.unit;
            for x in &mut c {
                *x *= scale;
                scale /= tick;
            }
            c[0] += zero;
            c
        };
        let played = drive.player.advance(drive.cycle);
        drive.exhausted = played == Played::Exhausted;
        match played {
            Played::Pieces(first, None) => Some(JointCubic::of(cubic(&first))),
            Played::Pieces(first, Some(second)) => {
                Some(JointCubic::of(cubic(&first)).then(second.from * tick, cubic(&second)))
            }
            Played::Nothing | Played::Exhausted => None,
        }
    }

    /// Joint `j` no longer follows: its table is over.
    pub(crate) fn stop(&mut self, j: usize) {
        self.drives[j].player.stop();
    }

    /// True if the table of joint `j` ended in motion in the cycle before.
    pub(crate) fn is_exhausted(&self, j: usize) -> bool {
        self.drives[j].exhausted
    }

    /// Replies of this cycle: answers, error codes that have changed, and the heartbeats of one drive of each line in
    /// turn and of those whose state has changed.
    pub(crate) fn replies(&mut self, errors: &[u32]) -> DriveReplies<'_> {
        let lines = self.layout.nodes.len().max(1);
        let turn = self.cycle % self.drives.len().div_ceil(lines) as u64;
        self.cycle += 1;
        let (mut emergencies, mut heartbeats) = (0, 0);
        let drives = self.drives.iter_mut().zip(&mut self.network).zip(errors);
        for (j, ((drive, state), &error)) in drives.enumerate() {
            emergencies |= u32::from(std::mem::replace(&mut drive.told, error) != error) << j;
            // Pre-operational follows upon having said that it has started.
            if [drive.said, *state] == [NetworkState::BootUp; 2] {
                *state = NetworkState::PreOperational;
            }
            let new = std::mem::replace(&mut drive.said, *state) != *state;
            heartbeats |= u32::from(new || drive.turn == turn) << j;
        }
        DriveReplies { telegrams: &self.answers, emergencies, heartbeats, network: &self.network }
    }
}

impl TableDrive {
    fn new(robot: &Robot, scene: &Scene, tables: &TableDrives, j: usize) -> Self {
        let layout = &robot.layout;
        let answers = layout.interpreter(false, j).map_or((0, 0), |m| (m.node as u32, m.id));
        // Nodes are numbered as the identifiers of their heartbeats are, 0x700 + n.
        let heartbeat = layout.messages.iter().find(|m| m.heartbeat() == Some(j));
        let node = heartbeat.map_or(0, |m| m.id & 0x7F);
        let line = |i: usize| layout.interpreter(false, i).map_or(0, |m| m.node as u32);
        let before = (0..j).filter(|&i| line(i) == answers.0);
        // SYNC corrects a clock in every cycle; what it is off within one is nothing.
        let ppm = match tables.playback {
            Playback::Sync => 0.0,
            Playback::Free => scene.plant_mismatch.drive_clock.of(&robot.joints[j].name).unwrap_or(0.0),
        };
        Self {
            player: TablePlayer::default(),
            answers,
            unit: layout.count(j).unwrap_or(1.0),
            cycle: tables.samples(scene.cycle) * (1.0 + 1e-6 * ppm),
            exhausted: false,
            told: 0,
            node,
            turn: before.count() as u64,
            said: NetworkState::Operational,
        }
    }

    /// The interpreter: what a command changes, and its answer.
    fn execute(&mut self, command: &Telegram, sampling_us: u32, follows: bool) -> Telegram {
        let (player, index, value) = (&mut self.player, usize::from(command.index), command.integer());
        if command.flag {
            let asked = match (command.letters, command.index) {
                (QP, _) => player.point(index),
                (MP, 1) => Some(player.next.first as i32),
                (MP, 2) => Some(player.next.last as i32),
                (MP, 3) => Some(player.next.cyclic.into()),
                (MP, 4) => Some(player.next.spacing as i32),
                (PT, 0) => Some(player.pointer() as i32),
                (WS, SAMPLING) => Some(sampling_us as i32),
                _ => None,
            };
            return asked.map_or(command.refuse(Refusal::Index), |value| command.answer(value));
        }
        let within = |most: usize| usize::try_from(value).ok().filter(|n| (1..=most).contains(n));
        let done = match (command.letters, command.index) {
            _ if command.float => Err(Refusal::Number),
            (QP, _) if !(1..=MOST_POINTS).contains(&index) => Err(Refusal::Index),
            (QP, _) => player.write(index, value).then_some(()).ok_or(Refusal::NotNow),
            (MP, 1) => within(MOST_POINTS).map(|n| player.next.first = n).ok_or(Refusal::Number),
            (MP, 2) => within(MOST_POINTS).map(|n| player.next.last = n).ok_or(Refusal::Number),
            (MP, 3) if matches!(value, 0 | 1) => {
                player.next.cyclic = value == 1;
                Ok(())
            }
            (MP, 4) => {
                within(MOST_SPACING as usize).map(|n| player.next.spacing = n as u32).ok_or(Refusal::Number)
            }
            (PT, 0) => within(MOST_POINTS).filter(|&n| player.choose(n)).map(|_| ()).ok_or(Refusal::Number),
            (BG, 0) if !follows => Err(Refusal::NotNow),
            (BG, 0) => u8::try_from(value)
                .ok()
                .filter(|&counter| player.begin_with(counter, self.cycle))
                .map(|_| ())
                .ok_or(Refusal::Number),
            (ST, 0) => {
                player.stop();
                Ok(())
            }
            (MP | PT | BG | ST | WS, _) => Err(Refusal::Index),
            _ => Err(Refusal::Command),
        };
        match done {
            Ok(()) => *command,
            Err(why) => command.refuse(why),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use config::Setup;

    fn archie() -> Setup {
        let mut setup = Setup::load(&config::root(None), "archie_walk").unwrap();
        setup.robot.play_tables().unwrap();
        setup.scene.cycle = 0.008;
        setup
    }

    fn tables(setup: &Setup) -> SimulatedTables {
        SimulatedTables::new(&setup.robot, &setup.scene).unwrap()
    }

    fn frames(setup: &Setup, j: usize, commands: &[Telegram]) -> BusFrames {
        let to = setup.robot.layout.interpreter(true, j).unwrap();
        let mut frames = BusFrames::default();
        commands.iter().for_each(|t| assert!(frames.push(&t.frame(to.node as u32, to.id))));
        frames
    }

    fn answers(tables: &SimulatedTables) -> Vec<String> {
        tables.answers.iter().map(|frame| Telegram::of(frame).unwrap().to_string()).collect()
    }

    #[test]
    fn the_interpreter_takes_what_it_knows_and_says_why_not() {
        let (setup, set) = (archie(), Telegram::set);
        let mut t = tables(&setup);
        let commands = [
            set(QP, 1, -7644),
            Telegram::ask(QP, 1),
            set(QP, 1025, 0),
            set(QP, 0, 0),
            Telegram::ask(WS, SAMPLING),
            set(WS, SAMPLING, 100),
            set(MP, 1, 1),
            set(MP, 2, 1025),
            set(MP, 2, 300),
            set(MP, 3, 2),
            set(MP, 3, 1),
            set(MP, 4, 257),
            set(MP, 4, 250),
            set(MP, 5, 0),
            set(BG, 0, 7),
            set(PT, 0, 301),
            set(PT, 0, 1),
            set(BG, 0, 256),
            set(BG, 0, 7),
            set(*b"XX", 0, 7),
            Telegram::set_real(QP, 1, 2.0),
            set(ST, 0, 0),
        ];
        t.receive(Some(&frames(&setup, 4, &commands)), |_| true);
        let said = [
            "QP[1]=-7644",
            "QP[1]=-7644",
            "QP[1025] refused: 3",
            "QP refused: 3",
            "WS[28]=320",
            "WS[28] refused: 3",
            "MP[1]=1",
            "MP[2] refused: 21",
            "MP[2]=300",
            "MP[3] refused: 3",
            "MP[3]=1",
            "MP[4] refused: 21",
            "MP[4]=250",
            "MP[5] refused: 3",
            "BG refused: 21",
            "PT refused: 21",
            "PT=1",
            "BG refused: 21",
            "BG=7",
            "XX refused: 2",
            "QP[1] refused: 21",
            "ST=0",
        ];
        assert_eq!(answers(&t), said);
        assert!(t.answers.iter().all(|frame| (frame.line, frame.id) == (0, 0x285)));
        t.receive(Some(&frames(&setup, 4, &[set(PT, 0, 1), set(BG, 0, 7)])), |_| false);
        assert_eq!(answers(&t), ["PT=1", "BG refused: 58"], "without torque nothing begins");
        t.receive(None, |_| true);
        assert!(t.answers.is_empty());
    }

    /// By its own clock, 100 ppm fast, a stride of 24 s is over 2.4 ms early; a drive on SYNC is in time.
    #[test]
    fn a_free_clock_drifts_and_one_on_sync_does_not() {
        let mut setup = archie();
        let own = vec![(setup.robot.joints[3].name.clone(), 100.0)];
        setup.scene.plant_mismatch.drive_clock = config::sensors::PerJoint { all: None, own };
        for (playback, early) in [(Playback::Sync, 0.0), (Playback::Free, 2.4e-3)] {
            setup.robot.tables.as_mut().unwrap().playback = playback;
            let mut t = tables(&setup);
            // A ramp of 10 counts a point after a beginning from rest.
            let mut commands: Vec<Telegram> =
                (0..100).map(|i| Telegram::set(QP, i + 1, 10 * i32::from(i))).collect();
            let registers = [(MP, 1, 1), (MP, 2, 100), (MP, 3, 0), (MP, 4, 250), (PT, 0, 1), (BG, 0, 1)];
            commands.extend(registers.map(|(letters, i, value)| Telegram::set(letters, i, value)));
            t.receive(Some(&frames(&setup, 3, &commands)), |_| true);
            let unit = setup.robot.layout.count(3).unwrap();
            let mut last = JointMotion::default();
            for tick in 1..=900u32 {
                let reference = t.reference(3, last, 0.5, Some(tick as u8));
                last = reference.unwrap_or_default().at(0.008);
            }
            // 90 points later: 10 counts per 80 ms.
            let ahead = ((last.angle - 0.5) / unit - 900.0) / (10.0 / 0.08);
            let wanted = early * 7.2 / 24.0;
            assert!((ahead - wanted).abs() < 1e-9 + 1e-3 * wanted, "{playback:?}: {ahead} s early, {wanted}");
        }
    }
}
