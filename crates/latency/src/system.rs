//! Ways of the operating system.

use std::io::{Read, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::os::fd::AsFd;
use std::os::unix::net::UnixDatagram;
use std::path::Path;

use nix::mqueue::{MQ_OFlag, MqAttr, MqdT, mq_open, mq_receive, mq_send, mq_unlink};
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use nix::sys::stat::Mode;

use crate::link::{LIMIT, Link, LinkEnd, Opened, SIZE, message, silent, stamp, text};

struct PosixQueue {
    output: MqdT,
    input: MqdT,
    names: [String; 2],
    end: LinkEnd,
    /// The other end has been heard.
    met: bool,
}

/// Bytes of one message of a queue: `/proc/sys/fs/mqueue/msgsize_max` is 8192 wherever nobody has changed it.
const PART: usize = SIZE.div_ceil(2);

/// POSIX message queues, two messages for each of ours.
pub fn posix_queue(dir: &Path, end: LinkEnd) -> Opened {
    let name = |way: &str| format!("/{}-{way}", dir.file_name().unwrap_or_default().to_string_lossy());
    let names = [name("out"), name("back")];
    let open = |name: &String, flags: MQ_OFlag| {
        let attributes = MqAttr::new(0, 8, PART as i64, 0);
        let mode = Mode::S_IRUSR | Mode::S_IWUSR;
        mq_open(name.as_str(), flags | MQ_OFlag::O_CREAT, mode, Some(&attributes)).map_err(text)
    };
    let [out, back] = if end == LinkEnd::Near { [0, 1] } else { [1, 0] };
    Ok(Box::new(PosixQueue {
        output: open(&names[out], MQ_OFlag::O_WRONLY)?,
        input: open(&names[back], MQ_OFlag::O_RDONLY)?,
        names,
        end,
        met: false,
    }))
}

impl Link for PosixQueue {
    fn send(&mut self, stamp: u64) -> Result<(), String> {
        message(stamp).chunks(PART).try_for_each(|part| mq_send(&self.output, part, 0).map_err(text))
    }

    fn receive(&mut self) -> Result<u64, String> {
        let mut bytes = [0; SIZE];
        if !std::mem::replace(&mut self.met, true) {
            let mut first = [PollFd::new(self.input.as_fd(), PollFlags::POLLIN)];
            poll(&mut first, PollTimeout::try_from(LIMIT).map_err(text)?).map_err(text)?;
            (first[0].any() == Some(true)).then_some(()).ok_or_else(silent)?;
        }
        for part in bytes.chunks_mut(PART) {
            mq_receive(&self.input, part, &mut 0).map_err(text)?;
        }
        Ok(stamp(&bytes))
    }
}

impl Drop for PosixQueue {
    fn drop(&mut self) {
        if self.end == LinkEnd::Near {
            for name in &self.names {
                let _ = mq_unlink(name.as_str());
            }
        }
    }
}

struct Datagrams(UnixDatagram, std::path::PathBuf);

/// Unix datagram sockets.
pub fn unix_socket(dir: &Path, end: LinkEnd) -> Opened {
    let [near, far] = ["near", "far"].map(|name| dir.join(name));
    let (own, other) = if end == LinkEnd::Near { (near, far) } else { (far, near) };
    let socket = UnixDatagram::bind(own).map_err(text)?;
    socket.set_read_timeout(Some(LIMIT)).map_err(text)?;
    Ok(Box::new(Datagrams(socket, other)))
}

impl Link for Datagrams {
    fn send(&mut self, stamp: u64) -> Result<(), String> {
        self.0.send_to(&message(stamp), &self.1).map(drop).map_err(text)
    }

    fn receive(&mut self) -> Result<u64, String> {
        let mut bytes = [0; SIZE];
        self.0.recv(&mut bytes).map_err(text)?;
        Ok(stamp(&bytes))
    }
}

/// The near end listens until the far one has come.
struct TcpLink(Option<TcpListener>, Option<TcpStream>);

/// TCP over the loopback interface.
pub fn tcp(dir: &Path, end: LinkEnd) -> Opened {
    let file = dir.join("port");
    if end == LinkEnd::Near {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).map_err(text)?;
        let port = listener.local_addr().map_err(text)?.port();
        std::fs::write(file, port.to_string()).map_err(text)?;
        return Ok(Box::new(TcpLink(Some(listener), None)));
    }
    let port = std::fs::read_to_string(file).map_err(text)?.parse().map_err(text)?;
    let stream = TcpStream::connect((Ipv4Addr::LOCALHOST, port)).map_err(text)?;
    Ok(Box::new(TcpLink(None, Some(stream))))
}

impl TcpLink {
    fn stream(&mut self) -> Result<&mut TcpStream, String> {
        if let Some(listener) = self.0.take() {
            self.1 = Some(listener.accept().map_err(text)?.0);
        }
        let stream = self.1.as_mut().ok_or("no connection")?;
        stream.set_nodelay(true).map_err(text)?;
        stream.set_read_timeout(Some(LIMIT)).map_err(text)?;
        Ok(stream)
    }
}

impl Link for TcpLink {
    fn send(&mut self, stamp: u64) -> Result<(), String> {
        self.stream()?.write_all(&message(stamp)).map_err(text)
    }

    fn receive(&mut self) -> Result<u64, String> {
        let mut bytes = [0; SIZE];
        self.stream()?.read_exact(&mut bytes).map_err(text)?;
        Ok(stamp(&bytes))
    }
}
