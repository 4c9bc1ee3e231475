//! The run directory: private, owned by who runs the robot, reached through no link, and gone at the end.
//!
//! It lies where others can write, too, so nothing in it is taken on trust: it is opened once without following a link, its
//! owner and mode are checked on what was opened, and every file is opened relative to that.

use crate::IpcError;
use rustix::fs::{AtFlags, Mode, OFlags};
use rustix::io::Errno;
use std::fs::File;
use std::io::{Read, Write};
use std::os::fd::OwnedFd;
use std::os::unix::fs::{DirBuilderExt, MetadataExt};
use std::path::{Path, PathBuf};

/// What a run puts there, besides a `.lock` of each process.
const FILES: [&str; 6] = [RUN, "run.new", NAMES, "names.new", "broker.sock", "broker.tcp"];
/// File with the part of the names in shared memory that is one run's own.
pub(crate) const NAMES: &str = "names";
/// Parameters of the run's processes.
const RUN: &str = "run";
/// The configuration of the run: read once by the supervisor, and by nobody from anywhere else.
pub const CONFIG: &str = "config";

/// An open run directory.
#[derive(Debug)]
pub(crate) struct RunDir {
    path: PathBuf,
    fd: OwnedFd,
}

/// Default run directory: `$XDG_RUNTIME_DIR/gangwerk` if that is this user's
/// own, else `/dev/shm/gangwerk-UID`.
pub fn default_dir() -> PathBuf {
    let uid = rustix::process::geteuid().as_raw();
    // An environment that was carried over from another user (su, sudo) leads to that user's directory: not this one's.
    let own = |dir: &PathBuf| {
        dir.is_absolute()
            && std::fs::metadata(dir).is_ok_and(|m| m.is_dir() && m.uid() == uid && m.mode() & 0o077 == 0)
    };
    let session = std::env::var_os("XDG_RUNTIME_DIR").map(PathBuf::from).filter(own);
    session.map_or_else(|| format!("/dev/shm/gangwerk-{uid}").into(), |dir| dir.join("gangwerk"))
}

/// Problem of a run directory; none if it is one, or is not there.
pub fn wrong_dir(path: &Path) -> Option<IpcError> {
    let there = std::fs::symlink_metadata(path);
    let missing = there.is_err_and(|e| e.kind() == std::io::ErrorKind::NotFound);
    if missing { None } else { RunDir::open(path).err() }
}

/// Writes a private file (mode 0600) into a run directory, whole or not at all; makes the directory if it is not there.
///
/// # Errors
/// The directory is not private, or the file cannot be written.
pub fn publish_file(dir: &Path, name: &str, text: &str) -> Result<(), IpcError> {
    let (dir, unfinished) = (RunDir::make(dir)?, format!("{name}.new"));
    let written = dir.new_file(&unfinished)?.write_all(text.as_bytes());
    written.map_err(|e| dir.told(name, e))?;
    dir.rename(&unfinished, name)
}

/// Removes a file of [`publish_file`] if it still holds `text`, and the directory if nothing else is in it.
pub fn withdraw_file(dir: &Path, name: &str, text: &str) {
    let Ok(open) = RunDir::open(dir) else { return };
    let mut found = String::new();
    let read = open.file(name, OFlags::RDONLY).map(|mut file| file.read_to_string(&mut found));
    if matches!(read, Ok(Ok(_))) && found == text {
        let _ = rustix::fs::unlinkat(&open.fd, name, AtFlags::empty());
        let _ = std::fs::remove_dir(dir);
    }
}

impl RunDir {
    /// Opens it, after making it if it is not there.
    pub(crate) fn make(path: &Path) -> Result<Self, IpcError> {
        let made = std::fs::DirBuilder::new().recursive(true).mode(0o700).create(path);
        // Something else in its place is told by opening it, in better words.
        match made {
            Err(e) if e.kind() == std::io::ErrorKind::NotADirectory => {
                Err(told(path, &"lies below something that is no directory: choose another one with --dir"))
            }
            Err(e) if e.kind() != std::io::ErrorKind::AlreadyExists => {
                Err(told(path, &format!("cannot be made: {e}; choose another one with --dir")))
            }
            _ => Self::open(path),
        }
    }

    /// Refuses a directory in which something has the name of what a run puts there, and removes at its end, if no run put it there:
    /// a run leaves `names` beside it.
    pub(crate) fn refuse_others(&self) -> Result<(), IpcError> {
        let there = |name: &str| rustix::fs::statat(&self.fd, name, AtFlags::SYMLINK_NOFOLLOW).is_ok();
        let mut names = String::new();
        let read = self.file(NAMES, OFlags::RDONLY).map(|file| file.take(7).read_to_string(&mut names));
        // Empty: the power failed before it was on the disk.
        let of_a_run = matches!(read, Ok(Ok(0 | 6))) && names.bytes().all(|c| c.is_ascii_hexdigit());
        match [NAMES, CONFIG, RUN].into_iter().find(|name| !of_a_run && there(name)) {
            None => Ok(()),
            Some(name) => Err(told(
                &self.path,
                &format!(
                    "is not a run directory: no run made the `{name}` in it; choose another one with --dir"
                ),
            )),
        }
    }

