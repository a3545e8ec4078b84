"""What the command line says of itself: help, techniques, suggestions, names of values, --quiet and --verbose."""
import json
import os
import pty
import re
import subprocess
import threading
from pathlib import Path

import cli
from cli import BINARY, CliTest

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs/command-line.md"
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted(ROOT.glob("docs/*.md")), ROOT / "bench/README.md"]
SCREENS, LINES, COLUMNS = 2, 50, 100


def commands_of(page):
    """The words behind `pellucid`, of every command in a page's code."""
    text = page.read_text(encoding="utf-8")
    blocks = re.findall(r"^```(?:sh)?\n(.*?)^```", text, flags=re.MULTILINE | re.DOTALL)
    lines = [line for block in blocks for line in block.replace("\\\n", " ").splitlines()]
    lines += re.findall(r"`([^`]+)`", re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL))
    for line in lines:
        for command in re.findall(r"(?:^|[\s/])pellucid (\S[^#;]*)", line):
            yield command.translate(str.maketrans("[]|'()", "      ")).split()


class Help(CliTest):
    def table(self):
        result = self.run_cli("help", "--json")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return json.loads(result.stdout)

    def test_help_fits_two_screens(self):
        commands = [command["name"] for command in self.table()["commands"]]
        self.assertGreaterEqual(set(commands), {"render", "compare", "bench", "experiment", "difference", "thickness", "volume",
                                                "info", "techniques", "help"})
        programs = [[BINARY], *([BINARY, command] for command in commands)]
        viewer = os.path.join(os.path.dirname(BINARY), "pellucid-view")
        for program in [*programs, *([[viewer]] if os.path.exists(viewer) else [])]:
            with self.subTest(program):
                result = subprocess.run([*program, "--help"], capture_output=True, text=True, check=True)
                lines = result.stdout.splitlines()
                self.assertLessEqual(len(lines), SCREENS * LINES)
                self.assertEqual([line for line in lines if len(line) > COLUMNS], [])
                self.assertIn("\nExamples:\n  pellucid", result.stdout)
                examples = result.stdout.split("\nExamples:\n")[1].splitlines()
                self.assertEqual([line for line in examples if not line.startswith("  pellucid")], [])

    def test_topics(self):
        table = self.table()
        listed = self.run_cli("help").stdout
        for topic in table["topics"]:
            with self.subTest(topic["name"]):
                self.assertIn(f"\n  {topic['name']} ", listed)
                text = self.run_cli("help", topic["name"]).stdout
                self.assertEqual(" ".join(text.split()), " ".join(topic["text"].split()))
                self.assertEqual([line for line in text.splitlines() if len(line) > COLUMNS], [])
        # Each topic that a help text refers to is one.
        names = {topic["name"] for topic in table["topics"]}
        docs = [option["doc"] for command in table["commands"] for option in command["options"]]
        for listed in re.findall(r"\(help ([a-z, ]+?)(?:, pellucid \w+)?\)", " ".join(docs)):
            self.assertLessEqual(set(listed.split(", ")), names)

    def test_help_of_a_command(self):
        self.assertEqual(self.run_cli("help", "render").stdout, self.run_cli("render", "--help").stdout)
        self.assert_refused(self.run_cli("help", "camera"), "unknown topic 'camera' (did you mean cameras?)")

    def test_every_option_is_documented(self):
        page = DOCS.read_text(encoding="utf-8")
        for command, name in sorted(self.OLDER):
            self.assertTrue(f" (or `{name}`)" in page, f"{name} of {command}")
            page = page.replace(f" (or `{name}`)", "")
        parameters = {parameter["name"] for technique in json.loads(self.run_cli("techniques", "--json").stdout)["techniques"]
                      for parameter in technique["parameters"]}
        for command in self.table()["commands"]:
            self.assertIn(f"pellucid {command['name']}", page)
            for option in command["options"]:
                for name in option["names"]:
                    if name.removeprefix("--") not in parameters and (command["name"], name) not in self.OLDER:
                        self.assertTrue(re.search(rf"{name}(?![\w-])", page), f"{name} of {command['name']}")

    def test_commands_of_the_pages_have_options_that_exist(self):
        table = self.table()
        known = {command["name"]: {name for option in command["options"] for name in option["names"]}
                 for command in table["commands"]}
        known[None] = {name for option in table["program"]["options"] for name in option["names"]}
        found = 0
        for page in PAGES:
            for words in commands_of(page):
                with self.subTest(page=page.name, command=" ".join(words)):
                    command = words[0] if words[0] in known else None
                    self.assertTrue(command or words[0].startswith("-"), f"there is no command {words[0]}")
                    options = {word.split("=")[0] for word in words if re.match(r"-[a-z]$|--[a-z]", word)}
                    self.assertLessEqual(options, known[command])
                    found += 1
        self.assertGreater(found, 100)

    # Second names of options that other commands have for something else; scripts may give them.
    OLDER = {("thickness", "--layers"), ("thickness", "--light"), ("difference", "--map")}

    def test_same_options_mean_the_same(self):
        """An option has one kind of value, whatever command it stands in."""
        kinds = {}
        for command in self.table()["commands"]:
            for option in command["options"]:
                for name in option["names"]:
                    # Experiments and benchmarks count the frames that they time; sequences number theirs.
                    if (command["name"], name) in {*self.OLDER, ("sequence", "--frames")} or name == "--json":
                        continue
                    with self.subTest(command["name"]):
                        self.assertEqual(kinds.setdefault(name, option["value"]), option["value"], name)

    def test_starts_without_the_image_library(self):
        """The 240 libraries behind it take longer to load than --help takes."""
        self.assertNotIn("OpenImageIO", subprocess.run(["ldd", BINARY], capture_output=True, text=True, check=True).stdout)


