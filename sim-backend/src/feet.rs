//! Contact layer under the feet: forces of the ground on each segment, and rates of the nodes.
//!
//! | symbol | name | unit | frame |
//! |---|---|---|---|
//! | d | displacement of a node from its place on the undeformed sole | m | points: world, pads: segment |
//! | F, T | force and moment of the ground on a segment (2.38), (2.39) | N, N m | world, about the segment's origin |

use std::error::Error;
use std::sync::Arc;

use config::Robot;
use config::components::ContactModel;
use contact::frame::frame;
use contact::hexahedron::{LinearElasticity, Volume};
use contact::point::{self, ContactLaw, PointState};
use contact::{Ground, Layer, Material, Memory, Pad, SegmentMotion, Settings, SolverReport, TOUCHING};
use environment::{Environment, Hit, Surface};
use messages::{ContactPoint, MAX_CONTACTS};
use multibody::{Data, Frame, Model};
use nalgebra::{IsometryMatrix3, Matrix3, Point3, Vector3};

/// Contact elements of both feet.
#[derive(Clone)]
pub struct Feet {
    law: ContactLaw,
    settings: Settings,
    segments: Vec<Segment>,
    /// True if each object of the environment carries something.
    touched: Vec<bool>,
    /// \[m\] @world Every node that can touch; kept only where there are objects.
    places: Vec<[f64; 3]>,
    /// Nodes that carry.
    carrying: Vec<ContactPoint>,
    worst: SolverReport,
}

/// A link that carries contact elements.
#[derive(Clone)]
struct Segment {
    frame: Frame,
    foot: usize,
    elements: Elements,
    force: Vector3<f64>,
    moment: Vector3<f64>,
}

/// Contact elements of a link.
#[derive(Clone)]
enum Elements {
    /// Independent nodes at these places, link axes.
    Points(Vec<Vector3<f64>>),
    /// Blocks of rubber.
    Pads(Vec<PadBlock>),
}

#[derive(Clone)]
struct PadBlock {
    pad: Pad,
    memory: Memory,
    ground: Vec<Option<Ground>>,
}

const CONVERGED: SolverReport = SolverReport { sweeps: 0, residual: 0.0, converged: true, unique: true };

/// Ground below the feet, and notes about it.
struct Below<'a> {
    ground: &'a Environment,
    touched: &'a mut [bool],
    places: &'a mut Vec<[f64; 3]>,
    carrying: &'a mut Vec<ContactPoint>,
}

/// \[m\] Height above which a node needs no exact gap: no step is so long.
const FAR: f64 = 0.05;

/// \[1/s\] Rate at which penetration of a finite step is taken back: within a few milliseconds, much faster than the layer relaxes.
/// Steps above its inverse would throw the node into the air.
pub(crate) const RECOVERY: f64 = 200.0;

/// \[m\] Gap up to which a compressed node is at the ground: steps let go of one for an instant now and then.
const AT_GROUND: f64 = 1e-4;

impl Feet {
    /// The contact elements of a robot: its points, or its pads.
    ///
    /// # Errors
    /// A link does not exist, or the pads cannot be built.
    pub fn new(
        robot: &Robot,
        model: &Model,
        contact: [ContactModel; 2],
        objects: usize,
    ) -> Result<Self, Box<dyn Error>> {
        // All pads are of one material, and share its matrices.
        let layer = if contact.contains(&ContactModel::Pads) { Some(layer(robot)?) } else { None };
        let mut segments: Vec<Segment> = Vec::new();
        let mut names: Vec<&str> = Vec::new();
        for (foot, description) in robot.feet.iter().enumerate() {
            let pads = contact[foot] == ContactModel::Pads;
            let places = if pads { &description.pads } else { &description.points };
            if places.is_empty() {
                return Err(format!(
                    "robot `{}`: its feet have no contact pads; choose depth 1, 2 or 3, or components.contact = \"points\"",
                    robot.name
                )
                .into());
            }
            for (link, at) in places {
                // One segment for each link, in the order in which the robot's file names them first.
                let i = match names.iter().position(|n| n == link) {
                    Some(i) => i,
                    None => {
                        names.push(link);
                        segments.push(Segment::new(model.frame(link, [0.0; 3])?, foot, pads));
                        names.len() - 1
                    }
                };
                segments[i].elements.add(Vector3::from(*at), layer.as_ref());
            }
        }
        let settings = Settings::of_friction(robot.contact.friction);
        let nodes: usize = segments.iter().map(|s| s.elements.nodes()).sum();
        let corners: usize = segments.iter().map(|s| s.elements.corners()).sum();
        if corners > MAX_CONTACTS {
            return Err(format!(
                "robot `{}`: {corners} contact points (four of a pad); a log holds {MAX_CONTACTS}",
                robot.name
            )
            .into());
        }
        Ok(Self {
            law: law(robot),
            settings,
            segments,
            touched: vec![false; objects],
            places: Vec::with_capacity(if objects > 0 { nodes } else { 0 }),
            carrying: Vec::with_capacity(corners),
            worst: CONVERGED,
        })
    }

