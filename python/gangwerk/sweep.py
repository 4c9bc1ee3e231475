"""A sweep on many machines: `python3 -m gangwerk.sweep FILE --out DIR [--scheduler ADDRESS]`.

Workers of a Dask cluster walk pieces of the sweep with the command `gangwerk`; the rows go to one
`gangwerk sweep --collect` here, which writes them down and makes the table. A piece whose worker is lost is walked
again by another one. After an interruption the same command, here or without Dask, goes on.
"""

import argparse
import json
import os
import subprocess
import sys
from concurrent.futures import CancelledError

# Names of pieces say how often they were tried: a piece is given up when its workers die again and again.
TRIES = 10


def walk(gangwerk, arguments, identity, begin, end):
    """Rows of the walks from `begin` up to, but not including, `end`: one line each. Runs on a worker."""
    command = [*gangwerk, "sweep", *arguments, "--walks", f"{begin}..{end}", "--identity", identity]
    try:
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    except OSError as error:
        raise RuntimeError(f"{gangwerk[0]}: {error}") from None
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip().removeprefix("error: ") or f"{command[0]} ended with {done.returncode}")
    return done.stdout


def pieces(left, size):
    """Walks in ascending order as (begin, end) of at most `size` that follow each other."""
    begin = end = None
    for number in left:
        if begin is not None and number == end and end - begin < size:
            end += 1
            continue
        if begin is not None:
            yield begin, end
        begin, end = number, number + 1
    if begin is not None:
        yield begin, end


def rows(client, gangwerk, arguments, identity, left, size):
    """Rows of the walks that are `left`, as they come in from the cluster."""
    from dask.distributed import as_completed
    from distributed import KilledWorker

    waiting, tries = {}, {}

    def submit(piece):
        tries[piece] = tries.get(piece, 0) + 1
        name = f"walks-{piece[0]}-{piece[1]}-{tries[piece]}"
        future = client.submit(walk, gangwerk, arguments, identity, *piece, key=name, pure=False)
        waiting[future.key] = piece
        return future

    done = as_completed([submit(piece) for piece in pieces(left, size)])
    for future in done:
        piece = waiting.pop(future.key)
        try:
            text = future.result()
        except KilledWorker:
            if tries[piece] == TRIES:
                raise RuntimeError(f"walks {piece[0]} to {piece[1]}: {TRIES} times every worker died") from None
            done.add(submit(piece))
            continue
        future.release()
        # A line without its end was cut off.
        yield from text.split("\n")[:-1]


def main(argv=None):
    parser = argparse.ArgumentParser(prog="python3 -m gangwerk.sweep", description=__doc__.splitlines()[0])
    parser.add_argument("file", help="a sweep file, at the same path on every machine: docs/sweeps.md")
    parser.add_argument("--out", default="runs/sweep", help="directory of rows, table and maps (default: %(default)s)")
    parser.add_argument("--scheduler", help="address of a Dask scheduler; default: workers of its own on this machine")
    parser.add_argument("--scheduler-file", help="file in which the scheduler has written its address")
    parser.add_argument("--workers", type=int, help="how many workers, without --scheduler (default: one per core)")
    parser.add_argument("--piece", type=int, default=20, help="walks that a worker does at a time (default: %(default)s)")
    parser.add_argument("--config", help="configuration directory, at the same path on every machine")
    parser.add_argument("--gangwerk", default="gangwerk", help="the command (default: %(default)s)")
    asked = parser.parse_args(argv)
    if asked.piece < 1:
        parser.error(f"--piece {asked.piece}: takes at least 1")
    if asked.workers is not None and asked.workers < 1:
        parser.error(f"--workers {asked.workers}: takes at least 1")
    # Dask waits for a file that is not there.
    if asked.scheduler_file and not os.path.isfile(asked.scheduler_file):
        parser.error(f"--scheduler-file {asked.scheduler_file}: there is no such file")
    try:
        from dask.distributed import Client, LocalCluster
    except ImportError:
        parser.exit(1, "error: Dask is missing; pip install 'dask[distributed]'\n")

    gangwerk = [asked.gangwerk, *(["--config", asked.config] if asked.config else [])]
    command = [*gangwerk, "sweep", asked.file, "--out", asked.out, "--collect"]
    try:
        collector = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    except OSError as error:
        parser.exit(1, f"error: {asked.gangwerk}: {error}; name it with --gangwerk\n")
    # What is wrong with the file, or the directory, the collector has said itself.
    told = collector.stdout.readline()
    if not told:
        return collector.wait() or 1
    told = json.loads(told)
    failed = None
    try:
        if told["left"]:
            if asked.scheduler or asked.scheduler_file:
                client = Client(asked.scheduler, scheduler_file=asked.scheduler_file)
            else:
                cluster = LocalCluster(n_workers=asked.workers, threads_per_worker=1, dashboard_address=None)
                client = Client(cluster)
            with client:
                for row in rows(client, gangwerk, [asked.file], told["identity"], told["left"], asked.piece):
                    collector.stdin.write(row + "\n")
                    collector.stdin.flush()
    except BrokenPipeError:
        pass  # the collector has said why
    except (RuntimeError, OSError) as error:
        failed = error
    except ValueError as error:
        failed = f"{asked.scheduler or asked.scheduler_file or 'Dask'}: {error}"
    except CancelledError as error:
        why = str(error).partition("\n")[0].rstrip(".")
        failed = f"the scheduler is gone: {why}; start the same command again: it goes on"
    except KeyboardInterrupt:
        failed = "interrupted; start the same command again: it goes on"
    try:
        collector.stdin.close()
    except BrokenPipeError:
        pass
    print(collector.stdout.read(), end="")
    code = collector.wait()
    if failed:
        print(f"error: {failed}", file=sys.stderr)
        return 1
    return code


if __name__ == "__main__":
    sys.exit(main())
