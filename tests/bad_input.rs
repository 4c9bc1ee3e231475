//! Bad input of every kind: one clear error, nothing moves, nothing is left behind, a robot that runs goes on.

use harness::{Running, Said, Site, doze};
use ipc::Space;
use messages::topics::SIM_STATE;
use messages::{Process, SimState};
use realtime::clock;
use std::io::{Read, Write};
use std::net::{Ipv4Addr, TcpStream};
use std::os::unix::fs::DirBuilderExt;

const EXE: &str = harness::executable!();

/// Both ways to run the scene `stand` refuse with the same error, which holds all of `texts`; no process was started.
fn refused(site: &Site, scene: &str, texts: &[&str]) {
    let run = site.run(scene, &["--lockstep"]).end();
    one_error(&run, texts);
    one_error(&site.gangwerk(&["sim", scene, "--json"]), texts);
    assert_eq!(run.out, "", "nothing was done");
    let lock = |p: &Process| site.run_dir().join(format!("{}.lock", p.name())).exists();
    assert!(!Process::ALL.iter().any(lock), "a process was started");
    assert_eq!(site.shared_memory(), [""; 0], "left in /dev/shm");
}

/// Exit code 1, one line that begins with `error:`, and it holds the texts.
#[track_caller]
fn one_error(said: &Said, texts: &[&str]) {
    assert_eq!(said.code, Some(1), "{said:#?}");
    let errors = said.err.lines().filter(|line| line.to_lowercase().contains("error")).count();
    assert_eq!(errors, 1, "one error: {}", said.err);
    assert!(!said.err.contains("panicked"), "{}", said.err);
    for text in texts {
        assert!(said.err.contains(text), "`{text}` in: {}", said.err);
    }
}

#[test]
fn real_time_that_is_required_and_not_to_be_had_is_refused_before_anything_is_armed() {
    let site = Site::patient(EXE);
    site.edit("system.toml", "[process.planner]\ncore = 1", "[process.planner]\ncore = 900");
    let said = site.run("stand", &["--no-log", "--rt", "required"]).end();
    assert_eq!(said.code, Some(1), "{said:#?}");
    for text in
        ["planner degraded: not bound to core 900", "error: planner", "--rt required", "gangwerk doctor"]
    {
        assert!(said.err.contains(text), "`{text}` in: {}", said.err);
    }
    assert!(!said.err.contains("motor supply on"), "{}", said.err);
    assert_eq!(site.shared_memory(), [""; 0], "left in /dev/shm");
}

#[test]
fn a_depth_or_integrator_that_cannot_be_is_refused() {
    let site = Site::patient(EXE);
    for (option, value, text) in [
        ("--depth", "6", "1..=5"),
        ("--depth", "two", "two"),
        ("--integrator", "eulr", "did you mean euler?"),
    ] {
        let said = site.run("stand", &["--lockstep", option, value]).end();
        assert!(said.code == Some(2) && said.err.contains(text), "{said:#?}");
    }
    let said = site.run("walk_auto", &["--lockstep", "--integrator", "euler"]).end();
    one_error(&said, &["scene walk_auto", "--depth"]);
}

#[test]
fn a_misspelt_key_is_named_with_its_line_and_the_nearest_one() {
    let site = Site::patient(EXE);
    site.edit("gaits/lola.toml", "swing_height", "swing_heigth");
    let texts = ["gaits/lola.toml", "line 8", "step.swing_heigth", "unknown key", "`swing_height`"];
    refused(&site, "stand", &texts);
}

#[test]
fn a_number_in_the_wrong_unit_is_refused_with_the_range() {
    let site = Site::patient(EXE);
    site.edit("scenes/stand.toml", "cycle = 0.001 # [s]", "cycle = 1.0 # [ms]");
    refused(&site, "stand", &["scenes/stand.toml", "line 7", "cycle: 1", "0.0001 to 0.02 s"]);
}

#[test]
fn a_missing_scene_is_named_with_those_there_are() {
    refused(
        &Site::patient(EXE),
        "walk_9kmh",
        &[
            "scenes/walk_9kmh.toml",
            "there is no scene `walk_9kmh`",
            "walk_1kmh or walk_2kmh",
            "gangwerk scene list",
        ],
    );
}

