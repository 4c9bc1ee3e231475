"""Gangwerk for Python. Units are SI, angles in rad, quaternions (x, y, z, w), feet right, left."""

from os import PathLike
from typing import Any, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .client import Client as Client, Lost as Lost, Parameter, Refused as Refused

Path = Union[str, PathLike[str]]
Reals = NDArray[np.float64]

version: str

def scenes(*, config: Optional[Path] = None) -> dict[str, str]:
    """Names of all scenes with what they show."""

def plan(scene: str, command: str, *, config: Optional[Path] = None, **values: float) -> Plan:
    """The first plan that the standing robot of a scene makes for a walking command: `plan("walk_2kmh", "walk/velocity", forward=0.3)`."""

class Event:
    """Something a process told."""

    time: float
    tick: int
    process: str
    name: str
    text: str

class State:
    """State of a walk, for `Chain.restore`. It lives in the memory of this interpreter and cannot be pickled."""

class Chain:
    """A whole robot in one process, what `gangwerk sim` runs: planner, stabilizer, joint loop, watchdog and simulated robot.

    `scene`: a name (`scenes()`) or the path of a scene file. `depth` (1 to 5), `integrator` ("euler", "rk4", "semi_implicit",
    "bdf"), `substeps` per bus cycle and `seed` stand in for those of the scene. `config`: configuration directory; without it
    the one that `gangwerk config where` names, or the set inside the package. Equal chains give the same bytes.
    A chain is for one thread at a time; others run while it steps."""

    def __init__(self, scene: str, *, depth: Optional[int] = None, seed: Optional[int] = None, integrator: Optional[str] = None,
                 substeps: Optional[int] = None, config: Optional[Path] = None) -> None: ...
    def step(self, n: int = 1) -> None:
        """Runs n bus cycles."""
    def run(self, until: Optional[float] = None) -> dict[str, Any]:
        """Runs until this time [s], or the end of the scene; ends 2 s after a fall, as `gangwerk sim` does. Gives `figures()`."""
    def trace(self, fields: Sequence[str], until: Optional[float] = None, *, every: int = 1) -> dict[str, NDArray[Any]]:
        """Runs as `run`, and gives these fields of every cycle, or of every n-th one, by name, with `time` [s]."""
    @property
    def time(self) -> float:
        """Simulated time [s]: cycles so far."""
    @property
    def tick(self) -> int:
        """Bus cycles so far."""
    @property
    def cycle(self) -> float:
        """Bus cycle [s]."""
    @property
    def duration(self) -> float:
        """Length of the scene [s]; a chain can be stepped beyond it."""
    @property
    def scene(self) -> str:
        """Name of the scene."""
    @property
    def robot(self) -> str:
        """Name of the robot."""
    @property
    def method(self) -> str:
        """Depth, integrator and steps per cycle."""
    @property
    def joint_names(self) -> list[str]:
        """Names of the joints, in the order of every array of joints."""
    def get(self, field: str) -> Any:
        """Present value of a field, `TOPIC.FIELD` as in `fields()`: a copy, or a number."""
    def fields(self) -> list[tuple[str, str, list[int]]]:
        """Name, unit and shape of every field of `sim_state`, `sensors`, `controller_state`, `joint_targets` and `power`."""
    def view(self, field: str) -> Reals:
        """Array of a field that every later `step`, `run` and `restore` of this chain writes anew; read only, always the same array."""
    @property
    def joint_angle(self) -> Reals:
        """True joint angles [rad]; a copy, as all that follow."""
    @property
    def joint_speed(self) -> Reals:
        """Measured joint speeds [rad/s]."""
    @property
    def joint_target(self) -> Reals:
        """Joint targets [rad]."""
    @property
    def torso_position(self) -> Reals:
        """True origin of the torso frame in the world [m]."""
    @property
    def torso_orientation(self) -> Reals:
        """True quaternion (x, y, z, w), world from torso."""
    @property
    def com(self) -> Reals:
        """True centre of gravity in the world [m]."""
    @property
    def capture_point(self) -> Reals:
        """Capture point [m], the divergent component of the measured motion, in the planning frame of the active plan; NaN where there is none."""
    @property
    def zmp(self) -> Reals:
        """Zero-moment point of the measured wrenches [m] in the same frame; NaN while no foot carries."""
    @property
    def foot_force(self) -> Reals:
        """True force of the ground on each foot in the world [N]; right, left."""
    @property
    def foot_moment(self) -> Reals:
        """Its moment about the foot's sole frame [N m]; right, left."""
    @property
    def feet(self) -> Reals:
        """True sole frames in the world: x, y, z [m] and heading [rad]; right, left."""
    @property
    def fallen(self) -> bool:
        """True once the robot has fallen."""
    @property
    def powered(self) -> bool:
        """Motor supply: true while it is on."""
    @property
    def gait(self) -> str:
        """State of the walk: idle, standing, starting, walking, stopping, fallen or halted."""
    @property
    def plan(self) -> Optional[Plan]:
        """The newest plan, if there is one."""
    def events(self) -> list[Event]:
        """Events of all processes since the last call."""
    def figures(self) -> dict[str, Any]:
        """Figures of the walk so far, as `gangwerk sim --json` prints them, without those of processor time."""
    def command(self, name: str, **values: float) -> str:
        """Gives a command, which is taken in the next cycle; the name of the process that takes it. Raises Refused with the reason and the limit. Fields with a dot: `**{"force.y": 40}`."""
    def push(self, force: ArrayLike, duration: float, at: Optional[float] = None) -> None:
        """Pushes the torso at its centre of gravity with this force in the world [N] for a duration [s], from the next cycle on or from the time `at` [s]; one push at a time."""
    def parameters(self) -> dict[str, Parameter]:
        """Parameters of all processes by `process.name`, with unit, range, default and present value."""
    def get_parameter(self, name: str) -> float:
        """Present value of a parameter, in its unit."""
    def set_parameter(self, name: str, value: float) -> str:
        """Gives a parameter another value from the next cycle on; the name of the process that takes it. Raises Refused."""
    def copy(self) -> Chain:
        """Chain in the same state, which goes on by itself: pushes and commands to come are copied, views and log are not."""
    def save(self) -> State:
        """The whole state: `restore` goes back to it, and what follows has the same bytes as without."""
    def restore(self, state: State) -> None:
        """Goes back to a state of this scene with the same depth, integrator and seed."""
    def log(self, path: Path) -> None:
        """Writes a log from now on, the file that `gangwerk sim --log` writes; before the first step only."""
    def end_log(self) -> None:
        """Ends the log with its index."""

