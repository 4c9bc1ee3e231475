//! Check of a machine's real-time setup: the output of `gangwerk doctor`.

use crate::thread::{CAP_IPC_LOCK, CAP_SYS_NICE, has_capability};
use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
use std::fs::read_to_string;

/// Files that this process may have open \[1\], after it has allowed itself as many as wanted, if it may.
pub fn open_files(wanted: u64) -> u64 {
    let limit = getrlimit(Resource::Nofile);
    let may = limit.maximum.is_none_or(|most| most >= wanted);
    if may && limit.current.is_some_and(|now| now < wanted) {
        let _ = setrlimit(Resource::Nofile, Rlimit { current: Some(wanted), ..limit });
    }
    getrlimit(Resource::Nofile).current.unwrap_or(u64::MAX)
}

/// Rating of a finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grade {
    /// As it should be.
    Good,
    /// Works; cycles will be late more often.
    Fair,
    /// Missing: the process says "degraded".
    Missing,
}

/// One finding.
#[derive(Clone, Debug)]
pub struct Check {
    /// Subject of the check.
    pub what: &'static str,
    /// Finding.
    pub found: String,
    /// Meaning.
    pub grade: Grade,
    /// Advice; empty if it is good.
    pub advice: &'static str,
}

/// Looks at this machine.
pub fn preflight() -> Vec<Check> {
    vec![
        kernel(),
        throttling(),
        priority(),
        memory(),
        cores(),
        isolation(),
        shared_memory(),
        clock_source(),
        processor_sleep(),
        frequency(),
    ]
}

fn check(what: &'static str, found: impl Into<String>, grade: Grade, advice: &'static str) -> Check {
    let advice = if grade == Grade::Good { "" } else { advice };
    Check { what, found: found.into(), grade, advice }
}

fn line(path: &str) -> Option<String> {
    read_to_string(path).ok().map(|text| text.trim().to_string())
}

fn kernel() -> Check {
    let uname = rustix::system::uname();
    let version = uname.version().to_string_lossy().into_owned();
    let release = uname.release().to_string_lossy().into_owned();
    let model = ["PREEMPT_RT", "PREEMPT_DYNAMIC", "PREEMPT"].into_iter().find(|m| version.contains(m));
    let real_time = model == Some("PREEMPT_RT") || line("/sys/kernel/realtime").as_deref() == Some("1");
    let grade = if real_time { Grade::Good } else { Grade::Fair };
    let found = format!("{release}, {}", model.unwrap_or("no preemption in the kernel"));
    check("kernel", found, grade, "install a kernel with PREEMPT_RT (in mainline since 6.12)")
}

fn throttling() -> Check {
    let what = "real-time throttling";
    let advice = "a spinning real-time thread is paused 50 ms per second; sysctl kernel.sched_rt_runtime_us=-1 lifts \
                  that, once nothing spins";
    match line("/proc/sys/kernel/sched_rt_runtime_us").as_deref() {
        Some("-1") => check(what, "off", Grade::Good, advice),
        Some(us) => check(what, format!("{us} us of each second"), Grade::Fair, advice),
        None => check(what, "not visible", Grade::Fair, advice),
    }
}

fn priority() -> Check {
    let limit = getrlimit(Resource::Rtprio).current;
    let allowed = has_capability(CAP_SYS_NICE) || limit.is_none_or(|l| l >= 98);
    let found = match limit {
        _ if has_capability(CAP_SYS_NICE) => "any (CAP_SYS_NICE)".into(),
        None => "any".into(),
        Some(l) => format!("up to {l}"),
    };
    let grade = if allowed { Grade::Good } else { Grade::Missing };
    check("SCHED_FIFO priority", found, grade, "add `@realtime - rtprio 98` to /etc/security/limits.conf")
}

fn memory() -> Check {
    let limit = getrlimit(Resource::Memlock).current;
    let allowed = has_capability(CAP_IPC_LOCK) || limit.is_none_or(|l| l >= 1 << 30);
    let found = match limit {
        _ if has_capability(CAP_IPC_LOCK) => "any (CAP_IPC_LOCK)".into(),
        None => "any".into(),
        Some(l) => format!("{} KiB", l >> 10),
    };
    let grade = if allowed { Grade::Good } else { Grade::Missing };
    check("lockable memory", found, grade, "add `@realtime - memlock unlimited` to /etc/security/limits.conf")
}

fn cores() -> Check {
    let n = std::thread::available_parallelism().map_or(1, usize::from);
    let grade = if n >= 4 { Grade::Good } else { Grade::Fair };
    check("cores", n.to_string(), grade, "four or more keep logging and the system off the control cores")
}

fn isolation() -> Check {
    let list = line("/sys/devices/system/cpu/isolated").unwrap_or_default();
    let quiet = line("/sys/devices/system/cpu/nohz_full").unwrap_or_default();
    let grade = if list.is_empty() { Grade::Fair } else { Grade::Good };
    let found = if list.is_empty() { "none".into() } else { format!("isolcpus {list}, nohz_full {quiet}") };
    check(
        "isolated cores",
        found,
        grade,
        "boot with isolcpus=, nohz_full= and rcu_nocbs= for the control cores",
    )
}

fn shared_memory() -> Check {
    let what = "/dev/shm";
    let advice = "mount -o remount,size=256m /dev/shm (containers: --shm-size=256m)";
    match rustix::fs::statvfs("/dev/shm") {
        Ok(s) => {
            let free = (s.f_bavail * s.f_frsize) >> 20;
            let grade = if free >= 64 { Grade::Good } else { Grade::Missing };
            check(what, format!("{free} MiB free"), grade, advice)
        }
        Err(e) => check(what, e.to_string(), Grade::Missing, advice),
    }
}

fn clock_source() -> Check {
    let found = line("/sys/devices/system/clocksource/clocksource0/current_clocksource")
        .unwrap_or_else(|| "not visible".into());
    let grade = if ["tsc", "kvm-clock", "arch_sys_counter"].contains(&found.as_str()) {
        Grade::Good
    } else {
        Grade::Fair
    };
    check(
        "clock source",
        found,
        grade,
        "a slow clock source costs a system call per reading; see tsc= in the kernel's parameters",
    )
}

fn processor_sleep() -> Check {
    let open = std::fs::File::options().write(true).open("/dev/cpu_dma_latency");
    let (found, grade) = match open {
        Ok(_) => ("can be kept awake".into(), Grade::Good),
        Err(e) => (e.to_string(), Grade::Missing),
    };
    check(
        "processor sleep states",
        found,
        grade,
        "give the user write access to /dev/cpu_dma_latency (udev rule)",
    )
}

fn frequency() -> Check {
    let what = "frequency governor";
    match line("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor") {
        Some(g) if g == "performance" => check(what, g, Grade::Good, ""),
        Some(g) => check(what, g, Grade::Fair, "cpupower frequency-set -g performance"),
        None => check(what, "not visible", Grade::Fair, "in a virtual machine the host decides"),
    }
}
