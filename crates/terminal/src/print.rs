//! `println!` and `eprintln!` that do not panic.

use std::fmt::Arguments;
use std::io::{self, ErrorKind, Write};
use std::sync::OnceLock;

use crate::console::Console;

/// A line of result on standard output; see [`result`].
#[macro_export]
macro_rules! println {
    () => { $crate::result(format_args!("\n")) };
    ($($arguments:tt)*) => { $crate::result(format_args!("{}\n", format_args!($($arguments)*))) };
}

/// A remark on standard error; see [`remark`].
#[macro_export]
macro_rules! eprintln {
    () => { $crate::remark(format_args!("\n")) };
    ($($arguments:tt)*) => { $crate::remark(format_args!("{}\n", format_args!($($arguments)*))) };
}

/// Writes a result. What asked for it would be misled by half of it: if it cannot be written, the program ends with code 1,
/// and says why unless the reader has just gone (`| head`).
pub fn result(text: Arguments) {
    let mut out = io::stdout().lock();
    if let Err(error) = out.write_fmt(text).and_then(|()| out.flush()) {
        if error.kind() != ErrorKind::BrokenPipe {
            remark(format_args!("error: standard output: {error}; the result is not complete\n"));
        }
        std::process::exit(1);
    }
}

/// Destination of remarks instead of standard error.
static CONSOLE: OnceLock<Console> = OnceLock::new();

/// From now on the remarks of this process go through a console, which does not wait for the terminal.
pub fn divert(console: &Console) {
    let _ = CONSOLE.set(console.clone());
}

/// Writes a remark, or loses it.
pub fn remark(text: Arguments) {
    write(text.to_string().as_bytes());
}

fn write(bytes: &[u8]) {
    match CONSOLE.get() {
        Some(console) => String::from_utf8_lossy(bytes).lines().for_each(|line| console.say(line)),
        None => to_terminal(bytes),
    }
}

/// Standard error itself: for the thread that owns it.
pub(crate) fn to_terminal(bytes: &[u8]) {
    let _ = io::stderr().write_all(bytes);
}

/// Standard error for diagnostics: every line in one piece, and never an error, which others would print or panic about.
#[derive(Clone, Copy, Debug, Default)]
pub struct Quiet;

impl Write for Quiet {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        write(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
