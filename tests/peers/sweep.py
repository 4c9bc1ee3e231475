"""A sweep by Dask beside one on a single core: `sweep.py KILLS [SEED]`, with GANGWERK in the environment; tests/peers/sweep.sh runs it.

Rows and table are read with Python's own parser and with PyArrow, neither of which knows who wrote them.
"""

import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import pyarrow.parquet

ROOT = pathlib.Path(__file__).resolve().parents[2]
GANGWERK = os.environ["GANGWERK"]
KILLS = int(sys.argv[1])
INSTANTS = random.Random(int(sys.argv[2]) if len(sys.argv) > 2 else 20261128)
# Long enough for all kills.
SEEDS = max(10, 2 * KILLS)
WALKS = 4 * SEEDS
SWEEP = f"""about = "Pushes on the spot."
scenes = ["push"]
seeds = {SEEDS}
[[number]]
key = "scene.push.0.force.1"
values = [20, 200, 300, 400]
[[number]]
key = "scene.push.0.time"
range = [4.0, 5.2]
[[number]]
key = "scene.duration"
values = [6.0]
[[number]]
key = "scene.command.2.time"
values = [5.9]
[survived]
"end_pose.1" = [-0.1, 0.1]
"""
environment = dict(os.environ, PYTHONPATH=str(ROOT / "python"))


def sweep(file, out, *more):
    return subprocess.run([GANGWERK, "sweep", file, "--out", out, *more], capture_output=True, text=True)


def by_dask(file, out, *more):
    command = [sys.executable, "-m", "gangwerk.sweep", file, "--out", out, "--piece", "4", *more]
    return subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def table_is_its_rows(out):
    """PyArrow's numbers are those of the text, bit for bit."""
    table = pyarrow.parquet.read_table(out / "table.parquet")
    lines = (out / "rows.tsv").read_text().splitlines()[1:]
    names, *rows = [line.split("\t") for line in lines]
    assert table.column_names == names and table.num_rows == len(rows) == WALKS, table.num_rows
    rows.sort(key=lambda row: int(row[0]))
    read = {bool: lambda text: text == "true", int: int, float: float, str: str}
    for k, name in enumerate(names):
        for row, value in zip(rows, table.column(name).to_pylist()):
            assert (value is None and row[k] == "") or value == read[type(value)](row[k]), (name, row[k], value)
    survived = table.column("survived").to_pylist()
    assert 0 < sum(survived) < WALKS, survived
    assert table.column("walk").to_pylist() == list(range(WALKS))
    return sum(survived)


def kill_workers(file, out, kills):
    """Two workers over loopback; one of them is killed and another one added, at random instants. How long the sweep took."""
    dask = str(pathlib.Path(sys.executable).parent / "dask")
    log = open(out.with_suffix(".log"), "w")
    address = out.with_suffix(".json")
    # Dask gives a piece up with its first lost worker: whoever asked has to ask again.
    strict = dict(environment, DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES="0")
    quiet = {"stdout": log, "stderr": log, "env": strict}
    scheduler = subprocess.Popen(
        [dask, "scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--scheduler-file", address], **quiet
    )
    worker = lambda: subprocess.Popen(  # noqa: E731
        [dask, "worker", "--scheduler-file", address, "--nthreads", "1", "--no-nanny", "--no-dashboard"], **quiet
    )
    workers = []
    try:
        while not (address.exists() and address.read_text().strip().endswith("}")):
            assert scheduler.poll() is None, "the scheduler ended"
            time.sleep(0.1)
        workers = [worker(), worker()]
        begun = time.monotonic()
        driver = by_dask(file, out, "--scheduler-file", str(address), "--gangwerk", GANGWERK)
        killed = 0
        while driver.poll() is None:
            time.sleep(INSTANTS.uniform(0.2, 2.0))
            if killed < kills and (out / "rows.tsv").exists():
                victim = workers.pop(INSTANTS.randrange(2))
                victim.send_signal(signal.SIGKILL)
                victim.wait()
                killed += 1
                workers.append(worker())
        said, complaints = driver.communicate()
        assert driver.returncode == 0, complaints
        assert killed == kills, f"the sweep was over after {killed} of {kills} workers were killed"
        return time.monotonic() - begun
    finally:
        for process in [*workers, scheduler]:
            process.kill()
        log.close()


