"""Gangwerk: walking control of biped robots. Simulation, planner, kinematics and dynamics, logs, client of running robots.

    import gangwerk
    chain = gangwerk.Chain("walk_1kmh")     # a whole robot in one process
    print(chain.run()["mean_speed_m_s"])    # m/s

| name | what |
|---|---|
| `Chain` | what `gangwerk sim` runs, step by step; `State`, `Event` |
| `plan`, `Plan` | what the planner makes of a command |
| `Model` | kinematics and dynamics of a robot, shipped or of your own URDF |
| `Log` | records of a log as NumPy arrays |
| `scenes` | names of all scenes |
| `Client` | operator of a running robot; `Refused`, `Lost` |

Units are SI, angles in rad, quaternions (x, y, z, w), feet right, left. A wrong argument is a ValueError that names it, its
value and its range; what the robot refuses is `Refused`. The client needs nothing but the standard library.
"""

import importlib

from .client import Client, Lost, Refused

_NATIVE = ("Chain", "Event", "Log", "Model", "Plan", "State", "plan", "scenes", "version")
__all__ = ["Client", "Lost", "Refused", *_NATIVE]


def __getattr__(name):
    # Loaded when asked for, so that the client works without it.
    if name not in _NATIVE:
        raise AttributeError(f"module 'gangwerk' has no attribute {name!r}; there are {', '.join(__all__)}")
    try:
        native = importlib.import_module("._native", __name__)
    except ModuleNotFoundError as error:
        raise ImportError(f"gangwerk.{name} needs the wheel of gangwerk: `pip install ./python` builds and installs it") from error
    globals().update({known: getattr(native, known) for known in _NATIVE})
    return globals()[name]


def __dir__():
    return sorted(__all__)
