//! A description that cannot be a robot is refused with one clear error that names the place.

use multibody::{Model, ModelError};

const INERTIAL: &str = r#"<inertial><origin xyz="0 0 -0.1"/><mass value="2"/>
    <inertia ixx="0.02" iyy="0.03" izz="0.04" ixy="0" ixz="0" iyz="0"/></inertial>"#;

fn link(name: &str, inertial: &str) -> String {
    format!(r#"<link name="{name}">{inertial}</link>"#)
}

fn joint(name: &str, kind: &str, parent: &str, child: &str) -> String {
    format!(
        r#"<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/><axis xyz="0 1 0"/></joint>"#
    )
}

/// base - hip - thigh - knee - shank = sole
fn robot() -> String {
    let links = ["base", "thigh", "shank"].map(|l| link(l, INERTIAL)).concat() + &link("sole", "");
    let joints = joint("hip", "revolute", "base", "thigh")
        + &joint("knee", "continuous", "thigh", "shank")
        + &joint("weld", "fixed", "shank", "sole");
    format!(r#"<robot name="r">{links}{joints}</robot>"#)
}

fn refusal(urdf: &str, order: &[&str]) -> ModelError {
    Model::from_urdf(urdf, "base", order).expect_err("must be refused")
}

#[test]
fn the_robot_itself_is_accepted() {
    let model = Model::from_urdf(&robot(), "base", &["hip", "knee"]).expect("a good robot");
    assert_eq!((model.n(), model.nv(), model.nq()), (2, 8, 9));
    assert_eq!(model.mass(), 6.0);
    assert_eq!(model.frame("sole", [0.0; 3]).expect("fixed links stay").joint(), Some(1));
    assert_eq!(model.frame("toe", [0.0; 3]).err(), Some(ModelError::UnknownLink("toe".into())));
    assert_eq!(model.parent_joint(1), Some(0));
    assert_eq!(model.joint_index("knee"), Some(1));
}

#[test]
fn text_that_is_no_urdf() {
    assert!(matches!(refusal("<robot", &[]), ModelError::Unreadable(_)));
    assert!(matches!(refusal("", &[]), ModelError::Unreadable(_)));
    assert!(matches!(refusal("mass = 3", &[]), ModelError::Unreadable(_)));
}

#[test]
fn joint_order_that_does_not_fit() {
    let r = robot();
    assert_eq!(refusal(&r, &["hip", "kneee"]), ModelError::UnknownJoint("kneee".into()));
    assert_eq!(refusal(&r, &["hip", "weld"]), ModelError::UnknownJoint("weld".into()));
    assert_eq!(refusal(&r, &["hip"]), ModelError::MissingJoint("knee".into()));
    assert_eq!(refusal(&r, &["hip", "hip"]), ModelError::Duplicate("hip".into()));
    assert_eq!(refusal(&r, &["knee", "hip"]), ModelError::Order("knee".into(), "hip".into()));
    assert_eq!(
        Model::from_urdf(&r, "torso", &["hip", "knee"]).err(),
        Some(ModelError::UnknownLink("torso".into()))
    );
}

#[test]
fn loops_and_loose_links() {
    let r = robot();
    let closed = r.replace("</robot>", &(joint("coupler", "revolute", "base", "shank") + "</robot>"));
    assert_eq!(
        refusal(&closed, &["hip", "knee", "coupler"]),
        ModelError::Loop("shank".into(), "knee".into(), "coupler".into())
    );
    let ring = r.replace("</robot>", &(joint("back", "revolute", "sole", "base") + "</robot>"));
    assert!(matches!(refusal(&ring, &["hip", "knee", "back"]), ModelError::Unreachable(_)));
    let loose = r.replace("</robot>", &(link("tool", INERTIAL) + "</robot>"));
    assert_eq!(refusal(&loose, &["hip", "knee"]), ModelError::Unreachable("tool".into()));
    let nowhere = r.replace("</robot>", &(joint("tip", "fixed", "sole", "nail") + "</robot>"));
    assert!(matches!(refusal(&nowhere, &["hip", "knee"]), ModelError::UnknownLink(l) if l == "nail"));
    let twice = r.replace("</robot>", &(link("base", INERTIAL) + "</robot>"));
    assert_eq!(refusal(&twice, &["hip", "knee"]), ModelError::Duplicate("base".into()));
}

#[test]
fn inertia_that_cannot_exist() {
    for (from, to, at) in [
        (r#"mass value="2""#, r#"mass value="0""#, "mass is zero"),
        (r#"mass value="2""#, r#"mass value="-1""#, "negative"),
        (r#"mass value="2""#, r#"mass value="NaN""#, "finite"),
        (r#"izz="0.04""#, r#"izz="0.06""#, "sum of the others"),
        (r#"ixx="0.02""#, r#"ixx="-0.02""#, "negative"),
        (r#"ixy="0""#, r#"ixy="0.05""#, "negative"),
    ] {
        let shank = link("shank", INERTIAL);
        let urdf = robot().replace(&shank, &shank.replace(from, to));
        let error = refusal(&urdf, &["hip", "knee"]);
        assert!(matches!(&error, ModelError::Inertia(l, why) if l == "shank" && why.contains(at)), "{error}");
    }
    let hollow = robot().replace(&link("shank", INERTIAL), &link("shank", ""));
    let error = refusal(&hollow, &["hip", "knee"]);
    assert!(
        matches!(&error, ModelError::Inertia(l, why) if l == "shank" && why.contains("moving body")),
        "{error}"
    );
}

#[test]
fn joints_without_one_coordinate() {
    for kind in ["floating", "planar"] {
        let urdf =
            robot().replace(r#"name="knee" type="continuous""#, &format!(r#"name="knee" type="{kind}""#));
        assert_eq!(refusal(&urdf, &["hip", "knee"]), ModelError::JointType("knee".into(), kind.into()));
    }
    let urdf = robot().replace(r#"name="knee" type="continuous""#, r#"name="knee" type="elastic""#);
    assert!(matches!(refusal(&urdf, &["hip", "knee"]), ModelError::Unreadable(_)));
    let axis =
        r#"<joint name="hip" type="revolute"><parent link="base"/><child link="thigh"/><axis xyz="0 1 0"/>"#;
    let urdf = robot().replace(axis, &axis.replace("0 1 0", "0 0 0"));
    assert_eq!(refusal(&urdf, &["hip", "knee"]), ModelError::Geometry("hip".into()));
}

#[test]
fn every_error_names_its_place_and_says_what_to_do() {
    for error in [
        refusal(&robot(), &["hip", "kneee"]),
        refusal(&robot(), &["hip"]),
        refusal(&robot(), &["knee", "hip"]),
        refusal("<robot", &[]),
    ] {
        let text = error.to_string();
        assert!(text.contains("; "), "{text}");
    }
}