#[test]
fn a_missing_file_that_the_scene_names_is_named() {
    let site = Site::patient(EXE);
    std::fs::remove_file(site.config("gaits/lola.toml")).unwrap();
    refused(&site, "stand", &["gaits/lola.toml", "cannot be read"]);
}

#[test]
fn a_urdf_with_a_loop_is_refused_with_the_joints_that_close_it() {
    let site = Site::patient(EXE);
    let bar = "<joint name=\"bar\" type=\"fixed\"><parent link=\"left_thigh\"/><child link=\"right_shank\"/></joint>\n</robot>";
    site.edit("robots/lola/lola.urdf", "</robot>", bar);
    refused(&site, "stand", &["right_shank", "`bar`", "`right_knee_flexion`", "remove one joint"]);
}

#[test]
fn a_urdf_with_a_massless_link_is_refused_with_the_link() {
    let site = Site::patient(EXE);
    site.edit("robots/lola/lola.urdf", "<mass value=\"9.886\"/>", "<mass value=\"0\"/>");
    refused(&site, "stand", &["lola.urdf", "50.999 kg", "total_mass in robot.toml is 60.885 kg"]);
    site.edit("robots/lola/robot.toml", "total_mass = 60.885", "total_mass = 50.999");
    refused(&site, "stand", &["`torso`", "mass"]);
}

#[test]
fn a_wrong_command_line_is_answered_with_the_usage() {
    let site = Site::patient(EXE);
    for arguments in [&["run"][..], &["walk"], &["topic", "pub"], &["run", "stand", "--fast"]] {
        let said = site.gangwerk(arguments);
        assert_eq!(said.code, Some(2), "{arguments:?}: {said:#?}");
        assert!(said.err.contains("error: ") && said.err.contains("Usage: "), "{}", said.err);
    }
}

#[test]
fn a_look_at_no_robot_says_how_to_start_one() {
    let site = Site::patient(EXE);
    one_error(&site.topic(&["pub", "walk/stop"]), &["gangwerk run"]);
    std::fs::DirBuilder::new().mode(0o700).create(site.run_dir()).unwrap();
    one_error(&site.topic(&["echo", "sensors", "--once"]), &["gangwerk run"]);
}

/// A FIFO, a file, a link or somebody else's directory where the processes are to meet: one error that says what to do, and
/// nobody waits for it.
#[test]
fn what_is_no_run_directory_is_refused_by_every_command() {
    let site = Site::patient(EXE);
    let (fifo, file, link, foreign) =
        (site.path("fifo"), site.path("file"), site.path("link"), site.path("foreign"));
    assert!(std::process::Command::new("mkfifo").arg(&fifo).status().unwrap().success());
    std::fs::write(&file, "").unwrap();
    std::os::unix::fs::symlink(site.path("."), &link).unwrap();
    std::fs::DirBuilder::new().mode(0o700).create(&foreign).unwrap();
    let no_dir = "is a link or no directory: remove it";
    let mut places = vec![
        (fifo.clone(), no_dir, no_dir),
        (file.clone(), no_dir, no_dir),
        (link, no_dir, no_dir),
        (file.join("below"), "lies below something that is no directory", no_dir),
    ];
    // Only root can give a directory away.
    if std::os::unix::fs::chown(&foreign, Some(65534), None).is_ok() {
        places.push((foreign, "belongs to user 65534", "belongs to user 65534"));
    }
    for (place, of_run, of_others) in places {
        let dir = place.display().to_string();
        let commands: [(&[&str], &str); 5] = [
            (&["run", "stand", "--lockstep", "--no-log"], of_run),
            (&["topic", "hz", "sensors"], of_others),
            (&["topic", "pub", "walk/stop"], of_others),
            (&["param", "list"], of_others),
            (&["can", "record", "shm", "/dev/null"], of_others),
        ];
        for (command, why) in commands {
            let said = site.gangwerk(&[command, &["--dir", &dir]].concat());
            one_error(&said, &["run directory", &dir, why, "choose another one with --dir"]);
        }
        let said = site.gangwerk(&["estop", "--dir", &dir]);
        let text = format!("{}{}", said.out, said.err);
        assert!(said.code == Some(1) && text.contains("NOT KNOWN TO BE OFF"), "{said:#?}");
    }
}