class Techniques(CliTest):
    def described(self, *arguments):
        result = self.run_cli("techniques", *arguments, "--json")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return json.loads(result.stdout)

    def test_list(self):
        text = self.run_cli("techniques").stdout
        described = self.described()
        names = [each["name"] for key in ("presets", "techniques") for each in described[key]]
        self.assertEqual(names, self.known_names("--technique", "?"))
        for technique in described["techniques"]:
            self.assertRegex(text, rf"(?m)^  {technique['name']} ")
            if technique["source"]:
                self.assertIn(technique["source"]["authors"].split(",")[0], text)
        self.assertEqual([line for line in text.splitlines() if len(line) > COLUMNS], [])

    def test_one(self):
        for technique in self.described()["techniques"]:
            with self.subTest(technique["name"]):
                text = self.run_cli("techniques", technique["name"]).stdout
                self.assertEqual([line for line in text.splitlines() if len(line) > COLUMNS], [])
                text = " ".join(text.split())
                for parameter in technique["parameters"]:
                    names = {each["value"]: each["name"] for each in parameter["names"]}
                    default = names.get(parameter["default"], f"{parameter['default']:g}")
                    self.assertRegex(text, rf"--{parameter['name']} .*?default {re.escape(default)}\)")
                    for name in names.values():
                        self.assertRegex(text, rf" = {name}\b")
        only = self.described("wang-2014")
        self.assertEqual([(each["name"], each["source"]["year"]) for each in only["techniques"]], [("wang-2014", 2014)])
        self.assertEqual(only["presets"], [])
        only = self.described("fast")
        self.assertEqual((only["techniques"], [each["name"] for each in only["presets"]]), ([], ["fast"]))
        self.assertIn("a preset", self.run_cli("techniques", "fast").stdout)
        self.assert_refused(self.run_cli("techniques", "wang-2015"), "did you mean wang-2014?")

    def test_place_in_a_source(self):
        text = " ".join(self.run_cli("techniques").stdout.split())
        for place in ("1979, sections 2 and 4", "2005, section 3", "2007, sections 3, 4.1, 5.3", "2014, chapter 3"):
            self.assertIn(f", {place} ", text)
        self.assertNotRegex(text, r"sections? [^\d]")

    def test_choices_take_names(self):
        pictures, values = {}, {}
        for value in ("linear", "0", "refraction", "2"):
            self.assert_rendered(self.render("shape:sphere", "--technique", "kay-greenberg-1979", "--mode", value, "--json",
                                             "out.json"))
            drawn = json.loads(self.read("out.json"))
            pictures[value] = self.read("out.png")
            values[value] = drawn["parameters"]["mode"], drawn["parameter_names"]["mode"]
        self.assertEqual(values, {"linear": (0, "linear"), "0": (0, "linear"), "refraction": (2, "refraction"),
                                  "2": (2, "refraction")})
        self.assertEqual((pictures["linear"], pictures["refraction"]), (pictures["0"], pictures["2"]))
        self.assertNotEqual(pictures["linear"], pictures["refraction"])
        self.refuses(["--mode", "'refracton' (did you mean refraction?); known: linear, non-linear, refraction"], "--technique",
                     "kay-greenberg-1979", "--mode", "refracton")
        self.refuses("mode", "--technique", "kay-greenberg-1979", "--mode", "3")


