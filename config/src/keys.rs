//! Keys of the files of a configuration: what each takes, as the readers ask for it over all shipped files, and its meaning, as the
//! source says it where the key becomes a field. For the reference (`gangwerk config reference`).

use std::collections::BTreeMap;
use std::path::Path;

use crate::error::ConfigError;
use crate::key_meaning::Sources;
use crate::questions::{self, Heard, Question};
use crate::{Gait, Robot, Scene, System, file, gait_path, scenes};

/// Kinds of files, with the ends of their names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum FileKind {
    /// `scenes/NAME.toml`.
    Scene,
    /// `gaits/NAME.toml`.
    Gait,
    /// `robots/NAME/robot.toml`.
    Robot,
    /// `system.toml`.
    System,
}

/// One key.
#[derive(Clone, Debug, PartialEq)]
pub struct FileKey {
    /// Kind of file that has it.
    pub file: FileKind,
    /// Its name with the tables around it: `[]` is each of a list, `NAME` a name of your own.
    pub path: String,
    /// Values that it takes, with unit and range.
    pub takes: String,
    /// It may be left out.
    pub may_be_left_out: bool,
    /// Meaning in one sentence.
    pub meaning: String,
}

/// Every key that the readers ask for while they read all files of the configuration `root`, whose sources are in `source`.
///
/// # Errors
/// A file or a source cannot be read.
pub fn all(root: &Path, source: &Path) -> Result<Vec<FileKey>, ConfigError> {
    let mut failed = None;
    let heard = questions::listen(|| failed = read_all(root).err());
    if let Some(error) = failed {
        return Err(error);
    }
    let sources = Sources::read(source)?;
    let mut keys: BTreeMap<(FileKind, String), FileKey> = BTreeMap::new();
    let mut order = Vec::new();
    // Fields of a command stand in the table of commands; a table of names has nothing to say itself.
    let is_told = |path: &str| {
        let of_command =
            path.starts_with("command[].") && !["time", "topic"].iter().any(|key| path.ends_with(key));
        !of_command && ![".NAME", ".SIDE"].iter().any(|end| path.ends_with(end))
    };
    for question in &heard.questions {
        let place = (kind(&question.file), general(question, &heard));
        if !is_told(&place.1) {
            continue;
        }
        let key = keys.entry(place.clone()).or_insert_with(|| {
            order.push(place.clone());
            let (file, path) = place;
            FileKey { file, path, takes: String::new(), may_be_left_out: false, meaning: String::new() }
        });
        key.may_be_left_out |= question.may_be_left_out;
        // Of several forms of a value all are told: a number, or a table.
        if !question.takes.is_empty() && !key.takes.split("; or ").any(|known| covers(known, &question.takes))
        {
            key.takes += if key.takes.is_empty() { "" } else { "; or " };
            key.takes += &question.takes;
        }
        if key.meaning.is_empty() {
            key.meaning = sources.meaning(&key.path, question);
        }
    }
    Ok(order.into_iter().filter_map(|place| keys.remove(&place)).collect())
}

/// True if `known` says all that `takes` does: words that are listed are strings.
fn covers(known: &str, takes: &str) -> bool {
    known == takes || takes == "a string" && known.starts_with("one of")
}

fn read_all(root: &Path) -> Result<(), ConfigError> {
    scenes::list(root)?.into_iter().try_for_each(|(_, scene)| scene.map(|_: Scene| ()))?;
    let names = |folder: &str, ending: &str| file::names(&root.join(folder), ending).unwrap_or_default();
    for name in names("gaits", "toml") {
        Gait::load(&gait_path(root, &name))?;
    }
    for name in names("robots", "") {
        Robot::load(&root.join("robots").join(name))?;
    }
    System::load(&root.join("system.toml"))?;
    // What no shipped file says: these are wrong in what they leave out, and are asked all the same.
    let more = root.join("tests/every_key");
    let _ = Scene::load(&more.join("scene.toml"));
    let _ = Scene::load(&more.join("tolerance.toml"));
    let _ = Gait::load(&more.join("gaits/gait.toml"));
    let _ = Robot::load(&more.join("robot"));
    let _ = System::load(&more.join("system.toml"));
    Ok(())
}

/// Tables whose keys are names that the program gives, and what stands for them.
const NAMED: [(&str, &str); 4] =
    [("process", "NAME"), ("pose_deg.NAME", "JOINT"), ("foot", "SIDE"), ("leg", "SIDE")];

/// Tables whose keys are names of joints, by their ends.
const BY_JOINT: [&str; 6] =
    ["bits", "counts", "gear_ratio", "bias_rad", "joint_offset_rad", "drive_clock_ppm"];

fn kind(file: &Path) -> FileKind {
    let folder = file.parent().and_then(Path::file_name).unwrap_or_default();
    match (file.file_name().unwrap_or_default().to_str(), folder.to_str()) {
        (Some("system.toml"), _) => FileKind::System,
        (Some("robot.toml"), _) => FileKind::Robot,
        (_, Some("gaits")) => FileKind::Gait,
        _ => FileKind::Scene,
    }
}

/// Path of a key for all elements of a list and all names.
fn general(question: &Question, heard: &Heard) -> String {
    let (mut path, mut out) = (String::new(), String::new());
    for part in question.path.split('.') {
        let is_name = heard.named.iter().any(|(file, table)| *file == question.file && *table == path);
        let by_joint = BY_JOINT.iter().any(|end| path.ends_with(end));
        let given = NAMED.iter().find(|(table, _)| *table == out).map(|(_, name)| *name);
        let stands = given.or(is_name.then_some(if by_joint { "JOINT" } else { "NAME" }));
        for text in [&mut path, &mut out].into_iter().filter(|text| !text.is_empty()) {
            text.push('.');
        }
        path += part;
        // `command[3]` is `command[]`.
        match part.split_once('[') {
            _ if stands.is_some() => out += stands.unwrap_or_default(),
            Some((name, _)) => out += &format!("{name}[]"),
            None => out += part,
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_of_every_file_is_explained() {
        let root = crate::root(None);
        let keys = all(&root, &root.join("src")).unwrap();
        assert!(keys.len() > 300, "{} keys", keys.len());
        let mut bare = String::new();
        for FileKey { file, path, takes, meaning, .. } in &keys {
            if meaning.is_empty() || takes.is_empty() {
                bare += &format!("{file:?} {path}: takes `{takes}`, means `{meaning}`\n");
            }
        }
        assert!(bare.is_empty(), "keys without words, which a documented field or KEY_WORDS gives:\n{bare}");
        // Words that nobody asks for any more.
        for (end, _) in crate::key_words::KEY_WORDS {
            let end = end.trim_start_matches('/');
            let is_asked = keys.iter().any(|key| key.path == end || key.path.ends_with(&format!(".{end}")));
            assert!(is_asked, "no key ends with {end}");
        }
    }
}
