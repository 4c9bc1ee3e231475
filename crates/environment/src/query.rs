//! The environment E (2.50) and the distance of a point to it (algorithm 2).
//!
//! Ground and objects are solids, and what counts is the surface of all of them together: outside, the nearest surface;
//! inside one or several of them, the one the point is deepest in (algorithm 2 compares distances without sign, so a
//! node deep inside a board would be told of the ground below it). Faces of an object that lie on or in the ground are no
//! surface. Where solids touch, their common faces still are: join them in one mesh if feet are to slide across.

use nalgebra::Vector3;

use crate::object::Object;

/// \[m\] How far around an object the distance to it is computed: boxes are enlarged by it. Further away a lower bound
/// is enough, because nothing touches.
pub const REACH: f64 = 0.01;

/// Surface that was hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// Nothing within reach: the gap is a lower bound, the normal points up.
    Far,
    /// The ground: the plane z = 0, unless it is tilted or at another height.
    Ground,
    /// The object of this number.
    Object(usize),
}

/// Answer to a query.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// \[m\] g_N, negative inside.
    pub gap: f64,
    /// \[1\] @world Unit normal of the surface, outward.
    pub normal: [f64; 3],
    /// Whose surface it is.
    pub surface: Surface,
}

/// Change of an object in [`crate::Environment::advance`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ObjectEvent {
    /// Its next change has to wait, because it is touched or would touch.
    Refused(usize),
    /// It goes on with its schedule.
    Resumed(usize),
    /// It is there from now on.
    Appeared(usize),
    /// It is not there any more.
    Vanished(usize),
}

/// Ground and objects.
#[derive(Clone, Debug, Default)]
pub struct Environment {
    pub(crate) objects: Vec<Object>,
    pub(crate) events: Vec<ObjectEvent>,
    /// \[s\]
    pub(crate) time: f64,
    /// \[1\] Normal of the ground, if it is tilted.
    pub(crate) up: Option<[f64; 3]>,
    /// \[m\] @world Height of the ground below or above the origin.
    pub(crate) height: f64,
}

const UP: [f64; 3] = [0.0, 0.0, 1.0];

impl Environment {
    /// The plane z = 0 and nothing else.
    pub fn flat() -> Self {
        Self::default()
    }

    /// The plane z = 0 with `objects`, as they are at time 0.
    pub fn new(objects: Vec<Object>) -> Self {
        let events = Vec::with_capacity(2 * objects.len());
        Self { objects, events, time: 0.0, up: None, height: 0.0 }
    }

    /// The same with the ground turned about the point of it that is above or below the origin: `roll` \[rad\] about x, then `pitch` about y.
    pub fn tilted(mut self, [roll, pitch]: [f64; 2]) -> Self {
        let up = [pitch.sin() * roll.cos(), -roll.sin(), pitch.cos() * roll.cos()];
        self.up = (up != UP).then_some(up);
        self
    }

    /// The same with the ground at `height` \[m\] over the origin: below zero, objects can have faces to stand on at z = 0 and
    /// end in a drop.
    pub fn at_height(mut self, height: f64) -> Self {
        self.height = height;
        self.objects.iter_mut().for_each(|object| object.lie_on(height));
        self
    }

    /// \[1\] @world Normal of the ground, if it is tilted and goes through the origin.
    pub fn up(&self) -> Option<[f64; 3]> {
        self.up.filter(|_| self.height == 0.0)
    }

    /// The objects, present or not.
    pub fn objects(&self) -> &[Object] {
        &self.objects
    }

    /// \[1\] Coefficient of friction of what was hit, if it has its own.
    pub fn friction(&self, surface: Surface) -> Option<f64> {
        match surface {
            Surface::Object(i) => self.objects.get(i)?.friction,
            Surface::Ground | Surface::Far => None,
        }
    }

    /// Gap and normal at `p` \[m\] @world.
    #[inline]
    pub fn query(&self, p: [f64; 3]) -> Hit {
        let ground = match self.up {
            None => Hit { gap: p[2] - self.height, normal: UP, surface: Surface::Ground },
            Some(n) => {
                let gap = p[0] * n[0] + p[1] * n[1] + (p[2] - self.height) * n[2];
                Hit { gap, normal: n, surface: Surface::Ground }
            }
        };
        if self.objects.is_empty() && ground.gap.is_finite() { ground } else { self.query_objects(p, ground) }
    }

    fn query_objects(&self, p: [f64; 3], ground: Hit) -> Hit {
        if !p.iter().all(|x| x.is_finite()) {
            return Hit { gap: f64::INFINITY, normal: UP, surface: Surface::Far };
        }
        let at = Vector3::from(p);
        let mut best = ground;
        for (i, object) in self.objects.iter().enumerate() {
            if !object.present {
                continue;
            }
            let outside = object.bounds().distance_squared(&at);
            if outside >= REACH * REACH {
                // Some surface may be as near as this, which matters only if nothing is nearer.
                if best.gap > REACH && outside < best.gap * best.gap {
                    best = Hit { gap: outside.sqrt(), normal: UP, surface: Surface::Far };
                }
            } else {
                let found = object.query(&at, REACH);
                let (gap, normal) = found.unwrap_or((REACH, Vector3::z()));
                if gap < best.gap {
                    let surface = if found.is_some() { Surface::Object(i) } else { Surface::Far };
                    best = Hit { gap, normal: normal.into(), surface };
                }
            }
        }
        best
    }
}
