//! Strangers against a robot that walks: not one bit of its walk is another one in lockstep; in real time it is where it
//! would be without them, and `gangwerk estop` is answered.
//!
//! `GANGWERK_ATTACKS=each` asks for an emergency stop under each attack alone, in a run of its own.

use std::collections::BTreeMap;

use harness::{Running, Site, Stalls, WALK, doze, turn};
use ipc::{Reader, Space};
use messages::topics::{POWER, SIM_STATE};
use messages::{Power, SimState};
use realtime::clock::{SECOND, now};
use recording::{Log, payload_hashes};

use crate::EXE;
use crate::strangers::{ATTACKS, Attack, Place, under, with_door};

/// \[s\] Simulated time: when it walks; for how long each attack goes on.
const WALKS: f64 = 3.5;
const EACH: f64 = 0.4;
/// \[m\] What may lie between the robot and an undisturbed one at the same time of the walk.
const ASIDE: f64 = 0.03;
/// \[s\] A machine that stood still for as long may itself have led a robot aside.
const STALL: f64 = 0.002;
/// Runs that may be disturbed by the machine.
const RUNS: usize = 5;

/// A run that walks until it is told to stop.
struct Walk {
    run: Running,
    sim: Reader<SimState>,
    power: Reader<Power>,
    _space: Space,
}

impl Walk {
    fn of(site: &Site, more: &[&str]) -> Self {
        let mut run = site.run("walk", more);
        let space = run.space();
        let (sim, power) = (space.reader(&SIM_STATE).unwrap(), space.reader(&POWER).unwrap());
        Self { run, sim, power, _space: space }
    }

    /// Where the robot is at this time of the simulation \[s\], or a little later.
    fn at(&mut self, time: f64) -> SimState {
        let begun = now();
        loop {
            if let Some(state) = self.sim.latest().filter(|s| s.time >= time) {
                return *state;
            }
            assert!(self.run.is_alive() && now() - begun < 60 * SECOND, "{}", self.run.err());
            doze(0.002);
        }
    }

    /// Each attack for a while, one after the other from `time` on.
    fn attacked(&mut self, site: &Site, mut time: f64) {
        for attack in ATTACKS {
            let done = under(&Place::of(site), &[attack], || {
                time = self.at(time).time + EACH;
                self.at(time);
            });
            println!("{}: {done} times", attack.0);
            assert!(done > 0, "{}", attack.0);
        }
    }

    /// The supply is off, and somebody was told so.
    fn stopped_by(&mut self, site: &Site, attacks: &[Attack]) {
        let dir = site.run_dir().display().to_string();
        under(&Place::of(site), attacks, || {
            assert_eq!(self.power.latest().map(|p| p.on), Some(1), "{}", self.run.err());
            let asked = now();
            let said = site.gangwerk(&["estop", "--dir", &dir]);
            println!("estop: {} in {:.0} ms", said.out.trim(), (now() - asked) as f64 * 1e-6);
            assert_eq!(said.code, Some(0), "{said:#?}");
            assert_eq!(self.power.latest().map(|p| p.on), Some(0), "{}", self.run.err());
        });
    }
}

/// What all processes wrote, but for wall time, and for the strangers at the broker's doors.
fn hashes(site: &Site) -> BTreeMap<String, u64> {
    let left_out = ["cycle_stats/", "events/broker", "events/logger", "commands/broker"];
    let counts = |channel: &str| {
        let name = channel.strip_prefix("/gangwerk/").unwrap_or(channel);
        name != "/rosout" && !left_out.iter().any(|out| name.starts_with(out))
    };
    payload_hashes(&site.path("walk.mcap"), counts).unwrap()
}

#[test]
fn strangers_change_no_bit_of_a_walk() {
    let _turn = turn();
    let site = with_door(Site::new(EXE));
    site.scene("walk", WALKS + 1.5 * EACH * ATTACKS.len() as f64 + 6.0, WALK);
    site.run("walk", &["--lockstep"]).end().well();
    let alone = hashes(&site);
    // As fast as its clock, so that there is time for all of them.
    let mut walk = Walk::of(&site, &["--lockstep", "--paced"]);
    walk.attacked(&site, WALKS);
    walk.run.end().well();
    let attacked = hashes(&site);
    let different: Vec<_> = alone.keys().filter(|name| alone.get(*name) != attacked.get(*name)).collect();
    assert!(different.is_empty() && alone.len() == attacked.len(), "{different:?}");
    assert!(alone.contains_key("/gangwerk/joint_targets"));
}

#[test]
fn strangers_neither_lead_a_walking_robot_aside_nor_hold_up_its_emergency_stop() {
    let _turn = turn();
    let site = with_door(Site::patient(EXE));
    site.scene("walk", 100.0, WALK);
    let log = site.path("alone.mcap");
    site.scene("alone", 40.0, WALK);
    site.gangwerk(&["sim", "alone", "--log", &log.display().to_string()]).well();
    let alone = Log::open(&log).unwrap().records::<SimState>(&SIM_STATE).unwrap();
    let aside = |here: &SimState| {
        let there = alone.iter().find(|s| s.time >= here.time).expect("the other one walks for longer");
        (here.position[0] - there.position[0]).hypot(here.position[1] - there.position[1])
    };
    // A run that the machine has disturbed is begun again.
    let walks = || {
        for _ in 0..RUNS {
            let mut walk = Walk::of(&site, &["--no-log"]);
            if aside(&walk.at(WALKS)) < ASIDE {
                return walk;
            }
            println!("disturbed before the attacks: {}", walk.run.err());
        }
        panic!("disturbed in each of {RUNS} runs");
    };
    let undisturbed = (0..RUNS).find_map(|_| {
        let mut walk = walks();
        let machine = Stalls::watch();
        walk.attacked(&site, WALKS);
        let (here, stall) = (*walk.sim.latest().unwrap(), machine.longest());
        let after = aside(&here);
        println!(
            "walked {:.3} m by {:.1} s, {after:.4} m aside, the machine stood still for {:.1} ms",
            here.position[0],
            here.time,
            stall * 1e3
        );
        let held = after < ASIDE && here.fallen == 0 && here.position[0] > 1.0;
        assert!(held || stall > STALL, "{here:?}");
        held.then_some(walk)
    });
    let mut walk = undisturbed.expect("the machine lets a robot walk");
    walk.stopped_by(&site, &ATTACKS);
    drop(walk);
    if std::env::var("GANGWERK_ATTACKS").is_ok_and(|which| which == "each") {
        for attack in ATTACKS {
            println!("{}:", attack.0);
            let mut walk = walks();
            walk.stopped_by(&site, &[attack]);
        }
    }
}
