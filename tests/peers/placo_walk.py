"""How long placo's walk pattern generator takes for a walk at 2 km/h, as Lola's plans: steps of 0.5 m in 0.9 s."""

import statistics
import tempfile
import time

import placo

LEG = """<link name="{s}_hip_yaw"><inertial><mass value="1"/><origin xyz="0 0 0"/>
<inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="{s}_hip" type="revolute"><parent link="trunk"/><child link="{s}_hip_yaw"/><origin xyz="0 {y} 0"/>
<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<link name="{s}_foot"><inertial><mass value="4"/><origin xyz="0 0 0"/>
<inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="{s}_leg" type="prismatic"><parent link="{s}_hip_yaw"/><child link="{s}_foot"/><origin xyz="0 0 -0.8"/>
<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>"""
TRUNK = """<link name="trunk"><inertial><mass value="50"/><origin xyz="0 0 0"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>"""


def robot():
    """Two feet and a trunk: the generator asks the robot for no more than where they are."""
    legs = "".join(LEG.format(s=s, y=y) for s, y in (("left", 0.105), ("right", -0.105)))
    path = tempfile.mkdtemp() + "/robot.urdf"
    with open(path, "w", encoding="utf-8") as file:
        file.write(f'<robot name="biped">{TRUNK}{legs}</robot>')
    return placo.HumanoidRobot(path)


def parameters(timesteps):
    """Those of Lola's gait; `timesteps` per single support."""
    p = placo.HumanoidParameters()
    p.single_support_duration = 0.72
    p.single_support_timesteps = timesteps
    p.double_support_ratio = 0.25
    p.startend_double_support_ratio = 1.25
    p.planned_timesteps = 200
    p.walk_com_height = 0.8
    p.walk_foot_height = 0.05
    p.feet_spacing = 0.21
    p.foot_length, p.foot_width, p.zmp_margin = 0.30, 0.10, 0.02
    p.walk_max_dx_forward = 1.0
    return p


def main():
    body = robot()
    print("placo 0.10.2, WalkPatternGenerator.plan, 2 km/h               median      p99")
    for timesteps in (5, 10, 20):
        p = parameters(timesteps)
        planner = placo.FootstepsPlannerRepetitive(p)
        planner.configure(0.5, 0.0, 0.0, 4)
        feet = [placo.flatten_on_floor(f) for f in (body.get_T_world_left(), body.get_T_world_right())]
        steps = planner.plan(placo.HumanoidRobot_Side.left, *feet)
        supports = placo.FootstepsPlanner.make_supports(steps, 0.0, True, p.has_double_support(), True)
        generator = placo.WalkPatternGenerator(body, p)
        times = []
        for _ in range(100):
            begun = time.process_time()
            walk = generator.plan(supports, body.com_world(), 0.0)
            times.append(1e6 * (time.process_time() - begun))
        times.sort()
        what = f"{len(list(steps))} footsteps, {walk.t_end:.1f} s, {timesteps} time steps per single support"
        print(f"{what:58} {statistics.median(times):8.0f} us {times[98]:8.0f} us")
    print(
        "\nThe problems differ. placo: one mass at constant height, jerk constant within a time step, a quadratic programme\n"
        "that weighs jerk and zero-moment point and holds the latter in every support polygon as inequalities; the walk begins\n"
        "and ends standing; feet only as cubic swings; called from Python (a few microseconds). Ours: three masses, height by\n"
        "quintics, linear equations for the centre of gravity (inequalities in the reference only, modifications checked\n"
        "after), two steps from the running motion, a periodic gait and the way to rest; times of whole plans are those of\n"
        "the planner's cycle, with footholds, both feet, torso and load factors."
    )


main()
