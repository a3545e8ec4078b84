#!/usr/bin/env python3
"""test_manuals.py PELLUCID MANUALS: man pages and completions have every command and option, and shells can use them."""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

BINARY, MANUALS = sys.argv.pop(1), Path(sys.argv.pop(1)).resolve()
TABLE = json.loads(subprocess.run([BINARY, "help", "--json"], capture_output=True, text=True, check=True).stdout)
VIEWER = Path(BINARY).with_name("pellucid-view")
# Each option as a line of the table: program, command (or none) and name.
OPTIONS = [("pellucid", command["name"], name) for command in TABLE["commands"] for option in command["options"]
           for name in option["names"]]
if VIEWER.exists():
    described = json.loads(subprocess.run([VIEWER, "--help-json"], capture_output=True, text=True, check=True).stdout)
    OPTIONS += [("pellucid-view", "", name) for option in described["options"] for name in option["names"]]
PAGES = sorted((MANUALS / "man").iterdir())


def needs(program):
    return unittest.skipUnless(shutil.which(program), f"{program} is not installed")


class Manuals(unittest.TestCase):
    def test_pages_have_every_option(self):
        self.assertGreater(len(OPTIONS), 300)
        pages = {page.name: page.read_text(encoding="utf-8") for page in PAGES}
        for program, command, name in OPTIONS:
            page = pages[f"{program}-{command}.1" if command else f"{program}.1"]
            self.assertIn(f"\\fB{name}\\fR".replace("-", "\\-"), page, (command, name))
        for command in TABLE["commands"]:
            self.assertIn(f"pellucid\\-{command['name']} (1)", pages["pellucid.1"])
        for topic in TABLE["topics"]:
            self.assertIn(f"\n.SH {topic['name'].upper()}\n", pages["pellucid-topics.7"])
        for page in pages.values():
            self.assertIn(f'"pellucid {TABLE["version"]}"', page)

    @needs("man")
    def test_man_warns_of_nothing(self):
        for page in PAGES:
            result = subprocess.run(["man", "--warnings", "-E", "UTF-8", "-l", "-Tutf8", "-Z", page], capture_output=True, text=True,
                                    env={**os.environ, "LC_ALL": "C.UTF-8", "MANROFFSEQ": "", "MANWIDTH": "80"}, check=True)
            self.assertEqual(result.stderr, "", page.name)

    @needs("mandoc")
    def test_mandoc_warns_of_nothing(self):
        for page in PAGES:
            result = subprocess.run(["mandoc", "-Tlint", "-W", "warning", page], capture_output=True, text=True)
            self.assertEqual(result.stdout, "", page.name)


class Bash(unittest.TestCase):
    def complete(self, *words, program="pellucid", folder=None):
        """What Bash offers for the last of `words`, which it has taken apart at = and :."""
        script = (f'source "{MANUALS}/bash/{program}"; COMP_WORDS=({program} "$@"); COMP_CWORD=$#; '
                  f'_{program.replace("-", "_")}; printf "%s\\n" "${{COMPREPLY[@]}}"')
        result = subprocess.run(["bash", "-c", script, "bash", *words], capture_output=True, text=True, check=True, cwd=folder)
        self.assertEqual(result.stderr, "")
        return set(result.stdout.split())

    def test_every_option(self):
        for program in {program for program, _, _ in OPTIONS}:
            for command in {command for of, command, _ in OPTIONS if of == program}:
                names = {name for of, at, name in OPTIONS if (of, at) == (program, command)}
                self.assertEqual(self.complete(*([command] if command else []), "-", program=program), names)

    def test_commands_and_topics(self):
        commands = {command["name"] for command in TABLE["commands"]}
        self.assertEqual(self.complete(""), commands)
        self.assertEqual(self.complete("te"), {"techniques"})
        self.assertEqual(self.complete("help", ""), commands | {topic["name"] for topic in TABLE["topics"]})

    def test_values(self):
        self.assertEqual(self.complete("render", "--technique", "wang"), {"wang-2014"})
        self.assertEqual(self.complete("render", "--technique", "=", "wang"), {"wang-2014"})
        self.assertEqual(self.complete("render", "--technique", "="), self.complete("render", "--technique", ""))
        self.assertEqual(self.complete("render", "--tonemap", ""), {"none", "reinhard", "aces", "neutral", "krawczyk"})
        self.assertEqual(self.complete("render", "--mode", "lin"), {"linear"})
        self.assertEqual(self.complete("bench", "--suite", "th"), {"thesis"})
        self.assertIn("layers", self.complete("render", "--thickness-method", ""))
        self.assertIn("goblet", self.complete("render", "shape", ":", "go"))
        self.assertIn("smoke", self.complete("render", "volume", ":"))
        self.assertEqual(self.complete("render", "--size", ""), set())

    def test_files(self):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "model.glb").touch()
            (Path(folder) / "models").mkdir()
            self.assertEqual(self.complete("render", "mod", folder=folder), {"model.glb", "models"})
            self.assertEqual(self.complete("render", "-o", "mod", folder=folder), {"model.glb", "models"})
            self.assertEqual(self.complete("bench", "--models", "mod", folder=folder), {"models"})
            self.assertEqual(self.complete("render", "--environment", "", folder=folder),
                             {"studio", "checker", "sky", "uniform", "model.glb", "models"})


class OtherShells(unittest.TestCase):
    def test_every_option(self):
        for program, _, name in OPTIONS:
            self.assertIn(f"'{name}" if not name.startswith("--") else name, (MANUALS / f"zsh/_{program}").read_text())
            self.assertIn(f" -l {name[2:]} " if name.startswith("--") else f" -s {name[1:]} ",
                          (MANUALS / f"fish/{program}.fish").read_text())

    @needs("zsh")
    def test_zsh(self):
        for file in (MANUALS / "zsh").iterdir():
            subprocess.run(["zsh", "-n", file], check=True)
        # The function itself, with stand-ins for those of zsh that show what it finds.
        script = ("_arguments() { print -l -- $@ }; _describe() { print -l -- $names }; _files() { }; words=(pellucid \"$@\"); "
                  f"CURRENT=$#words; source {MANUALS}/zsh/_pellucid $words")
        offered = subprocess.run(["zsh", "-fc", script, "zsh", "render", "-"], capture_output=True, text=True, check=True).stdout
        self.assertRegex(offered, r"(?m)^--tonemap=\[.*\]:name:\(none reinhard aces neutral krawczyk\)$")
        offered = subprocess.run(["zsh", "-fc", script, "zsh", ""], capture_output=True, text=True, check=True).stdout
        for command in TABLE["commands"]:
            self.assertRegex(offered, rf"(?m)^{command['name']}:")

    @needs("fish")
    def test_fish(self):
        def offered(line):
            with tempfile.TemporaryDirectory() as home:
                result = subprocess.run(["fish", "--no-config", "-c", f"source {MANUALS}/fish/pellucid.fish; complete -C'{line}'"],
                                        capture_output=True, text=True, check=True, env={**os.environ, "HOME": home})
            self.assertEqual(result.stderr, "")
            return {row.split("\t")[0] for row in result.stdout.splitlines()}
        self.assertEqual(offered("pellucid te"), {"techniques"})
        self.assertLessEqual({name for _, command, name in OPTIONS if command == "render"}, offered("pellucid render --") | {"-h", "-o"})
        self.assertEqual(offered("pellucid render --tonemap n"), {"none", "neutral"})


if __name__ == "__main__":
    unittest.main()
