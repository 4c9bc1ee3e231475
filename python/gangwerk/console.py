"""Interactive shell with a client `robot` of the running robot: `gangwerk console`, or `python3 -m gangwerk.console`."""

import argparse
import code
import sys

from . import client

HELP = """robot is the running robot. Commands and their answers:
  robot.command("walk/stand"); robot.command("walk/velocity", forward=0.3); robot.command("walk/stop")
  robot.commands            every command with its fields, units and ranges
  robot.list_parameters()   robot.set_parameter("planner.swing_height", 0.06)
  robot.watch(rate=10, events=True); robot.state(1.0).com; robot.event(1.0)
With this shell ends the command lease: a robot that walks comes to a stand."""


def main(arguments=None):
    """Connects, and hands the connection over to a shell. Exit code 1: there is no robot."""
    parser = argparse.ArgumentParser(prog="gangwerk console", description=__doc__)
    parser.add_argument("--dir", metavar="DIR", help="run directory; default: that of `gangwerk run`")
    parser.add_argument("-c", metavar="CODE", help="run this Python code instead of a shell, and end")
    options = parser.parse_args(arguments)
    directory = options.dir or client.default_directory()
    try:
        robot = client.Client.local(directory, "console")
    except (OSError, client.Refused) as error:
        print(f"error: no robot in {directory}: {error}; start one with `gangwerk run demo`, or name its --dir", file=sys.stderr)
        return 1
    names = {"robot": robot, "Refused": client.Refused, "Lost": client.Lost}
    with robot:
        if options.c is not None:
            exec(compile(options.c, "-c", "exec"), names)
            return 0
        _shell(names)
    return 0


def _shell(names):
    """IPython where it is installed, else Python's own with history and completion."""
    try:
        from IPython import start_ipython
    except ImportError:
        try:
            import readline
            import rlcompleter

            readline.set_completer(rlcompleter.Completer(names).complete)
            readline.parse_and_bind("tab: complete")
        except ImportError:
            pass
        code.interact(banner=HELP, local=names, exitmsg="")
    else:
        print(HELP)
        start_ipython(argv=["--no-banner"], user_ns=names)


if __name__ == "__main__":
    sys.exit(main())