    /// Opens it and checks that nobody else has a hand in it.
    pub(crate) fn open(path: &Path) -> Result<Self, IpcError> {
        // Without a slash or a dot at the end, behind which a link would be followed.
        let path: PathBuf = path.components().collect();
        let flags = OFlags::RDONLY | OFlags::DIRECTORY | OFlags::NOFOLLOW | OFlags::CLOEXEC;
        let fd = rustix::fs::open(&path, flags, Mode::empty()).map_err(|e| match e {
            Errno::LOOP | Errno::NOTDIR => {
                told(&path, &"is a link or no directory: remove it, or choose another one with --dir")
            }
            Errno::NOENT => told(&path, &"does not exist: start a run with `gangwerk run SCENE`"),
            e => told(&path, &e),
        })?;
        let (found, user) =
            (rustix::fs::fstat(&fd).map_err(|e| told(&path, &e))?, rustix::process::geteuid().as_raw());
        if found.st_uid != user {
            let text = format!(
                "belongs to user {} and this is user {user}: have it removed, or choose another one with --dir",
                found.st_uid
            );
            return Err(told(&path, &text));
        }
        let mode = found.st_mode & 0o777;
        if mode != 0o700 {
            let text =
                format!("has mode {mode:04o}, must be 0700, or others get in: chmod 700 {}", path.display());
            return Err(told(&path, &text));
        }
        Ok(Self { path, fd })
    }

    /// A file in it that is there, or with `OFlags::CREATE` is made; never a link, never somebody else's.
    pub(crate) fn file(&self, name: &str, flags: OFlags) -> Result<File, IpcError> {
        let flags = flags | OFlags::NOFOLLOW | OFlags::CLOEXEC | OFlags::NONBLOCK;
        let opened = rustix::fs::openat(&self.fd, name, flags, Mode::RUSR | Mode::WUSR);
        let file = File::from(opened.map_err(|e| self.told(name, e))?);
        let found = file.metadata().map_err(|e| self.told(name, e))?;
        // A hard link has another name elsewhere, which writing here would change.
        if !found.is_file() || found.nlink() > 1 || found.uid() != rustix::process::geteuid().as_raw() {
            return Err(self.told(name, "is a link, no file, or somebody else's: remove it"));
        }
        Ok(file)
    }

    /// A file in it that has not been there before: what has its name is removed.
    pub(crate) fn new_file(&self, name: &str) -> Result<File, IpcError> {
        let _ = rustix::fs::unlinkat(&self.fd, name, AtFlags::empty());
        self.file(name, OFlags::WRONLY | OFlags::CREATE | OFlags::EXCL)
    }

    /// Gives a file another name, in one step.
    pub(crate) fn rename(&self, from: &str, to: &str) -> Result<(), IpcError> {
        rustix::fs::renameat(&self.fd, from, &self.fd, to).map_err(|e| self.told(to, e))
    }

    /// Whether `file` is what has this name now: a file that was removed after it was opened is not.
    pub(crate) fn holds(&self, name: &str, file: &File) -> bool {
        let here = rustix::fs::statat(&self.fd, name, AtFlags::SYMLINK_NOFOLLOW);
        here.is_ok_and(|here| file.metadata().is_ok_and(|m| (m.dev(), m.ino()) == (here.st_dev, here.st_ino)))
    }

    /// Removes what a run puts there, and the directory itself if nothing else is in it. What cannot be removed stays.
    pub(crate) fn clear(&self, locks: impl Iterator<Item = &'static str>) {
        let _ = std::fs::remove_dir_all(self.path.join(CONFIG));
        for name in FILES.map(String::from).into_iter().chain(locks.map(|who| format!("{who}.lock"))) {
            let _ = rustix::fs::unlinkat(&self.fd, &name, AtFlags::empty());
        }
        let _ = std::fs::remove_dir(&self.path);
    }

    fn told(&self, name: &str, reason: impl std::fmt::Display) -> IpcError {
        IpcError::Other(format!("{}: {reason}", self.path.join(name).display()))
    }
}

