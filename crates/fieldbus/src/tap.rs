//! Listening on CAN lines and playing recorded frames on them: for tools, not for control cycles.
//!
//! Each interface is read by a thread of its own, so that nobody waits for a quiet line. Time stamps are those of the
//! kernel (SO_TIMESTAMPNS, the clock candump stamps with): when the frame passed the socket layer.

use crate::capture::{CLASSIC_BYTES, Captured, FrameType};
use crate::interface::{self, InterfaceError};
use rustix::io::Errno;
use socketcan::frame::{can_frame_default, canfd_frame_default};
use socketcan::{
    CanAnyFrame, CanFdFrame, CanFdSocket, CanFrame, EmbeddedFrame, Frame, ShouldRetry, Socket, SocketOptions,
};
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TrySendError, sync_channel};
use std::thread::JoinHandle;
use std::time::{Duration, UNIX_EPOCH};

/// Threads look this often whether they are to end.
const LOOK: Duration = Duration::from_millis(50);
/// Frames that may wait for their reader: several seconds of nine full lines.
const DEPTH: usize = 1 << 17;
/// A full queue of an interface is asked again after this time, this often: two seconds.
const PATIENCE: (Duration, u32) = (Duration::from_micros(200), 10_000);

/// Hears everything on some interfaces, error frames included.
pub struct Tap {
    heard: Receiver<Result<Captured, InterfaceError>>,
    stop: Arc<AtomicBool>,
    threads: Vec<JoinHandle<()>>,
}

impl Tap {
    /// Begins to listen. Lines are counted in the order of `names`.
    ///
    /// # Errors
    /// One of the interfaces cannot be opened.
    pub fn open(names: &[String]) -> Result<Self, InterfaceError> {
        let sockets = names.iter().map(|name| listen(name)).collect::<Result<Vec<_>, _>>()?;
        let stop = Arc::new(AtomicBool::new(false));
        let (tell, heard) = sync_channel(DEPTH);
        let listener = |(line, (socket, name)): (usize, (CanFdSocket, &String))| {
            let ear = Ear { socket, name: name.clone(), line: line as u32 };
            let (tell, stop) = (tell.clone(), stop.clone());
            std::thread::spawn(move || ear.listen(&tell, &stop))
        };
        let threads = sockets.into_iter().zip(names).enumerate().map(listener).collect();
        Ok(Self { heard, stop, threads })
    }

    /// The next frame; `None` if there is none within `patience`.
    ///
    /// # Errors
    /// An interface went down or away; or more was heard than could be kept.
    pub fn next(&self, patience: Duration) -> Result<Option<Captured>, InterfaceError> {
        match self.heard.recv_timeout(patience) {
            Ok(heard) => heard.map(Some),
            Err(RecvTimeoutError::Timeout) => Ok(None),
            Err(RecvTimeoutError::Disconnected) => Err(InterfaceError::new(
                "CAN",
                "frames came faster than they could be taken, or all lines ended",
            )),
        }
    }
}

impl Drop for Tap {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        for thread in self.threads.drain(..) {
            let _ = thread.join();
        }
    }
}

fn listen(name: &str) -> Result<CanFdSocket, InterfaceError> {
    let socket = interface::open(name)?;
    let ready = socket
        .set_error_filter_accept_all()
        .and_then(|()| socket.set_recv_timestamp(true))
        .and_then(|()| socket.set_read_timeout(LOOK));
    ready.map(|()| socket).map_err(|e| InterfaceError::of(name, &e))
}

/// One interface being listened to.
struct Ear {
    socket: CanFdSocket,
    name: String,
    line: u32,
}

impl Ear {
    fn listen(&self, tell: &SyncSender<Result<Captured, InterfaceError>>, stop: &AtomicBool) {
        while !stop.load(Ordering::Relaxed) {
            let heard = match self.socket.read_frame_with_timestamp() {
                Ok((frame, stamp)) => {
                    let time_ns = stamp.duration_since(UNIX_EPOCH).map_or(0, |t| t.as_nanos() as u64);
                    Ok(captured(&frame, self.line, time_ns))
                }
                Err(e) if e.should_retry() || e.kind() == io::ErrorKind::Interrupted => continue,
                Err(e) => Err(InterfaceError::of(&self.name, &e)),
            };
            let over = heard.is_err();
            match tell.try_send(heard) {
                Ok(()) if !over => {}
                Err(TrySendError::Full(_)) | Err(TrySendError::Disconnected(_)) | Ok(()) => return,
            }
        }
    }
}

