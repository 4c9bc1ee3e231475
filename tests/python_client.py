"""The Python client against a real broker: `python3 tests/python_client.py RUN_DIRECTORY HOST PORT KEY_NAME KEY`.

Prints one line per check; the test that starts it (tests/commands.rs) looks at its exit code.
"""

import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "python"))
from gangwerk.client import Client, Lost, Refused  # noqa: E402

run, host, port, key_name, key = sys.argv[1:]


def refused(do, *words):
    try:
        do()
    except (Refused, Lost) as error:
        missing = [word for word in words if word not in str(error)]
        assert not missing, f"{missing} not in: {error}"
        print("refused:", error)
    else:
        raise AssertionError(f"not refused: {words}")


with Client.local(run, "first") as robot:
    assert robot.commands["walk/velocity"].needs_lease and not robot.commands["walk/stop"].needs_lease
    print("accepted by", robot.command("walk/velocity", forward=0.2))
    refused(lambda: robot.command("walk/velocity", forward=1.9), "walk/velocity", "planner", "at most")
    refused(lambda: robot.command("walk/velocity", forward=float("nan")), "not a finite number")
    # The lease stays with who gives heartbeats, longer than half a second.
    time.sleep(1.0)
    with Client.local(run, "second") as other:
        refused(lambda: other.command("walk/start"), "first", "holds the command lease")
        robot.subscribe("walk")
        print("accepted by", other.command("walk/stop"))
        assert robot.heard(2.0) == ("walk/stop", {}), "others' commands are heard"
        other.take_lease(over=True)
        refused(lambda: robot.command("walk/start"), "second", "holds the command lease")
    # 500 commands at once, each with an answer.
    numbers = [robot.send("walk/stop") for _ in range(500)]
    assert {robot.wait(number) for number in numbers} == {"planner"}
    assert any(line.startswith("broker: ") for line in robot.statistics())


def until(what, look, seconds=20.0):
    """What `look` gives as soon as it is something."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        found = look()
        if found:
            return found
        time.sleep(0.005)
    raise AssertionError(f"no {what} within {seconds} s")


with Client.local(run, "operator") as robot:
    table = robot.list_parameters()
    processes = {name.split(".")[0] for name in table}
    assert processes == {"planner", "controller", "lowlevel", "watchdog", "sim-backend", "logger", "broker"}, processes
    height = table["planner.swing_height"]
    assert (height.unit, height.change, height.value) == ("m", "live", height.default), height
    assert height.low <= height.default <= height.high and height.about
    refused(lambda: robot.set_parameter("lowlevel.bus.missed", 10), "fixed at start", "config/system.toml")
    refused(lambda: robot.set_parameter("planner.swing_height", 0.5), "outside of [0, 0.15] m")
    robot.command("walk/velocity", forward=0.2)
    with Client.local(run, "late") as late:
        # In the middle of a walk: what is the case is known without waiting for a change.
        layout = late.watch(rate=20, events=True)
        assert any(line.startswith("joint_angle 32 rad") for line in layout), layout
        first = late.state(2.0)
        assert (first.supply, first.start_up, first.not_standing) == (1.0, 6.0, 0.0), first
        assert late.lease_holder.startswith("operator"), late.lease_holder
        assert late.parameters["planner.swing_height"] == height.value
        assert until("walk", lambda: (late.state() or first).gait == 3.0)
        print("accepted by", robot.set_parameter("planner.swing_height", 0.07))
        set_ = until("event", lambda: next((e for e in iter(late.event, None) if e.name == "ParameterSet"), None))
        assert (set_.process, set_.detail) == ("planner", 0), set_
        until("new value", lambda: late.parameters["planner.swing_height"] == 0.07)
        assert robot.list_parameters()["planner.swing_height"].value == 0.07
        robot.set_parameter("planner.swing_height", height.value)
        one = until("state", late.state)
        two = until("state", late.state)
        assert two.tick > one.tick and len(two.joint_angle) == 32 and late.lost == 0
    robot.command("walk/stop")


def forgets():
    """Makes a client and walks her; nobody refers to it any more once it has raised."""
    robot = Client.local(run, "forgetful")
    robot.command("walk/velocity", forward=0.2)
    raise RuntimeError("a fault of the program")


with Client.local(run, "next") as other:

    def is_free():
        try:
            other.take_lease()
        except Refused:
            return False
        other.give_lease()
        return True

    try:
        forgets()
    except RuntimeError as error:
        print("forgotten after", error)
    until("end of the lease of a forgotten client", is_free)
    # A program that hangs keeps it for as long as its deadline says.
    with Client.local(run, "hanging", deadline=0.3) as robot:
        robot.command("walk/velocity", forward=0.2)
        until("end of the lease of a program that hangs", is_free)
        print("accepted by", robot.command("walk/velocity", forward=0.2))

with Client.network(host, int(port), (key_name, key)) as console:
    print("accepted by", console.command("walk/velocity", forward=0.1))
    refused(lambda: console.command("system/enable"), "may not command `system`")
    print("accepted by", console.command("walk/stop"))

refused(lambda: Client.network(host, int(port), (key_name, "ff" * 32)), "the key is wrong")
with Client.network(host, int(port)) as stranger:
    refused(lambda: stranger.command("walk/velocity", forward=0.1), "may not command `walk`")
    print("accepted by", stranger.command("walk/stop"))
print("all checks passed")
