"""Signals, full disks, read-only folders, devices that fail: one line, the exit code, and no half-written file."""
import json
import os
import resource
import shutil
import signal
import subprocess
import time
import unittest

import cli
from cli import BINARY, CliTest
from pictures import read_exr

FAILING_LAYER = os.environ.get("PELLUCID_FAILING_LAYER", "")


class Interrupted(CliTest):
    """SIGINT and SIGTERM: what is finished stays, as after a kill, and nothing else does."""

    def interrupt(self, number, ready, *arguments, may_be_done=False):
        def heed():  # whatever the shell that runs the tests ignores
            signal.signal(signal.SIGINT, signal.SIG_DFL)
        process = subprocess.Popen([BINARY, *arguments], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                   text=True, preexec_fn=heed)
        self.addCleanup(process.kill)
        while process.poll() is None and not ready():
            time.sleep(0.01)
        if process.poll() is not None and not may_be_done:
            self.fail(f"{arguments}: ended before the signal: {process.communicate()[1]}")
        process.send_signal(number)
        _, printed = process.communicate(timeout=100)
        if may_be_done and process.returncode == 0:
            return
        self.assertEqual(process.returncode, -number, printed)
        self.assertRegex(printed, r"pellucid: ended by [^\n]*; finished files stay\n\Z")
        self.assertEqual([name for name in self.files() if ".part-" in name], [])

    def test_while_a_file_is_written(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            self.interrupt(number, self.files, "render", "shape:sphere", "-o", "out.exr", "--size", "1500x1500", "--technique",
                           "one-interface", may_be_done=True)
            if self.files() == ["out.exr"]:  # the signal came too late: the file is whole
                read_exr(self.read("out.exr"))
                os.remove(self.path("out.exr"))
            self.assertEqual(self.files(), [])

    def test_frames_that_are_done_stay(self):
        self.interrupt(signal.SIGTERM, lambda: "f-0002.png" in self.files(), "sequence", "shape:sphere", "-o", "f-####.png",
                       "--size", "24x24", "--technique", "one-interface", "--frames", "0..9999")
        self.assertEqual(self.read("f-0001.png")[-8:-4], b"IEND")

    def test_commands_of_many_files(self):
        self.write("recipe.json", json.dumps({"images": 1000, "width": 32, "height": 32}))
        self.interrupt(signal.SIGINT, lambda: len(self.files()) > 1, "dataset", "recipe.json", "--folder", "data")
        for number, arguments in ((signal.SIGINT, ("bench", "shape:sphere", "--frames", "100000", "--size", "64x64", "--json", "out.json")),
                                  (signal.SIGTERM, ("experiment", "kay-greenberg-transparency", "--report", "report", "--size", "800x800"))):
            begin = time.monotonic()
            self.interrupt(number, lambda: time.monotonic() > begin + 1, *arguments)
            self.assertNotIn("out.json", self.files())

    def test_shells_see_the_code_of_the_convention(self):
        command = f"'{BINARY}' render shape:sphere -o out.png --samples 1000000 & sleep 1; kill -TERM $!; wait $!; echo $?"
        result = subprocess.run(["bash", "-c", command], cwd=self.folder, capture_output=True, text=True, timeout=100)
        self.assertEqual(result.stdout, "143\n")

    def test_ignored_signals_stay_ignored(self):
        result = subprocess.run(["bash", "-c", f"trap '' INT; '{BINARY}' render shape:sphere -o out.png --size 400x400 & "
                                 "sleep 0.3; kill -INT $!; wait $!; echo $?"],
                                cwd=self.folder, capture_output=True, text=True, timeout=100)
        self.assertEqual(result.stdout, "0\n", result.stderr)


class FullDisk(CliTest):
    def limited(self, *arguments):
        """As on a full disk: files cannot grow beyond 2000 bytes."""
        def limit():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))
        return self.run_cli(*arguments, restore_signals=False, preexec_fn=limit)

    def test_each_kind_of_file(self):
        self.write("out.png", "old")
        for output in ("out.png", "out.exr"):
            before = self.files()
            result = self.limited("render", "shape:goblet", "-o", output, "--size", "128x128")
            self.assert_refused(result, output)
            self.assertEqual(self.files(), before)
        self.assertEqual(self.read("out.png"), b"old")
        result = self.limited("export", "shape:goblet", "-o", "out.glb")
        self.assert_refused(result, "out.glb")
        self.assertEqual(self.files(), ["out.png"])

    @unittest.skipUnless(os.geteuid() == 0 and shutil.which("unshare"), "mounting a small file system needs root")
    def test_of_a_small_file_system(self):
        script = (f"mount -t tmpfs -o size=64k none '{self.folder}' && cd '{self.folder}' && '{BINARY}' sequence shape:goblet "
                  "-o f-##.exr --size 64x64 --technique one-interface --frames 0..9; echo $?; ls -A")
        result = subprocess.run(["unshare", "-m", "sh", "-c", script], capture_output=True, text=True, timeout=100)
        self.assertIn("f-", result.stderr)
        self.assertIn("cannot write", result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1)
        self.assertNotIn(".part-", result.stdout)
        self.assertIn("f-00.exr", result.stdout)
        self.assertIn("\n4\n", "\n" + result.stdout)

    @unittest.skipUnless(os.geteuid() == 0 and shutil.which("setpriv"), "another user is needed")
    def test_folders_of_others(self):
        os.chmod(self.folder, 0o755)
        result = subprocess.run(["setpriv", "--reuid=65534", "--clear-groups", BINARY, "render", "shape:sphere", "-o", "out.png",
                                 "--size", "16x16"], cwd=self.folder, capture_output=True, text=True, timeout=100,
                                env={**os.environ, "PELLUCID_CACHE_DIR": self.path("cache")})
        self.assert_refused(result, "out.png", "Permission denied")
        self.assertEqual(self.files(), [])


