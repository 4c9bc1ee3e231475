//! One joint on a bench: a motor, its gear and a link on a base too heavy to feel them, with the drives, gears, friction and
//! controllers that move the robot. The axis is vertical, so weight does nothing.

use config::Robot;
use config::method::Integrator;
use config::robot::Drive;
use drives::{CascadePi, ControlLaw, Sampling, Transmission};
use environment::Environment;
use sim_backend::drive::{JointCubic, JointMotion};
use sim_backend::integrate::Stepper;
use sim_backend::plant::{Plant, PlantInputs, Substep};

use crate::Error;

/// A robot of one joint, number 0, whose link has this inertia \[kg m^2\]; what else it is made of is the template's.
pub(crate) fn one_joint(template: &Robot, drive: Drive, inertia: f64) -> Robot {
    let mut robot = template.clone();
    robot.urdf = format!(
        r#"<robot name="bench"><link name="base"><inertial><mass value="1e6"/>
        <inertia ixx="1e7" ixy="0" ixz="0" iyy="1e7" iyz="0" izz="1e7"/></inertial></link>
        <joint name="joint" type="continuous"><parent link="base"/><child link="link"/><axis xyz="0 0 1"/></joint>
        <link name="link"><inertial><mass value="1"/>
        <inertia ixx="{inertia}" ixy="0" ixz="0" iyy="{inertia}" iyz="0" izz="{inertia}"/></inertial></link></robot>"#
    );
    robot.torso = "base".into();
    robot.joints.truncate(1);
    robot.joints[0].name = "joint".into();
    for foot in &mut robot.feet {
        (foot.link, foot.sensor_link, foot.toe) = ("base".into(), "base".into(), None);
        foot.points.iter_mut().for_each(|point| point.0 = "base".into());
        foot.pads.clear();
    }
    robot.contact.pads = None;
    robot.drives = vec![Drive { joints: vec![0], stator: "base".into(), axis: [0.0, 0.0, 1.0], ..drive }];
    robot
}

/// A joint whose drive has a clock of its own.
#[derive(Clone)]
pub(crate) struct ServoBench {
    template: Robot,
    pub(crate) drive: Drive,
    /// \[kg m^2\] Of the link.
    pub(crate) link: f64,
}

/// What a joint on the bench is told and what disturbs it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Course {
    /// \[rad/s\] Speed of the rotor at the beginning.
    pub(crate) kick: f64,
    /// \[rad/s\] Reference of the rotor's speed, from the beginning on.
    pub(crate) speed: f64,
    /// \[rad\] Reference of its angle, where the speed's is zero.
    pub(crate) angle: f64,
    /// \[rad\], \[s\] Angle of the joint that is led there from 0 to rest by a quintic, and how long that takes; else none.
    pub(crate) stroke: Option<[f64; 2]>,
    /// \[N m\] Torque on the link, and how long it takes to come \[s\].
    pub(crate) load: f64,
    pub(crate) ramp: f64,
    /// \[s\]
    pub(crate) seconds: f64,
}

/// State of the shaft at a sample of its speed loop.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShaftState {
    /// \[s\]
    pub(crate) time: f64,
    /// \[rad\], \[rad/s\] Of the rotor.
    pub(crate) angle: f64,
    pub(crate) speed: f64,
    /// \[A\]
    pub(crate) current: f64,
}

/// Rest to rest by 10 u^3 - 15 u^4 + 6 u^5 over an angle \[rad\] and a time \[s\].
pub(crate) fn quintic([angle, seconds]: [f64; 2], time: f64) -> JointMotion {
    let u = (time / seconds).clamp(0.0, 1.0);
    JointMotion {
        angle: angle * u.powi(3) * (10.0 - u * (15.0 - 6.0 * u)),
        speed: angle / seconds * 30.0 * (u * (1.0 - u)).powi(2),
        ..JointMotion::default()
    }
}

impl ServoBench {
    /// Bench of a drive with a link of `link` \[kg m^2\].
    ///
    /// # Errors
    /// Its gear is no constant one, or its law has no clock of its own.
    pub(crate) fn new(template: &Robot, drive: Drive, link: f64) -> Result<Self, String> {
        let name = &drive.name;
        if !matches!(drive.transmission, Transmission::Harmonic { .. }) {
            return Err(format!(
                "drive `{name}`: it takes a gear with a constant ratio, and this is a linkage"
            ));
        }
        let Sampling::Period(_) = drive.control.sampling else {
            return Err(format!(
                "drive `{name}`: [joint_control] law = \"cascade_pi\" is tuned, and this drive has another one"
            ));
        };
        Ok(Self { template: template.clone(), drive, link })
    }

