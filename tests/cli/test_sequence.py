"""`pellucid sequence`: frames, keys, what is left after kills, failures, and array jobs by Slurm and without it."""
import json
import os
import random
import shutil
import signal
import socket
import subprocess
import time
import unittest
from pathlib import Path

import cli
from cli import BINARY, CliTest

DATA = Path(os.environ.get("PELLUCID_TEST_DATA", "/nonexistent"))
TURN = ("--camera-at", "0=orbit:0,15,4", "--camera-at", "59=orbit:354,15,4")
SMALL = ("--size", "24x24", "--technique", "one-interface")


def frames(numbers):
    return [f"f-{number:03}.png" for number in numbers]


class SequenceTest(CliTest):
    def sequence(self, *arguments, scene="shape:cube", output="f-###.png", **options):
        return self.run_cli("sequence", scene, "-o", output, *SMALL, *arguments, **options)

    def pictures(self):
        return [name for name in self.files() if name.endswith(".png")]

    def contents(self, folder="."):
        return {path.name: path.read_bytes() for path in Path(self.path(folder)).glob("*.png")}

    def assert_done(self, result):
        self.assertEqual((result.returncode, result.stderr), (0, ""))


class SequenceCliTests(SequenceTest):
    def test_camera(self):
        """Frames are what `render` shows from the camera between the keys."""
        self.assert_done(self.sequence("--camera-at", "0=orbit:0,15,4", "--camera-at", "4=orbit:40,15,4"))
        self.assertEqual(self.pictures(), frames(range(5)))
        self.assert_rendered(self.render("shape:cube", *SMALL, "--camera", "orbit:20,15,4", size="24x24"))
        self.assertEqual(self.read("f-002.png"), self.read("out.png"))
        self.assertEqual(len(set(self.contents().values())), 5)

    def test_light(self):
        keys = ("--light-at", "0=lamp:2,0,2,20", "--light-at", "2=lamp:-2,0,2,20")
        self.write("a.obj", cli.TETRAHEDRON)
        opaque = ("--translucent", "0.5,0.5,0.5,1")
        self.assert_done(self.sequence(*keys, *opaque, scene="a.obj"))
        self.assert_rendered(self.render("a.obj", *SMALL, *opaque, "--add-light", "lamp:0,0,2,20", size="24x24"))
        self.assertEqual(self.read("f-001.png"), self.read("out.png"))
        self.assertEqual(len(set(self.contents("."))), 4)

    def test_animation(self):
        model = DATA / "gltf-samples/AnimatedMorphCube.glb"
        found = sorted(DATA.glob("**/AnimatedMorphCube*.gl[bt]*")) if DATA.is_dir() else []
        model = model if model.exists() else (found[0] if found else None)
        if not model:
            self.skipTest("AnimatedMorphCube is not in PELLUCID_TEST_DATA")
        self.assert_done(self.sequence("--quiet", "--fps", "2", "--camera", "orbit:20,15,4", scene=str(model)))
        self.assertEqual(self.pictures(), frames(range(9)), "4.2 s, 2 per second")
        self.assertGreater(len(set(self.contents().values())), 4)
        self.assert_rendered(self.render(str(model), *SMALL, "--quiet", "--time", "0", "--camera", "orbit:20,15,4", size="24x24"))
        self.assertEqual(self.read("f-000.png"), self.read("out.png"))

    def test_what_is_there_stays(self):
        turn = (*TURN, "--frames", "3,5..6")
        self.assert_done(self.sequence(*turn))
        self.assertEqual(self.pictures(), frames([3, 5, 6]))
        before = self.contents()
        os.remove(self.path("f-005.png"))
        self.write("f-003.png", "kept")
        result = self.sequence(*turn)
        self.assert_done(result)
        self.assertEqual(result.stdout, "3 frames: 1 rendered, 2 were there\n")
        self.assertEqual(self.contents(), {**before, "f-003.png": b"kept"})

    def test_files_of_a_kill_are_removed(self):
        self.write(".f-000.part-99-0.png", "half")
        self.assert_done(self.sequence("--frames", "0"))
        self.assertEqual(self.files(), ["f-000.png", "f-sequence.json", "f-sequence.lock"])

    def test_aov(self):
        self.assert_done(self.sequence("--frames", "0..1", "--aov", "depth=d-#.exr"))
        self.assertEqual([name for name in self.files() if name.endswith(".exr")], ["d-0.exr", "d-1.exr"])

    def test_failures(self):
        os.makedirs(self.path("f-001.png"))
        result = self.sequence("--frames", "0..2")
        self.assertEqual(result.returncode, 4)
        self.assertEqual(result.stdout, "3 frames: 2 rendered, 0 were there\n")
        self.assertRegex(result.stderr, r"\Apellucid: 1 of 3 frames are missing: 1; frame 1: f-001.png: .*folder[^\n]*\n\Z")
        self.assertEqual(self.read("f-002.png")[1:4], b"PNG")
        gathered = self.sequence("--frames", "0..2", "--gather")
        self.assertEqual(gathered.returncode, 4)
        os.rmdir(self.path("f-001.png"))
        self.assert_done(self.sequence("--frames", "0..2"))
        self.assert_done(self.sequence("--frames", "0..2", "--gather"))
        self.write("f-002.png", "damaged")
        self.assertIn("f-002.png", self.sequence("--frames", "0..2", "--gather").stderr)

    def test_several_at_once_share_the_frames(self):
        command = [BINARY, "sequence", "shape:cube", "-o", "f-###.png", *SMALL, *TURN, "--frames", "0..19"]
        several = [subprocess.Popen(command, cwd=self.folder, stdout=subprocess.PIPE, text=True) for _ in range(3)]
        printed = [process.communicate(timeout=200)[0] for process in several]
        self.assertEqual([process.returncode for process in several], [0, 0, 0])
        self.assertEqual(self.pictures(), frames(range(20)))
        self.assertEqual(sum(int(text.split()[2]) for text in printed), 20, printed)

    def test_other_options_are_no_continuation(self):
        self.assert_done(self.sequence("--frames", "0"))
        self.assert_refused(self.sequence("--frames", "1", "--ior", "1.3"), "f-sequence.json", "other options")
        self.assert_done(self.sequence("--frames", "1", "--threads", "1"))

    def test_refused(self):
        for words, arguments in (("is not animated", ()), ("--frames: '3..1'", ("--frames", "3..1")),
                                 ("--camera-at: '0=2'", ("--camera-at", "0=2")), ("--fps", ("--frames", "0", "--fps", "0")),
                                 ("unknown technique", ("--frames", "0", "--technique", "x")),
                                 ("elevation", ("--camera-at", "0=orbit:0,95,4")), ("sun", ("--frames", "0", "--light-at", "0=star:1,2")),
                                 ("excludes", (*TURN, "--camera", "orbit:0,0,4"))):
            with self.subTest(arguments):
                self.assert_refused(self.sequence(*arguments), words)
        self.assert_refused(self.sequence("--frames", "0", output="f.png"), "should have one run of #")
        self.assert_refused(self.sequence("--frames", "0", output="no/f-#.png"), "there is no folder")
        self.assert_refused(self.sequence("--frames", "0", output="f-#.jpg"), ".png or .exr")
        self.assertEqual(self.files(), [])