/// `--dir .` removed the project's `config`, and then the project.
#[test]
fn a_directory_that_holds_somebodys_config_is_no_run_directory() {
    let site = Site::new(EXE);
    let (project, run) = (site.path("project"), ["run", "stand", "--lockstep", "--no-log", "--dir"]);
    std::fs::DirBuilder::new().mode(0o700).create(&project).unwrap();
    std::fs::create_dir(project.join("config")).unwrap();
    std::fs::write(project.join("config/notes"), "precious").unwrap();
    let said = site.gangwerk(&[&run[..], &[&project.display().to_string()]].concat());
    one_error(&said, &["is not a run directory", "`config`", "choose another one with --dir"]);
    let said = site.gangwerk(&[&run[..], &[&site.path("").display().to_string()]].concat());
    one_error(&said, &["lies in the run directory", "choose another --dir"]);
    assert_eq!(std::fs::read_to_string(project.join("config/notes")).unwrap(), "precious");
    assert_eq!(std::fs::read_dir(&project).unwrap().count(), 1, "and nothing else");
}

/// A robot in simulated time that stands on its feet.
struct Robot {
    site: Site,
    run: Running,
    space: Space,
}

impl Robot {
    fn standing() -> Self {
        let site = Site::patient(EXE);
        site.scene("wait", 100_000.0, "[[command]]\ntime = 0.2\ntopic = \"walk/stand\"\n");
        let mut run = site.run("wait", &["--lockstep", "--no-log"]);
        let space = run.space();
        let robot = Self { site, run, space };
        robot.at(|s| s.time > 12.0); // joints without a task have settled too
        robot
    }

    /// The first state from now on of which `what` is true.
    #[track_caller]
    fn at(&self, what: impl Fn(&SimState) -> bool) -> SimState {
        let mut sim = self.space.reader::<SimState>(&SIM_STATE).unwrap();
        let begun = clock::now();
        loop {
            if let Some(state) = sim.newer().filter(|s| what(s)) {
                return *state;
            }
            assert!(clock::now() - begun < 20 * clock::SECOND, "{}", self.run.err());
            doze(0.001);
        }
    }

    /// Nothing moves, before and for two seconds after `what`; the robot still listens, and ends as asked.
    fn undisturbed_by(mut self, what: impl FnOnce(&Site)) {
        assert!(!self.site.shared_memory().is_empty(), "this is where the run is");
        let before = self.at(|_| true);
        what(&self.site);
        let now = self.at(|_| true);
        let after = self.at(|s| s.time > now.time + 2.0);
        let moved =
            (0..before.joint_angle.len()).map(|j| (after.joint_angle[j] - before.joint_angle[j]).abs());
        // A standing robot's knees creep by some 3e-6 rad/s while the stabilizer settles; its feet do not.
        assert!(moved.fold(0.0, f64::max) < 1e-3, "joints moved");
        let slid = |foot: usize, k: usize| (after.feet[foot][k] - before.feet[foot][k]).abs();
        assert!((0..8).all(|i| slid(i / 4, i % 4) < 1e-6), "feet moved: {:?}, {:?}", before.feet, after.feet);
        assert_eq!((after.power, after.fallen), (1, 0));
        assert_eq!(self.site.topic(&["pub", "walk/stand"]).well().out, "walk/stand accepted by planner\n");
        assert!(self.run.is_alive());
        self.run.interrupt();
        let Self { site, run, space } = self;
        drop(space);
        assert_eq!(run.end().code, Some(130), "ended by Ctrl-C");
        assert_eq!(site.shared_memory(), [""; 0], "left in /dev/shm");
    }
}

