//! The CAN lines of a robot: one end of them, over SocketCAN.
//!
//! After [`BusLines::open`] nothing allocates and, but for [`BusLines::wait`], nothing blocks.

use std::io::{self, ErrorKind};
use std::os::fd::AsFd;
use std::time::Duration;

use crate::interface::{self, InterfaceError};
use codec::layout::{FrameLayout, MAX_NODES};
use messages::{BusFrames, ERROR_FLAG, Frame, MAX_FRAMES};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use socketcan::{
    CanAnyFrame, CanDataFrame, CanErrorFrame, CanFdFrame, CanFdSocket, CanFilter, EmbeddedFrame, Frame as _,
    Socket, SocketOptions, StandardId,
};

/// Errno: the interface is down.
const DOWN: i32 = 100;
/// Largest transfer of a CAN FD interface \[byte\].
const FD_MTU: &str = "72";
/// Receive buffer asked for \[byte\].
const BUFFER: usize = 1 << 20;

/// Which end of the lines this is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BusEnd {
    /// Lowlevel.
    Near,
    /// The drives.
    Far,
}

/// Failures since the last check.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LineTrouble {
    /// \[1\] Frames that could not be sent.
    pub unsent: u32,
    /// Lines (bits) whose interface is down.
    pub down: u32,
}

/// One end of all lines.
pub struct BusLines {
    sockets: Vec<CanFdSocket>,
    /// Whether all lines share one interface: then the identifier says which line a frame is of.
    shared: Option<FrameLayout>,
    fd: bool,
    trouble: LineTrouble,
}

impl BusLines {
    /// Opens one interface per node of the layout, or one for all.
    ///
    /// # Errors
    /// An interface is missing, down, not a CAN interface or not one of CAN FD; the kernel has no CAN; there are neither one
    /// nor as many interfaces as nodes.
    pub fn open(
        interfaces: &[String],
        layout: &FrameLayout,
        fd: bool,
        end: BusEnd,
    ) -> Result<Self, Box<dyn std::error::Error>> {
        // One line for all needs identifiers that say which line is meant.
        let nodes = layout.nodes.len();
        let shared = interfaces.len() == 1 && nodes > 1;
        if interfaces.len() != nodes && !shared {
            let n = interfaces.len();
            return Err(
                format!("the robot has {nodes} CAN lines; give 1 or {nodes} interfaces, not {n}").into()
            );
        }
        if shared && let Some(m) = layout.messages.iter().find(|m| layout.line_of(m.id).is_none()) {
            let (name, id) = (&m.name, m.id);
            return Err(
                format!("message {name}: identifier {id:#x} is used on several lines; give {nodes} interfaces, one for each").into()
            );
        }
        // The kernel filters: a socket gets what the other end sends on its line, and not its own frames back.
        let mut sockets = Vec::new();
        for (line, interface) in interfaces.iter().enumerate() {
            let wanted = layout.messages.iter().filter(|m| m.to_drives == (end == BusEnd::Far));
            let ids: Vec<CanFilter> =
                wanted.filter(|m| shared || m.node == line).map(|m| CanFilter::new(m.id, 0x7ff)).collect();
            sockets.push(open(interface, &ids, fd)?);
        }
        Ok(Self { sockets, shared: shared.then(|| layout.clone()), fd, trouble: LineTrouble::default() })
    }

    /// Sends the frames of a cycle; what a line cannot take is counted.
    pub fn send(&mut self, frames: &BusFrames) {
        frames.as_slice().iter().for_each(|frame| self.send_one(frame));
    }

    fn send_one(&mut self, frame: &Frame) {
        let line = if self.shared.is_some() { 0 } else { frame.line as usize };
        let Some(socket) = self.sockets.get(line) else { return };
        if let Err(e) = write(socket, frame, self.fd) {
            self.trouble.unsent += 1;
            self.note(line, &e);
        }
    }

    /// Sends those frames of a cycle that belong to one line.
    pub fn send_on(&mut self, line: u32, frames: &BusFrames) {
        frames.as_slice().iter().filter(|f| f.line == line).for_each(|f| self.send_one(f));
    }

    /// Appends what has come; returns how many frames.
    pub fn receive(&mut self, frames: &mut BusFrames) -> usize {
        let before = frames.count;
        for line in 0..self.sockets.len() {
            if !self.receive_line(line, u32::MAX, frames) {
                break;
            }
        }
        (frames.count - before) as usize
    }

