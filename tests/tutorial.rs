//! The tutorial of the book is true: each block of shell is run as it stands, and says what the page says it does.
//!
//! Words behind `sh` of a block: `background` runs it beside those that follow, until its text has come; `by-hand` is not run. In a
//! block of text, `…` stands for anything; behind the word `varies`, numbers need only be numbers.

use harness::{doze, root};
use realtime::clock;
use std::fs::{self, File};
use std::os::unix::fs::{DirBuilderExt, symlink};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

const EXE: &str = harness::executable!();
/// Limit for a block \[ns\].
const PATIENCE: u64 = 60 * clock::SECOND;

/// A block of a page.
struct Block {
    kind: String,
    text: String,
    /// Its first line in the page.
    line: usize,
}

/// Blocks between fences.
fn blocks(page: &str) -> Vec<Block> {
    let (mut all, mut open): (Vec<Block>, bool) = (Vec::new(), false);
    for (i, line) in page.lines().enumerate() {
        match line.strip_prefix("```") {
            Some(_) if open => open = false,
            Some(kind) => {
                all.push(Block { kind: kind.to_owned(), text: String::new(), line: i + 2 });
                open = true;
            }
            None if open => {
                let block = all.last_mut().expect("a fence has opened it");
                block.text += line;
                block.text.push('\n');
            }
            None => {}
        }
    }
    assert!(!open, "a block without an end");
    all
}

/// True if `said` is `wanted`, in which `…` stands for anything.
fn is_as_told(said: &str, wanted: &str, varies: bool) -> bool {
    let (said, wanted) =
        if varies { (without_numbers(said), without_numbers(wanted)) } else { (said.into(), wanted.into()) };
    // A line that is only an ellipsis stands for whole lines, or none.
    let wanted: String =
        wanted.lines().map(|line| if line == "…" { "…".into() } else { format!("{line}\n") }).collect();
    let parts: Vec<&str> = wanted.split('…').collect();
    let (Some(first), Some(last)) = (parts.first(), parts.last()) else { return false };
    let Some(mut rest) = said.strip_prefix(first) else { return false };
    for part in &parts[1..] {
        match rest.find(part) {
            Some(at) => rest = &rest[at + part.len()..],
            None => return false,
        }
    }
    // Nothing after what was told, unless the text ends with an ellipsis.
    parts.len() == 1 && rest.is_empty() || parts.len() > 1 && (last.is_empty() || said.ends_with(last))
}

/// Text in which every number is `0`.
fn without_numbers(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '0'..='9' if out.ends_with('0') => {}
            '0'..='9' => out.push('0'),
            '.' if out.ends_with('0') => {}
            _ => out.push(c),
        }
    }
    out
}

/// Shell in a place of its own, with `gangwerk` as installed: no tree around it.
struct Shell {
    place: PathBuf,
    beside: Option<Child>,
}

impl Shell {
    fn new(page: &str) -> Self {
        let place = PathBuf::from(format!("/dev/shm/gangwerk-test-{}-{page}", std::process::id()));
        let _ = fs::remove_dir_all(&place);
        fs::create_dir_all(place.join("bin")).unwrap();
        fs::create_dir(place.join("work")).unwrap();
        fs::DirBuilder::new().mode(0o700).create(place.join("run")).unwrap();
        symlink(EXE, place.join("bin/gangwerk")).unwrap();
        Self { place, beside: None }
    }

    /// Starts a block; what it says goes into the file that is returned.
    fn start(&self, block: &Block) -> (Child, PathBuf) {
        let said = self.place.join(format!("{}.said", block.line));
        let file = File::create(&said).unwrap();
        let path = format!("{}:{}", self.place.join("bin").display(), std::env::var("PATH").unwrap());
        let mut command = Command::new("sh");
        // A signal for a block of one command is for that command.
        let one = block.text.lines().count() == 1;
        command.arg("-c").arg(if one { format!("exec {}", block.text) } else { block.text.clone() });
        command.current_dir(self.place.join("work")).env("PATH", path).env("HOME", &self.place);
        command.env("XDG_RUNTIME_DIR", self.place.join("run")).env_remove("GANGWERK_CONFIG");
        command.stdin(Stdio::null()).stdout(file.try_clone().unwrap()).stderr(file);
        (command.spawn().unwrap(), said)
    }

