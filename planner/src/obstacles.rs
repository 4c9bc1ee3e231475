//! Obstacles as unordered triangles, and the part of them in the way of a foot (thesis 4.3.3).
//!
//! A triangle is cut with half spaces, one after the other; what is left is a convex polygon. Nothing left: it does not
//! reach into their intersection. That is exact for a box, and needs no case for edges or corners.

use crate::pose::PlanarPose;
use crate::told_boxes::ToldBoxes;

/// A point or direction \[m\].
pub(crate) type Point = [f64; 3];
/// Most corners of a triangle cut by six half spaces.
const MAX_CORNERS: usize = 10;

/// Everything that is known to lie on the ground.
#[derive(Clone, Debug, Default)]
pub struct KnownObstacles {
    obstacles: Vec<(Vec<[Point; 3]>, Disc)>,
    /// Boxes that were told while she walks, besides those.
    pub(crate) told: ToldBoxes,
}

/// One of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Obstacle<'a> {
    /// Corners \[m\] @I_0.
    pub(crate) triangles: &'a [[Point; 3]],
    /// It lies in it.
    pub(crate) disc: Disc,
}

/// Disc around an obstacle, seen from above: most obstacles are far away, and need no look at their triangles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Disc {
    middle: [f64; 2],
    radius: f64,
}

impl Disc {
    /// \[m\] More than rounding can be.
    const ROOM: f64 = 1e-6;

    /// Around triangles \[m\] @I_0.
    pub(crate) fn around(triangles: &[[Point; 3]]) -> Self {
        let corners = || triangles.iter().flatten();
        let [x, y] = [0, 1].map(|d| {
            let (low, high) =
                corners().fold((f64::MAX, f64::MIN), |(low, high), p| (low.min(p[d]), high.max(p[d])));
            0.5 * low + 0.5 * high
        });
        let radius = corners().map(|p| (p[0] - x).hypot(p[1] - y)).fold(0.0, f64::max);
        Self { middle: [x, y], radius: radius + Self::ROOM }
    }
}

/// Bounding box, in a frame, of the part of an obstacle in a strip along the x axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// \[m\] Its least x.
    pub begin: f64,
    /// \[m\] Its greatest x.
    pub end: f64,
    /// \[m\] Its greatest height in I_0.
    pub top: f64,
}

/// A box that stands upright: a foot.
#[derive(Clone, Copy, Debug)]
pub struct Upright {
    /// Its pose in I_0.
    pub at: PlanarPose,
    /// \[m\] Back, front, right, left, as [`crate::sole::Sole::new`] takes them.
    pub sides: [f64; 4],
    /// \[m\] Its lower and its upper side, in I_0.
    pub height: [f64; 2],
}

impl KnownObstacles {
    /// Obstacles of one list of triangles \[m\] @I_0 each.
    pub fn new(obstacles: impl IntoIterator<Item = Vec<[Point; 3]>>) -> Self {
        let mut known = Self::default();
        obstacles.into_iter().for_each(|triangles| known.add(triangles));
        known
    }

    /// Adds one obstacle, triangles \[m\] @I_0. Those with a number that is not finite are left out.
    pub fn add(&mut self, triangles: impl IntoIterator<Item = [Point; 3]>) {
        let finite = |t: &[Point; 3]| t.iter().flatten().all(|x| x.is_finite());
        let triangles: Vec<_> = triangles.into_iter().filter(finite).collect();
        let disc = Disc::around(&triangles);
        self.obstacles.push((triangles, disc));
    }

    /// Nothing there?
    pub fn is_empty(&self) -> bool {
        self.all().all(|obstacle| obstacle.triangles.is_empty())
    }