class SharedCache(CliTest):
    def test_by_processes_that_bake_at_once(self):
        environment = {**os.environ, "PELLUCID_CACHE_DIR": self.path("cache")}
        baking = [subprocess.Popen([BINARY, "render", "shape:knot", "-o", f"{i}.png", "--size", "32x32", "--technique",
                                    "wyman-2005"], cwd=self.folder, env=environment, stderr=subprocess.PIPE, text=True)
                  for i in range(4)]
        printed = [process.communicate(timeout=200)[1] for process in baking]
        self.assertEqual([process.returncode for process in baking], [0] * 4, printed)
        self.assertEqual(len({self.read(f"{i}.png") for i in range(4)}), 1)
        kept = [name for name in self.files() if name.startswith("cache/")]
        self.assertNotEqual(kept, [])
        self.assertEqual([name for name in kept if ".part-" in name], [])

    def test_damaged_files_are_made_again(self):
        environment = {**os.environ, "PELLUCID_CACHE_DIR": self.path("cache")}
        bake = ("render", "shape:knot", "-o", "out.png", "--size", "32x32", "--technique", "wyman-2005")
        self.assertEqual(self.run_cli(*bake, env=environment).returncode, 0)
        picture = self.read("out.png")
        for name in [name for name in self.files() if name.startswith("cache/")]:
            self.write(name, self.read(name)[:-5])
        result = self.run_cli(*bake, env=environment)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.read("out.png"), picture)


@unittest.skipUnless(FAILING_LAYER, "PELLUCID_FAILING_LAYER names no folder")
class FailingDevices(CliTest):
    def failing(self, **how):
        environment = {**os.environ, "VK_ADD_LAYER_PATH": FAILING_LAYER, "VK_INSTANCE_LAYERS": "VK_LAYER_PELLUCID_failing",
                       **{f"PELLUCID_{name}": str(value) for name, value in how.items()}}
        return self.render("shape:goblet", env=environment)

    def test_lost(self):
        for n in (1, 8, 12):
            self.assert_refused(self.failing(LOSE_DEVICE=n), "device was lost", "Start again", code=3)
            self.assertEqual(self.files(), [])

    def test_out_of_memory(self):
        for n in (1, 12, 30):
            self.assert_refused(self.failing(FAIL_ALLOCATIONS=n), "out of device memory", "smaller")
            self.assert_refused(self.failing(FAIL_OBJECTS=2 * n), "out of device memory", "smaller")
            self.assertEqual(self.files(), [])

    def test_layer_changes_nothing_else(self):
        self.assert_rendered(self.failing())


if __name__ == "__main__":
    cli.main()
