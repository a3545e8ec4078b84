"""The viewer in a window of an X server, as its users meet it. Skipped where there is no Xvfb.

The script of a test and the test wait for each other by files: `wait file NAME` and `mark NAME`.
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

VIEWER = os.environ.get("PELLUCID_VIEWER", "pellucid-view")
RENDER = os.environ.get("PELLUCID_BINARY", "pellucid")
X_CLIENT = os.environ.get("PELLUCID_X_CLIENT", "x_client")
SKIPPED = 77  # exit code for "nothing could be tested", as viewer.cmake tells ctest
PATIENCE_S = 120

# Of the keyboard of Xvfb (evdev)
KEY_ESCAPE, KEY_TAB, KEY_W, KEY_CTRL, KEY_D, KEY_Z, KEY_V, KEY_F1 = 9, 23, 25, 37, 40, 52, 55, 67


def start_server():
    """Xvfb on a display of its own choice: the process and the display."""
    read, write = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x800x24", "-nolisten", "tcp"],
                              pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    os.close(write)
    with os.fdopen(read) as file:
        number = file.readline().strip()
    if not number:
        server.wait()
        raise unittest.SkipTest("Xvfb did not start")
    return server, f":{number}"


class ViewerTest(unittest.TestCase):
    """Each test has a folder and an X server of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="pellucid-view-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        server, display = start_server()
        self.addCleanup(server.wait)
        self.addCleanup(server.terminate)
        self.environment = dict(os.environ, DISPLAY=display, XDG_STATE_HOME=self.path("state"))
        self.environment.pop("WAYLAND_DISPLAY", None)

    def path(self, name):
        return os.path.join(self.folder, name)

    def read(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def start(self, *arguments, script=None):
        if script is not None:
            with open(self.path("script"), "w", encoding="utf-8") as file:
                file.write("\n".join(script) + "\n")
            arguments = [*arguments, "--script", "script"]
        viewer = subprocess.Popen([VIEWER, *arguments], cwd=self.folder, env=self.environment, stdin=subprocess.DEVNULL,
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(viewer.communicate)
        self.addCleanup(viewer.kill)
        return viewer

    def run_viewer(self, *arguments, script=None, code=0):
        viewer = self.start(*arguments, script=script)
        out, err = viewer.communicate(timeout=5 * PATIENCE_S)
        self.assertEqual(viewer.returncode, code, err)
        return out + err

    def run_script(self, *script, scene="shape:goblet", size="320x200"):
        return self.run_viewer(scene, "--size", size, "--validate", "--technique", "fast", "--samples", "2", script=script)

    def wait_for(self, viewer, name):
        end = time.monotonic() + PATIENCE_S
        while not os.path.exists(self.path(name)):
            self.assertIsNone(viewer.poll(), "the viewer has ended")
            self.assertLess(time.monotonic(), end, f"no {name}")
            time.sleep(0.02)

    def x_client(self, *arguments):
        subprocess.run([X_CLIENT, *arguments], cwd=self.folder, env=self.environment, check=True)

    def mark(self, name):
        with open(self.path(name), "w", encoding="utf-8"):
            pass

    def report(self, name):
        return json.loads(self.read(name))


class TestWindow(ViewerTest):
    def test_the_window_shows_what_the_screenshot_has(self):
        viewer = self.start("shape:goblet", "--size", "400x240", "--technique", "fast", "--samples", "2",
                            script=["wait still", "screenshot shot.png", "mark ready", "wait file seen"])
        self.wait_for(viewer, "ready")
        self.x_client("capture", "Pellucid", "window.png")
        self.mark("seen")
        viewer.communicate(timeout=PATIENCE_S)
        self.assertEqual(viewer.returncode, 0)
        self.assertEqual(self.read("window.png"), self.read("shot.png"))

    def test_a_drag_turns_the_camera_and_keys_undo_it(self):
        script = ["wait still", "save before.png", "command before", "mark ready",
                  "wait file dragged", "wait still", "save turned.png", "command turned", "mark next",
                  "wait file undone", "wait still", "save after.png", "command after"]
        viewer = self.start("shape:goblet", "--size", "400x240", "--technique", "fast", "--samples", "2", "--no-panels",
                            script=script)
        self.wait_for(viewer, "ready")
        self.x_client("drag", "Pellucid", "300", "120", "200", "90")
        self.mark("dragged")
        self.wait_for(viewer, "next")
        self.x_client("keys", "Pellucid", str(KEY_CTRL), str(KEY_Z))
        self.mark("undone")
        _, err = viewer.communicate(timeout=PATIENCE_S)
        self.assertEqual(viewer.returncode, 0, err)
        self.assertNotEqual(self.read("before.png"), self.read("turned.png"))
        self.assertNotEqual(self.read("before"), self.read("turned"))
        self.assertEqual(self.read("before"), self.read("after"))
        self.assertEqual(self.read("before.png"), self.read("after.png"))

    def test_a_key_shows_the_help(self):
        script = ["wait still", "screenshot before.png", "mark ready", "wait file pressed", "screenshot after.png"]
        viewer = self.start("shape:goblet", "--size", "400x240", "--technique", "fast", "--samples", "1", script=script)
        self.wait_for(viewer, "ready")
        self.x_client("drag", "Pellucid", "390", "230", "391", "230")  # the pointer is in the window
        self.x_client("keys", "Pellucid", str(KEY_F1))
        self.mark("pressed")
        viewer.communicate(timeout=PATIENCE_S)
        self.assertEqual(viewer.returncode, 0)
        self.assertNotEqual(self.read("before.png"), self.read("after.png"))


class TestInput(ViewerTest):
    """Each act is one call of the X client; between two of them the viewer writes its command and what it shows."""

    def play(self, *acts, scene="shape:goblet", size="400x240", options=("--no-panels",), first=()):
        script = [*first, "wait still", "command command0", "screenshot shot0.png", "mark ready0"]
        for i in range(1, len(acts) + 1):
            script += [f"wait file acted{i}", "wait still", f"command command{i}", f"screenshot shot{i}.png", f"mark ready{i}"]
        viewer = self.start(scene, "--size", size, "--technique", "fast", "--samples", "1", *options, script=script)
        for i, act in enumerate(acts, 1):
            self.wait_for(viewer, f"ready{i - 1}")
            self.x_client(act[0], "Pellucid", *(str(word) for word in act[1:]))
            self.mark(f"acted{i}")
        _, err = viewer.communicate(timeout=PATIENCE_S)
        self.assertEqual(viewer.returncode, 0, err)
        return [self.read(f"command{i}").decode() for i in range(len(acts) + 1)]

    @staticmethod
    def orbit(command):
        """Azimuth, elevation, distance and, where it is not the centre, the target."""
        return [float(x) for x in command.split("orbit:")[1].split()[0].split(",")]

    def test_the_wheel_zooms(self):
        start, near, back = map(self.orbit, self.play(("wheel", 200, 120, 3), ("wheel", 200, 120, -3)))
        self.assertLess(near[2], 0.8 * start[2])
        self.assertAlmostEqual(back[2], start[2], places=3)

    def test_the_right_button_looks_around_and_the_middle_one_pans(self):
        start, looked, panned = map(self.orbit, self.play(("drag", 200, 120, 260, 120, 3), ("drag", 200, 120, 200, 90, 2)))
        self.assertNotEqual(start[0], looked[0])
        self.assertEqual(len(looked), 6)
        self.assertEqual(looked[:3], panned[:3])
        self.assertNotEqual(looked[3:], panned[3:])

    def test_keys_fly_as_long_as_they_are_held(self):
        start, forward, right, undone = self.play(("hold", KEY_W, 600), ("hold", KEY_D, 600), ("keys", KEY_CTRL, KEY_Z))
        self.assertNotEqual(start, forward)
        self.assertNotEqual(forward, right)
        self.assertEqual(undone, forward)  # one step of the history for each key

    def test_the_divider_is_dragged(self):
        acts = [("drag", 200, 120, 100, 120), ("keys", KEY_V), ("keys", KEY_V)]
        commands = self.play(*acts, first=["split one-interface 0.5"])
        self.assertEqual(commands[0], commands[1])  # the camera stays
        self.assertIn("right of the divider", commands[1])
        self.assertNotIn("right of the divider", commands[2])
        self.assertNotEqual(self.read("shot0.png"), self.read("shot1.png"))
        self.assertEqual(self.read("shot1.png"), self.read("shot3.png"))

    def test_a_number_of_a_material_is_dragged(self):
        acts = [("drag", 100, 366, 100, 366), ("drag", 100, 452, 130, 452), ("keys", KEY_CTRL, KEY_Z)]
        closed, opened, dragged, undone = self.play(*acts, size="500x480", options=())
        self.assertNotEqual(self.read("shot0.png"), self.read("shot1.png"))  # the section is open
        self.assertEqual(closed, opened)
        self.assertIn("--ior 1.65", dragged)
        self.assertEqual(undone, opened)

    def test_files_are_dropped_into_the_window(self):
        model = self.path("a cube 100%.obj")
        with open(model, "w", encoding="utf-8") as file:
            for i in range(8):
                file.write(f"v {i & 1} {i >> 1 & 1} {i >> 2}\n")
            for face in ("1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"):
                file.write(f"f {face}\n")
        broken = self.path("broken.obj")
        with open(broken, "w", encoding="utf-8") as file:
            file.write("v 1 2\nf 1 2 3\n")
        commands = self.play(("drop", model), ("drop", broken))
        self.assertIn("a cube 100%.obj", commands[1])
        self.assertEqual(commands[1], commands[2])
        self.assertNotEqual(self.read("shot1.png"), self.read("shot2.png"))  # the message

    def test_escape_cancels_loading(self):
        script = ["wait still", "open shape:sphere,segments=900", "mark ready", "wait still", "expect-no-message",
                  "report report.json"]
        viewer = self.start("shape:goblet", "--size", "300x200", "--technique", "fast", "--samples", "1", script=script)
        self.wait_for(viewer, "ready")
        self.x_client("keys", "Pellucid", str(KEY_ESCAPE))
        viewer.communicate(timeout=PATIENCE_S)
        self.assertEqual(viewer.returncode, 0)
        self.assertEqual(self.report("report.json")["scene"], "shape:goblet")


class TestScripts(ViewerTest):
    def test_a_broken_file_leaves_the_old_scene(self):
        with open(self.path("broken.obj"), "w", encoding="utf-8") as file:
            file.write("v 1 2\nf 1 2 3\n")
        self.run_script("wait still", "save before.png", "drop broken.obj", "expect-message broken.obj", "wait still",
                        "save after.png", "report report.json")
        self.assertEqual(self.read("before.png"), self.read("after.png"))
        self.assertEqual(self.report("report.json")["scene"], "shape:goblet")

    def test_what_is_being_loaded_can_be_cancelled(self):
        self.run_script("wait still", "save before.png", "open shape:sphere,segments=900", "screenshot loading.png", "cancel",
                        "wait still", "save after.png", "screenshot idle.png", "expect-no-message", "report report.json")
        self.assertEqual(self.report("report.json")["scene"], "shape:goblet")
        self.assertEqual(self.read("before.png"), self.read("after.png"))
        self.assertNotEqual(self.read("loading.png"), self.read("idle.png"))

    def test_an_environment_that_is_missing_leaves_the_old_one(self):
        self.run_script("environment sky", "wait still", "save before.png", "environment missing.hdr",
                        "expect-message missing.hdr", "wait still", "save after.png", "command command")
        self.assertEqual(self.read("before.png"), self.read("after.png"))
        self.assertIn(b"--environment sky", self.read("command"))

    def test_files_that_are_dropped_together(self):
        self.run_script("drop shape:gem shape:torus", "expect-no-message", "wait still", "report report.json")
        self.assertEqual(self.report("report.json")["scene"], "shape:torus")

    def test_the_smallest_window_and_back(self):
        self.run_script("wait still", "save before.png", "size 1x1", "wait still", "size 320x200", "wait still",
                        "save after.png")
        self.assertEqual(self.read("before.png"), self.read("after.png"))

    def test_minimise_and_restore(self):
        self.run_script("wait still", "minimize", "wait still", "restore", "wait still", "screenshot after.png")

    def test_it_closes_while_it_refines(self):
        self.run_script("samples 64", "wait frames 3", "close")

    def test_undo_and_redo(self):
        self.run_script("wait still", "command first", "technique exact", "wait still", "exposure 1", "wait still", "undo",
                        "undo", "command second", "redo", "redo", "command third")
        self.assertEqual(self.read("first"), self.read("second"))
        self.assertIn(b"--technique exact", self.read("third"))
        self.assertIn(b"--exposure 1", self.read("third"))

    def test_a_ray_and_a_divider(self):
        self.run_script("wait still", "screenshot before.png", "split exact 0.5", "wait still", "inspect 160 90",
                        "screenshot after.png")
        self.assertNotEqual(self.read("before.png"), self.read("after.png"))

    def test_materials_change_the_image(self):
        self.run_script("wait still", "save a.png", "material 0 ior 1.2", "wait still", "save b.png",
                        "material 0 attenuation-color 0.2 0.9 0.3", "material 0 attenuation-distance 0.1", "wait still",
                        "save c.png")
        self.assertNotEqual(self.read("a.png"), self.read("b.png"))
        self.assertNotEqual(self.read("b.png"), self.read("c.png"))

    def test_every_technique(self):
        err = self.run_viewer("shape:gem", "--technique", "?", code=2)
        names = [name for name in err.split("known: ")[1].strip().split(", ") if name]
        self.assertGreater(len(names), 8)
        # What the device lacks is said, and the next technique draws.
        lines = [line for name in names for line in (f"technique {name}", "wait still")]
        self.run_script(*lines, "technique fast", "wait still", "report report.json", scene="shape:sphere", size="96x64")
        self.assertEqual(self.report("report.json")["samples"], 2)

    def test_an_animation_plays(self):
        model = os.path.join(os.environ.get("PELLUCID_TEST_DATA", ""),
                             "gltf/AnimatedMorphCube/glTF-Binary/AnimatedMorphCube.glb")
        if not os.path.isfile(model):
            self.skipTest("no animated model in PELLUCID_TEST_DATA")
        self.run_script("wait still", "save rest.png", "animation 0", "time 0.7", "wait still", "save posed.png",
                        "play on", "wait frames 5", "play off", "animation off", "wait still", "save after.png",
                        scene=model)
        self.assertNotEqual(self.read("rest.png"), self.read("posed.png"))
        self.assertEqual(self.read("rest.png"), self.read("after.png"))

    def test_overlays(self):
        script = ["wait still", "screenshot none.png"]
        names = ("error", "status", "layers", "thickness", "caustic")
        for name in names:
            script += [f"overlay {name}", "wait still", f"screenshot {name}.png"]
        self.run_script(*script, "overlay off", "wait still", "screenshot again.png")
        self.assertEqual(len({self.read(f"{name}.png") for name in names}), len(names))
        self.assertEqual(self.read("none.png"), self.read("again.png"))

    def test_the_command_draws_the_image(self):
        self.run_viewer("shape:goblet", "--size", "200x120", "--technique", "fast", "--samples", "4", script=[
            "orbit 30 10", "pan 0.1 0.05", "zoom 1.3", "wait still", "save image-view.png", "command command"])
        words = self.read("command").decode().splitlines()[0].split()[1:]
        subprocess.run([RENDER, *words], cwd=self.folder, check=True, capture_output=True)
        self.assertEqual(self.read("image-view.png"), self.read("image.png"))


class TestUsage(ViewerTest):
    def test_bad_input_is_one_line(self):
        for arguments, words in ((["missing.obj"], "missing.obj"), (["shape:nothing"], "nothing"),
                                 (["--technique", "magic", "--fresh", "shape:gem"], "magic"),
                                 (["--size", "0x3"], "--size"), (["--script", "missing"], "missing"),
                                 (["--no-such"], "--no-such")):
            with self.subTest(arguments=arguments):
                err = self.run_viewer(*arguments, code=2)
                self.assertRegex(err, r"\Apellucid-view: [^\n]+\n\Z")
                self.assertIn(words, err)

    def test_no_display_is_one_line(self):
        del self.environment["DISPLAY"]
        err = self.run_viewer("shape:gem", code=2)
        self.assertRegex(err, r"\Apellucid-view: [^\n]*display[^\n]*\n\Z")

    def test_what_was_open_last_comes_back(self):
        viewer = self.start("shape:gem", "--size", "300x200", "--technique", "fast", "--samples", "1")
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            found = subprocess.run([X_CLIENT, "keys", "gem", str(KEY_TAB)], env=self.environment, capture_output=True)
            if found.returncode == 0:
                break
            time.sleep(0.1)
        viewer.terminate()
        viewer.communicate(timeout=PATIENCE_S)
        self.assertTrue(os.path.isfile(self.path("state/pellucid/viewer.json")))
        state = json.loads(self.read("state/pellucid/viewer.json"))
        self.assertEqual(state["scene"], "shape:gem")


def main():
    if shutil.which("Xvfb") is None:
        print("skipped: Xvfb is not installed")
        sys.exit(SKIPPED)
    program = unittest.main(module="__main__", exit=False, verbosity=2)
    if not program.result.wasSuccessful():
        sys.exit(1)
    if program.result.testsRun == len(program.result.skipped):
        sys.exit(SKIPPED)


if __name__ == "__main__":
    main()
