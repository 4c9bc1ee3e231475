"""Heartbeats of the client, by which an operator keeps the lease: when they end, whatever the program does or forgets.

The broker here is as much of one as a client needs. Nothing is measured: what must come is waited for, and heartbeats have
ended when none has come for five times their distance.
"""

import gc
import os
import pathlib
import queue
import random
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest

from gangwerk import client
from gangwerk.client import Client

PATIENCE = 30.0  # [s]
SILENCE = 0.5  # [s] five heartbeats


class Broker:
    """Greets one client, accepts all it asks for, and keeps its heartbeats in `pings`."""

    def __init__(self, directory, floods=False):
        self.pings, self.ended, self.floods = queue.Queue(), threading.Event(), floods
        self.sending, self.reads = threading.Lock(), threading.Event()
        self.reads.set()
        self.listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self.listener.bind(os.path.join(directory, "broker.sock"))
        self.listener.listen()
        threading.Thread(target=self.serve, daemon=True).start()

    def serve(self):
        stream, _ = self.listener.accept()
        try:
            with stream, stream.makefile("rb") as frames:
                while length := frames.read(4):
                    self.take(stream, frames.read(*struct.unpack("<I", length)))
        except OSError:
            pass  # it went with something unread
        self.ended.set()

    def take(self, stream, frame):
        self.reads.wait()
        domain, ident, _, _, _, sequence, _ = client.HEAD.unpack_from(frame)
        if (domain, ident) == (client.SERVICE, client.PING):
            self.pings.put(sequence)
        elif (domain, ident) == (client.SERVICE, client.HELLO):
            self.send(stream, client.WELCOME, sequence, struct.pack("<HQ16sIIB", client.VERSION, 0, b"", 1, 0xFF, 0))
        else:
            if (domain, ident) == (client.SERVICE, client.DESCRIBE):
                self.send(stream, client.LINE, sequence, b"walk/stop 1 2 3 0")
                self.send(stream, client.LINE, sequence, b"walk/velocity 1 1 1 1 forward:d:m/s:-2:2:0")
                self.send(stream, client.LINE, sequence, b"parameter 1 3 4 1 number:I:-:0:63:0")
            self.send(stream, client.ACCEPTED, sequence, b"planner")
            if self.floods:
                self.floods = False
                threading.Thread(target=self.flood, args=(stream,), daemon=True).start()

    def flood(self, stream):
        """So many frames that its client has always one to read."""
        try:
            while True:
                self.send(stream, client.PARAMETER, 0, struct.pack("<d", 0.05) + b"planner.swing_height")
        except OSError:
            pass

    def send(self, stream, ident, sequence, payload):
        frame = client.HEAD.pack(client.SERVICE, ident, 2, 0, 0, sequence, time.monotonic_ns()) + payload
        with self.sending:
            stream.sendall(struct.pack("<I", len(frame)) + frame)

    def shows_life(self, count=5):
        """True as soon as there are this many more heartbeats."""
        try:
            for _ in range(count):
                self.pings.get(timeout=PATIENCE)
        except queue.Empty:
            return False
        return True

    def is_silent(self):
        """True as soon as there are none any more."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            try:
                self.pings.get(timeout=SILENCE)
            except queue.Empty:
                return True
        return False


class SignsOfLife(unittest.TestCase):
    def broker(self, **options):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.directory = directory.name
        broker = Broker(self.directory, **options)
        self.addCleanup(broker.listener.close)
        return broker

    def test_a_client_that_is_kept_gives_them(self):
        broker = self.broker()
        with Client.local(self.directory) as robot:
            self.assertEqual(robot.command("walk/stop"), "planner")
            gc.collect()
            self.assertTrue(broker.shows_life())
            self.assertFalse(broker.ended.is_set())
        self.assertTrue(broker.ended.wait(PATIENCE))

    def test_a_forgotten_client_ends(self):
        """Its threads once referred to it: she walked on, and nobody had the handle any more."""

        def raises():
            robot = Client.local(self.directory)
            robot.command("walk/stop")
            raise RuntimeError("a fault of the program")

        def replaces():
            robot = Client.local(self.directory)
            robot.command("walk/stop")
            robot = None  # noqa: F841

        def in_a_circle():
            circle = [Client.local(self.directory)]
            circle.append(circle)

        for forget in (raises, replaces, in_a_circle):
            with self.subTest(forget.__name__):
                broker = self.broker()
                try:
                    forget()
                except RuntimeError:
                    pass
                gc.collect()
                self.assertTrue(broker.ended.wait(PATIENCE))

    def test_a_client_may_be_forgotten_at_any_moment(self):
        """Also while its threads are at work for it."""
        moments = random.Random(8)
        threads = threading.active_count()
        for _ in range(30):
            broker = self.broker(floods=True)
            robot = Client.local(self.directory)
            robot.send("walk/stop")
            time.sleep(moments.uniform(0.0, 0.02))
            del robot
            self.assertTrue(broker.ended.wait(PATIENCE))
        end = time.monotonic() + PATIENCE
        while threading.active_count() > threads and time.monotonic() < end:
            time.sleep(0.01)
        self.assertLessEqual(threading.active_count(), threads, "threads end with their client")

    def test_a_program_that_hangs_ends_them_if_it_named_a_deadline(self):
        broker = self.broker()
        with Client.local(self.directory, deadline=0.2) as robot:
            self.assertTrue(broker.is_silent())
            self.assertFalse(broker.ended.is_set())
            # It goes on: whichever call it is.
            for call in (lambda: robot.command("walk/stop"), robot.event, robot.state, robot.statistics):
                while not broker.pings.empty():
                    broker.pings.get()
                end = time.monotonic() + PATIENCE
                while broker.pings.empty() and time.monotonic() < end:
                    call()
                    time.sleep(0.01)
                self.assertFalse(broker.pings.empty())
                self.assertTrue(broker.is_silent())

    def test_calls_in_time_keep_them(self):
        broker = self.broker()
        with Client.local(self.directory, deadline=0.3) as robot:
            begin = time.monotonic()
            while broker.pings.qsize() < 20 and time.monotonic() < begin + PATIENCE:
                robot.event(timeout=0.02)
            self.assertGreaterEqual(broker.pings.qsize(), 20)

    def test_they_end_with_the_main_thread(self):
        broker = self.broker()
        # A thread that waits, and nobody for whom.
        program = """import sys, threading