    /// Contact nodes of both feet.
    pub fn nodes(&self) -> usize {
        self.segments.iter().map(|s| s.elements.nodes()).sum()
    }

    /// Frames of all segments.
    pub fn frames(&self) -> Vec<Frame> {
        self.segments.iter().map(|s| s.frame).collect()
    }

    /// Which objects of the environment carry something, after [`Feet::update`].
    pub fn touched(&self) -> &[bool] {
        &self.touched
    }

    /// \[m\] @world Places of the nodes that can touch, after [`Feet::update`]; empty on ground without objects.
    pub fn places(&self) -> &[[f64; 3]] {
        &self.places
    }

    /// Nodes that carry, after [`Feet::update`]; of a pad the outermost ones.
    pub(crate) fn carrying(&self) -> &[ContactPoint] {
        &self.carrying
    }

    /// Worst end of the solver of the pads since the last call.
    pub(crate) fn take_worst(&mut self) -> SolverReport {
        std::mem::replace(&mut self.worst, CONVERGED)
    }

    /// \[m\] Depth to which a robot of `weight` \[N\] presses flat soles in.
    pub fn deflection(&self, weight: f64) -> f64 {
        let stiffness = |e: &Elements| match e {
            Elements::Points(places) => self.law.stiffness[2] * places.len() as f64,
            Elements::Pads(blocks) => blocks.iter().map(|b| b.pad.layer().block_stiffness(2)).sum(),
        };
        weight / self.segments.iter().map(|s| stiffness(&s.elements)).sum::<f64>()
    }

    /// Height \[m\] of the lowest place of the undeformed soles, after the model's kinematics.
    pub fn lowest(&self, model: &Model, data: &Data) -> f64 {
        let of = |s: &Segment| s.elements.lowest(&model.frame_pose(data, &s.frame));
        self.segments.iter().map(of).fold(f64::INFINITY, f64::min)
    }

    /// Presses flat soles in by `depth` \[m\]: writes the displacements `d` of a robot that stands upright.
    pub fn press(&self, model: &Model, data: &Data, depth: f64, d: &mut [f64]) {
        let lowest = self.lowest(model, data);
        let mut at = 0;
        for s in &self.segments {
            let pose = model.frame_pose(data, &s.frame);
            let Elements::Points(places) = &s.elements else { continue }; // pads find their shape by themselves
            for place in places {
                let low = (pose * Point3::from(*place)).z - lowest;
                d[at + 2] = (depth - low).max(0.0);
                at += 3;
            }
        }
    }

    /// Forces of the ground, and rates of the nodes for displacements `d`, after the model's kinematics and motion.
    pub fn update(&mut self, model: &Model, data: &Data, ground: &Environment, d: &[f64], rate: &mut [f64]) {
        let Self { law, settings, segments, touched, places: seen, carrying, worst } = self;
        touched.fill(false);
        seen.clear();
        carrying.clear();
        let mut below = Below { ground, touched, places: seen, carrying };
        let mut at = 0;
        for s in segments {
            let pose = model.frame_pose(data, &s.frame);
            let twist = model.frame_velocity(data, &s.frame);
            let n = 3 * s.elements.nodes();
            let (d, rate) = (&d[at..at + n], &mut rate[at..at + n]);
            (s.force, s.moment) = match &mut s.elements {
                Elements::Points(places) => points(law, places, &pose, &twist, &mut below, d, rate),
                Elements::Pads(blocks) => {
                    // A pad is solved in the axes of its link, where its matrices are constant.
                    let inside = SegmentMotion {
                        linear: pose.rotation.inverse() * twist.linear,
                        angular: pose.rotation.inverse() * twist.angular,
                    };
                    let per = 3 * blocks[0].pad.layer().nodes();
                    let parts = d.chunks_exact(per).zip(rate.chunks_exact_mut(per));
                    let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
                    for (block, (d, rate)) in blocks.iter_mut().zip(parts) {
                        let friction = block.look(&pose, &mut below, d).unwrap_or(settings.friction);
                        let PadBlock { pad, memory, ground } = block;
                        let settings = Settings { friction, ..*settings };
                        let out = pad.solve(memory, d, ground, &inside, &settings, rate);
                        // A pad that is not solved goes on with the last sweep's forces, and is reported.
                        if !out.report.converged && out.report.residual >= worst.residual {
                            *worst = out.report;
                        }
                        block.note(&pose, &mut below, d);
                        force += out.force;
                        moment += out.moment;
                    }
                    (pose.rotation * force, pose.rotation * moment)
                }
            };
            at += n;
        }
    }