class KilledSequences(SequenceTest):
    kills = 10

    def start(self, folder):
        os.makedirs(self.path(folder), exist_ok=True)
        return subprocess.Popen([BINARY, "sequence", "shape:goblet", "-o", "f-###.png", *SMALL, *TURN], cwd=self.path(folder),
                                stdout=subprocess.DEVNULL)

    def test_kills_leave_the_same_files(self):
        begin = time.monotonic()
        self.assertEqual(self.start("whole").wait(), 0)
        whole_s = time.monotonic() - begin
        whole = self.contents("whole")
        self.assertEqual(sorted(whole), frames(range(60)))
        kills = runs = 0
        moments = random.Random(24)
        while kills < self.kills:
            folder = f"killed{runs}"
            process = self.start(folder)
            try:
                process.wait(timeout=moments.uniform(0, whole_s))
                self.assertEqual(process.returncode, 0)
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGKILL)
                process.wait()
                kills += 1
                continue
            self.assertEqual(self.contents(folder), whole)
            runs += 1
        folder = f"killed{runs}"
        self.assertEqual(self.start(folder).wait(), 0)
        self.assertEqual(self.contents(folder), whole)
        self.assertEqual([name for name in os.listdir(self.path(folder)) if ".part-" in name], [])
        print(f"{kills} kills of {runs + 1} runs of 60 frames; a whole run takes {whole_s:.1f} s")


