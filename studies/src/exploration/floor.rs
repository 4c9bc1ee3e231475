//! Floor of a room: which of it a robot could get to, and which it has been to.

use super::room::Room;

/// \[m\] Side of the cells in which floor is counted.
const CELL: f64 = 0.1;
/// \[m\] Radius of the robot, shoulders and arms: less far from walls and boxes it cannot be.
const ROBOT: f64 = 0.35;
/// \[m\] What is nearer to the robot's middle than this it has been to.
const BEEN: f64 = 0.5;

/// Cells of the floor to which the robot can get, and whether it has.
pub(super) struct Floor {
    low: [f64; 2],
    columns: usize,
    /// None: it cannot be there.
    cells: Vec<Option<bool>>,
}

impl Floor {
    /// That of a room, seen from the robot's start at its origin.
    pub(super) fn new(room: &Room) -> Self {
        let [low, high] = room.inside;
        let [columns, rows] = [0, 1].map(|i| ((high[i] - low[i]) / CELL).round() as usize);
        let mut floor = Self { low, columns, cells: vec![None; columns * rows] };
        // Spreads from the start over neighbours where a disc as wide as the robot stands free.
        let mut open = vec![floor.index([0.0; 2])];
        while let Some(i) = open.pop() {
            let is_free = room.standing.iter().all(|r| r.distance(floor.middle(i)) > ROBOT);
            if floor.cells[i].is_some() || !is_free {
                continue;
            }
            floor.cells[i] = Some(false);
            let (x, y) = (i % columns, i / columns);
            let neighbours = [(x > 0, i.wrapping_sub(1)), (x + 1 < columns, i + 1)];
            let others = [(y > 0, i.wrapping_sub(columns)), (y + 1 < rows, i + columns)];
            open.extend(neighbours.iter().chain(&others).filter(|(inside, _)| *inside).map(|(_, i)| *i));
        }
        floor
    }

    /// The robot's middle is here \[m\] @world.
    pub(super) fn visit(&mut self, at: [f64; 2]) {
        for i in 0..self.cells.len() {
            let [x, y] = self.middle(i);
            if let (Some(been), true) = (&mut self.cells[i], (x - at[0]).hypot(y - at[1]) < BEEN) {
                *been = true;
            }
        }
    }

    /// \[1\] Share that it has been to, of all that it could.
    pub(super) fn share(&self) -> f64 {
        let could = self.cells.iter().flatten();
        let been = could.clone().filter(|been| **been).count();
        been as f64 / could.count() as f64
    }

    fn index(&self, at: [f64; 2]) -> usize {
        let [x, y] = [0, 1].map(|i| ((at[i] - self.low[i]) / CELL) as usize);
        y * self.columns + x
    }

    fn middle(&self, i: usize) -> [f64; 2] {
        [(i % self.columns, self.low[0]), (i / self.columns, self.low[1])]
            .map(|(k, low)| low + (k as f64 + 0.5) * CELL)
    }
}
