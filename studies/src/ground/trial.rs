//! One walk over one place.

use std::fmt;

use chain::Chain;
use chain::ending::{Ending, WalkEnd};
use config::Setup;
use messages::GaitState;

use crate::undisturbed::{AFTER, Stride};

/// \[s\] Standing at the beginning, and \[1\] how much slower than told the robot may get to the end of a place.
const STANDS: f64 = 5.0;
const SLOWER: f64 = 1.5;

/// How a walk ended.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Outcome {
    /// To the end, and then as told.
    Walked,
    /// The robot fell, or its supply or a process gave up.
    Ended(WalkEnd),
    /// It did not get to the end of the place in time.
    Stuck,
    /// On its feet, and not as told.
    NotAsTold,
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Walked => write!(f, "walked"),
            Self::Ended(end) => end.fmt(f),
            Self::Stuck => write!(f, "stuck"),
            Self::NotAsTold => write!(f, "not as told"),
        }
    }
}

/// Walks a scene, which is a place that ends at `end` \[m\] along the way, at `speed` \[m/s\], and holds it against a stride of the undisturbed walk. With the
/// outcome: when \[s\] the walk ended, and where \[m\] along the way.
///
/// # Errors
/// The robot cannot be built.
pub(super) fn walk(
    setup: &Setup,
    end: f64,
    stride: &Stride,
    speed: f64,
) -> Result<(Outcome, [f64; 2]), String> {
    let mut chain = Chain::new(setup).map_err(|e| e.to_string())?;
    let (mut ending, mut behind, mut place) = (Ending::default(), 0.0, 0.0);
    let cycle = chain.cycle();
    let mut see = |c: &chain::Cycle, time: f64| {
        c.events.iter().for_each(|&(_, code, detail)| ending.tell(time, code, detail));
        ending.see(time, c.power.on == 1, GaitState::from(c.controller_state.gait));
        place = c.sim_state.position[0];
        (ending.end(), place)
    };
    // Over the place, and on until it is forgotten.
    let late = STANDS + SLOWER * end / speed;
    let mut time = 0.0;
    while behind < AFTER {
        time += cycle;
        let ((how, at), x) = see(chain.step(), time);
        if how != WalkEnd::Done {
            return Ok((Outcome::Ended(how), [at, x]));
        }
        if x > end {
            behind += cycle;
        } else if time > late {
            return Ok((Outcome::Stuck, [time, x]));
        }
    }
    let mut last = (WalkEnd::Done, time);
    let walks = stride.is_repeated(&mut chain, |c| {
        time += cycle;
        last = see(c, time).0;
    });
    let outcome = match last.0 {
        WalkEnd::Done if walks => Outcome::Walked,
        WalkEnd::Done => Outcome::NotAsTold,
        how => Outcome::Ended(how),
    };
    Ok((outcome, [last.1, place]))
}