class SequencesKilledAHundredTimes(KilledSequences):
    kills = 100


class ArrayJobs(SequenceTest):
    def write_script(self, *arguments):
        result = self.sequence(*TURN, "--slurm", "job.sh", *arguments)
        self.assert_done(result)
        return result.stdout

    def run_tasks(self, command):
        return subprocess.run(["bash", "-c", command], cwd=self.folder, capture_output=True, text=True, timeout=250)

    def test_tasks_by_xargs(self):
        self.assertEqual(self.write_script("--tasks", "7", "--frames", "0..9,30"), "job.sh: 11 frames in 7 tasks\n")
        self.assertIn("#SBATCH --array=0-6\n", self.read("job.sh").decode())
        result = self.run_tasks("seq 0 6 | xargs -P 2 -I{} env SLURM_ARRAY_TASK_ID={} bash job.sh")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.pictures(), frames([*range(10), 30]))
        self.assert_done(self.sequence(*TURN, "--frames", "0..9,30", "--gather"))

    @unittest.skipUnless(shutil.which("parallel"), "GNU parallel is not installed")
    def test_frames_by_parallel(self):
        result = self.run_tasks(f"parallel -j 2 '{BINARY}' sequence shape:cube -o f-###.png {' '.join(SMALL + TURN)} --frames "
                                "{} ::: 0..1 2..3 4")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.pictures(), frames(range(5)))

    def test_script_has_what_is_missing(self):
        self.assert_done(self.sequence(*TURN, "--frames", "1..3"))
        self.assertEqual(self.write_script("--frames", "0..5"), "job.sh: 3 frames in 3 tasks\n")
        self.assertIn("frames=(\n    0\n    4\n    5\n)", self.read("job.sh").decode())
        os.remove(self.path("job.sh"))
        self.assertEqual(self.write_script("--frames", "1..3"), "no frame is missing; job.sh was not written\n")
        self.assertFalse(os.path.exists(self.path("job.sh")))

    def test_names_with_blanks(self):
        os.makedirs(self.path("it's here"))
        self.assert_done(self.sequence("--frames", "0..1", "--slurm", "a job.sh", output="it's here/f #.png"))
        result = self.run_tasks("for i in 0 1; do SLURM_ARRAY_TASK_ID=$i bash 'a job.sh' || exit; done")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual([name for name in self.files() if name.endswith(".png")], ["it's here/f 0.png", "it's here/f 1.png"])


class ThousandsOfTasks(SequenceTest):
    def test_tasks_that_fail(self):
        """Of 10,000 tasks 5% end early or not at all; what the next script has is what they left out."""
        self.write("program", "#!/bin/sh\nfor frames; do :; done\n"
                   "n=$((frames + $(wc -l < log)))\n"
                   "case $((n % 20)) in 0) exit 1 ;; esac\n"
                   "[ ! -e f-$frames.png ] && echo $frames >> log && : > f-$frames.png\n")
        os.chmod(self.path("program"), 0o755)
        self.write("log", "")
        command = ("--frames", "0..9999", "--tasks", "10000", "--slurm", "job.sh")
        rounds = 0
        while not (said := self.sequence(*command, output="f-#.png").stdout).startswith("no frame"):
            tasks = int(said.split()[-2])
            subprocess.run(["bash", "-c", f"seq 0 {tasks - 1} | shuf --random-source=job.sh | "
                            "PELLUCID=./program xargs -P 4 -I{} env SLURM_ARRAY_TASK_ID={} bash job.sh"], cwd=self.folder)
            rounds += 1
            self.assertLess(rounds, 20)
        made = sorted(int(line) for line in self.read("log").split())
        self.assertEqual(made, list(range(10000)))
        self.assertGreater(rounds, 1)


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