fn told(path: &Path, reason: &dyn std::fmt::Display) -> IpcError {
    IpcError::Other(format!("run directory {} {reason}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::{PermissionsExt, symlink};

    /// A place for one test, removed at its end.
    struct Ground(PathBuf);
    impl Ground {
        fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("gangwerk-run-dir-{}-{name}", std::process::id()));
            std::fs::create_dir_all(&path).unwrap();
            Self(path)
        }
    }
    impl Drop for Ground {
        fn drop(&mut self) {
            let _ = std::fs::remove_dir_all(&self.0);
        }
    }

    fn refused(result: Result<impl std::fmt::Debug, IpcError>, why: &str) {
        let text = result.unwrap_err().to_string();
        assert!(text.contains(why), "{text}");
    }

    #[test]
    fn a_link_in_place_of_the_directory_is_refused() {
        let ground = Ground::new("link");
        let (real, link) = (ground.0.join("real"), ground.0.join("link"));
        RunDir::make(&real).unwrap();
        symlink(&real, &link).unwrap();
        for path in [link.clone(), link.join(""), link.join(".")] {
            refused(RunDir::make(&path), "is a link or no directory");
        }
    }

    #[test]
    fn a_directory_that_others_can_enter_or_own_is_refused() {
        let ground = Ground::new("open");
        let dir = ground.0.join("run");
        RunDir::make(&dir).unwrap();
        for mode in [0o755, 0o777, 0o750] {
            std::fs::set_permissions(&dir, PermissionsExt::from_mode(mode)).unwrap();
            refused(RunDir::make(&dir), &format!("mode {mode:04o}"));
        }
        std::fs::set_permissions(&dir, PermissionsExt::from_mode(0o700)).unwrap();
        // Only root can give a directory away.
        if rustix::process::geteuid().is_root() {
            std::os::unix::fs::chown(&dir, Some(65534), None).unwrap();
            refused(RunDir::make(&dir), "belongs to user 65534");
        }
    }

    /// The links `supervisor.lock` and `run.new` of somebody who made the directory first had a run overwrite other files.
    #[test]
    fn files_behind_links_are_not_touched() {
        let ground = Ground::new("victim");
        let dir = RunDir::make(&ground.0.join("run")).unwrap();
        let victim = ground.0.join("victim");
        std::fs::write(&victim, "precious").unwrap();
        symlink(&victim, dir.path.join("supervisor.lock")).unwrap();
        std::fs::hard_link(&victim, dir.path.join("planner.lock")).unwrap();
        symlink(&victim, dir.path.join("run.new")).unwrap();
        for name in ["supervisor.lock", "planner.lock"] {
            assert!(dir.file(name, OFlags::RDWR | OFlags::CREATE).is_err(), "{name}");
        }
        dir.new_file("run.new").unwrap();
        assert!(!dir.path.join("run.new").is_symlink());
        assert_eq!(std::fs::read_to_string(&victim).unwrap(), "precious");
    }

    #[test]
    fn a_published_file_is_private_and_goes_with_its_writer() {
        let ground = Ground::new("publish");
        let path = ground.0.join("run");
        publish_file(&path, "x.url", "one").unwrap();
        publish_file(&path, "x.url", "two").unwrap();
        let mode = std::fs::metadata(path.join("x.url")).unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o600);
        withdraw_file(&path, "x.url", "one");
        assert_eq!(std::fs::read_to_string(path.join("x.url")).unwrap(), "two", "somebody else's by now");
        withdraw_file(&path, "x.url", "two");
        assert!(!path.exists());
    }

    /// `--dir .` removed the `config` of the project, and then the project's directory.
    #[test]
    fn what_no_run_put_there_is_refused_and_stays() {
        for name in ["config", "run", "names"] {
            let ground = Ground::new(&format!("own-{name}"));
            let (path, precious) = (ground.0.join("project"), ground.0.join("project").join(name));
            let dir = RunDir::make(&path).unwrap();
            std::fs::write(&precious, "precious").unwrap();
            refused(dir.refuse_others(), &format!("is not a run directory: no run made the `{name}`"));
            refused(crate::Space::create(&path).map(drop), "is not a run directory");
            let left: Vec<_> = std::fs::read_dir(&path).unwrap().map(|e| e.unwrap().file_name()).collect();
            assert_eq!(left, [name]);
            assert_eq!(std::fs::read_to_string(&precious).unwrap(), "precious");
        }
        // What a killed run left is no reason.
        let ground = Ground::new("killed");
        let dir = RunDir::make(&ground.0.join("run")).unwrap();
        std::fs::create_dir(dir.path.join("config")).unwrap();
        std::fs::write(dir.path.join("names"), "00c0de").unwrap();
        dir.refuse_others().unwrap();
    }

    #[test]
    fn what_a_run_puts_there_goes_and_what_others_put_there_stays() {
        let ground = Ground::new("clear");
        let path = ground.0.join("run");
        let dir = RunDir::make(&path).unwrap();
        for name in ["run", "names", "broker.sock", "broker.tcp", "watchdog.lock"] {
            dir.new_file(name).unwrap();
        }
        std::fs::write(path.join("notes"), "mine").unwrap();
        dir.clear(["watchdog"].into_iter());
        let left: Vec<_> = std::fs::read_dir(&path).unwrap().map(|e| e.unwrap().file_name()).collect();
        assert_eq!(left, ["notes"]);
        std::fs::remove_file(path.join("notes")).unwrap();
        dir.clear(std::iter::empty());
        assert!(!path.exists());
    }
}
