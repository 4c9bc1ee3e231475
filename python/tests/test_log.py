"""The log reader gives what was written, with names, units and times."""

import pathlib
import tempfile
import unittest

import numpy as np
from places import METHODS, rng, same, scene

import gangwerk


class Reader(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory()
        path = scene(pathlib.Path(cls.place.name) / "walk.toml", rng(21), METHODS[0], 4.0)
        chain = gangwerk.Chain(str(path))
        cls.file = pathlib.Path(cls.place.name) / "walk.mcap"
        chain.log(cls.file)
        cls.seen = chain.trace([name for name, _, _ in chain.fields()])
        cls.told = chain.events()
        chain.end_log()
        cls.chain, cls.log = chain, gangwerk.Log(cls.file)

    @classmethod
    def tearDownClass(cls):
        cls.place.cleanup()

    def test_every_field_of_every_topic_is_what_the_chain_had(self):
        for topic in ("sensors", "controller_state", "joint_targets", "sim_state", "power"):
            read = self.log.read(topic)
            seen = {name.split(".", 1)[1]: array for name, array in self.seen.items() if name.startswith(topic + ".")}
            seen.pop("time", None)
            # The first writer of a topic, which only the log names.
            seen["header.epoch"] = np.ones_like(seen["header.epoch"])
            np.testing.assert_array_equal(read.pop("time"), self.seen["time"])
            self.assertIsNone(same(read, seen), topic)
            self.assertEqual(self.log.units(topic).keys() - {"time"}, read.keys())

    def test_windows_and_chosen_fields(self):
        random = rng(22)
        times = self.log.read("sensors", ["joint_angle"])["time"]
        for _ in range(10):
            begin, end = np.sort(random.uniform(0, 4, 2))
            read = self.log.read("sensors", ["joint_angle", "imu.rate"] if "imu.rate" in self.log.units("sensors") else ["joint_angle"], begin=begin, end=end)
            inside = (times >= begin) & (times < end)
            np.testing.assert_array_equal(read["time"], times[inside])
            np.testing.assert_array_equal(read["joint_angle"], self.seen["sensors.joint_angle"][inside])
            self.assertEqual(read["joint_angle"].shape[1], len(self.log.joint_names))
        self.assertEqual(len(self.log.read("plan", ["id"], begin=4.0)["id"]), 0)

    def test_what_it_says_of_itself(self):
        log = self.log
        self.assertEqual((log.robot, log.scene, log.cycle, log.joint_names), ("lola", "walk", 1e-3, self.chain.joint_names))
        self.assertEqual((log.topics()["sensors"], log.topics()["plan"] > 1), (4000, True))
        self.assertEqual(log.units("sensors")["joint_angle"], "rad")
        self.assertEqual(log.units("sim_state")["foot_wrench.moment"], "N m")
        codes = log.read("events/planner", ["code"])["code"]
        planner = [event for event in self.told if event.process == "planner"]
        self.assertEqual(len(codes), len(planner) + 2, "with begin and end")
        self.assertIn("<robot", log.urdf)
        with self.assertRaisesRegex(ValueError, "topic `sensor`; did you mean sensors"):
            log.read("sensor")
        with self.assertRaisesRegex(ValueError, "field `joint_angel`; did you mean joint_angle"):
            log.read("sensors", ["joint_angel"])
        with self.assertRaisesRegex(ValueError, r"end = 1: must be a number in \[2, "):
            log.read("sensors", begin=2, end=1)

    def test_a_cut_log_is_read_to_its_end(self):
        cut = self.file.with_name("cut.mcap")
        bytes_ = self.file.read_bytes()
        cut.write_bytes(bytes_[: len(bytes_) // 2])
        read = gangwerk.Log(cut).read("sensors", ["joint_angle"])["joint_angle"]
        self.assertTrue(0 < len(read) < 4000)
        np.testing.assert_array_equal(read, self.seen["sensors.joint_angle"][: len(read)])
        # Damage is named, and nothing ends the interpreter.
        random = rng(23)
        for _ in range(20):
            broken = bytearray(bytes_)
            for at in random.integers(0, len(broken), 20):
                broken[at] ^= int(random.integers(1, 256))
            cut.write_bytes(broken)
            try:
                gangwerk.Log(cut).read("sensors")
            except ValueError as error:
                self.assertIn("cut.mcap", str(error))


if __name__ == "__main__":
    unittest.main()