    /// Adds what the ground does to a generalized force (2.40), after [`Feet::update`].
    pub(crate) fn add_to(&self, model: &Model, data: &Data, generalized: &mut [f64]) {
        for s in self.loaded() {
            model.add_wrench(data, &s.frame, &s.force, &s.moment, generalized);
        }
    }

    /// Force and moment about `at` of the ground on the robot or, if given, on one foot; world axes.
    pub fn total(
        &self,
        model: &Model,
        data: &Data,
        at: &Vector3<f64>,
        foot: Option<usize>,
    ) -> (Vector3<f64>, Vector3<f64>) {
        let wanted = self.loaded().filter(|s| foot.is_none_or(|foot| s.foot == foot));
        wanted.fold(Default::default(), |(f, m), s| {
            let arm = model.frame_position(data, &s.frame) - at;
            (f + s.force, m + s.moment + arm.cross(&s.force))
        })
    }

    fn loaded(&self) -> impl Iterator<Item = &Segment> {
        self.segments.iter().filter(|s| s.force != Vector3::zeros())
    }
}

/// Independent nodes of one segment: force and moment on it, world axes.
fn points(
    law: &ContactLaw,
    places: &[Vector3<f64>],
    pose: &IsometryMatrix3<f64>,
    twist: &multibody::Twist,
    below: &mut Below<'_>,
    d: &[f64],
    rate: &mut [f64],
) -> (Vector3<f64>, Vector3<f64>) {
    let (mut sum, mut moment) = (Vector3::zeros(), Vector3::zeros());
    for ((place, d), rate) in places.iter().zip(d.chunks_exact(3)).zip(rate.chunks_exact_mut(3)) {
        let (arm, d) = (pose.rotation * place, Vector3::new(d[0], d[1], d[2]));
        let w = twist.linear + twist.angular.cross(&arm);
        let node = (pose.translation.vector + arm + d).into();
        let hit = below.hit(node);
        let level = hit.surface == Surface::Ground && hit.normal[2] == 1.0;
        // Level ground, nearly always: the axes of the law are those of the world.
        let (force, speed) = if level {
            let answer = point::solve(law, d.into(), w.into(), hit.gap);
            (Vector3::from(answer.force), Vector3::from(answer.rate))
        } else {
            let e: Matrix3<f64> = frame(&Vector3::from(hit.normal));
            let inside = |x: &Vector3<f64>| <[f64; 3]>::from(e.tr_mul(x));
            let law =
                ContactLaw { friction: below.ground.friction(hit.surface).unwrap_or(law.friction), ..*law };
            let answer = point::solve(&law, inside(&d), inside(&w), hit.gap);
            if let (Surface::Object(i), true) = (hit.surface, answer.state != PointState::Open) {
                below.touched[i] = true;
            }
            (e * Vector3::from(answer.force), e * Vector3::from(answer.rate))
        };
        rate.copy_from_slice(speed.as_slice());
        if force != Vector3::zeros() || at_ground(&hit, &d) {
            below.carrying.push(ContactPoint { place: node, normal: hit.normal });
        }
        sum += force; // (2.38)
        moment += (arm + d).cross(&force); // (2.39) with the deformed node
    }
    (sum, moment)
}

/// True for a node at the ground that is compressed; its displacement `d` \[m\] in world axes.
fn at_ground(hit: &Hit, d: &Vector3<f64>) -> bool {
    hit.gap < AT_GROUND && Vector3::from(hit.normal).dot(d) > 0.0
}

