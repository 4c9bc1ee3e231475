//! `[components]` of a scene: what is changed, and what a person reads who asks for what there is not.

use config::Setup;
use config::components::{ContactModel, JointModel, Selection};

/// The scene `walk_1kmh` with another type and a table of components, in words if it is refused.
fn loaded(depth: &str, components: &str) -> Result<Setup, String> {
    let root = config::root(None);
    let text = std::fs::read_to_string(root.join("scenes/walk_1kmh.toml")).unwrap();
    let begin = text.find("[[command]]").unwrap();
    let (head, commands) = text.split_at(begin);
    let head = head.replacen("depth = 1", &format!("depth = {depth}"), 1);
    let file = std::env::temp_dir().join(format!(
        "gangwerk-components-{}-{:?}.toml",
        std::process::id(),
        std::thread::current().id()
    ));
    std::fs::write(&file, format!("{head}[components]\n{components}\n\n{commands}")).unwrap();
    let setup = Setup::load(&root, file.to_str().unwrap());
    std::fs::remove_file(&file).unwrap();
    setup.map_err(|e| e.to_string())
}

#[test]
fn changes_to_a_type() {
    let setup = loaded(
        "1",
        "joints = \"motors\"\nelastic = [\"right_hip_flexion\"]\nfriction = false\ncontact = [\"pads\", \"points\"]",
    );
    let components = setup.unwrap().scene.components();
    assert_eq!(components.joints, JointModel::Motors);
    assert_eq!(components.elastic, Selection::Named(vec!["right_hip_flexion".to_owned()]));
    assert!(components.currents && !components.friction, "motors have currents but where it is said");
    assert_eq!(components.contact, [ContactModel::Pads, ContactModel::Points]);
    assert_eq!(loaded("3", "").unwrap().scene.model(), "type 3");
}

#[test]
fn what_there_is_not_is_refused_with_its_name() {
    for (depth, text, wanted) in [
        ("2", "locked = [\"tail\"]", "components.locked: `tail` is no joint of lola"),
        ("2", "locked = [\"right_ankle_flexion\"]", "shares the drive `right_ankle_inner`"),
        (
            "2",
            "elastic = [\"right_hip\"]",
            "components.elastic: `right_hip` is no drive of lola with a spring",
        ),
        ("1", "friction = true", "components.friction: needs joints = \"motors\", or depth 2 to 5"),
        ("1", "currents = false", "components.currents: needs joints = \"motors\", or depth 2 to 5"),
        ("2", "rotors = false", "components.rotors: false needs joints that follow their targets"),
        ("2", "contact = [\"pads\"]", "takes \"points\" or \"pads\", or two of them: right, left"),
        ("2", "joints = \"legs\"", "`legs` is not known; it takes one of"),
        ("2", "gears = \"stiff\"", "gears"),
    ] {
        let told = loaded(depth, text).err().unwrap_or_default();
        assert!(told.contains(wanted), "{text}: {told}");
    }
}
