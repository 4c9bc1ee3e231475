//! Local map: what stands on the floor around the robot, from the points that its cameras saw in the last seconds.
//!
//! Cells of the floor of I_0, without end: as odometry drifts, what was seen too long ago is forgotten, and the map never grows
//! beyond what a few seconds show. A cell keeps a balance of points above the floor and points of the floor itself, so that a
//! single wrong point is no obstacle and what has gone is one no longer as soon as its floor is seen.

use std::collections::BTreeMap;

/// \[m\] Side of a cell.
pub const CELL: f64 = 0.05;
/// Balance of a point above the floor, of a point of the floor, and the most either way.
const STANDS: i8 = 2;
const FLOOR: i8 = -1;
const MOST: i8 = 6;
/// Balance from which on something stands there: two points that no floor contradicts.
const TAKEN: i8 = 3;
/// \[m\] Height of a point above the floor that is none of the floor: beside the robot, and more for each metre away \[1\], for the
/// inclination of the cameras is measured, too.
const LOWEST: f64 = 0.06;
const LOWEST_PER_WAY: f64 = 0.03;
/// \[m\] Higher than the robot: of no concern.
const HIGHEST: f64 = 2.0;
/// \[s\] How long a cell is believed that nobody sees any more.
const MEMORY: f64 = 40.0;

/// Cell of the floor.
#[derive(Clone, Copy, Debug)]
struct Cell {
    /// Of points that stand and points of the floor.
    balance: i8,
    /// \[s\] When a point was last seen in it.
    seen: f64,
}

/// What stands around the robot.
#[derive(Clone, Debug, Default)]
pub struct LocalMap {
    cells: BTreeMap<[i32; 2], Cell>,
    /// \[s\] When the map was last rid of old cells.
    swept: f64,
}

impl LocalMap {
    /// Adds the `points` \[m\] @I_0 that were seen at `time` \[s\] from above `from` \[m\].
    pub fn add(&mut self, time: f64, from: [f64; 2], points: &[[f64; 3]]) {
        for &[x, y, z] in points {
            let lowest = LOWEST + LOWEST_PER_WAY * (x - from[0]).hypot(y - from[1]);
            if !(-lowest..=HIGHEST).contains(&z) {
                continue; // NaN as well
            }
            let cell = self.cells.entry(index([x, y])).or_insert(Cell { balance: 0, seen: time });
            let weight = if z > lowest { STANDS } else { FLOOR };
            cell.balance = (cell.balance + weight).clamp(-MOST, MOST);
            cell.seen = time;
        }
        if time - self.swept > 1.0 {
            self.cells.retain(|_, cell| time - cell.seen <= MEMORY);
            self.swept = time;
        }
    }

    /// Middles \[m\] @I_0 of the cells within `reach` \[m\] of `at` in which something stands.
    pub fn taken(&self, at: [f64; 2], reach: f64) -> impl Iterator<Item = [f64; 2]> + '_ {
        let [low, high] = [-reach, reach].map(|d| index([at[0] + d, at[1] + d]));
        let rows = self.cells.range([low[0], i32::MIN]..=[high[0], i32::MAX]);
        let taken = rows.filter(move |(i, cell)| cell.balance >= TAKEN && (low[1]..=high[1]).contains(&i[1]));
        taken.map(|(i, _)| i.map(|k| (f64::from(k) + 0.5) * CELL))
    }
}

fn index(at: [f64; 2]) -> [i32; 2] {
    at.map(|x| (x / CELL).floor() as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The points of a floor of a square metre, a centimetre apart, in which something stands at `there`.
    fn scene(there: Option<[f64; 2]>) -> Vec<[f64; 3]> {
        let grid = (0..10_000).map(|i| [f64::from(i % 100), f64::from(i / 100)].map(|k| 0.01 * (k + 0.5)));
        let height = |at: [f64; 2]| if there.map(index) == Some(index(at)) { 0.4 } else { 0.0 };
        grid.map(|at| [at[0], at[1], height(at)]).collect()
    }

    fn taken(map: &LocalMap) -> Vec<[f64; 2]> {
        map.taken([0.5, 0.5], 2.0).collect()
    }

    #[test]
    fn what_moves_on_leaves_nothing_behind() {
        let mut map = LocalMap::default();
        map.add(0.0, [0.0; 2], &scene(Some([0.31, 0.52])));
        let [[x, y]] = taken(&map)[..] else { panic!("{:?}", taken(&map)) };
        assert!((x - 0.325).abs() < 1e-9 && (y - 0.525).abs() < 1e-9, "{x} {y}");
        map.add(0.1, [0.0; 2], &scene(Some([0.72, 0.17])));
        assert_eq!(taken(&map).len(), 1, "its floor was seen: it is gone");
        map.add(0.2, [0.0; 2], &scene(None));
        assert!(taken(&map).is_empty());
    }

    #[test]
    fn what_is_out_of_sight_is_remembered_and_then_forgotten() {
        let mut map = LocalMap::default();
        map.add(0.0, [0.0; 2], &scene(Some([0.31, 0.52])));
        map.add(MEMORY - 0.1, [0.0; 2], &[[5.0, 5.0, 0.0]]);
        assert_eq!(taken(&map).len(), 1);
        map.add(MEMORY + 1.1, [0.0; 2], &[[5.0, 5.0, 0.0]]);
        assert!(taken(&map).is_empty());
        assert_eq!(map.cells.len(), 1);
    }

    #[test]
    fn a_single_wrong_point_is_no_obstacle_nor_is_what_cannot_be() {
        let mut map = LocalMap::default();
        let wrong = [[0.5, 0.5, 0.3], [0.5, 0.6, f64::NAN], [0.7, 0.6, 2.5], [0.8, 0.6, -3.0]];
        map.add(0.0, [0.0; 2], &wrong);
        // A floor that lies askew by as much as inclinations are off.
        let askew = |at: [f64; 3]| [at[0], at[1], 0.03 * at[0] + 0.05];
        map.add(0.0, [0.0; 2], &scene(None).into_iter().map(askew).collect::<Vec<_>>());
        assert!(taken(&map).is_empty(), "{:?}", taken(&map));
    }
}
