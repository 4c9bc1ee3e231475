//! The shipped configuration inside the executable: what an installed command walks with.

use config::Embedded;
use include_dir::{Dir, include_dir};

/// Everything that `config` calls a configuration, folder by folder; `build.rs` has the same list.
const FOLDERS: [(&str, Dir); 5] = [
    ("gaits", include_dir!("$CARGO_MANIFEST_DIR/../config/gaits")),
    ("gears", include_dir!("$CARGO_MANIFEST_DIR/../config/gears")),
    ("objects", include_dir!("$CARGO_MANIFEST_DIR/../config/objects")),
    ("robots", include_dir!("$CARGO_MANIFEST_DIR/../config/robots")),
    ("scenes", include_dir!("$CARGO_MANIFEST_DIR/../config/scenes")),
];

/// Every file, by its path below the configuration directory.
pub fn files() -> Vec<Embedded> {
    let mut all: Vec<Embedded> = vec![
        ("system.toml".into(), include_bytes!("../../config/system.toml")),
        ("joystick.toml".into(), include_bytes!("../../config/joystick.toml")),
    ];
    FOLDERS.iter().for_each(|(name, folder)| collect(name, folder, &mut all));
    all
}

fn collect(name: &str, folder: &Dir<'static>, all: &mut Vec<Embedded>) {
    all.extend(folder.files().map(|file| (std::path::Path::new(name).join(file.path()), file.contents())));
    folder.dirs().for_each(|inner| collect(name, inner, all));
}

#[cfg(test)]
mod tests {
    /// The executable holds what the source tree holds, no more and no less.
    #[test]
    fn what_is_inside_is_what_is_shipped() {
        config::embed(super::files());
        let place = std::env::temp_dir().join(format!("gangwerk-shipped-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&place);
        let [inside, tree] = ["inside", "tree"].map(|name| place.join(name));
        config::snapshot(config::BUILT_IN.as_ref(), &inside).unwrap();
        config::snapshot(&config::root(None), &tree).unwrap();
        let said = std::process::Command::new("diff").arg("-r").args([&inside, &tree]).output().unwrap();
        assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stdout));
        for (name, scene) in config::scenes::list(config::BUILT_IN.as_ref()).unwrap() {
            scene.unwrap_or_else(|e| panic!("{name}: {e}"));
            let load = |root| config::Setup::load(root, &name).map(|setup| (setup.hash, setup.files));
            assert!(load(config::BUILT_IN.as_ref()) == load(&tree), "{name}");
        }
        std::fs::remove_dir_all(place).unwrap();
    }
}
