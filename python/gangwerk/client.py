"""Client of Gangwerk's broker: commands, answers, lease, parameters, events, state. Standard library only.

    with Client.local() as robot:
        robot.command("walk/stand")
        robot.command("walk/velocity", forward=0.3)   # raises Refused with reason and limit
        time.sleep(5)
        robot.command("walk/stop")
        robot.set_parameter("planner.swing_height", 0.06)
        robot.watch(rate=10, events=True)
        print(robot.state(timeout=1.0).com, robot.event())

While the client is open, a thread gives heartbeats; so the command lease, taken with the first command that needs it,
stays with it. When the program ends, is killed or stopped, or has no reference to the client any more, the lease runs out
within half a second and the robot stops. That thread does not notice a loop that hangs: name a `deadline` for that.
The protocol, and what each number means: docs/protocol.md.
"""

import collections
import contextlib
import hashlib
import hmac
import math
import os
import socket
import stat
import struct
import threading
import time
import types
import weakref

VERSION = 3
SERVICE = 0xFFFF
SUBSCRIBE, STATISTICS, PING, HELLO, PROVE, TAKE_LEASE, GIVE_LEASE, DESCRIBE = 3, 4, 5, 7, 8, 9, 10, 11
WATCH, PARAMETERS, SET = 12, 13, 14
ACCEPTED, REFUSED, LINE, WELCOME, LEASE, STATE, EVENT, PARAMETER = 16, 17, 18, 19, 20, 21, 22, 23
HEAD = struct.Struct("<HHB3xIIQQ")
TAG = 16
MAX_MESSAGE = 512
HIGH, NORMAL, LOW = 0, 1, 2
DOMAINS = ("system", "walk", "stabilize", "joint", "head", "log", "sim", "vision")

Field = collections.namedtuple("Field", "name kind unit low high default")
Command = collections.namedtuple("Command", "name domain id number needs_lease fields")
Message = collections.namedtuple("Message", "domain id sequence time payload")
Parameter = collections.namedtuple("Parameter", "name unit low high default value change about")
Event = collections.namedtuple("Event", "tick process name code detail")


class Refused(Exception):
    """The command was not carried out. `code` is the number of the reason, `text` says it with the limit."""

    def __init__(self, code, text):
        super().__init__(text)
        self.code, self.text = code, text


class Lost(ConnectionError):
    """The connection has ended."""


def default_directory():
    """Run directory of this user: `$XDG_RUNTIME_DIR/gangwerk` if that is private and the user's own, else in /dev/shm."""
    session, user = os.environ.get("XDG_RUNTIME_DIR", ""), os.geteuid()
    try:
        about = os.stat(session)
        own = os.path.isabs(session) and stat.S_ISDIR(about.st_mode) and about.st_uid == user and not about.st_mode & 0o077
    except OSError:
        own = False
    return os.path.join(session, "gangwerk") if own else f"/dev/shm/gangwerk-{user}"