class Suggestions(CliTest):
    """A name that is nearly right is refused with the one that was meant."""

    def test_names(self):
        self.assert_refused(self.run_cli("rendr"), "unknown command 'rendr' (did you mean render?)")
        for arguments, words in (
                (("--tecnique", "fast"), "unknown option '--tecnique' (did you mean --technique?)"),
                (("--stpes=3",), "unknown option '--stpes' (did you mean --steps?)"),
                (("--technique", "wang-204"), "unknown technique 'wang-204' (did you mean wang-2014?)"),
                (("--technique", "balancd"), "(did you mean balanced?)"),
                (("--aov", "normals=a.exr"), "unknown AOV 'normals' (did you mean normal?)"),
                (("--environment", "stduio"), "unknown environment 'stduio' (did you mean studio?)"),
                (("--tonemap", "neutrl"), "(did you mean neutral?)"),
                (("--view", "analisys"), "(did you mean analysis?)"),
                (("--thickness-method", "layrs"), "(did you mean layers?)")):
            self.refuses(words, *arguments)
        self.refuses("(did you mean goblet?)", scene="shape:gobelt")
        self.refuses("(did you mean tube?)", scene="shape:torus,tub=0.3")
        self.refuses("(did you mean smoke?)", scene="volume:smoek")
        self.assert_refused(self.run_cli("bench", "--suite", "quik"), "(did you mean quick?)")
        self.assert_refused(self.run_cli("experiment", "interface"), "(did you mean interfaces?)")

    def test_nothing_is_near(self):
        for arguments in (["--colour", "red"], ["--technique", "xylophone"]):
            result = self.render("shape:sphere", *arguments)
            self.assertNotIn("did you mean", result.stderr)


class Console(CliTest):
    def test_quiet(self):
        self.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        self.assertIn("warning", self.render("open.obj").stderr)
        quiet = self.render("open.obj", "--quiet")
        self.assert_rendered(quiet)
        self.assertEqual((quiet.stdout, quiet.stderr), ("", ""))
        self.assert_refused(self.render("nowhere.obj", "--quiet"), "nowhere.obj")
        table = self.run_cli("compare", "shape:cube", "--techniques", "one-interface", "--size", "8x8", "--views", "1",
                             "--truth", "reference", "--quiet")
        self.assertEqual((table.returncode, table.stdout, table.stderr), (0, "", ""))
        self.refuses("--quiet", "--quiet", "--verbose")

    def test_verbose(self):
        result = self.render("shape:sphere", "--verbose")
        self.assert_rendered(result)
        self.assertRegex(result.stderr, r"(?m)^pellucid: load shape:sphere: \d+\.\d\d s$")
        self.assertRegex(result.stderr, r"(?m)^pellucid: balanced: \d+\.\d\d s$")

    def test_progress_on_a_terminal_only(self):
        """Work of more than two seconds shows what is left, and the line is gone when it is done."""
        arguments = [BINARY, "render", "shape:sphere", "-o", "out.png", "--technique", "path", "--samples", "65536", "--size", "64x64"]
        ours, theirs = pty.openpty()
        said = bytearray()

        def read():
            try:
                while chunk := os.read(ours, 4096):
                    said.extend(chunk)
                    if b" left" in said:
                        process.terminate()
            except OSError:  # the other end is closed
                pass
        process = subprocess.Popen(arguments, cwd=self.folder, stderr=theirs, stdout=subprocess.DEVNULL)
        os.close(theirs)
        reader = threading.Thread(target=read)
        reader.start()
        process.wait(timeout=60)
        reader.join()
        os.close(ours)
        self.assertRegex(bytes(said), rb"path \[#*\.*\] \d+%, \d+ (s|min|h).* left")


if __name__ == "__main__":
    cli.main()