impl PadBlock {
    /// Looks where the ground is under every node of the sole; friction of an object that carries, if it has its own.
    fn look(&mut self, pose: &IsometryMatrix3<f64>, below: &mut Below<'_>, d: &[f64]) -> Option<f64> {
        let back = pose.rotation.inverse();
        let mut friction = None;
        for (i, (to, d)) in self.ground.iter_mut().zip(d.chunks_exact(3)).enumerate() {
            let node = pose * Point3::from(self.pad.place(i) + Vector3::new(d[0], d[1], d[2]));
            let hit = below.hit(node.coords.into());
            let near = hit.surface != Surface::Far && hit.gap < FAR;
            *to = near.then(|| Ground { gap: hit.gap, normal: back * Vector3::from(hit.normal) });
            if let (Surface::Object(object), true) = (hit.surface, hit.gap < TOUCHING) {
                below.touched[object] = true;
                friction = friction.or(below.ground.friction(hit.surface));
            }
        }
        friction
    }

    /// Notes the outermost nodes that carry.
    fn note(&self, pose: &IsometryMatrix3<f64>, below: &mut Below<'_>, d: &[f64]) {
        let own = |i: usize| Vector3::new(d[3 * i], d[3 * i + 1], d[3 * i + 2]);
        let rests =
            |i: usize| self.ground[i].is_some_and(|g| g.gap < AT_GROUND && g.normal.dot(&own(i)) > 0.0);
        for (i, ground) in self.pad.outermost(rests).filter_map(|i| Some((i, self.ground[i]?))) {
            let place = (pose * Point3::from(self.pad.place(i) + own(i))).coords.into();
            below.carrying.push(ContactPoint { place, normal: (pose.rotation * ground.normal).into() });
        }
    }
}

impl Below<'_> {
    fn hit(&mut self, node: [f64; 3]) -> Hit {
        if !self.touched.is_empty() {
            self.places.push(node);
        }
        self.ground.query(node)
    }
}

impl Elements {
    fn add(&mut self, at: Vector3<f64>, layer: Option<&Arc<Layer>>) {
        match (self, layer) {
            (Self::Points(places), _) => places.push(at),
            (Self::Pads(blocks), Some(layer)) => {
                let pad = Pad::new(layer.clone(), at);
                let n = layer.contacts();
                blocks.push(PadBlock { memory: pad.memory(), ground: vec![None; n], pad });
            }
            (Self::Pads(_), None) => {}
        }
    }

    fn nodes(&self) -> usize {
        match self {
            Self::Points(places) => places.len(),
            Self::Pads(blocks) => blocks.iter().map(|b| b.pad.layer().nodes()).sum(),
        }
    }

    /// Most nodes that [`Feet::carrying`] can hold of it.
    fn corners(&self) -> usize {
        match self {
            Self::Points(places) => places.len(),
            Self::Pads(blocks) => 4 * blocks.len(),
        }
    }

    fn lowest(&self, pose: &IsometryMatrix3<f64>) -> f64 {
        let height = |place: Vector3<f64>| (pose * Point3::from(place)).z;
        match self {
            Self::Points(places) => places.iter().map(|p| height(*p)).fold(f64::INFINITY, f64::min),
            Self::Pads(blocks) => blocks
                .iter()
                .flat_map(|b| (0..b.pad.layer().contacts()).map(move |i| b.pad.place(i)))
                .map(height)
                .fold(f64::INFINITY, f64::min),
        }
    }
}

impl Segment {
    fn new(frame: Frame, foot: usize, pads: bool) -> Self {
        let elements = if pads { Elements::Pads(Vec::new()) } else { Elements::Points(Vec::new()) };
        Self { frame, foot, elements, force: Vector3::zeros(), moment: Vector3::zeros() }
    }
}

/// The matrices that all pads share.
fn layer(robot: &Robot) -> Result<Arc<Layer>, Box<dyn Error>> {
    let Some(p) = robot.contact.pads else {
        return Err(format!(
            "robot `{}`: robot.toml has no [contact.pads]; take contact points (depth 1 to 3, components.contact = \"points\"), or \
             describe the pads",
            robot.name
        )
        .into());
    };
    let material = Material {
        size: p.size,
        bricks: p.bricks,
        elasticity: LinearElasticity { modulus: p.modulus, poisson: p.poisson },
        volume: Volume::Full,
        damping_time: robot.contact.damping_time,
    };
    Ok(Arc::new(Layer::new(&material)?))
}

fn law(robot: &Robot) -> ContactLaw {
    let c = &robot.contact;
    let stiffness = [c.tangential_stiffness, c.tangential_stiffness, c.normal_stiffness];
    ContactLaw {
        stiffness,
        damping: stiffness.map(|k| k * c.damping_time),
        friction: c.friction,
        recovery: RECOVERY,
    }
}
