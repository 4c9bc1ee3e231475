//! Links and joints that `robot.toml` names, held against the URDF.

use std::path::Path;

use messages::{LEFT, RIGHT};
use multibody::{Data, Model};

use crate::error::{ConfigError, Problem};
use crate::leg;
use crate::robot::Robot;

/// \[kg\] Tolerance between the URDF's masses and the robot's total mass.
const MASS_TOLERANCE: f64 = 1e-3;
/// \[m\] Tolerance of a support rectangle that is the hull of the contact points.
const HULL_TOLERANCE: f64 = 1e-6;
/// Tables of the feet.
const SIDES: [&str; 2] = ["foot.right", "foot.left"];

/// Problems of a robot whose `robot.toml` at `path` and whose URDF, named `urdf_path`, are not of one robot.
pub(crate) fn compare(robot: &Robot, path: &Path, urdf_path: &Path) -> Result<(), ConfigError> {
    let of_urdf = |text: String| ConfigError::of_file(urdf_path, text);
    let masses = Model::urdf_mass(&robot.urdf).map_err(|e| of_urdf(e.to_string()))?;
    let total = robot.total_mass;
    if (masses - total).abs() > MASS_TOLERANCE {
        let text = format!("its masses sum to {masses:.3} kg, but total_mass in robot.toml is {total} kg");
        return Err(of_urdf(text));
    }
    let model = robot.model().map_err(|e| of_urdf(e.to_string()))?;
    let mut comparison = Comparison { robot, model: &model, problems: Vec::new() };
    comparison.joints();
    if comparison.links() {
        comparison.feet();
        comparison.supports();
        comparison.limbs();
    }
    let problems = comparison.problems;
    if !problems.is_empty() {
        return Err(ConfigError { file: path.to_path_buf(), problems });
    }
    leg::compare_with_urdf(robot, &model).map_err(|text| ConfigError::of_file(path, text))
}

struct Comparison<'a> {
    robot: &'a Robot,
    model: &'a Model,
    problems: Vec<Problem>,
}

