"""Makes the models that peer.c simulates, as MuJoCo's binary files: its XML writer keeps six digits.

usage: model.py ROBOT_DIRECTORY CHAIN_URDF OUTPUT_DIRECTORY

| file              | what                                                                             |
|-------------------|----------------------------------------------------------------------------------|
| lola_flight.mjb   | robot with a free base, nothing else                                             |
| lola_stiff.mjb    | with the contact points of robot.toml, a floor, position servos; MuJoCo's contact|
| lola_layer.mjb    | same, contact parameters such that a point has the spring and damper of robot.toml|
| chain_fixed.mjb   | limb chain, first link fixed to the world                                        |
| chain_free.mjb    | limb chain, all free                                                             |
| block.mjb         | block of 1 kg on a plane                                                         |

Bodies are as in the URDF, none fused, bounded or balanced. Ranges and effort limits of the joints are left out: no
comparison reaches them on purpose. A contact point is a sphere of 1 um at the point, as MuJoCo knows no bare points;
points touch the floor only. The toes' points hang on the toes, so a point stays one when the foot tilts.

Contact of lola_layer: MuJoCo's constraint force is f = (a_ref - a)/R with a_ref = -(b/d) v - (k/d) r (its "direct"
format at constant impedance d), R = A (1 - d)/d and A the inverse inertia of the body at the point. With
k = K A (1 - d), b = B A (1 - d): f = -K r - B v - a d/(A (1 - d)): the spring and damper of the robot, and a
thousandth of the body's inertia at d = 0.001. A tangential spring it cannot have: a loaded point creeps against the
robot's tangential damper (impratio = B_T / B_N, with B = damping_time K in robot.toml).
"""

import sys
import tomllib
from pathlib import Path

import mujoco

GRAVITY = [0, 0, -9.81]  # [m/s^2]
POINT = 1e-6  # [m] radius
# Servos: torque = STIFFNESS (target - angle) - DAMPING speed. The rotor inertia lets explicit steps of 1 ms live.
STIFFNESS, DAMPING, ROTOR = 1e4, 200.0, 0.3  # [N m/rad], [N m s/rad], [kg m^2]
IMPEDANCE = 1e-3  # d of lola_layer
COMPILER = '<mujoco><compiler fusestatic="false" discardvisual="true" balanceinertia="false"/></mujoco>'


def bodies(urdf):
    """The URDF as MuJoCo reads it, joints without limits."""
    spec = mujoco.MjSpec.from_string(urdf.replace("</robot>", COMPILER + "</robot>"))
    spec.option.gravity = GRAVITY
    # Numbers that are not finite shall be seen, not reset; a servo's damping is a force like any other.
    spec.option.disableflags = mujoco.mjtDisableBit.mjDSBL_AUTORESET | mujoco.mjtDisableBit.mjDSBL_EULERDAMP
    for joint in spec.joints:
        joint.limited = joint.actfrclimited = mujoco.mjtLimited.mjLIMITED_FALSE
    return spec


def free(spec):
    """With the first body floating."""
    spec.worldbody.first_body().add_freejoint(name="base")
    return spec


def on_its_feet(urdf, robot, layer):
    spec = free(bodies(urdf))
    for joint in robot["joint"]:
        spec.joint(joint["name"]).armature = ROTOR
        servo = spec.add_actuator(name=joint["name"], target=joint["name"], trntype=mujoco.mjtTrn.mjTRN_JOINT)
        servo.set_to_position(kp=STIFFNESS, kv=DAMPING)
    floor(spec, [robot["contact"]["friction"], 0, 0])
    points(spec, robot)
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    if layer:
        soft(spec, robot)
    return spec


def points(spec, robot):
    """The contact points of robot.toml."""
    friction = [robot["contact"]["friction"], 0, 0]
    for side in ("right", "left"):
        for point in robot["foot"][side]["points"]:
            spec.body(point["link"]).add_geom(
                name=f"{side} {point['at']}", type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[POINT, 0, 0], pos=point["at"],
                friction=friction, condim=3, contype=0, conaffinity=1, priority=1, mass=0)


def soft(spec, robot, impedance=IMPEDANCE):
    """Gives the points the spring and damper of robot.toml."""
    contact = robot["contact"]
    model = spec.compile()
    stiffness, damping = contact["normal_stiffness"], contact["normal_stiffness"] * contact["damping_time"]
    for geom in spec.geoms:
        if geom.type == mujoco.mjtGeom.mjGEOM_SPHERE:
            a = model.body_invweight0[model.body(geom.parent.name).id, 0] * (1 - impedance)
            geom.solref = [-stiffness * a, -damping * a]
            geom.solimp = [impedance, impedance, 1e-3, 0.5, 2]
    spec.option.impratio = contact["tangential_stiffness"] / stiffness


def floor(spec, friction):
    spec.worldbody.add_geom(name="floor", type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], friction=friction, condim=3,
                            contype=1, conaffinity=0)


def block():
    spec = mujoco.MjSpec()
    spec.option.gravity = GRAVITY
    spec.option.disableflags = mujoco.mjtDisableBit.mjDSBL_AUTORESET
    floor(spec, [1, 0, 0])
    body = spec.worldbody.add_body(name="block", pos=[0, 0, 0.05])
    body.add_freejoint(name="base")
    body.add_geom(name="block", type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.1, 0.1, 0.05], mass=1.0, friction=[1, 0, 0],
                  condim=3, contype=0, conaffinity=1)
    return spec


def all_models(directory, chain):
    robot = tomllib.loads((directory / "robot.toml").read_text())
    urdf = (directory / robot["urdf"]).read_text()
    yield "lola_flight", free(bodies(urdf))
    yield "lola_stiff", on_its_feet(urdf, robot, layer=False)
    yield "lola_layer", on_its_feet(urdf, robot, layer=True)
    yield "chain_fixed", bodies(chain.read_text())
    yield "chain_free", free(bodies(chain.read_text()))
    yield "block", block()


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    robot, chain, output = (Path(a) for a in sys.argv[1:])
    output.mkdir(parents=True, exist_ok=True)
    for name, spec in all_models(robot, chain):
        mujoco.mj_saveModel(spec.compile(), str(output / f"{name}.mjb"), None)


if __name__ == "__main__":
    main()