from gangwerk.client import Client
robot = Client.local(sys.argv[1])
sys.stdin.readline()
threading.Thread(target=sys.stdin.read).start()
raise RuntimeError("a fault of the program")
"""
        path = os.pathsep.join([str(pathlib.Path(client.__file__).parents[1]), *filter(None, sys.path)])
        run = subprocess.Popen(
            [sys.executable, "-c", program, self.directory],
            env={**os.environ, "PYTHONPATH": path},
            stdin=subprocess.PIPE,
            stderr=subprocess.PIPE,
        )
        try:
            self.assertTrue(broker.shows_life())
            run.stdin.write(b"\n")
            run.stdin.flush()
            self.assertTrue(broker.is_silent())
            self.assertIsNone(run.poll(), "the other thread goes on")
        finally:
            _, said = run.communicate()
        self.assertIn(b"a fault of the program", said)

    def test_a_broker_that_does_not_read_holds_nobody_up(self):
        """Its clients once waited for ever, an emergency stop behind a heartbeat as well."""
        broker = self.broker()
        self.addCleanup(broker.reads.set)
        robot = Client.local(self.directory, timeout=0.3)
        self.addCleanup(robot.close)
        broker.reads.clear()
        errors = queue.Queue()

        def goes_on():
            while True:
                try:
                    robot.send("walk/stop")
                except TimeoutError:
                    pass  # it is the turn of another one
                except Exception as error:
                    return errors.put(error)

        for _ in range(3):
            threading.Thread(target=goes_on, daemon=True).start()
        for _ in range(3):
            error = errors.get(timeout=PATIENCE)
            self.assertIsInstance(error, client.Lost)
            self.assertIn("has read nothing for 0.3 s", str(error))


class Arguments(unittest.TestCase):
    """What a broker cannot read once ended the connection, and with it lease and walk; or was an error of `struct`."""

    def test_what_cannot_be_sent_is_named_and_costs_nothing(self):
        with tempfile.TemporaryDirectory() as directory:
            broker = Broker(directory)
            self.addCleanup(broker.listener.close)
            with Client.local(directory) as robot:
                for call, parts in (
                    (lambda: robot.command("walk/velocity", forward="0.3"), ["walk/velocity: forward = '0.3'", "number in [-2.0, 2.0] m/s"]),
                    (lambda: robot.command("walk/velocity", forward=10**400), ["forward = 1000", "[-2.0, 2.0] m/s"]),
                    (lambda: robot.command("parameter", number=2.5), ["number = 2.5", "whole number in [0.0, 63.0]"]),
                    (lambda: robot.command("parameter", number=-1), ["number = -1", "whole number"]),
                    (lambda: robot.set_parameter("planner.swing_height", None), ["planner.swing_height = None", "must be a number"]),
                    (lambda: robot.set_parameter("x" * 600, 1.0), ["name = 'xxx", "at most 472 bytes"]),
                    (lambda: robot.set_parameter(None, 1.0), ["name = None", "a text"]),
                    (lambda: robot.watch(rate=-1), ["watch: rate = -1", "[0, 50] 1/s"]),
                    (lambda: robot.watch(rate=2.5), ["watch: rate = 2.5", "whole number"]),
                    (lambda: robot.subscribe("nonsense"), ["no domain 'nonsense'", "walk"]),
                    (lambda: Client.local(directory, name="x" * 600), ["name = 'xxx", "bytes"]),
                ):
                    with self.assertRaises(ValueError) as raised:
                        call()
                    for part in parts:
                        self.assertIn(part, str(raised.exception))
                self.assertEqual(robot.command("walk/stop"), "planner")
                robot.watch(rate=10, events=2)
                self.assertEqual(robot.command("walk/stop"), "planner")


if __name__ == "__main__":
    unittest.main()
