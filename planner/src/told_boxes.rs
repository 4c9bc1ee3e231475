//! Boxes that somebody sees while she walks (`vision/box`), each until its lifetime is over (thesis 6.2).
//!
//! An id is the place of a box, so there is never one too many, and nothing allocates after construction. Time is the
//! robot's own, in cycles: a replay forgets a box in the cycle in which the run did.

use crate::commands;
use crate::obstacles::{Disc, Obstacle, Point};
use crate::pose::rotate;
use environment::Mesh;
use messages::command::{BoxCommand, MAX_BOXES};
use messages::{Command, Reason};

/// Triangles of a box.
const FACES: usize = 12;

/// Boxes by their ids.
#[derive(Clone, Debug)]
pub(crate) struct ToldBoxes {
    /// Those of a box of 1 m around its middle: as a scene's boxes are made, so that the same box is the same triangles.
    unit: [[Point; 3]; FACES],
    /// Place of id 1 first.
    boxes: Vec<Option<ToldBox>>,
}

/// A box that was told.
#[derive(Clone, Copy, Debug)]
struct ToldBox {
    /// Corners \[m\] @I_0.
    triangles: [[Point; 3]; FACES],
    disc: Disc,
    /// First tick in which it is gone.
    until: u64,
}

impl Default for ToldBoxes {
    fn default() -> Self {
        let mut unit = [[[0.0; 3]; 3]; FACES];
        let cube = Mesh::cuboid([1.0; 3]).expect("a cube is a closed surface");
        unit.iter_mut().zip(cube.faces()).for_each(|(to, from)| *to = from.map(Into::into));
        Self { unit, boxes: vec![None; MAX_BOXES] }
    }
}

impl ToldBoxes {
    /// Those that are there.
    pub(crate) fn all(&self) -> impl Iterator<Item = Obstacle<'_>> {
        self.boxes.iter().flatten().map(|known| Obstacle { triangles: &known.triangles, disc: known.disc })
    }

    /// Takes `vision/box` and `vision/gone`; lifetimes begin at `tick`, in cycles of `cycle_s` \[s\].
    ///
    /// # Errors
    /// A number out of its range.
    pub(crate) fn take(&mut self, command: &Command, tick: u64, cycle_s: f64) -> Result<(), Reason> {
        // By the table again: a chain in one process has no broker before it.
        commands::in_range(command)?;
        let (id, told) = match command {
            // Nobody meets what lies under the ground.
            Command::Box(c) if c.base[2] + c.size[2] <= 0.0 => (c.id, None),
            Command::Box(c) => (c.id, Some(self.placed(c, tick + (c.lifetime / cycle_s).round() as u64))),
            Command::Gone(c) => (c.id, None),
            _ => return Err(Reason::NotNow),
        };
        self.boxes[id as usize - 1] = told;
        Ok(())
    }

    /// The box until that tick.
    fn placed(&self, c: &BoxCommand, until: u64) -> ToldBox {
        // Its base is told, the cube is around its middle.
        let middle = [c.base[0], c.base[1], c.base[2] + 0.5 * c.size[2]];
        let place = |corner: Point| {
            let [x, y, z]: Point = std::array::from_fn(|d| corner[d] * c.size[d]);
            let [x, y] = rotate(c.yaw, [x, y]);
            [x + middle[0], y + middle[1], z + middle[2]]
        };
        let triangles = self.unit.map(|corners| corners.map(place));
        ToldBox { triangles, disc: Disc::around(&triangles), until }
    }

    /// Forgets boxes that nobody has told again in their lifetime.
    pub(crate) fn forget(&mut self, tick: u64) {
        for known in &mut self.boxes {
            *known = known.filter(|b| tick < b.until);
        }
    }
}