    /// Runs a block and holds what it says against `told`.
    fn run(&mut self, page: &str, block: &Block, told: Option<&Block>) {
        let (mut child, file) = self.start(block);
        let background = block.kind.ends_with(" background");
        let begun = clock::now();
        let place = format!("docs/tutorial/{page}.md, line {}", block.line);
        let fits = |said: &str| told.is_none_or(|t| is_as_told(said, &t.text, t.kind.ends_with(" varies")));
        loop {
            let ended = child.try_wait().unwrap();
            let said = fs::read_to_string(&file).unwrap();
            if background && fits(&said) {
                self.beside = Some(child);
                return;
            }
            if let Some(status) = ended {
                // The last line of a page may be one that is to fail.
                assert!(!background && fits(&said), "{place}\n{}said\n{said}", block.text);
                assert!(told.is_some() || status.success(), "{place}: {status}\n{said}");
                return;
            }
            if clock::now() - begun > PATIENCE {
                let _ = child.kill();
                panic!("{place} does not end, or does not say what it should; it said\n{said}");
            }
            doze(0.02);
        }
    }
}

impl Drop for Shell {
    fn drop(&mut self) {
        if let Some(mut child) = self.beside.take() {
            let late = clock::now() + 8 * clock::SECOND;
            // Asked twice it ends at once.
            while child.try_wait().is_ok_and(|status| status.is_none()) && clock::now() < late {
                harness::signal(child.id(), harness::Signal::TERM);
                doze(0.2);
            }
            let _ = child.kill();
            let _ = child.wait();
        }
        if !std::thread::panicking() {
            let _ = fs::remove_dir_all(&self.place);
        }
    }
}

/// Every block of a page, in the order of the page.
fn follow(page: &str) {
    let text = fs::read_to_string(root().join(format!("docs/tutorial/{page}.md"))).unwrap();
    let blocks = blocks(&text);
    let mut shell = Shell::new(page);
    let mut ran = 0;
    for (i, block) in blocks.iter().enumerate() {
        let mut words = block.kind.split(' ');
        if words.next() == Some("sh") && words.next() != Some("by-hand") {
            let told = blocks.get(i + 1).filter(|next| next.kind.starts_with("text"));
            shell.run(page, block, told);
            ran += 1;
        }
    }
    assert!(ran >= 4, "{ran} blocks of {page} were run");
}

#[test]
fn first_walk() {
    follow("first_walk");
}

#[test]
fn first_command() {
    follow("first_command");
}

#[test]
fn first_push() {
    follow("first_push");
}

#[test]
fn first_scene() {
    follow("first_scene");
}

#[test]
fn first_gain() {
    follow("first_gain");
}

#[test]
fn every_page_of_the_tutorial_is_followed() {
    let this = fs::read_to_string(root().join("tests/tutorial.rs")).unwrap();
    let pages = fs::read_dir(root().join("docs/tutorial")).unwrap().flatten();
    let mut count = 0;
    for page in pages {
        let name = Path::new(&page.file_name()).file_stem().unwrap().to_string_lossy().into_owned();
        assert!(this.contains(&format!("follow(\"{name}\")")), "nobody follows {name}");
        count += 1;
    }
    assert_eq!(count, 5);
}

#[test]
fn what_is_not_as_told_is_seen() {
    let told = "a 1.5\n…\nz … end\n";
    for (said, varies, fits) in [
        ("a 1.5\nb\nz is the end\n", false, true),
        ("a 1.5\nz the end\n", false, true),
        ("a 1.6\nz the end\n", false, false),
        ("a 12.25\nz the end\n", true, true),
        ("a x\nz the end\n", true, false),
        ("a 1.5\nz the end\nmore\n", false, false),
        ("a 1.5\nb\n", false, false),
    ] {
        assert_eq!(is_as_told(said, told, varies), fits, "{said}");
    }
    assert!(!is_as_told("one\ntwo\n", "one\n", false) && is_as_told("one\ntwo\n", "one\n…\n", false));
}