class Client:
    """One connection to the broker. Its methods may be called from any thread.

    `timeout`: seconds for an answer, and for sending: a broker that has read nothing for so long has ended the connection.
    `deadline`: seconds after the last call, by whatever thread, for which there are heartbeats; None: for as long as the
    main thread lives. A program that hangs for longer loses the lease."""

    def __init__(self, stream, name, key=None, timeout=3.0, shared_clock=True, deadline=None):
        self._stream, self._timeout, self._deadline = stream, timeout, deadline
        self._called = time.monotonic()
        self._sending = threading.Lock()
        self._changed = threading.Condition()
        self._sequence = 0
        self._answers = {}
        self._lines = collections.defaultdict(list)
        self._heard = collections.deque(maxlen=10_000)
        self._events = collections.deque(maxlen=10_000)
        self._state, self._layout = None, []
        self.lost = 0  # frames of `watch` and `subscribe` that the broker dropped, because they were not read in time
        self.parameters = {}  # present values of those that can be changed, by name; kept up to date after `watch`
        self._end = None
        self._seal = self._open = None
        self._out = self._in = 0
        # On a network: newest time of the broker and own time when it came, which is never ahead of the broker.
        self._clock = None if shared_clock else (0, time.monotonic_ns())
        self.lease_holder = ""
        self.commands = {}
        stream.settimeout(None)
        # The kernel's limit for sending alone: the reader waits for as long as nothing comes.
        limit = max(1000, round(timeout * 1e6))
        stream.setsockopt(socket.SOL_SOCKET, socket.SO_SNDTIMEO, struct.pack("@ll", *divmod(limit, 1_000_000)))
        # Threads that referred to the client would keep a forgotten one, and its lease, for ever.
        weak = weakref.ref(self)
        weakref.finalize(self, _hang_up, stream).atexit = False  # at the end of the program the kernel does it
        self._reader = threading.Thread(target=_read, args=(stream, weak), daemon=True)
        self._reader.start()
        try:
            self._greet(name, key)
            self.commands = {c.name: c for c in map(_command, self._ask_lines(DESCRIBE))}
        except BaseException:
            self.close()
            raise
        threading.Thread(target=_live, args=(weak,), daemon=True).start()

    @classmethod
    def local(cls, run_directory=None, name="python", timeout=3.0, deadline=None):
        """Connects to the robot of this run directory on this machine; without one, to that of `gangwerk run`."""
        stream = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        stream.connect(os.path.join(run_directory or default_directory(), "broker.sock"))
        return cls(stream, name, timeout=timeout, deadline=deadline)

    @classmethod
    def network(cls, host, port, key=None, name="python", timeout=3.0, deadline=None):
        """Connects over TCP. `key`: a pair (name of the key, 64 hexadecimal digits); without one, only stops are taken."""
        stream = socket.create_connection((host, port), timeout)
        stream.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return cls(stream, name, key, timeout, shared_clock=False, deadline=deadline)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        """Ends the connection; with it goes the command lease, and a walk that was commanded under it."""
        self._stop("closed")

    # What an operator does.

    def command(self, name, **values):
        """Sends a command and waits for its answer; the name of the process that took it. Raises Refused."""
        return self.wait(self.send(name, **values))

    def send(self, name, **values):
        """Sends a command without waiting; its number, for `wait`. Fields with a dot: `**{"force.y": 40}`."""
        entry = self.commands.get(name)
        if entry is None:
            raise ValueError(f"there is no command {name}; there are {', '.join(sorted(self.commands))}")
        unknown = set(values) - {field.name for field in entry.fields}
        if unknown:
            raise ValueError(f"{name}: no field {', '.join(sorted(unknown))}")
        payload = struct.pack("<I", entry.number)
        for field in entry.fields:
            value = values.get(field.name, field.default)
            if value is None:
                raise ValueError(f"{name}: {field.name} is missing: a number in [{field.low}, {field.high}] {field.unit}")
            payload += _packed(f"{name}: {field.name}", field.kind, value, field.low, field.high, field.unit)
        priority = HIGH if name == "system/emergency_stop" else NORMAL
        return self._send(entry.domain, entry.id, payload, priority)

    def wait(self, number):
        """The answer to the frame `number`: who accepted it. Raises Refused, or Lost."""
        code, text = self._wait(lambda: self._answers.pop(number, None))
        if code:
            raise Refused(code, text)
        return text

    def take_lease(self, over=False):
        """Takes the command lease now; `over`: from whoever holds it."""
        self.wait(self._send(SERVICE, TAKE_LEASE, bytes([bool(over)])))

    def give_lease(self):
        """Gives the command lease back: what was commanded under it comes to a stop."""
        self.wait(self._send(SERVICE, GIVE_LEASE, b""))

    def subscribe(self, *domains):
        """From now on `heard` gives the commands of these domains, whoever sends them."""
        unknown = [domain for domain in domains if domain not in DOMAINS]
        if unknown:
            raise ValueError(f"subscribe: there is no domain {unknown[0]!r}; there are {', '.join(DOMAINS)}")
        mask = sum(1 << DOMAINS.index(domain) for domain in set(domains))
        self.wait(self._send(SERVICE, SUBSCRIBE, struct.pack("<I", mask)))

    def heard(self, timeout=0.0):
        """The next command of the domains subscribed to, as (name, values); None if none comes in this time."""
        try:
            message = self._wait(lambda: self._heard.popleft() if self._heard else None, timeout)
        except TimeoutError:
            return None
        for entry in self.commands.values():
            if (entry.domain, entry.id) == (message.domain, message.id):
                values = struct.unpack("<I" + "".join(f.kind for f in entry.fields), message.payload)[1:]
                return entry.name, dict(zip((f.name for f in entry.fields), values))
        return None

    def list_parameters(self):
        """Parameters of all processes by `process.name`; `change`: live, fixed (in the configuration) or constant."""
        return {p.name: p for p in map(_parameter, self._ask_lines(PARAMETERS))}

    def set_parameter(self, name, value):
        """Gives a parameter another value; the name of the process that took it. Raises Refused."""
        value = _packed(f"set_parameter: {name}", "d", value)
        return self.wait(self._send(SERVICE, SET, value + _name("set_parameter: name", name, len(value))))

    def watch(self, rate=0, events=False):
        """The present state and parameters at once; from now on `state` gives states at `rate` per second (at most 50),
        and `event` what the processes report. Lines that say what a state holds: name, count, unit, meaning."""
        asked = _packed("watch: rate", "H", rate, 0, 50, "1/s") + _packed("watch: events", "?", bool(events))
        lines = self._ask_lines(WATCH, asked)
        with self._changed:
            self._layout = [(name, int(count)) for name, count, *_ in (line.split(" ", 3) for line in lines)]
        return lines

    def state(self, timeout=0.0):
        """The newest state that was not given yet: tick, and numbers or tuples by name; None if none comes in time."""
        try:
            payload = self._wait(self._take_state, timeout)
        except TimeoutError:
            return None
        fields, at = {"tick": struct.unpack_from("<Q", payload)[0]}, 12
        for name, count in self._layout:
            numbers = struct.unpack_from(f"<{count}f", payload, at)
            fields[name], at = numbers if count > 1 else numbers[0], at + 4 * count
        return types.SimpleNamespace(**fields)

    def event(self, timeout=0.0):
        """The next thing that a process reported; None if nothing is reported in this time."""
        try:
            return self._wait(lambda: self._events.popleft() if self._events else None, timeout)
        except TimeoutError:
            return None

    def statistics(self):
        """One line about the broker and one about each of its clients."""
        return self._ask_lines(STATISTICS)

    # How it travels.

    def _greet(self, name, key):
        nonce = os.urandom(16)
        of_key = b"\0" + _name("name of the key", key[0], 27) if key else b""
        names = _name("name", name, 26 + len(of_key)) + of_key
        # Schema 0: the table of commands is learnt from the broker.
        hello = self._send(SERVICE, HELLO, struct.pack("<HQ", VERSION, 0) + nonce + names)
        code, welcome = self._wait(lambda: self._answers.pop(hello, None))
        if code:
            raise Refused(code, welcome)
        if not key:
            return
        secret, theirs = bytes.fromhex(key[1]), welcome[10:26]
        derive = lambda direction: hmac.digest(secret, direction + nonce + theirs, hashlib.sha256)
        to_broker, to_client = derive(b"gangwerk to broker"), derive(b"gangwerk to client")
        with self._turn():
            # The answer is the first frame with a tag, if the proof was a good one; it may be here before the next line.
            self._open = to_client
            prove = self._write(SERVICE, PROVE, hmac.digest(to_broker, b"proof", hashlib.sha256), LOW)
            self._seal = to_broker
        self.wait(prove)

    def _send(self, domain, ident, payload, priority=LOW):
        self._called = time.monotonic()
        with self._turn():
            return self._write(domain, ident, payload, priority)

    @contextlib.contextmanager
    def _turn(self):
        """One frame after the other; a thread that waits for a broker that does not read holds up the others no longer than itself."""
        if not self._sending.acquire(timeout=self._timeout):
            raise TimeoutError("the broker does not read")
        try:
            yield
        finally:
            self._sending.release()

    def _write(self, domain, ident, payload, priority):
        if self._end:
            raise Lost(self._end)
        if HEAD.size + len(payload) > MAX_MESSAGE:
            raise ValueError(f"{HEAD.size + len(payload)} bytes in a message, at most {MAX_MESSAGE}")
        self._sequence += 1
        message = HEAD.pack(domain, ident, priority, 0, 0, self._sequence, self._now()) + payload
        if self._seal:
            message += self._tag(self._seal, self._out, message)
            self._out += 1
        try:
            self._stream.sendall(struct.pack("<I", len(message)) + message)
        except BlockingIOError:
            # Part of the frame may be on its way: none can follow.
            self._stop(f"the broker has read nothing for {self._timeout} s")
            raise Lost(self._end) from None
        except OSError as error:
            raise Lost(self._end or str(error)) from error
        return self._sequence

    def _now(self):
        if self._clock is None:
            return time.monotonic_ns()
        broker, own = self._clock
        return broker + time.monotonic_ns() - own

    @staticmethod
    def _tag(key, number, message):
        return hmac.digest(key, struct.pack("<Q", number) + message, hashlib.sha256)[:TAG]

    def _wait(self, ready, timeout=None):
        self._called = time.monotonic()
        limit = self._called + (self._timeout if timeout is None else timeout)
        with self._changed:
            while True:
                found = ready()
                if found is not None:
                    return found
                if self._end:
                    raise Lost(self._end)
                left = limit - time.monotonic()
                if left <= 0:
                    raise TimeoutError("the broker has not answered")
                self._changed.wait(left)

    def _take_state(self):
        if not self._layout:
            return None
        state, self._state = self._state, None
        return state

    def _ask_lines(self, service, payload=b""):
        number = self._send(SERVICE, service, payload)
        self.wait(number)
        with self._changed:
            return self._lines.pop(number, [])

    def _show_life(self):
        """A heartbeat, if the program shows one itself; False if there will be none any more."""
        # Daemon threads outlive the main thread for as long as another thread of the program does not end.
        if self._end or not threading.main_thread().is_alive():
            return False
        if self._deadline is None or time.monotonic() - self._called < self._deadline:
            try:
                with self._turn():
                    self._write(SERVICE, PING, b"", LOW)
            except TimeoutError:
                pass  # another thread is sending, and ends the connection if it cannot
        return True

    def _authentic(self, message):
        if not self._open:
            return message
        message, tag = message[:-TAG], message[-TAG:]
        if not hmac.compare_digest(tag, self._tag(self._open, self._in, message)):
            raise Lost("the key is wrong, or this is not the broker that has it")
        self._in += 1
        return message

    def _take(self, frame):
        frame = self._authentic(frame)
        domain, ident, _, _, _, sequence, sent = HEAD.unpack_from(frame)
        message = Message(domain, ident, sequence, sent, frame[HEAD.size :])
        with self._changed:
            if self._clock and message.domain == SERVICE:
                self._clock = max(self._clock, (message.time, time.monotonic_ns()), key=self._reading)
            text = message.payload.decode(errors="replace")
            if message.domain != SERVICE:
                self._heard.append(message)
            elif message.id == LINE:
                self._lines[message.sequence].append(text)
            elif message.id == ACCEPTED:
                self._answers[message.sequence] = (0, text)
            elif message.id == WELCOME:
                self._answers[message.sequence] = (0, message.payload)
            elif message.id == REFUSED and message.sequence:
                self._answers[message.sequence] = (message.payload[0], message.payload[1:].decode(errors="replace"))
            elif message.id == REFUSED:
                # A reason without a number: the broker closes the connection.
                raise Lost(message.payload[1:].decode(errors="replace"))
            elif message.id == LEASE:
                self.lease_holder = message.payload[12:].decode(errors="replace")
            elif message.id == STATE:
                self._state, (self.lost,) = message.payload, struct.unpack_from("<I", message.payload, 8)
            elif message.id == EVENT:
                tick, code, detail = struct.unpack_from("<QIQ", message.payload)
                process, name = message.payload[20:].decode(errors="replace").split(" ", 1)
                self._events.append(Event(tick, process, name, code, detail))
            elif message.id == PARAMETER:
                (value,) = struct.unpack_from("<d", message.payload)
                self.parameters[message.payload[8:].decode(errors="replace")] = value
            self._changed.notify_all()

    @staticmethod
    def _reading(clock):
        return clock[0] - clock[1]

    def _stop(self, reason):
        with self._changed:
            self._end = self._end or reason
            self._changed.notify_all()
        _shut(self._stream)
        if threading.current_thread() is not self._reader:
            self._stream.close()


