//! Rules of the house that no compiler checks: which crate may know which, what may stand in code, and whether the
//! files and tests that the documents name exist.

#[path = "tidy/book.rs"]
mod book;

use harness::root;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Layers from the bottom to the top. A crate depends only on crates of layers below its own, or of its own layer if
/// that is not the processes'.
const LAYERS: [&[&str]; 9] = [
    &["contact", "curves", "drawing", "drives", "environment", "multibody", "terminal"],
    &["messages", "codec"],
    &["ipc", "realtime", "config", "recording", "daemon", "fieldbus", "sercos", "latency"],
    &["planner", "controller", "lowlevel", "sim-backend", "broker", "watchdog", "logger"],
    &["chain", "dashboard", "joystick", "gateway"],
    &["vision"],
    &["studies", "harness", "fuzzing"],
    &["cli"],
    &["python"],
];
const PROCESSES: usize = 3;

/// Libraries that only these crates name.
const ONLY: [(&str, &[&str]); 17] = [
    ("iceoryx2", &["ipc", "latency"]),
    ("toml", &["config"]),
    ("bincode", &["messages"]),
    ("mcap", &["recording"]),
    ("urdf-rs", &["multibody", "studies"]),
    ("tiny-skia", &["drawing"]),
    ("tokio", &["broker", "dashboard", "fuzzing"]),
    ("axum", &["dashboard"]),
    ("pulldown-cmark", &["dashboard"]),
    ("hyper", &["dashboard"]),
    ("socketcan", &["fieldbus"]),
    ("can-dbc", &["config"]),
    ("evdev", &["joystick"]),
    ("libc", &["ipc", "realtime", "sercos"]),
    ("pyo3", &["python"]),
    ("numpy", &["python"]),
    ("parquet", &["studies"]),
];

/// Folders that hold no source of ours.
const NOT_OURS: [&str; 5] = ["target", "runs", ".git", ".venv", "node_modules"];
/// Longest source file \[lines\], and the files that may be longer, each with its reason.
const LONGEST: usize = 500;
const LONGER: [(&str, &str); 0] = [];
/// Longest `main.rs` of a process \[lines\].
const LONGEST_MAIN: usize = 60;

/// All files of the tree with one of these endings, relative to its root.
fn files(endings: &[&str]) -> Vec<PathBuf> {
    let (mut found, mut open) = (Vec::new(), vec![root().to_path_buf()]);
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(&folder).unwrap().flatten() {
            let (path, name) = (entry.path(), entry.file_name().into_string().unwrap());
            if path.is_dir() {
                if !NOT_OURS.contains(&name.as_str()) {
                    open.push(path);
                }
            } else if endings.iter().any(|ending| name.ends_with(ending)) {
                found.push(path.strip_prefix(root()).unwrap().to_owned());
            }
        }
    }
    found.sort();
    assert!(!found.is_empty(), "no {endings:?} in {}", root().display());
    found
}