    /// Appends what has come, of each line no more than is missing of it: what belongs to later cycles stays in the
    /// sockets. Returns how many frames.
    pub fn receive_missing(&mut self, missing: &[u8; MAX_NODES], frames: &mut BusFrames) -> usize {
        let before = frames.count;
        for line in 0..self.sockets.len() {
            if !self.receive_line(line, self.wanted(line, missing), frames) {
                break;
            }
        }
        (frames.count - before) as usize
    }

    /// `false`: there is no more room, the rest waits in the sockets.
    fn receive_line(&mut self, line: usize, mut at_most: u32, frames: &mut BusFrames) -> bool {
        while at_most > 0 {
            if frames.as_slice().len() == MAX_FRAMES {
                return false;
            }
            match self.sockets[line].read_frame() {
                Ok(CanAnyFrame::Remote(_)) => {}
                Ok(read) => {
                    frames.push(&self.frame(line as u32, &read));
                    at_most -= 1;
                }
                Err(e) if e.kind() == ErrorKind::Interrupted => {}
                Err(e) => {
                    self.note(line, &e);
                    break;
                }
            }
        }
        true
    }

    /// Of what is missing of each node, how much comes through this socket.
    fn wanted(&self, line: usize, missing: &[u8; MAX_NODES]) -> u32 {
        match self.shared {
            Some(_) => missing.iter().map(|&n| u32::from(n)).sum(),
            None => u32::from(missing[line]),
        }
    }

    /// Waits until a frame is there, at most that long; on one line, if it is known which one will speak last.
    pub fn wait(&self, line: Option<usize>, at_most: Duration) {
        let n = self.sockets.len().min(MAX_NODES);
        let mut waiting: [PollFd<'_>; MAX_NODES] = std::array::from_fn(|i| {
            PollFd::from_borrowed_fd(self.sockets[i.min(n - 1)].as_fd(), PollFlags::IN)
        });
        let timeout = Timespec::try_from(at_most).ok();
        let wanted = line.map_or(0..n, |line| line.min(n - 1)..line.min(n - 1) + 1);
        // Woken early or in vain: the caller looks and waits again.
        let _ = poll(&mut waiting[wanted], timeout.as_ref());
    }

    /// Failures since the last call.
    pub fn take_trouble(&mut self) -> LineTrouble {
        std::mem::take(&mut self.trouble)
    }

    fn frame(&self, line: u32, read: &CanAnyFrame) -> Frame {
        let id = read.id_word();
        let line = match &self.shared {
            Some(layout) => layout.line_of(id).unwrap_or(line),
            None => line,
        };
        let payload = read.data();
        let mut data = [0; 64];
        data[..payload.len()].copy_from_slice(payload);
        Frame { line, id, len: payload.len() as u32, data }
    }

    fn note(&mut self, line: usize, e: &io::Error) {
        if e.raw_os_error() == Some(DOWN) {
            self.trouble.down |= 1 << line;
        }
    }
}

fn write(socket: &CanFdSocket, frame: &Frame, fd: bool) -> io::Result<()> {
    let payload = &frame.data[..frame.len as usize];
    let wrong = || io::Error::from(ErrorKind::InvalidInput);
    if frame.id & ERROR_FLAG != 0 {
        // Of a simulated bus controller: on a virtual interface the other end hears it as from its own one.
        return socket.write_frame(&CanErrorFrame::new_error(frame.id, payload).map_err(|_| wrong())?);
    }
    let id = StandardId::new((frame.id & 0x7ff) as u16).ok_or_else(wrong)?;
    if fd {
        let mut frame = CanFdFrame::new(id, payload).ok_or_else(wrong)?;
        frame.set_brs(true);
        socket.write_frame(&frame)
    } else {
        socket.write_frame(&CanDataFrame::new(id, payload).ok_or_else(wrong)?)
    }
}

fn open(name: &str, ids: &[CanFilter], fd: bool) -> Result<CanFdSocket, InterfaceError> {
    let socket = interface::open(name)?;
    let mtu = std::fs::read_to_string(format!("/sys/class/net/{name}/mtu")).unwrap_or_default();
    if fd && mtu.trim() != FD_MTU {
        let why = format!("carries no CAN FD; `ip link set {name} mtu 72` while it is down");
        return Err(InterfaceError::new(name, why));
    }
    socket
        .set_nonblocking(true)
        .and_then(|()| socket.set_filters(ids))
        .and_then(|()| socket.set_error_filter_accept_all())
        .and_then(|()| socket.as_raw_socket().set_recv_buffer_size(BUFFER))
        .map_err(|e| InterfaceError::of(name, &e))?;
    Ok(socket)
}