# Threads of a client. Between two calls of `_of` they have no reference to it, so one that is forgotten ends with them.


def _of(weak, method, *values):
    """What this method of the client gives; False if there is no client any more."""
    client = weak()
    return client is not None and method(client, *values)


def _live(weak):
    try:
        while _of(weak, Client._show_life):
            time.sleep(0.1)
    except Lost:
        pass


def _read(stream, weak):
    try:
        while True:
            (length,) = struct.unpack("<I", _exactly(stream, 4))
            if not HEAD.size <= length <= MAX_MESSAGE + TAG:
                raise Lost(f"a frame of {length} bytes came: that is no broker of version {VERSION}")
            _of(weak, Client._take, _exactly(stream, length))
    except (OSError, Lost, struct.error) as error:
        _of(weak, Client._stop, str(error))


def _exactly(stream, count):
    data = b""
    while len(data) < count:
        part = stream.recv(count - len(data))
        if not part:
            raise Lost("the broker closed the connection")
        data += part
    return data


def _shut(stream):
    """Ends the connection; who waits for a frame of it is woken."""
    try:
        stream.shutdown(socket.SHUT_RDWR)
    except OSError:
        pass


def _hang_up(stream):
    _shut(stream)
    stream.close()


# Arguments, before anything of them is sent: what the broker cannot read ends the connection, and with it a walk.


