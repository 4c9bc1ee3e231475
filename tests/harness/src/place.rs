//! A place of its own for one test: run directory, copy of the configuration, TCP port.

use crate::running::{Running, Said};
use std::fs;
use std::io::PipeWriter;
use std::net::{Ipv4Addr, TcpListener};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};

/// Tables of a scene: Lola stands up, and walks until she is told to stop.
pub const WALK: &str = "
[[command]]
time = 0.2
topic = \"walk/stand\"
[[command]]
time = 2.0
topic = \"walk/velocity\"
forward = 0.278
";

/// Directory, configuration and port of one test. Removed when dropped.
pub struct Site {
    exe: PathBuf,
    dir: PathBuf,
    port: u16,
}

impl Site {
    /// A new place for the executable `exe`, with a copy of the shipped configuration and a free TCP port.
    pub fn new(exe: &str) -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let n = COUNT.fetch_add(1, Ordering::Relaxed);
        let dir = PathBuf::from(format!("/dev/shm/gangwerk-test-{}-{n}", std::process::id()));
        let _ = fs::remove_dir_all(&dir);
        config::snapshot(&config::root(None), &dir.join("config")).unwrap_or_else(|e| panic!("{e}"));
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).expect("a free port");
        let port = listener.local_addr().expect("a bound socket has an address").port();
        let site = Self { exe: exe.into(), dir, port };
        site.edit("system.toml", "tcp_listen = \"\"", &format!("tcp_listen = \"127.0.0.1:{port}\""));
        site
    }

    /// The same with a watchdog that bears a machine which is shared with others and stands still for some milliseconds: for
    /// tests of something else than the watchdog's limit.
    pub fn patient(exe: &str) -> Self {
        let site = Self::new(exe);
        site.edit("system.toml", "watchdog_missed = 2 ", "watchdog_missed = 100 ");
        site.edit("system.toml", "toggle_missed = 50 ", "toggle_missed = 200 ");
        site
    }

    /// The TCP port of the broker.
    pub fn port(&self) -> u16 {
        self.port
    }

    /// Path of a file of this test.
    pub fn path(&self, name: &str) -> PathBuf {
        self.dir.join(name)
    }

    /// Run directory.
    pub fn run_dir(&self) -> PathBuf {
        self.path("run")
    }

    /// Path of a configuration file.
    pub fn config(&self, name: &str) -> PathBuf {
        self.dir.join("config").join(name)
    }

    /// Replaces the only occurrence of `from` in a configuration file.
    pub fn edit(&self, name: &str, from: &str, to: &str) {
        let path = self.config(name);
        let text = fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        assert_eq!(text.matches(from).count(), 1, "`{from}` in {name}");
        fs::write(&path, text.replace(from, to)).expect("the copy is ours");
    }

    /// Writes a scene of Lola's: duration \[s\], what else stands at the top level, commands and pushes.
    pub fn scene(&self, name: &str, duration: f64, tables: &str) {
        let text = format!(
            "about = \"A test.\"\nrobot = \"lola\"\ngait = \"lola\"\ndepth = 1\nintegrator = \"euler\"\n\
             substeps = 4\ncycle = 0.001\nstart_pose = \"stand\"\nduration = {duration:?}\nseed = 1\n{tables}"
        );
        fs::write(self.config(&format!("scenes/{name}.toml")), text).expect("the copy is ours");
    }

    /// `gangwerk ARGUMENTS` to its end.
    pub fn gangwerk(&self, arguments: &[&str]) -> Said {
        self.start(arguments).end()
    }

    /// Starts `gangwerk ARGUMENTS`.
    pub fn start(&self, arguments: &[&str]) -> Running {
        Running::start(&mut self.command(arguments), self)
    }

    /// Starts `WRAPPER gangwerk ARGUMENTS`: a program that changes something of its own and becomes what it is given.
    pub fn start_under(&self, wrapper: &[&str], arguments: &[&str]) -> Running {
        let mut command = Command::new(wrapper.first().copied().unwrap_or("env"));
        command.args(wrapper.get(1..).unwrap_or_default()).arg(&self.exe).args(arguments);
        self.place(&mut command);
        Running::start(&mut command, self)
    }

    /// The same on these cores only.
    pub fn start_on(&self, cores: &[usize], arguments: &[&str]) -> Running {
        let mut command = self.command(arguments);
        let start = || {
            let mut set = rustix::thread::CpuSet::new();
            cores.iter().for_each(|&core| set.set(core));
            rustix::thread::sched_setaffinity(None, &set).expect("the machine has these cores");
            Running::start(&mut command, self)
        };
        // A thread of its own: what it starts inherits its cores, and they end with it.
        std::thread::scope(|s| s.spawn(start).join()).unwrap_or_else(|e| std::panic::resume_unwind(e))
    }

    /// Starts `gangwerk run SCENE`, logging to `SCENE.mcap` in this place.
    pub fn run(&self, scene: &str, more: &[&str]) -> Running {
        self.start(&self.run_arguments(scene, more).iter().map(String::as_str).collect::<Vec<_>>())
    }

    /// The same with standard output and standard error into a pipe.
    pub fn run_into(&self, scene: &str, more: &[&str], errors: PipeWriter) -> Running {
        let arguments = self.run_arguments(scene, more);
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        Running::start_into(&mut self.command(&arguments), self, errors)
    }

    /// The arguments of [`Site::run`].
    pub fn run_arguments(&self, scene: &str, more: &[&str]) -> Vec<String> {
        let dir = self.run_dir().display().to_string();
        let out = self.dir.display().to_string();
        let all = ["run", scene, "--dir", &dir, "--out", &out, "--no-plots"];
        all.iter().chain(more).map(|&a| a.to_owned()).collect()
    }

    /// `gangwerk topic ARGUMENTS` in this run directory.
    pub fn topic(&self, arguments: &[&str]) -> Said {
        let dir = self.run_dir().display().to_string();
        self.gangwerk(&[&["topic"], arguments, &["--dir", &dir]].concat())
    }

    /// Names of this run's objects in shared memory.
    pub fn shared_memory(&self) -> Vec<String> {
        let mut hash = 0xcbf2_9ce4_8422_2325u64;
        for byte in self.run_dir().as_os_str().as_encoded_bytes() {
            hash = (hash ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3);
        }
        let prefix = format!("gangwerk_{:012x}", hash >> 16);
        let all = fs::read_dir("/dev/shm").expect("shared memory is mounted").flatten();
        all.filter_map(|entry| entry.file_name().into_string().ok())
            .filter(|n| n.starts_with(&prefix))
            .collect()
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(&self.exe);
        command.args(arguments);
        self.place(&mut command);
        command
    }

    fn place(&self, command: &mut Command) {
        command.arg("--config").arg(self.dir.join("config")).current_dir(&self.dir).stdin(Stdio::null());
    }
}

impl Drop for Site {
    fn drop(&mut self) {
        if std::thread::panicking() {
            eprintln!("kept for a look: {}", self.dir.display());
        } else {
            let _ = fs::remove_dir_all(&self.dir);
        }
    }
}

/// The source tree.
pub fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}
