"""The Python client against a real broker: `python3 tests/python_client.py RUN_DIRECTORY HOST PORT KEY_NAME KEY`.

Prints one line per check; the test that starts it (tests/commands.rs) looks at its exit code.
"""

import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "python"))
from gangwerk_client import Client, Lost, Refused  # noqa: E402

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
    # The lease stays with who gives signs of life, longer than half a second.
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

with Client.network(host, int(port), (key_name, key)) as console:
    print("accepted by", console.command("walk/velocity", forward=0.1))
    refused(lambda: console.command("system/enable"), "may not command `system`")
    print("accepted by", console.command("walk/stop"))

refused(lambda: Client.network(host, int(port), (key_name, "ff" * 32)), "the key is wrong")
with Client.network(host, int(port)) as stranger:
    refused(lambda: stranger.command("walk/velocity", forward=0.1), "may not command `walk`")
    print("accepted by", stranger.command("walk/stop"))
print("all checks passed")