def _packed(what, kind, value, low=None, high=None, unit=""):
    """The bytes of a number. A range is the robot's to judge."""
    try:
        return struct.pack("<" + kind, value)
    except (struct.error, TypeError, OverflowError):
        wanted = "a number" if kind == "d" else "a whole number"
        among = "" if low is None else f" in [{low}, {high}] {unit}".rstrip()
        raise ValueError(f"{what} = {value!r:.60}: must be {wanted}{among}") from None


def _name(what, text, before):
    """The bytes of a name behind so many others of a message."""
    most = MAX_MESSAGE - HEAD.size - before
    if not isinstance(text, str) or len(text.encode()) > most:
        raise ValueError(f"{what} = {text!r:.60}: must be a text of at most {most} bytes")
    return text.encode()


def _command(line):
    name, domain, ident, number, lease, *fields = line.split(" ")
    return Command(name, int(domain), int(ident), int(number), lease == "1", [_field(f) for f in fields])


def _parameter(line):
    name, unit, low, high, default, value, change, about = line.split(" ", 7)
    unit = "" if unit == "-" else unit.replace("*", " ")
    return Parameter(name, unit, float(low), float(high), float(default), float(value), change, about)


def _field(text):
    name, kind, unit, low, high, default = text.split(":")
    default = None if default == "" else float(default)
    if kind == "I" and default is not None:
        default = math.floor(default)
    return Field(name, kind, unit, float(low), float(high), default)