class Plan:
    """Trajectories from the start of the plan until the robot stands, in its planning frame."""

    @property
    def id(self) -> int:
        """Number of the plan."""
    @property
    def start(self) -> float:
        """Time at which it begins [s]."""
    @property
    def end(self) -> float:
        """Its length [s]: from then on the robot rests."""
    @property
    def state(self) -> str:
        """State of the walk in its first step."""
    @property
    def origin(self) -> tuple[float, float, float, float]:
        """Planning frame where the robot was first: x, y, z [m] and heading [rad]."""
    @property
    def steps(self) -> list[dict[str, Any]]:
        """Steps: stance foot; begin of the double support, lift and end of the swing [s]; foothold and landing (x, y [m], heading [rad])."""
    def sample(self, times: ArrayLike) -> dict[str, Reals]:
        """Trajectories at these times since the start [s]: com [m] with com_velocity [m/s] and com_acceleration [m/s^2]; torso
        (inclinations, heading [rad]); feet (right, left; x, y, z [m], heading [rad]); pitch [rad]; zmp [m]; load_left [1]."""

class Model:
    """Kinematics and dynamics of a robot of the configuration: a tree of rigid bodies whose base, the torso, floats.

    q: position of the base in the world [m], quaternion (x, y, z, w), joint coordinates [rad, m]; 7 + n numbers. v: velocity [m/s]
    and angular velocity [rad/s] of the base in base axes, joint speeds; 6 + n. A generalized force has the shape of v: force [N]
    and moment [N m] at the base's origin in base axes, joint torques. Numbers up to 1e6. Frames are links, by name, with an
    offset [m] in the link; their velocities and Jacobians have world axes. Results are copies."""

    def __init__(self, robot: str, *, config: Optional[Path] = None) -> None: ...
    @staticmethod
    def from_urdf(urdf: str, *, base: Optional[str] = None, joints: Optional[Sequence[str]] = None) -> Model:
        """Model of a URDF, its text or its path. `base`: link that floats, the root; `joints`: order of the joints, parents first."""
    @property
    def n(self) -> int:
        """Number of joints."""
    @property
    def nq(self) -> int:
        """Length of q: 7 + n."""
    @property
    def nv(self) -> int:
        """Length of v: 6 + n."""
    @property
    def mass(self) -> float:
        """Mass of the whole robot [kg]."""
    @property
    def urdf(self) -> str:
        """Text of the URDF."""
    @property
    def joint_names(self) -> list[str]:
        """Names of the joints in the order of q."""
    @property
    def link_names(self) -> list[str]:
        """Names of the links: the frames."""
    @property
    def pose_names(self) -> list[str]:
        """Names of the poses that the robot's file has."""
    def neutral(self, pose: Optional[str] = None) -> Reals:
        """q with the base at the origin, upright, joints at zero or in a pose of the robot's file."""
    def pose(self, q: ArrayLike, link: str, offset: Optional[ArrayLike] = None) -> Reals:
        """world_from_link as a 4 x 4 matrix [1, m]."""
    def velocity(self, q: ArrayLike, v: ArrayLike, link: str, offset: Optional[ArrayLike] = None) -> Reals:
        """Velocity [m/s] and angular velocity [rad/s] of a frame, world axes."""
    def jacobian(self, q: ArrayLike, link: str, offset: Optional[ArrayLike] = None) -> Reals:
        """Jacobian of a frame, 6 x (6 + n): rows velocity, then angular velocity, world axes."""
    def com(self, q: ArrayLike) -> Reals:
        """Centre of gravity in the world [m]."""
    def com_jacobian(self, q: ArrayLike) -> Reals:
        """Its Jacobian, 3 x (6 + n), world axes."""
    def momentum(self, q: ArrayLike, v: ArrayLike) -> Reals:
        """Linear momentum [kg m/s], and angular momentum about the centre of gravity [kg m^2/s], world axes."""
    def energy(self, q: ArrayLike, v: ArrayLike) -> tuple[float, float]:
        """Kinetic and potential energy [J]."""
    def mass_matrix(self, q: ArrayLike) -> Reals:
        """Mass matrix M, (6 + n) x (6 + n)."""
    def nonlinear_terms(self, q: ArrayLike, v: ArrayLike) -> Reals:
        """Coriolis and centrifugal terms and weight h: M dv/dt + h is the generalized force."""
    def inverse_dynamics(self, q: ArrayLike, v: ArrayLike, acceleration: ArrayLike) -> Reals:
        """Generalized force for dv/dt = acceleration [m/s^2, rad/s^2]."""
    def forward_dynamics(self, q: ArrayLike, v: ArrayLike, force: ArrayLike) -> Reals:
        """dv/dt [m/s^2, rad/s^2] under a generalized force."""
    def integrate(self, q: ArrayLike, v: ArrayLike, dt: float) -> Reals:
        """q after moving with constant v for dt [s]."""

class Log:
    """Records of a log, as `gangwerk run` and `gangwerk sim --log` write it."""

    def __init__(self, path: Path) -> None: ...
    @property
    def robot(self) -> str:
        """Name of the robot."""
    @property
    def urdf(self) -> str:
        """Text of its URDF."""
    @property
    def joint_names(self) -> list[str]:
        """Names of its joints, in the order of every array of joints."""
    @property
    def scene(self) -> str:
        """Name of the scene; empty of a real robot."""
    @property
    def seed(self) -> int:
        """Seed of everything random."""
    @property
    def cycle(self) -> float:
        """Bus cycle [s]."""
    def topics(self) -> dict[str, int]:
        """Topics with the number of their records."""
    def units(self, topic: str) -> dict[str, str]:
        """Units of the fields of a topic; of a last index with several units one for each; empty: none."""
    def read(self, topic: str, fields: Optional[Sequence[str]] = None, *, begin: Optional[float] = None,
             end: Optional[float] = None) -> dict[str, NDArray[Any]]:
        """Fields of a topic by name, all or these, a row for each record with begin <= `time` < end [s], the time since the first cycle."""