#[test]
fn nan_and_numbers_out_of_range_over_topic_pub_are_refused_with_field_and_range() {
    Robot::standing().undisturbed_by(|site| {
        let pub_ = |arguments: &[&str]| site.topic(&[&["pub"], arguments].concat());
        one_error(
            &pub_(&["walk/velocity", "forward=NaN"]),
            &["walk/velocity", "forward = NaN", "[-2, 2] m/s"],
        );
        one_error(&pub_(&["walk/velocity", "left=inf"]), &["left = inf", "[-1, 1] m/s"]);
        one_error(&pub_(&["walk/velocity", "forward=9"]), &["forward = 9", "[-2, 2] m/s"]);
        one_error(&pub_(&["walk/step", "length=0.3", "duration=0.01"]), &["duration = 0.01", "[0.3, 5] s"]);
        one_error(&pub_(&["sim/push", "force.x=1e9", "duration=1"]), &["force.x", "[-5000, 5000] N"]);
        one_error(&pub_(&["walk/velocity", "forward=fast"]), &["forward = `fast`", "[-2, 2] m/s"]);
        one_error(&pub_(&["walk/velocity", "forwards=0.1"]), &["`forwards`", "did you mean forward?"]);
        one_error(&pub_(&["walk/run"]), &["`walk/run`", "topic list"]);
    });
}

#[test]
fn garbage_on_the_tcp_port_closes_its_connection_and_no_other() {
    let robot = Robot::standing();
    let err = |robot: &Robot| robot.run.err().matches("connection closed: ").count();
    assert_eq!(err(&robot), 0);
    let mut stream = TcpStream::connect((Ipv4Addr::LOCALHOST, robot.site.port())).unwrap();
    stream.write_all(b"GET / HTTP/1.1\r\nHost: lola\r\n\r\n").unwrap();
    let mut answer = Vec::new();
    stream.set_read_timeout(Some(std::time::Duration::from_secs(5))).unwrap();
    stream.read_to_end(&mut answer).expect("the broker closes the connection");
    let text = String::from_utf8_lossy(&answer);
    assert!(text.contains("length"), "the broker says why: {text}");
    // The line comes by way of the supervisor's console.
    for _ in 0..500 {
        if err(&robot) == 0 {
            harness::doze(0.01);
        }
    }
    assert_eq!(err(&robot), 1, "{}", robot.run.err());
    let mut noise = TcpStream::connect((Ipv4Addr::LOCALHOST, robot.site.port())).unwrap();
    let port = robot.site.port();
    robot.undisturbed_by(|_| {
        // Frames of a right length with anything in them, and one that is cut off.
        for seed in 0..50u32 {
            let mut other = TcpStream::connect((Ipv4Addr::LOCALHOST, port)).unwrap();
            let body: Vec<u8> = (0..32u32)
                .map(|i| (i.wrapping_mul(2_654_435_761).wrapping_add(seed * 97) >> 13) as u8)
                .collect();
            let _ = other.write_all(&32u32.to_le_bytes()).and_then(|()| other.write_all(&body));
        }
        noise.write_all(&[200, 0]).unwrap();
        drop(noise);
    });
}

#[test]
fn a_second_instance_in_the_same_place_is_refused_and_the_first_goes_on() {
    Robot::standing().undisturbed_by(|site| {
        let said = site.run("wait", &["--lockstep"]).end();
        let dir = site.run_dir().display().to_string();
        one_error(&said, &["supervisor is already running", &dir, "pid", "choose another directory"]);
    });
}

#[test]
fn a_second_robot_on_the_same_port_is_refused_and_the_first_goes_on() {
    Robot::standing().undisturbed_by(|first| {
        let second = Site::patient(EXE);
        let (port, own) = (format!("127.0.0.1:{}", first.port()), format!("127.0.0.1:{}", second.port()));
        second.edit("system.toml", &own, &port);
        let said = second.run("stand", &["--lockstep"]).end();
        assert_eq!(said.code, Some(1), "{said:#?}");
        for text in [
            &format!("127.0.0.1:{}", first.port()),
            "another tcp_listen in system.toml",
            "broker did not start",
        ] {
            assert!(said.err.contains(text), "`{text}` in: {}", said.err);
        }
        assert_eq!(second.shared_memory(), [""; 0], "left in /dev/shm");
    });
}