/// A frame of a socket as it is recorded.
fn captured(frame: &CanAnyFrame, line: u32, time_ns: u64) -> Captured {
    let form = match frame {
        CanAnyFrame::Fd(fd) => FrameType::Fd { flags: fd.flags().bits() },
        _ => FrameType::CLASSIC,
    };
    let mut data = [0; 64];
    let payload = if frame.is_remote_frame() { &[] } else { frame.data() };
    data[..payload.len()].copy_from_slice(payload);
    let len = if frame.is_remote_frame() { frame.dlc() } else { payload.len() } as u8;
    Captured { time_ns, line, id: frame.id_word(), len, data, form, way: None }
}

/// A recorded frame as a socket takes it. A length code above 8 becomes 8: the socket has no place for it.
fn for_socket(frame: &Captured) -> CanAnyFrame {
    match frame.form {
        FrameType::Fd { flags } => {
            let mut raw = canfd_frame_default();
            (raw.can_id, raw.len, raw.flags, raw.data) = (frame.id, frame.len, flags, frame.data);
            CanFdFrame::from(raw).into()
        }
        FrameType::Classic { .. } => {
            let mut raw = can_frame_default();
            (raw.can_id, raw.can_dlc) = (frame.id, frame.len);
            raw.data.copy_from_slice(&frame.data[..CLASSIC_BYTES]);
            CanFrame::from(raw).into()
        }
    }
}

/// Plays recorded frames on some interfaces.
pub struct Player {
    names: Vec<String>,
    sockets: Vec<CanFdSocket>,
}

impl Player {
    /// Opens the interfaces; lines are counted in the order of `names`.
    ///
    /// # Errors
    /// One of the interfaces cannot be opened.
    pub fn open(names: &[String]) -> Result<Self, InterfaceError> {
        let mute = |name: &String| {
            let socket = interface::open(name)?;
            // It hears nothing: what arrives would only fill its queue.
            socket.set_filter_drop_all().map_err(|e| InterfaceError::of(name, &e))?;
            Ok(socket)
        };
        let sockets = names.iter().map(mute).collect::<Result<Vec<_>, InterfaceError>>()?;
        Ok(Self { names: names.to_vec(), sockets })
    }

    /// Sends a frame on line `line`; waits while the interface's queue is full, as that of a real line soon is.
    ///
    /// # Errors
    /// The interface went down, does not take such a frame, or its queue stays full.
    pub fn send(&self, line: usize, frame: &Captured) -> Result<(), InterfaceError> {
        let name = &self.names[line];
        let ready = for_socket(frame);
        for _ in 0..PATIENCE.1 {
            match self.sockets[line].write_frame(&ready) {
                Ok(()) => return Ok(()),
                // The queue of the interface is full: wait and send again.
                Err(e) if Errno::from_io_error(&e) == Some(Errno::NOBUFS) || e.should_retry() => {
                    std::thread::park_timeout(PATIENCE.0);
                }
                Err(e) => return Err(InterfaceError::of(name, &e)),
            }
        }
        let why = "its queue stayed full for two seconds: does anybody acknowledge frames on this line?";
        Err(InterfaceError::new(name, why))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::candump_line;

    /// What a socket takes is what it would tell of.
    #[test]
    fn recorded_frames_go_through_the_frames_of_sockets_unchanged() {
        for text in
            ["123#1122", "00000123#", "7FF#R4", "20000004#000C000000000000", "1FFFFFFF##70102", "001##4"]
        {
            let (_, frame) =
                candump_line::parse(&format!("(0.000000) can0 {text}")).unwrap_or_else(|e| panic!("{e}"));
            let back = captured(&for_socket(&frame), 0, 0);
            let mut told = String::new();
            candump_line::write_frame(&mut told, &back);
            assert_eq!((told.as_str(), back), (text, frame));
        }
    }

    #[test]
    fn an_interface_that_is_not_there_is_an_error_with_advice() {
        let names = ["gangwerk_none".to_string()];
        for error in [Tap::open(&names).err(), Player::open(&names).err()] {
            let said = error.map(|e| e.to_string()).unwrap_or_default();
            // A kernel without CAN says so before it looks for the interface.
            assert!(
                said.starts_with("gangwerk_none: ")
                    && (said.contains("ip link add") || said.contains("modprobe")),
                "{said}"
            );
        }
    }
}
