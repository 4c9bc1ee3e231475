//! The command where nothing of the source tree is: the executable alone, in an empty folder, as another user; where it finds
//! its configuration, and where its runs go.

use harness::{Site, turn};
use std::fs;
use std::os::unix::fs::{PermissionsExt, chown};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const EXE: &str = harness::executable!();
/// The other user, if this one may become it.
const NOBODY: u32 = 65534;

/// Lola stands up.
const SHORT: &str = "about = \"A test.\"\nrobot = \"lola\"\ngait = \"lola\"\ndepth = 1\nintegrator = \"euler\"\nsubsteps = 4\n\
    cycle = 0.001\nstart_pose = \"stand\"\nduration = 1.5\nseed = 1\n[[command]]\ntime = 0.2\ntopic = \"walk/stand\"\n";

/// A folder with nothing in it but the executable, which belongs to another user. Removed when dropped.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let dir = std::env::temp_dir().join(format!("gangwerk-installed-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&dir);
        fs::create_dir(&dir).unwrap();
        // Copied by another process: a child forked by a test beside this one would inherit our descriptor of the file,
        // and a file that is open for writing cannot be executed ("Text file busy").
        assert!(Command::new("cp").arg(EXE).arg(&dir).status().unwrap().success());
        fs::set_permissions(&dir, fs::Permissions::from_mode(0o755)).unwrap();
        // As an ordinary user there is no other one to become: the rest holds all the same.
        let _ = chown(&dir, Some(NOBODY), Some(NOBODY));
        Self(dir)
    }

    /// `gangwerk ARGUMENTS` by the other user in `folder`, with an environment of nothing but `home`.
    fn gangwerk_in(&self, folder: &Path, home: &Path, arguments: &[&str]) -> Output {
        let mut command = Command::new(self.0.join("gangwerk"));
        command.args(arguments).current_dir(folder).env_clear().env("HOME", home);
        if fs::metadata(&self.0).is_ok_and(|m| std::os::unix::fs::MetadataExt::uid(&m) == NOBODY) {
            command.uid(NOBODY).gid(NOBODY);
        }
        command.output().unwrap()
    }

    fn gangwerk(&self, arguments: &[&str]) -> Output {
        self.gangwerk_in(&self.0, Path::new("/nonexistent"), arguments)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[track_caller]
fn well(said: Output) -> String {
    assert!(said.status.success(), "{said:?}");
    String::from_utf8(said.stdout).unwrap()
}

#[track_caller]
fn refused(said: Output, parts: &[&str]) {
    let text = String::from_utf8_lossy(&said.stderr).into_owned();
    assert_eq!(said.status.code(), Some(1), "{text}");
    parts.iter().for_each(|part| assert!(text.contains(part), "`{part}` in: {text}"));
}

/// Its configuration was found only where it was built, and in a copy of the tree it was that of the old one.
#[test]
fn the_executable_alone_walks_in_an_empty_folder_as_another_user() {
    let _turn = turn();
    let folder = Folder::new("alone");
    assert!(well(folder.gangwerk(&["config", "where"])).starts_with("(built in): "));
    // By name, with a mesh and DBC files that are inside the executable; and by path.
    let text = well(folder.gangwerk(&["sim", "stairs", "--json"]));
    assert!(text.contains("\"fell\":false"), "{text}");
    fs::write(folder.0.join("short.toml"), SHORT).unwrap();
    well(folder.gangwerk(&["sim", "./short.toml", "--log", "sim.mcap", "--can", "bus.log"]));
    let decoded = well(folder.gangwerk(&["can", "stat", "bus.log", "--robot", "lola"]));
    assert!(!decoded.is_empty());
    // All processes; log and pictures beside it.
    let said = well(folder.gangwerk(&["run", "short.toml", "--lockstep"]));
    assert!(said.contains("runs/latest/short.mcap"), "{said}");
    for file in ["short.mcap", "zmp.png", "stick_figures.png"] {
        assert!(
            folder.0.join("runs/latest").join(file).metadata().is_ok_and(|m| m.len() > 1000),
            "{file}: {said}"
        );
    }
    let info = well(folder.gangwerk(&["log", "info", "runs/latest/short.mcap"]));
    assert!(info.contains("scene short, robot lola"), "{info}");
}

/// A folder in which this user may not write.
#[test]
fn runs_go_where_the_user_may_write() {
    let _turn = turn();
    let folder = Folder::new("state");
    fs::write(folder.0.join("short.toml"), SHORT).unwrap();
    let scene = folder.0.join("short.toml").display().to_string();
    let foreign = Path::new("/proc");
    let run = ["run", &scene, "--lockstep", "--no-plots"];
    refused(folder.gangwerk_in(foreign, Path::new("/nonexistent"), &run), &["runs/latest: ", "--out"]);
    let said = folder.gangwerk_in(foreign, &folder.0, &run);
    let told = String::from_utf8_lossy(&said.stderr).into_owned();
    well(said);
    let place = folder.0.join(".local/state/gangwerk/latest");
    assert!(told.contains(&format!("log and pictures go to {}", place.display())), "{told}");
    assert!(place.join("short.mcap").exists());
}

#[test]
fn the_configuration_is_found_in_its_order_and_a_copy_can_be_changed() {
    let folder = Folder::new("order");
    let place = |said: Output| well(said).split(": ").next().unwrap().to_owned();
    let home = folder.0.join("home");
    let at = |home: &Path| place(folder.gangwerk_in(&folder.0, home, &["config", "where"]));
    assert_eq!(at(&home), "(built in)");
    let [own, local, named] =
        [home.join(".config/gangwerk"), folder.0.join("config"), folder.0.join("named")]
            .map(|p| p.display().to_string());
    well(folder.gangwerk(&["config", "copy", &own]));
    assert_eq!(at(&home), own);
    well(folder.gangwerk(&["config", "copy", &local]));
    assert_eq!(at(&home), local);
    well(folder.gangwerk(&["config", "copy", &named]));
    assert_eq!(place(folder.gangwerk(&["config", "where", "--config", "named"])), named);
    // What is there stays, and what is named must be there.
    let before = fs::read(folder.0.join("named/system.toml")).unwrap();
    refused(
        folder.gangwerk(&["config", "copy", "named"]),
        &["named: exists", "nothing in it is overwritten"],
    );
    assert_eq!(fs::read(folder.0.join("named/system.toml")).unwrap(), before);
    refused(
        folder.gangwerk(&["sim", "stand", "--config", "nowhere"]),
        &["nowhere: is no configuration", "config copy"],
    );
    // A copy that is changed is what is walked.
    let scenes = well(folder.gangwerk(&["scene", "list"]));
    let about = "Lola walks at 1 km/h";
    let file = folder.0.join("config/scenes/walk_1kmh.toml");
    let text = fs::read_to_string(&file).unwrap();
    let (first, rest) = text.split_once('\n').unwrap();
    assert!(first.starts_with("about = ") && !scenes.contains("Changed by hand"), "{first}, {about}");
    fs::write(&file, format!("about = \"Changed by hand.\"\n{rest}")).unwrap();
    assert!(well(folder.gangwerk(&["scene", "list"])).contains("Changed by hand."));
}

#[test]
fn scenes_are_listed_and_a_wrong_name_is_answered_with_the_nearest() {
    let site = Site::new(EXE);
    let said = site.gangwerk(&["scene", "list"]).well();
    let line = said
        .out
        .lines()
        .find(|line| line.starts_with("walk_1kmh "))
        .unwrap_or_else(|| panic!("{}", said.out));
    let about = fs::read_to_string(site.config("scenes/walk_1kmh.toml")).unwrap();
    let about = about.lines().find_map(|l| l.strip_prefix("about = \"")?.strip_suffix('"')).unwrap();
    assert!(line.contains("lola") && line.ends_with(about), "{line}");
    let said = site.gangwerk(&["sim", "walk_1km"]);
    assert!(said.code == Some(1) && said.err.contains("did you mean walk_1kmh?"), "{said:?}");
    assert!(said.err.lines().count() == 1 && said.err.len() < 300, "one line, not all names: {said:?}");
}
