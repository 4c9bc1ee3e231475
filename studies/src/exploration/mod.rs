//! Exploration (thesis 6.1): in rooms with boxes and people of which nobody has told her, does the robot get about without
//! touching anything, and how much of the floor does she get to?
//!
//! The whole way is walked: a camera in the head of the simulated robot (`sim_backend::eye`), the vision system of `vision`, its
//! datagrams as bytes over a network that may be bad, the gateway's gate, and the planner; only sockets are left out. Then the
//! vision system is killed, and she has to stand.

mod floor;
mod network;
mod outline;
mod picture;
mod room;
mod session;
#[cfg(test)]
mod tests;

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use chain::ending::WalkEnd;
use chain::parallel;
use config::Setup;
use serde::Serialize;
use vision::Speeds;

use crate::random::seeds;
use crate::sheet::{Column, fixed, plain};
use crate::undisturbed::{STEP, on_type};
use crate::{Error, Given, Sheet, Study};
use network::Faults;
use room::Room;
use session::{Case, Explored, explore};

const COLUMNS: &[Column] = &[
    plain("/seed", "room"),
    plain("/depth", "type"),
    plain("/network", "network"),
    plain("/end", "end"),
    fixed("/minutes", "minutes", 1),
    plain("/touched", "touched"),
    fixed("/way_m", "way [m]", 0),
    fixed("/share", "floor she got to", 2),
    plain("/stood", "stood without vision"),
    plain("/accepted", "datagrams accepted"),
    plain("/refused", "refused"),
    plain("/not_walked", "velocities refused"),
];

/// The study's arguments.
#[derive(clap::Args, Clone, Debug)]
pub struct Exploration {
    /// Scene whose robot, gait and sensors they are, and whose objects a room takes the place of.
    #[arg(long, default_value = "room")]
    pub scene: String,
    /// Number of rooms.
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u64).range(1..=1000))]
    pub rooms: u64,
    /// Seed of the first room; the others count on.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Minutes in each of them; one of type 1 takes a core some 6 seconds.
    #[arg(long, default_value_t = 10.0, value_parser = crate::ground::size)]
    pub minutes: f64,
    /// Boxes in a room.
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u64).range(0..=50))]
    pub boxes: u64,
    /// People who walk about in it.
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u64).range(0..=messages::MAX_MOVING as u64))]
    pub people: u64,
    /// Simulation types.
    #[arg(long, value_delimiter = ',', default_values_t = [1], value_parser = clap::value_parser!(u8).range(1..=5))]
    pub types: Vec<u8>,
    /// Networks: without errors, and with 30 % of the datagrams lost, 30 % late by up to 300 ms, others doubled, spoiled with NaN and
    /// replayed.
    #[arg(long, value_delimiter = ',', value_enum, default_values_t = [NetworkKind::Sound, NetworkKind::Bad])]
    pub network: Vec<NetworkKind>,
    /// Speed ahead (m/s).
    #[arg(long, default_value_t = 0.3, value_parser = crate::ground::size)]
    pub forward: f64,
    /// Speed of turns on the spot (rad/s).
    #[arg(long, default_value_t = 0.25, value_parser = crate::ground::size)]
    pub turn: f64,
    /// Directory of the picture; none is drawn without it.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Network between robot and vision system.
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum NetworkKind {
    /// Everything arrives, at once.
    Sound,
    /// Datagrams are lost, late, doubled, spoiled and replayed.
    Bad,
}

/// \[s\] What pictures take to be understood: least and most.
const DELAY: [f64; 2] = [0.1, 0.3];

/// An exploration.
#[derive(Serialize)]
struct Row {
    seed: u64,
    depth: u8,
    network: NetworkKind,
    end: String,
    minutes: f64,
    /// First thing that was touched: object, link, second; empty: nothing.
    touched: String,
    way_m: f64,
    share: f64,
    stood: bool,
    accepted: u64,
    refused: u64,
    not_walked: u64,
}

impl Study for Exploration {
    fn run(&self, given: &Given<'_>) -> Result<Sheet, Error> {
        let scene = Setup::load(given.config, &self.scene)?;
        let cases: Vec<(u8, NetworkKind, u64)> = seeds(self.seed, self.rooms)
            .flat_map(|seed| self.types.iter().map(move |depth| (*depth, seed)))
            .flat_map(|(depth, seed)| self.network.iter().map(move |network| (depth, *network, seed)))
            .collect();
        // Each room of each type and network by itself, on all cores.
        let done = AtomicUsize::new(0);
        let explored = parallel::map(cases.len(), |k| {
            let (depth, network, seed) = cases[k];
            (given.progress)(
                done.fetch_add(1, Ordering::Relaxed),
                cases.len(),
                &format!("room {seed}, type {depth}"),
            );
            self.explore(&scene, depth, network, seed).map_err(|e| e.to_string())
        });
        let explored = explored.into_iter().collect::<Result<Vec<_>, _>>()?;
        let rows: Vec<Row> =
            cases.iter().zip(&explored).map(|(case, (_, explored))| row(*case, explored)).collect();
        let mut sheet = Sheet::titled(format!(
            "Exploration of rooms of 4 m x 7 m with {} boxes and {} people, {} min each, seeds from {}",
            self.boxes, self.people, self.minutes, self.seed
        ));
        sheet.rows("rows", COLUMNS, &rows);
        if let Some(out) = &self.out {
            let pairs: Vec<_> = rows.iter().zip(&explored).collect();
            sheet.draw(out, "exploration.png", &picture::ways(&pairs))?;
        }
        Ok(sheet)
    }
}

impl Exploration {
    fn explore(
        &self,
        scene: &Setup,
        depth: u8,
        network: NetworkKind,
        seed: u64,
    ) -> Result<(Room, Explored), Error> {
        let time = 60.0 * self.minutes;
        let mut setup = scene.clone();
        on_type(&mut setup, depth, if depth == 1 { scene.scene.cycle } else { STEP });
        let room = Room::draw(seed, self.boxes as usize, self.people as usize, time);
        setup.scene.objects.clone_from(&room.objects);
        let faults = if network == NetworkKind::Bad { Faults::BAD } else { Faults::NONE };
        let speeds = Speeds { forward: self.forward, turn: self.turn };
        let explored =
            explore(&Case { setup: &setup, room: &room, faults, time, speeds, delay: DELAY, seed })?;
        Ok((room, explored))
    }
}

fn row((depth, network, seed): (u8, NetworkKind, u64), explored: &Explored) -> Row {
    let way_m = explored.way.windows(2).map(|w| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1])).sum();
    let touched = explored.touched.as_ref().map(|t| format!("{}: {}, {:.1} s", t.object, t.link, t.time));
    let [accepted, refused, not_walked] = explored.datagrams;
    Row {
        seed,
        depth,
        network,
        end: if explored.end == WalkEnd::Done { "walked".into() } else { explored.end.to_string() },
        minutes: explored.time / 60.0,
        touched: touched.unwrap_or_default(),
        way_m,
        share: explored.share,
        stood: explored.stood,
        accepted,
        refused,
        not_walked,
    }
}