    fn all(&self) -> impl Iterator<Item = Obstacle<'_>> {
        self.obstacles
            .iter()
            .map(|(triangles, disc)| Obstacle { triangles, disc: *disc })
            .chain(self.told.all())
    }

    /// Extent of the part of each obstacle between y = `strip[0]` and `strip[1]` of the frame `at`.
    pub(crate) fn extents(&self, at: PlanarPose, strip: [f64; 2]) -> impl Iterator<Item = Extent> {
        let view = View::from(&at);
        let beside = move |disc: &Disc| {
            let [_, y] = at.local(disc.middle);
            y - disc.radius > strip[1] || y + disc.radius < strip[0]
        };
        self.all().filter(move |obstacle| !beside(&obstacle.disc)).filter_map(move |obstacle| {
            let own = obstacle.triangles.iter().filter_map(|corners| {
                let mut piece = view.of(corners);
                piece.cut([0.0, 1.0, 0.0], strip[1]);
                piece.cut([0.0, -1.0, 0.0], -strip[0]);
                piece.extent()
            });
            own.reduce(|a, b| Extent {
                begin: a.begin.min(b.begin),
                end: a.end.max(b.end),
                top: a.top.max(b.top),
            })
        })
    }

    /// Does a triangle reach into the box?
    pub fn hit(&self, foot: &Upright) -> bool {
        let ([back, front, right, left], [low, high]) = (foot.sides, foot.height);
        let (view, reach) =
            (View::from(&foot.at), back.abs().max(front.abs()).hypot(right.abs().max(left.abs())));
        let away = |disc: &Disc| {
            let [x, y] = disc.middle;
            (x - foot.at.x).hypot(y - foot.at.y) > disc.radius + reach
        };
        let near = self.all().filter(|obstacle| !away(&obstacle.disc));
        near.flat_map(|obstacle| obstacle.triangles).any(|corners| {
            let mut piece = view.of(corners);
            piece.cut([1.0, 0.0, 0.0], front);
            piece.cut([-1.0, 0.0, 0.0], -back);
            piece.cut([0.0, 1.0, 0.0], left);
            piece.cut([0.0, -1.0, 0.0], -right);
            piece.cut([0.0, 0.0, 1.0], high);
            piece.cut([0.0, 0.0, -1.0], -low);
            piece.len > 0
        })
    }
}

/// A convex polygon in space.
struct Polygon {
    len: usize,
    corners: [Point; MAX_CORNERS],
}

/// Look from a frame, for many triangles.
#[derive(Clone, Copy)]
struct View {
    from: [f64; 2],
    /// Sine and cosine of the turn into the frame.
    turn: (f64, f64),
}

impl View {
    fn from(frame: &PlanarPose) -> Self {
        Self { from: [frame.x, frame.y], turn: (-frame.heading).sin_cos() }
    }

    /// The triangle in the frame.
    fn of(&self, triangle: &[Point; 3]) -> Polygon {
        let mut corners = [[0.0; 3]; MAX_CORNERS];
        let (s, c) = self.turn;
        for (to, from) in corners.iter_mut().zip(triangle) {
            let [x, y] = [from[0] - self.from[0], from[1] - self.from[1]];
            *to = [c * x - s * y, s * x + c * y, from[2]];
        }
        Polygon { len: 3, corners }
    }
}

impl Polygon {
    /// Keeps what lies in normal . p <= offset (Sutherland and Hodgman).
    fn cut(&mut self, normal: Point, offset: f64) {
        let above = |p: &Point| (0..3).map(|d| normal[d] * p[d]).sum::<f64>() - offset;
        let (old, n) = (self.corners, self.len);
        self.len = 0;
        for i in 0..n {
            let (a, b) = (old[i], old[(i + 1) % n]);
            let (ga, gb) = (above(&a), above(&b));
            if ga <= 0.0 {
                self.push(a);
            }
            if (ga < 0.0 && gb > 0.0) || (ga > 0.0 && gb < 0.0) {
                let s = ga / (ga - gb);
                self.push([0, 1, 2].map(|d| a[d] + s * (b[d] - a[d])));
            }
        }
    }

