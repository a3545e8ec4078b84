"""The devices of this machine, and a machine without any."""
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
