"""`python3 -m gangwerk.sweep` with wrong options and a cluster that fails: one sentence each, and no waiting. Dask and the command are stand-ins."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import gangwerk

# Tells the collector's line, and then how many rows came in.
COLLECTOR = f"""#!{sys.executable}
import json, sys
print(json.dumps({{"identity": "this", "walks": 2, "left": [0, 1]}}), flush=True)
print("rows:", sys.stdin.read().count("\\n"))
"""
DASK = """
import os
from concurrent.futures import CancelledError

class KilledWorker(Exception):
    pass

class Future:
    def __init__(self, key):
        self.key = key
    def result(self):
        if os.environ["FAILS"] == "scheduler":
            raise CancelledError("walks-0-2-1: lost its scheduler")
        return "0\\tdone\\n1\\tdo"
    def release(self):
        pass

class Client:
    def __init__(self, address=None, scheduler_file=None):
        if address == "nonsense":
            raise ValueError("missing port number in address 'nonsense'")
    def __enter__(self):
        return self
    def __exit__(self, *_):
        pass
    def submit(self, walk, *arguments, key, pure):
        return Future(key)

LocalCluster = dict
as_completed = list
"""


class Sweep(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.directory = pathlib.Path(directory.name)
        (self.directory / "dask").mkdir()
        for name in ("dask/__init__.py", "dask/distributed.py", "distributed.py"):
            (self.directory / name).write_text("" if "init" in name else DASK)
        (self.directory / "collector").write_text(COLLECTOR)
        (self.directory / "collector").chmod(0o755)

    def said(self, *options, fails=""):
        """Exit code, and what went to standard output and to standard error."""
        path = [str(self.directory), str(pathlib.Path(gangwerk.__file__).parents[1])]
        command = [sys.executable, "-m", "gangwerk.sweep", "sweep.toml", "--gangwerk", str(self.directory / "collector"), *options]
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path), "FAILS": fails}
        done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=60)
        self.assertNotIn("Traceback", done.stderr)
        return done.returncode, done.stdout, done.stderr

    def test_options_that_would_be_waited_for_are_refused(self):
        for options, why in (
            (["--workers", "0"], "--workers 0: takes at least 1"),
            (["--workers", "-1"], "--workers -1: takes at least 1"),
            (["--piece", "0"], "--piece 0: takes at least 1"),
            (["--scheduler-file", "/nowhere/scheduler.json"], "--scheduler-file /nowhere/scheduler.json: there is no such file"),
        ):
            code, _, error = self.said(*options)
            self.assertEqual(code, 2)
            self.assertIn(why, error)

    def test_a_scheduler_that_there_is_not_or_no_longer_is_told_in_a_sentence(self):
        code, _, error = self.said("--scheduler", "nonsense")
        self.assertEqual((code, error), (1, "error: nonsense: missing port number in address 'nonsense'\n"))
        code, _, error = self.said("--scheduler", "tcp://host:1", fails="scheduler")
        self.assertEqual(code, 1)
        self.assertRegex(error, "^error: the scheduler is gone: .*; start the same command again: it goes on\n$")

    def test_a_row_that_was_cut_is_not_handed_on(self):
        self.assertEqual(self.said("--scheduler", "tcp://host:1"), (0, "rows: 1\n", ""))


if __name__ == "__main__":
    unittest.main()
