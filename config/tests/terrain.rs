//! What lies on the ground of the shipped scenes, and what is wrong with other objects.

use config::Scene;
use config::terrain::ObjectShape;

fn shipped(name: &str) -> Scene {
    Scene::load(&config::root(None).join("scenes").join(name).with_extension("toml")).unwrap()
}

#[test]
fn flat_scenes_have_no_objects() {
    assert!(shipped("stand").objects.is_empty());
}

#[test]
fn a_board_lies_on_the_ground() {
    let [board] = &shipped("board").objects[..] else { panic!() };
    let ObjectShape::Box([_, _, thickness]) = board.shape else { panic!() };
    assert_eq!((thickness, board.pose.position[2] - thickness / 2.0), (0.008, 0.0));
    assert_eq!((board.appears, board.vanishes, board.friction), (0.0, f64::INFINITY, None));
}

#[test]
fn a_box_moves() {
    let [object] = &shipped("passing_box").objects[..] else { panic!() };
    assert_eq!((object.appears, object.vanishes, object.friction), (1.0, 9.0, Some(0.4)));
    let [(4.0, _), (7.0, end)] = object.poses[..] else { panic!() };
    assert!((end.rotation[2] - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
}

#[test]
fn meshes_are_files_of_the_configuration() {
    for (scene, of_file) in [("stairs", 1.0), ("uneven", 0.6)] {
        let ObjectShape::Mesh { file, scale, .. } = &shipped(scene).objects[0].shape else { panic!() };
        assert!(file.is_file() && *scale == of_file, "{}", file.display());
    }
}

/// The message for the scene `stand` with these lines added.
fn message(lines: &str) -> String {
    let root = config::root(None);
    let folder = std::env::temp_dir().join(format!("terrain-{}", std::process::id())).join("scenes");
    std::fs::create_dir_all(&folder).unwrap();
    let text = std::fs::read_to_string(root.join("scenes/stand.toml")).unwrap();
    let path = folder.join("stand.toml");
    std::fs::write(&path, format!("{text}\n{lines}\n")).unwrap();
    Scene::load(&path).expect_err(lines).to_string()
}

#[test]
fn wrong_objects() {
    let table = "[[object]]\nname = \"x\"\nposition = [0, 0, 0]\n";
    for (lines, parts) in [
        ("", &["either `box`", "or `mesh`"][..]),
        ("box = [1, 1, 1]\nmesh = \"a.stl\"", &["either `box`"]),
        ("box = [1, 1, 0]", &["box[2]", "0.001"]),
        ("box = [1, 1, 1]\nappears = 3.0\nvanishes = 2.0", &["vanishes", "later than it appears, 3 s"]),
        ("mesh = \"../robots/lola/robot.toml\"", &["mesh", "directory `objects`"]),
        ("mesh = \"none.obj\"", &["none.obj", "cannot be read"]),
        ("box = [1, 1, 1]\nfrictoin = 1.0", &["frictoin", "`friction`"]),
        ("box = [1, 1, 1]\nfriction = -1.0", &["friction", "0 to 10"]),
        (
            "box = [1, 1, 1]\n[[object.pose]]\ntime = 2.0\nposition = [0, 0, 0]\n[[object.pose]]\ntime = 2.0\nposition = [0, 0, 1]",
            &["pose", "later than 2 s"],
        ),
        ("box = [1, 1, 1]\n[[object.pose]]\ntime = 2.0", &["object[0].pose[0].position", "missing"]),
    ] {
        let message = message(&format!("{table}{lines}"));
        for part in parts {
            assert!(message.contains(part), "`{part}` is not in: {message}");
        }
    }
}