    fn push(&mut self, p: Point) {
        if self.len < MAX_CORNERS {
            self.corners[self.len] = p;
            self.len += 1;
        }
    }

    fn extent(&self) -> Option<Extent> {
        let of = |p: &Point| Extent { begin: p[0], end: p[0], top: p[2] };
        self.corners[..self.len].iter().map(of).reduce(|a, b| Extent {
            begin: a.begin.min(b.begin),
            end: a.end.max(b.end),
            top: a.top.max(b.top),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of 1 m at the height 0.1 m, turned by 45 degrees: corners on the axes.
    fn diamond() -> KnownObstacles {
        let r = std::f64::consts::FRAC_1_SQRT_2;
        let (a, b, c, d) = ([r, 0.0, 0.1], [0.0, r, 0.1], [-r, 0.0, 0.1], [0.0, -r, 0.1]);
        let mut obstacles = KnownObstacles::default();
        obstacles.add([[a, b, c], [c, d, a]]);
        obstacles
    }

    #[test]
    fn extent_in_a_strip_is_that_of_the_cut_diamond() {
        let r = std::f64::consts::FRAC_1_SQRT_2;
        let all: Vec<_> = diamond().extents(PlanarPose::default(), [0.5, 1.0]).collect();
        assert_eq!(all.len(), 1);
        assert!((all[0].end - (r - 0.5)).abs() < 1e-12 && (all[0].begin + (r - 0.5)).abs() < 1e-12);
        assert_eq!(all[0].top, 0.1);
        assert_eq!(diamond().extents(PlanarPose::default(), [0.8, 1.0]).count(), 0);
        // Seen from a frame turned by 45 degrees it is an upright square.
        let turned = PlanarPose::new(2.0, 0.0, std::f64::consts::FRAC_PI_4);
        let e = diamond().extents(turned, [-9.0, 9.0]).next().unwrap();
        assert!((e.end - e.begin - 1.0).abs() < 1e-12);
    }

    #[test]
    fn boxes_hit_exactly_what_they_reach() {
        let r = std::f64::consts::FRAC_1_SQRT_2;
        let foot = |x: f64, y: f64, heading: f64, height: [f64; 2]| Upright {
            at: PlanarPose::new(x, y, heading),
            sides: [-0.2, 0.1, -0.05, 0.05],
            height,
        };
        assert!(diamond().hit(&foot(0.0, 0.0, 0.3, [0.0, 0.2])), "the square passes through it");
        assert!(!diamond().hit(&foot(0.0, 0.0, 0.3, [0.11, 0.2])), "above");
        assert!(!diamond().hit(&foot(0.0, 0.0, 0.3, [0.0, 0.09])), "below");
        assert!(diamond().hit(&foot(-r - 0.09, 0.0, 0.0, [0.0, 0.2])), "toe over the corner");
        assert!(!diamond().hit(&foot(-r - 0.11, 0.0, 0.0, [0.0, 0.2])), "toe before the corner");
        // Beside an edge: bounding boxes overlap, the bodies do not.
        assert!(!diamond().hit(&foot(0.5, 0.5, 0.0, [0.0, 0.2])));
    }

    /// An obstacle with a second triangle far away has a disc that leaves nothing out.
    #[test]
    fn what_is_left_out_for_its_disc_is_not_in_the_way() {
        let mut seed = 11u64;
        let mut random = |lo: f64, hi: f64| {
            seed ^= seed << 13;
            seed ^= seed >> 7;
            seed ^= seed << 17;
            lo + (hi - lo) * (seed >> 11) as f64 / (1u64 << 53) as f64
        };
        let (mut hits, mut seen) = (0, 0);
        for _ in 0..20_000 {
            let middle = [random(-0.8, 0.8), random(-0.8, 0.8)];
            let corner = |z: f64| [middle[0] + random(-0.3, 0.3), middle[1] + random(-0.3, 0.3), z];
            let t: [Point; 3] = [0.0, 0.05, 0.1].map(corner);
            // So far ahead and so high that no foot and, turned as the frames are, no strip reaches it.
            let far = t.map(|[x, y, _]| [x + 1e4, y + 1e4, 50.0]);
            let (mut near, mut whole) = (KnownObstacles::default(), KnownObstacles::default());
            near.add([t]);
            whole.add([t, far]);
            let at = PlanarPose::new(random(-0.3, 0.3), random(-0.3, 0.3), random(-0.7, 0.7));
            let foot = Upright { at, sides: [-0.26, 0.04, -0.05, 0.05], height: [0.0, 0.08] };
            assert_eq!(near.hit(&foot), whole.hit(&foot));
            let strip = [random(-0.4, 0.0), random(0.0, 0.4)];
            let found = near.extents(at, strip).next();
            assert_eq!(found, whole.extents(at, strip).next());
            hits += u32::from(near.hit(&foot));
            seen += u32::from(found.is_some());
        }
        assert!(hits > 500 && seen > 2000, "{hits} hits, {seen} seen");
    }

    /// Random boxes against the same question asked of many points of the triangle.
    #[test]
    fn agrees_with_sampled_triangles() {
        let mut seed = 7u64;
        let mut random = |lo: f64, hi: f64| {
            seed ^= seed << 13;
            seed ^= seed >> 7;
            seed ^= seed << 17;
            lo + (hi - lo) * (seed >> 11) as f64 / (1u64 << 53) as f64
        };
        let mut hits = 0;
        for _ in 0..500 {
            let t: [Point; 3] = std::array::from_fn(|_| std::array::from_fn(|_| random(-0.5, 0.5)));
            let mut obstacles = KnownObstacles::default();
            obstacles.add([t]);
            let at = PlanarPose::new(random(-0.3, 0.3), random(-0.3, 0.3), random(-3.0, 3.0));
            let foot = Upright { at, sides: [-0.2, 0.1, -0.05, 0.1], height: [-0.1, 0.2] };
            let inside = (0..=60)
                .flat_map(|i| (0..=60 - i).map(move |j| (i as f64 / 60.0, j as f64 / 60.0)))
                .any(|(u, v)| {
                    let p: Point =
                        std::array::from_fn(|d| t[0][d] + u * (t[1][d] - t[0][d]) + v * (t[2][d] - t[0][d]));
                    let [x, y] = at.local([p[0], p[1]]);
                    let within = |x: f64, lo: f64, hi: f64| x > lo && x < hi;
                    within(x, -0.2, 0.1) && within(y, -0.05, 0.1) && within(p[2], -0.1, 0.2)
                });
            assert!(!inside || obstacles.hit(&foot));
            // The other way round with a box a little larger than the spacing of the points would miss.
            let larger = Upright { sides: [-0.22, 0.12, -0.07, 0.12], height: [-0.12, 0.22], ..foot };
            let hit = obstacles.hit(&foot);
            assert!(!hit || obstacles.hit(&larger));
            hits += u32::from(hit);
            if hit {
                let near = (0..=60)
                    .flat_map(|i| (0..=60 - i).map(move |j| (i as f64 / 60.0, j as f64 / 60.0)))
                    .any(|(u, v)| {
                        let p: Point = std::array::from_fn(|d| {
                            t[0][d] + u * (t[1][d] - t[0][d]) + v * (t[2][d] - t[0][d])
                        });
                        let [x, y] = at.local([p[0], p[1]]);
                        let within = |x: f64, lo: f64, hi: f64| x > lo - 0.02 && x < hi + 0.02;
                        within(x, -0.2, 0.1) && within(y, -0.05, 0.1) && within(p[2], -0.1, 0.2)
                    });
                assert!(near, "a hit, and no point of the triangle is near");
            }
        }
        assert!(hits > 50, "{hits}");
    }
}