    /// Its law.
    pub(crate) fn law(&self) -> CascadePi {
        match self.drive.control.law {
            ControlLaw::CascadePi(law) => law,
            _ => unreachable!("a clock of its own has no other law"),
        }
    }

    /// The same with another law.
    pub(crate) fn with(&self, law: CascadePi) -> Self {
        let mut bench = self.clone();
        bench.drive.control.law = ControlLaw::CascadePi(law);
        bench
    }

    /// Ratio of the gear.
    pub(crate) fn ratio(&self) -> f64 {
        match self.drive.transmission {
            Transmission::Harmonic { ratio } => ratio,
            _ => f64::NAN,
        }
    }

    /// \[kg m^2\] Inertia on the shaft, of rotor and link.
    pub(crate) fn inertia(&self) -> f64 {
        self.drive.rotor_inertia + self.link / (self.ratio() * self.ratio())
    }

    /// States of the shaft, one for each sample of its speed loop, in steps of at most `longest` \[s\]; ends early where they
    /// are no numbers any more.
    pub(crate) fn run(&self, course: Course, longest: f64) -> Result<Vec<ShaftState>, Error> {
        let Sampling::Period(periods) = self.drive.control.sampling else { return Ok(Vec::new()) };
        let elastic = self.drive.elasticity.is_some();
        let robot = one_joint(&self.template, self.drive.clone(), self.link);
        let mut plant = Plant::new(&robot, Environment::flat(), if elastic { 3 } else { 2 }, &[0.0])?;
        let (l, mut x, n) = (*plant.layout(), plant.standing(&[0.0]), self.ratio());
        x[2] += 1e3;
        x[l.layer()].fill(0.0);
        if elastic {
            x[l.rotor_speed()][0] = course.kick / n;
        } else {
            x[l.speed()][6] = course.kick / n;
        }
        let per_sample = (periods.speed / longest).ceil() as u32;
        let (h, cycle) =
            (periods.speed / f64::from(per_sample), periods.speed * f64::from(periods.position_every));
        let drives = |time: f64| {
            if let Some(stroke) = course.stroke {
                let [from, to] = [time, time + cycle].map(|t| quintic(stroke, t));
                return [JointCubic::follow(from, to.angle, to.speed, cycle)];
            }
            let from =
                JointMotion { angle: (course.angle + course.speed * time) / n, ..JointMotion::default() };
            if course.speed == 0.0 {
                return [JointCubic::resting(from.angle)];
            }
            let speed = course.speed / n;
            [JointCubic::follow(JointMotion { speed, ..from }, from.angle + speed, speed, 1.0)]
        };
        // A rigid gear turns the rotor along.
        let loaded = if elastic { self.link } else { n * n * self.inertia() };
        let (mut stepper, inputs) = (Stepper::new(Integrator::SemiImplicit, x.len()), PlantInputs::POWERED);
        let mut states = Vec::new();
        for k in 0..(course.seconds / cycle).ceil() as u32 {
            let begin = f64::from(k) * cycle;
            let references = drives(begin);
            for i in 0..per_sample * periods.position_every {
                plant.tick(Substep { index: i, h }, &x, &references, &inputs);
                stepper.step(&mut plant, f64::from(i) * h, h, &mut x, &references, &inputs);
                let come = ((begin + f64::from(i) * h) / course.ramp.max(h)).min(1.0);
                x[l.speed()][6] += h * come * course.load / loaded;
                if (i + 1).is_multiple_of(per_sample) {
                    let [angle, speed] = match elastic {
                        true => [x[l.rotor_angle()][0], x[l.rotor_speed()][0]],
                        false => [x[l.pose()][7], x[l.speed()][6]],
                    };
                    let time = begin + f64::from(i + 1) * h;
                    states.push(ShaftState {
                        time,
                        angle: n * angle,
                        speed: n * speed,
                        current: x[l.current()][0],
                    });
                    if !(speed.abs() < 1e7) {
                        return Ok(states);
                    }
                }
            }
        }
        Ok(states)
    }
}
