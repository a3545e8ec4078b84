"""The devices of this machine, and a machine without any."""
import json
import os

import cli
from cli import CliTest


class Devices(CliTest):
    def test_info(self):
        result = self.run_cli("info")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertRegex(result.stdout, r"(?m)^0: .+ \(\w+, Vulkan 1\.\d+")
        default = result.stdout.split("default: ")[1].strip()
        self.assert_rendered(self.render("shape:sphere", "--device", default.upper()))
        self.assert_rendered(self.render("shape:sphere", "--device", default[:5]))

    def test_unknown(self):
        self.refuses(["999", "found: 0 ("], "--device", "999")


class MeasuredPresets(CliTest):
    """A preset stands for the fastest of its techniques, as was measured once on the device."""

    def drawn(self):
        environment = {**os.environ, "PELLUCID_CACHE_DIR": self.path("cache")}
        self.assert_rendered(self.render("shape:sphere", "--technique", "balanced", "--json", "out.json", env=environment))
        return json.loads(self.read("out.json"))

    def kept(self):
        return json.loads(self.read("cache/presets.json"))

    def test_the_fastest_is_taken(self):
        drawn = self.drawn()
        if "because" not in drawn:
            self.skipTest("the device offers one technique for the preset")
        (device, times), = self.kept().items()
        self.assertIn(drawn["device"], device)
        self.assertEqual(min(times, key=times.get), drawn["stands_for"])
        slowest = max(times, key=times.get)
        self.assertIn(slowest, drawn["because"])
        # What is kept is believed, and not measured again.
        self.write("cache/presets.json", json.dumps({device: times | {slowest: 0.001}, "another": 1}))
        self.assertEqual(self.drawn()["stands_for"], slowest)
        self.assertEqual(self.kept()["another"], 1)

    def test_damaged_files_are_written_anew(self):
        drawn = self.drawn()
        if "because" not in drawn:
            self.skipTest("the device offers one technique for the preset")
        (device, times), = self.kept().items()
        for damaged in ("{", "[]", "", json.dumps({device: 3}), json.dumps({device: {name: "fast" for name in times}})):
            self.write("cache/presets.json", damaged)
            with self.subTest(damaged):
                self.drawn()
                self.assertEqual(set(self.kept()[device]), set(times))
                self.assertTrue(all(time > 0 for time in self.kept()[device].values()))


class NoDevice(CliTest):
    """A Vulkan loader that finds no driver: exit code 3."""

    def without_driver(self, driver, *arguments):
        # Loaders before 1.3.207 know only the second name.
        environment = {**os.environ, "VK_DRIVER_FILES": driver, "VK_ICD_FILENAMES": driver}
        return self.run_cli(*arguments, env=environment)

    def test_render(self):
        for driver in (self.path("nowhere.json"), self.path(self.write("empty.json", "")),
                       self.path(self.write("wrong.json", '{"file_format_version": "1.0.0", "ICD": {}}'))):
            before = self.files()
            with self.subTest(driver):
                self.assert_refused(self.without_driver(driver, "render", "shape:sphere", "-o", "out.png"), "Vulkan", code=3)
                self.assertEqual(self.files(), before)

    def test_info(self):
        result = self.without_driver(self.path("nowhere.json"), "info")
        self.assertEqual(result.returncode, 3)
        self.assertRegex(result.stderr, r"\Apellucid: [^\n]*Vulkan[^\n]*\n\Z")

    def test_bad_input_comes_first(self):
        result = self.without_driver(self.path("nowhere.json"), "render", "nowhere.obj", "-o", "out.png")
        self.assert_refused(result, "nowhere.obj")


if __name__ == "__main__":
    cli.main()