def killed_again_and_again(file, out):
    """Killed at random instants and started again, on all cores, until it ends by itself. How often it was killed."""
    for kills in range(1000):
        running = subprocess.Popen([GANGWERK, "sweep", file, "--out", out], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        try:
            _, complaints = running.communicate(timeout=INSTANTS.uniform(0.5, 4.0))
            assert running.returncode == 0, complaints
            return kills
        except subprocess.TimeoutExpired:
            running.kill()
            running.communicate()
    raise AssertionError("it does not get on")


def full_disk(file, out):
    """A directory that takes 8 kB: one error, and the rows that fit are gone on from elsewhere."""
    small = out.with_suffix(".small")
    small.mkdir()
    script = 'mount -t tmpfs -o size=8k none "$1" && { "$2" sweep "$3" --out "$1"; code=$?; cp "$1/rows.tsv" "$4"; exit $code; }'
    kept = out / "rows.tsv"
    out.mkdir()
    done = subprocess.run(["unshare", "-rm", "sh", "-c", script, "sh", small, GANGWERK, file, kept], capture_output=True, text=True)
    if not kept.exists():
        print("full disk: not tried, no mount namespace here:", done.stderr.strip())
        shutil.rmtree(out)
        return
    errors = [line for line in done.stderr.splitlines() if line.startswith("error: ")]
    assert done.returncode == 1 and len(errors) == 1 and "rows.tsv: No space left" in errors[0], done
    rows = len(kept.read_text().splitlines()) - 2
    assert 0 < rows < WALKS, rows
    print(f"full disk after {rows} rows: {errors[0]}")
    done = sweep(file, out)
    assert done.returncode == 0, done.stderr


def main():
    with tempfile.TemporaryDirectory() as directory:
        directory = pathlib.Path(directory)
        file = directory / "sweep.toml"
        file.write_text(SWEEP)
        begun = time.monotonic()
        done = sweep(file, directory / "one", "--cores", "1")
        assert done.returncode == 0, done.stderr
        alone = time.monotonic() - begun
        one = (directory / "one" / "table.parquet").read_bytes()
        print(f"{WALKS} walks on one core in {alone:.1f} s, {table_is_its_rows(directory / 'one')} survived")

        took = kill_workers(file, directory / "dask", KILLS)
        assert (directory / "dask" / "table.parquet").read_bytes() == one, "another table"
        print(f"the same table from two workers, of which {KILLS} were killed, in {took:.1f} s")

        kills = killed_again_and_again(file, directory / "killed")
        assert kills > 0 and (directory / "killed" / "table.parquet").read_bytes() == one, f"another table after {kills} kills"
        print(f"the same table from a sweep that was killed {kills} times")

        full_disk(file, directory / "full")
        if (directory / "full").exists():
            assert (directory / "full" / "table.parquet").read_bytes() == one, "another table after a full disk"

        # Workers have another program than who collects.
        other = directory / "other"
        other.write_bytes(pathlib.Path(GANGWERK).read_bytes() + b"\0")
        mixed = directory / "gangwerk"
        mixed.write_text(f'#!/bin/sh\ncase " $* " in *" --walks "*) exec "{other}" "$@";; *) exec "{GANGWERK}" "$@";; esac\n')
        for program in (other, mixed):
            program.chmod(0o755)
        driver = by_dask(file, directory / "mixed", "--workers", "1", "--gangwerk", str(mixed))
        said, complaints = driver.communicate()
        errors = [line for line in complaints.splitlines() if line.startswith("error: ")]
        assert driver.returncode == 1 and any("install the same program" in line for line in errors), complaints
        assert len((directory / "mixed" / "rows.tsv").read_text().splitlines()) == 2, "a row of another program"
        print("another program on a worker:", [line for line in errors if "install" in line][0][:100], "...")


main()
