//! Keys of the files of a configuration.

use config::keys::{FileKey, FileKind};

use super::{Page, begin, cell, code, head, row};

/// A page for each kind of file.
pub(super) fn pages(keys: &[FileKey]) -> Vec<Page> {
    let of = |kind, title: &str, about: &str| {
        let keys: Vec<&FileKey> = keys.iter().filter(|key| key.file == kind).collect();
        page(title, about, &keys)
    };
    vec![
        (
            "scene_keys.md",
            of(
                FileKind::Scene,
                "Keys of a scene",
                "`config/scenes/NAME.toml`, or a file of your own: what is simulated, and what is commanded when. A `[[command]]` takes \
                 besides the fields of its topic: [commands](commands.md).",
            ),
        ),
        (
            "gait_keys.md",
            of(
                FileKind::Gait,
                "Keys of a gait",
                "`config/gaits/NAME.toml`: how a robot walks and how it is stabilized. A gait is balanced, or a fixed pattern: then \
                 `[pattern]` is its only table.",
            ),
        ),
        (
            "robot_keys.md",
            of(
                FileKind::Robot,
                "Keys of a robot",
                "`config/robots/NAME/robot.toml`, beside the robot's URDF: what a URDF cannot say.",
            ),
        ),
        (
            "system_keys.md",
            of(
                FileKind::System,
                "Keys of the system",
                "`config/system.toml`: processes, cores, priorities, limits of the run-time system.",
            ),
        ),
    ]
}

fn page(title: &str, about: &str, keys: &[&FileKey]) -> String {
    let mut text = begin(title, about);
    text += "\nA key that is not listed is refused. `[]`: each table of a list; `NAME`: a name of your own, or of a process; `SIDE`: `right` or `left`; `JOINT`: \
             the name of a joint, or `all`. Keys marked with ° may be \
             left out.\n";
    // A heading for each table, in the order in which they are read first.
    let mut tables: Vec<&str> = Vec::new();
    let table = |key: &FileKey| key.path.rsplit_once('.').map_or(0, |(table, _)| table.len());
    for key in keys {
        let name = &key.path[..table(key)];
        if !tables.contains(&name) {
            tables.push(name);
        }
    }
    for name in tables {
        let heading = if name.is_empty() { "Top of the file".into() } else { code(name) };
        text += &format!("\n## {heading}\n{}", head(&["key", "takes", "meaning"]));
        for key in keys.iter().filter(|key| &key.path[..table(key)] == name) {
            let own = key.path[table(key)..].trim_start_matches('.');
            let mark = if key.may_be_left_out { "°" } else { "" };
            text += &row(&[&format!("{}{mark}", code(own)), &cell(&key.takes), &cell(&key.meaning)]);
        }
    }
    text
}