impl Comparison<'_> {
    fn note(&mut self, key: String, text: String) {
        self.problems.push(Problem { line: 0, key, text });
    }

    /// Every joint turns: ranges, speeds and torques of `robot.toml` are those of turning joints.
    fn joints(&mut self) {
        for (j, joint) in self.robot.joints.iter().enumerate() {
            if self.model.slides(j) {
                let text =
                    format!("`{}` is prismatic in the URDF; joints of a robot are revolute", joint.name);
                self.note(format!("joint[{j}]"), text);
            }
        }
    }

    /// Does every link that is named exist?
    fn links(&mut self) -> bool {
        let mut named = Vec::new();
        for (side, foot) in SIDES.into_iter().zip(&self.robot.feet) {
            named.push((format!("{side}.link"), &foot.link));
            named.push((format!("{side}.sensor_link"), &foot.sensor_link));
            for (key, elements) in [("points", &foot.points), ("pads", &foot.pads)] {
                for (i, (link, _)) in elements.iter().enumerate() {
                    named.push((format!("{side}.{key}[{i}].link"), link));
                }
            }
        }
        named.extend(self.robot.head.iter().map(|head| ("head.link".to_owned(), &head.link)));
        let links: Vec<&str> = self.model.link_names().collect();
        for (key, link) in named {
            if !links.contains(&link.as_str()) {
                let near = messages::nearest(link, &links)
                    .map_or(String::new(), |n| format!("; the nearest is `{n}`"));
                self.note(key, format!("the URDF has no link `{link}`{near}"));
            }
        }
        self.problems.is_empty()
    }

    /// Joints from the body of a link to the torso, the nearest first.
    fn chain(&self, link: &str) -> Vec<usize> {
        let moved_by = self.model.frame(link, [0.0; 3]).ok().and_then(|frame| frame.joint());
        std::iter::successors(moved_by, |&joint| self.model.parent_joint(joint)).collect()
    }

    /// Sensor, contact elements and toe joint of each foot belong to its leg alone.
    fn feet(&mut self) {
        let chains = [RIGHT, LEFT].map(|foot| self.chain(&self.robot.feet[foot].link));
        for foot in [RIGHT, LEFT] {
            let (side, of) = (SIDES[foot], &self.robot.feet[foot]);
            let (own, other) = (&chains[foot], &chains[1 - foot]);
            // Below where the legs part, on the way to the sole or beyond it.
            let in_leg = |link: &str| {
                let chain = self.chain(link);
                let joins = chain.first().is_some_and(|joint| own.contains(joint) && !other.contains(joint));
                joins || own.first().is_some_and(|sole| !other.contains(sole) && chain.contains(sole))
            };
            let elements =
                [("points", &of.points), ("pads", &of.pads)].into_iter().flat_map(|(key, elements)| {
                    elements.iter().enumerate().map(move |(i, (link, _))| (format!("{key}[{i}].link"), link))
                });
            let named = [("link".to_owned(), &of.link), ("sensor_link".to_owned(), &of.sensor_link)];
            let strange = named.into_iter().chain(elements).find(|(_, link)| !in_leg(link));
            let turned = of.toe.filter(|toe| own.first() != Some(toe));
            if let Some((key, link)) = strange {
                self.note(format!("{side}.{key}"), format!("`{link}` is no part of this leg alone"));
            }
            if let Some(toe) = turned {
                let (name, link) = (&self.robot.joints[toe].name, &of.link);
                let text =
                    format!("joint `{name}` is not the one that moves `{link}`, which carries the sole");
                self.note(format!("{side}.toe"), text);
            }
        }
    }

    /// The support of each foot lies within the outline of its contact points, in the sole frame, toes straight.
    fn supports(&mut self) {
        let mut data = Data::new(self.model);
        self.model.forward_kinematics(&mut data, &self.model.neutral());
        for (side, of) in SIDES.into_iter().zip(&self.robot.feet) {
            let place = |link: &str, at: [f64; 3]| self.model.frame(link, at).ok();
            let sole = place(&of.link, of.sole).map(|sole| self.model.frame_pose(&data, &sole));
            let points = of.points.iter().filter_map(|(link, at)| {
                let point = self.model.frame_position(&data, &place(link, *at)?);
                Some(sole?.inverse_transform_point(&point.into()))
            });
            let outline =
                points.fold([f64::MAX, f64::MIN, f64::MAX, f64::MIN], |[back, front, right, left], p| {
                    [back.min(p.x), front.max(p.x), right.min(p.y), left.max(p.y)]
                });

            for (key, [low, high], [from, to]) in [
                ("support_x", [of.support[0], of.support[1]], [outline[0], outline[1]]),
                ("support_y", [of.support[2], of.support[3]], [outline[2], outline[3]]),
            ] {
                if low < from - HULL_TOLERANCE || high > to + HULL_TOLERANCE {
                    let text = format!(
                        "[{low}, {high}] m reaches beyond the contact points, which lie from {from:.4} to {to:.4} m in the sole frame"
                    );
                    self.note(format!("{side}.{key}"), text);
                }
            }
        }
    }

    /// Joints of head and arms are different ones, and move no foot.
    fn limbs(&mut self) {
        let legs: Vec<usize> = self.robot.feet.iter().flat_map(|foot| self.chain(&foot.link)).collect();
        let head = self.robot.head.iter().flat_map(|head| [("head.pan", head.pan), ("head.tilt", head.tilt)]);
        let arms = self
            .robot
            .arms
            .iter()
            .flat_map(|arms| [("arms.right", arms.joints[0]), ("arms.left", arms.joints[1])]);
        let mut taken = Vec::new();
        for (key, joint) in head.chain(arms) {
            let name = &self.robot.joints[joint].name;
            if legs.contains(&joint) {
                self.note(key.to_owned(), format!("joint `{name}` moves a foot"));
            } else if taken.contains(&joint) {
                self.note(key.to_owned(), format!("joint `{name}` is named twice"));
            }
            taken.push(joint);
        }
    }
}
