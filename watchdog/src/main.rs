//! `watchdog --run DIR`: the watchdog alone, without live commands. `gangwerk watchdog` is the same with the broker.

use std::process::ExitCode;

#[global_allocator]
static ALLOCATOR: realtime::CountingAllocator = realtime::CountingAllocator;

fn main() -> ExitCode {
    let arguments: Vec<_> = std::env::args_os().skip(1).collect();
    let [flag, dir] = arguments.as_slice() else {
        eprintln!("usage: watchdog --run DIR");
        return ExitCode::FAILURE;
    };
    let result = match flag.to_str() {
        Some("--run") => {
            watchdog::daemon::main(dir.as_ref(), Box::new(|_| Ok(Box::new(messages::NoCommands))))
        }
        _ => Err("usage: watchdog --run DIR".into()),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("watchdog: {error}");
            ExitCode::FAILURE
        }
    }
}