class Slurm(SequenceTest):
    """A Slurm of one node that the test starts itself, without munge and control groups."""

    def setUp(self):
        super().setUp()
        missing = [name for name in ("slurmctld", "slurmd", "sbatch", "sinfo") if not shutil.which(name)]
        if missing:
            self.skipTest(f"{', '.join(missing)} of slurm-wlm are not installed")
        if os.geteuid() != 0:
            self.skipTest("slurmd starts jobs as root only")
        host, root = socket.gethostname().split(".")[0], self.path("slurm")
        for name in ("state", "spool"):
            os.makedirs(os.path.join(root, name))
        self.write("slurm/slurm.conf", f"""
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={free_port()}
SlurmdPort={free_port()}
SlurmUser=root
AuthType=auth/none
CredType=cred/none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MpiDefault=none
ReturnToService=2
StateSaveLocation={root}/state
SlurmdSpoolDir={root}/spool
SlurmctldPidFile={root}/slurmctld.pid
SlurmdPidFile={root}/slurmd.pid
SlurmctldLogFile={root}/slurmctld.log
SlurmdLogFile={root}/slurmd.log
NodeName={host} NodeAddr=127.0.0.1 CPUs={os.cpu_count()} State=UNKNOWN
PartitionName=all Nodes={host} Default=YES State=UP
""")
        self.environment = {**os.environ, "SLURM_CONF": os.path.join(root, "slurm.conf")}
        for daemon in ("slurmctld", "slurmd"):
            process = subprocess.Popen([daemon, "-D"], env=self.environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
            self.addCleanup(process.wait)
            self.addCleanup(process.terminate)
        if not self.wait_for(lambda: self.slurm("sinfo", "-h", "-o", "%t").strip() == "idle", 60):
            logs = "".join(Path(root, f"{name}.log").read_text()[-600:] for name in ("slurmctld", "slurmd")
                           if Path(root, f"{name}.log").exists())
            self.skipTest(f"Slurm does not start here: {logs}")

    def slurm(self, *command):
        return subprocess.run(command, env=self.environment, cwd=self.folder, capture_output=True, text=True, timeout=60).stdout

    def wait_for(self, condition, seconds):
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end:
                return False
            time.sleep(0.3)
        return True

    def test_array_job(self):
        self.assert_done(self.sequence(*TURN, "--frames", "0..11", "--tasks", "4", "--slurm", "job.sh"))
        job = self.slurm("sbatch", "--parsable", "--output=log-%a", "job.sh").strip()
        self.assertRegex(job, r"\A\d+\Z")
        self.assertTrue(self.wait_for(lambda: not self.slurm("squeue", "-h").strip(), 200))
        logs = {name: self.read(name).decode() for name in self.files() if name.startswith("log-")}
        self.assertEqual(set(logs.values()), {"3 frames: 3 rendered, 0 were there\n"}, logs)
        self.assertEqual(len(logs), 4)
        self.assert_done(self.sequence(*TURN, "--frames", "0..11", "--gather"))
        # A task that is cancelled leaves frames to the next script.
        os.remove(self.path("f-004.png"))
        self.assertEqual(self.sequence(*TURN, "--frames", "0..11", "--gather").returncode, 4)
        self.assert_done(self.sequence(*TURN, "--frames", "0..11", "--slurm", "job.sh"))
        self.slurm("sbatch", "--wait", "--output=log-%a", "job.sh")
        self.assert_done(self.sequence(*TURN, "--frames", "0..11", "--gather"))


if __name__ == "__main__":
    cli.main()