fn text(path: impl AsRef<Path>) -> String {
    let path = path.as_ref();
    fs::read_to_string(root().join(path)).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// Name of each crate of the workspace with what it depends on (tests of its own aside), and its folder.
fn crates() -> BTreeMap<String, (BTreeSet<String>, PathBuf)> {
    let mut all = BTreeMap::new();
    for path in files(&["Cargo.toml"]) {
        let manifest = text(&path);
        let (mut name, mut section, mut needs) = (None, "", BTreeSet::new());
        for line in manifest.lines().map(str::trim) {
            if let Some(header) = line.strip_prefix('[') {
                // `[target.X.dependencies]` is one, too, and `[dependencies.NAME]` names one.
                section = header.trim_end_matches(']');
                if section.starts_with("target.") {
                    section = section.find(".dependencies").map_or("", |at| &section[at + 1..]);
                }
                needs.extend(section.strip_prefix("dependencies.").map(str::to_owned));
            } else if let Some((key, value)) = line.split_once('=').filter(|_| !line.starts_with('#')) {
                match section {
                    "package" if key.trim() == "name" => {
                        name = Some(value.trim().trim_matches('"').to_owned());
                    }
                    "dependencies" | "build-dependencies" => {
                        // Under another name, too.
                        let renamed = value.split("package = \"").nth(1).and_then(|s| s.split('"').next());
                        needs.insert(renamed.unwrap_or(key.trim().trim_end_matches(".workspace")).to_owned());
                    }
                    _ => {}
                }
            }
        }
        // The root has no package; programs to compare with are workspaces of their own.
        if let Some(name) =
            name.filter(|_| !manifest.contains("\n[workspace]") && !manifest.starts_with("[workspace]"))
        {
            all.insert(name, (needs, path.parent().unwrap().to_owned()));
        }
    }
    all
}

#[test]
fn dependencies_point_down_and_no_process_knows_another() {
    let layer = |name: &str| LAYERS.iter().position(|layer| layer.contains(&name));
    let all = crates();
    assert!(all.len() >= 17, "{:?}", all.keys());
    for (name, (needs, _)) in &all {
        let own = layer(name).unwrap_or_else(|| panic!("crate {name} is in no layer: add it to LAYERS"));
        for need in needs.iter().filter(|need| all.contains_key(*need)) {
            let other = layer(need).unwrap_or_else(|| panic!("crate {need} is in no layer"));
            assert!(other <= own, "{name} depends upwards on {need}");
            assert!(other < PROCESSES || other < own, "process {name} depends on process {need}");
        }
    }
}

#[test]
fn each_library_is_known_to_its_crate_only() {
    let all = crates();
    for (library, allowed) in ONLY {
        let users: Vec<_> =
            all.iter().filter(|(_, (needs, _))| needs.contains(library)).map(|(name, _)| name).collect();
        assert!(!users.is_empty(), "nobody uses {library} any more: take it from this list");
        let wrong: Vec<_> = users.iter().filter(|user| !allowed.contains(&user.as_str())).collect();
        assert!(wrong.is_empty(), "{library} is named by {wrong:?}, only {allowed:?} may");
    }
    // Names in code, so that no re-export goes round the manifests.
    for path in files(&[".rs"]) {
        let here = path.display().to_string();
        let code = code(&path);
        let names = |word: &str| code.contains(&format!("{word}::"));
        assert!(!names("bincode") || here == "crates/messages/src/wire.rs", "{here} names bincode");
        let ipc = here.starts_with("crates/ipc/") || here == "crates/latency/src/raw.rs";
        assert!(!names("iceoryx2") || ipc, "{here} names iceoryx2");
        assert!(!names("toml") || here.starts_with("config/"), "{here} names toml");
    }
}

/// A source file without its comments.
fn code(path: &Path) -> String {
    let without = |line: &str| line.split("//").next().unwrap_or("").to_owned() + "\n";
    text(path).lines().map(without).collect()
}

/// Clippy's bans keep clocks and the scheduler in `crates/realtime`; nobody else lifts them.
#[test]
fn only_realtime_may_name_clocks() {
    let bans = text("clippy.toml");
    for ban in ["std::thread::sleep", "std::time::Instant::now", "std::time::SystemTime::now"] {
        assert!(bans.contains(ban), "clippy.toml does not ban {ban}");
    }
    let clocks = [
        "Instant::",
        "SystemTime::",
        "Instant as",
        "SystemTime as",
        "UNIX_EPOCH.elapsed",
        "thread::sleep",
        "clock_gettime",
        "clock_nanosleep",
        "sched_setscheduler",
    ];
    let may = |here: &str| {
        // A time of tokio's is its own; the recorder stamps no message with it.
        let reasons = ["crates/realtime/", "broker/src/connection_tests.rs", "tests/peers/", "tests/tidy.rs"];
        reasons.iter().any(|path| here.starts_with(path))
            || here.contains("/benches/")
            || here.contains("/examples/")
    };
    for path in files(&[".rs"]) {
        let here = path.display().to_string();
        for word in clocks.iter().filter(|_| !may(&here)) {
            assert!(!code(&path).contains(word), "{here} names {word}: only crates/realtime reads clocks");
        }
    }
}

/// What the compiler cannot check stands in three places, whatever a file allows itself.
#[test]
fn unsafe_code_is_where_it_may_be() {
    let may = ["crates/ipc/", "crates/realtime/", "crates/sercos/src/socket.rs", "tests/tidy.rs"];
    let words = ["unsafe {", "unsafe fn", "unsafe impl", "unsafe extern", "unsafe(", "unsafe_code"];
    for path in files(&[".rs"]) {
        let here = path.display().to_string();
        for word in words.iter().filter(|_| !may.iter().any(|path| here.starts_with(path))) {
            assert!(!code(&path).contains(word), "{here} holds {word}: see CONTRIBUTING.md");
        }
    }
}

/// `println!` and `eprintln!` of the standard library wait for a paused terminal and panic when the reader is gone. The command
/// has those of `crates/terminal` instead; a process says something with `tracing`.
#[test]
fn nothing_prints_but_through_the_terminal_crate() {
    let may = |here: &str| {
        // The program that starts a process alone ends after its one line.
        let reasons = ["cli/src/", "crates/terminal/", "watchdog/src/main.rs"];
        reasons.iter().any(|path| here.starts_with(path))
            || here.ends_with("build.rs") // Cargo reads what it says
            || ["/benches/", "/examples/", "/tests/", "tests/"].iter().any(|part| here.contains(part))
    };
    for path in files(&[".rs"]) {
        let here = path.display().to_string();
        for word in ["println!(", "print!("].iter().filter(|_| !may(&here)) {
            assert!(!code(&path).contains(word), "{here} holds {word}: use tracing, or crates/terminal");
        }
    }
    for root in ["cli/src/lib.rs", "cli/src/main.rs"] {
        assert!(
            text(root).contains("#[macro_use(println, eprintln)]"),
            "{root} prints with the standard library"
        );
    }
    for path in files(&[".rs"]).iter().filter(|path| path.starts_with("cli/src")) {
        assert!(
            !code(path).contains("std::eprint") && !code(path).contains("std::print"),
            "{}",
            path.display()
        );
    }
}

#[test]
fn nothing_unfinished_is_in_the_code() {
    // Put together here, so that this file does not hold them.
    let forbidden =
        ["#[ign!ore", "db!g!(", "tod!o!(", "unimple!mented!("].map(|word| word.replacen('!', "", 1));
    // But for tests that LONG=1 runs.
    let long = format!("{} = \"long\"]", forbidden[0]);
    for path in files(&[".rs"]) {
        let code = code(&path).replace(&long, "");
        for word in &forbidden {
            assert!(!code.contains(word.as_str()), "{} holds {word}", path.display());
        }
    }
}

#[test]
fn files_are_short() {
    let long: BTreeMap<_, _> = LONGER.into();
    for path in files(&[".rs"]) {
        let (here, lines) = (path.display().to_string(), text(&path).lines().count());
        let is_long = lines > LONGEST;
        assert_eq!(
            is_long,
            long.contains_key(here.as_str()),
            "{here} has {lines} lines; at most {LONGEST}, or LONGER"
        );
    }
    for (name, (_, folder)) in crates() {
        let main = folder.join("src/main.rs");
        if LAYERS[PROCESSES].contains(&name.as_str()) && root().join(&main).exists() {
            let lines = text(&main).lines().count();
            assert!(lines <= LONGEST_MAIN, "{} has {lines} lines, at most {LONGEST_MAIN}", main.display());
        }
    }
}

#[test]
fn every_row_of_the_system_table_is_a_process() {
    let table = text("config/system.toml");
    let rows: BTreeSet<_> =
        table.lines().filter_map(|line| line.strip_prefix("[process.")?.split(']').next()).collect();
    let processes: BTreeSet<_> = messages::Process::ALL.iter().map(|p| p.name()).collect();
    assert_eq!(rows, processes);
    let crates = crates();
    assert!(processes.iter().all(|p| crates.contains_key(*p)), "a process without its crate");
}

/// Documents whose every path and test must exist.
fn documents() -> Vec<PathBuf> {
    let whole = |path: &PathBuf| {
        let name = path.display().to_string();
        ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md"].contains(&name.as_str())
            || name.starts_with("docs/")
    };
    files(&[".md"]).into_iter().filter(whole).collect()
}

/// Quotations between backticks in running text, without blocks of code.
fn quoted(document: &str) -> Vec<String> {
    let prose: String = document.split("```").step_by(2).collect();
    prose
        .lines()
        .flat_map(|line| line.split('`').skip(1).step_by(2).map(str::to_owned).collect::<Vec<_>>())
        .collect()
}

/// Whether a quotation claims that a file or folder of the tree exists.
fn is_path(word: &str) -> bool {
    const FOLDERS: [&str; 21] = [
        "planner",
        "controller",
        "lowlevel",
        "sim-backend",
        "broker",
        "watchdog",
        "logger",
        "dashboard",
        "joystick",
        "gateway",
        "cli",
        "config",
        "crates",
        "chain",
        "studies",
        "python",
        "tests",
        "docs",
        "runs",
        "scenes",
        "gaits",
    ];
    // Names that stand for others are patterns; a bare file name may be anywhere.
    let plain = word.chars().all(|c| c.is_ascii_alphanumeric() || "/._-".contains(c));
    let ending = [".rs", ".toml", ".md", ".urdf", ".sh", ".py"].iter().any(|e| word.ends_with(e));
    let pattern = word.split(['/', '.']).any(|part| part == "NAME" || part == "PROCESS" || part == "SCENE");
    let first = word.split('/').next().unwrap_or("");
    let in_folder = FOLDERS[..18].contains(&first) && word.contains('/');
    plain && !pattern && (in_folder || ending && word.contains('/'))
}

#[test]
fn every_path_that_the_documents_name_exists() {
    let mut missing = Vec::new();
    for document in documents() {
        let beside = document.parent().unwrap().to_owned();
        for word in quoted(&text(&document)) {
            let word = word.split(':').next().unwrap_or("").to_owned();
            // Events and topics look like paths too: `events/planner`, `tests/run`.
            let here =
                [Path::new(""), &beside, Path::new("config")].map(|base| root().join(base).join(&word));
            if is_path(&word) && !here.iter().any(|path| path.exists()) {
                missing.push(format!("{}: `{word}`", document.display()));
            }
        }
        for target in links(&text(&document)) {
            if !root().join(&beside).join(&target).exists() {
                missing.push(format!("{}: link to {target}", document.display()));
            }
        }
    }
    assert!(missing.is_empty(), "there is no\n{}", missing.join("\n"));
}

/// Targets of links within the tree.
fn links(document: &str) -> Vec<String> {
    let targets = document.split("](").skip(1).filter_map(|rest| rest.split([')', '#']).next());
    targets
        .filter(|t| !t.is_empty() && !t.contains("://") && !t.starts_with("mailto:"))
        .map(str::to_owned)
        .collect()
}

/// Tests are named `file.rs: name_of_the_test`, or as a path to the file: `tests/file.rs: name_of_the_test`.
#[test]
fn every_test_that_the_documents_name_exists() {
    let sources = files(&[".rs"]);
    let mut missing = Vec::new();
    for document in documents() {
        for word in quoted(&text(&document)) {
            let Some((file, name)) = word.split_once(".rs: ").or_else(|| word.split_once(".rs::")) else {
                continue;
            };
            let file = format!("{file}.rs");
            let named = |path: &&PathBuf| path.ends_with(&file);
            let holds = |path: &PathBuf| text(path).contains(&format!("fn {name}("));
            if !sources.iter().filter(named).any(holds) {
                missing.push(format!("{}: `{word}`", document.display()));
            }
        }
    }
    assert!(missing.is_empty(), "there is no\n{}", missing.join("\n"));
}

#[test]
fn every_file_of_tests_is_run() {
    let mut left_out = Vec::new();
    for all in
        files(&["all.rs"]).iter().filter(|path| path.parent().is_some_and(|folder| folder.ends_with("tests")))
    {
        let folder = root().join(all.parent().unwrap());
        let (run, manifest) = (text(all), text(folder.parent().unwrap().join("Cargo.toml")));
        for entry in fs::read_dir(&folder).unwrap().flatten() {
            let path = entry.path();
            let name = path.file_stem().unwrap().to_str().unwrap();
            let runs = run.contains(&format!("mod {name};"))
                || manifest.contains(&format!("[[test]]\nname = \"{name}\"\n"));
            if !runs && (path.extension().is_some_and(|e| e == "rs") || path.join("mod.rs").exists()) {
                left_out.push(path.display().to_string());
            }
        }
    }
    assert!(
        left_out.is_empty(),
        "neither in all.rs nor an executable of their own:\n{}",
        left_out.join("\n")
    );
}
