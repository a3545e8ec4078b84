"""The commands of README, docs and help run as they stand, with smaller pictures and fewer samples."""
import contextlib
import json
import math
import os
import re
import shlex
import struct
import sys
from pathlib import Path

import cli
from cli import CliTest

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", *sorted(ROOT.glob("docs/*.md"))]
DATA = Path(os.environ.get("PELLUCID_TEST_DATA", "/nonexistent"))

# What stands for something that the reader chooses, or needs a preparation of its own.
PLACEHOLDER = re.compile(r"\b[A-Z]{3,}\b|\b[NTLXB]\b|\[|\.\.\.|\$|=\"|limit\.exr|light-ball\.gltf")
# Their own tests run them at reduced size; they take minutes.
ELSEWHERE = {"experiment", "--suite"}
SMALL = {"render": {"--size": "24x24", "--samples": "2"},
         "compare": {"--size": "24x24", "--samples": "1", "--views": "1", "--truth-samples": "2"},
         "bench": {"--size": "24x24", "--frames": "1"},
         "sequence": {"--size": "24x24", "--samples": "1", "--frames": "0..1"},
         "dataset": {"--images": "0..0"},
         "thickness": {"--size": "24x24"},
         "volume": {"--resolution": "24"}}
OUTPUTS = {"-o", "--json", "--html", "--report", "--flip-map", "--aov"}


def words_of(command):
    """Without a comment, and what another program does next."""
    return shlex.split(re.split(r"\s#\s|&&", command)[0])


def commands_of_pages():
    """Page and words of every command in a block of code that names all that it needs."""
    for page in PAGES:
        for block in re.findall(r"^```(?:sh)?\n(.*?)^```", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL):
            for line in block.replace("\\\n", " ").splitlines():
                found = re.search(r"^(?:build/release/bin/)?pellucid (\S.*)", line)
                if found and not PLACEHOLDER.search(re.split(r"\s#\s", found[1])[0]):
                    yield page.name, words_of(found[1])


def ball(rings=12):
    """Wavefront OBJ of a closed ball."""
    lines = ["v 0 1 0", "v 0 -1 0"]
    for i in range(1, rings):
        for k in range(2 * rings):
            height, angle = math.pi * i / rings, math.pi * k / rings
            lines.append("v %g %g %g" % (math.sin(height) * math.cos(angle), math.cos(height), -math.sin(height) * math.sin(angle)))
    vertex = lambda i, k: 3 + (i - 1) * 2 * rings + k % (2 * rings)
    for k in range(2 * rings):
        lines.append(f"f 1 {vertex(1, k)} {vertex(1, k + 1)}")
        lines.append(f"f 2 {vertex(rings - 1, k + 1)} {vertex(rings - 1, k)}")
        for i in range(1, rings - 1):
            lines.append(f"f {vertex(i, k)} {vertex(i + 1, k)} {vertex(i + 1, k + 1)} {vertex(i, k + 1)}")
    return "\n".join(lines) + "\n"


def jumping_glb():
    """A glTF binary of a glass tetrahedron that moves up in an animation named "jump"."""
    corners, faces = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2]
    data = b"".join(struct.pack("<3f", *c) for c in corners) + struct.pack("<12I", *faces)
    data += struct.pack("<2f", 0, 1) + struct.pack("<6f", 0, 0, 0, 0, 1, 0)
    views = [(0, 48), (48, 48), (96, 8), (104, 24)]
    glass = {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_volume": {"thicknessFactor": 1}}
    root = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
            "materials": [{"extensions": glass}], "extensionsUsed": list(glass), "buffers": [{"byteLength": len(data)}],
            "bufferViews": [{"buffer": 0, "byteOffset": at, "byteLength": size} for at, size in views],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
                          {"bufferView": 1, "componentType": 5125, "count": 12, "type": "SCALAR"},
                          {"bufferView": 2, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
                          {"bufferView": 3, "componentType": 5126, "count": 2, "type": "VEC3"}],
            "animations": [{"name": "jump", "samplers": [{"input": 2, "output": 3}],
                            "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}]}
    text = json.dumps(root).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(data), 0x004E4942) + data
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def radiance_hdr(width=8, height=4):
    return b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (height, width) + bytes([128, 128, 128, 129]) * (width * height)


def reduced(words):
    """The command with pictures and samples of SMALL."""
    words = list(words)
    for option, value in SMALL.get(words[0], {}).items():
        if option in words:
            words[words.index(option) + 1] = value
        else:
            words += [option, value]
    return words


class Examples(CliTest):
    def provide(self, words):
        """Writes the files that a command reads and that are not there yet."""
        compared = words[0] == "difference"  # images of one size
        for before, word in zip([""] + words, words):
            if before in OUTPUTS or os.path.exists(self.path(word)) and not compared:
                continue
            os.makedirs(os.path.dirname(self.path(word)), exist_ok=True)
            model = "/" not in word and not word.endswith((".exr", ".png"))
            known = sorted(DATA.glob(f"**/{word}")) if model else []
            if word.startswith("scenes/"):
                self.made_scenes()
            elif known:
                os.symlink(known[0], self.path(word))
            elif word.endswith((".obj", ".ply")):
                self.write(word, ball())
            elif word.endswith(".glb"):
                self.write(word, jumping_glb())
            elif word == "recipe.json":
                self.write(word, json.dumps({"images": 2, "width": 24, "height": 24}))
            elif word.endswith(".hdr"):
                self.write(word, radiance_hdr())
            elif word.endswith((".exr", ".png")):
                aov = ["--aov", f"events={word}"] if word.startswith("events") else []
                output = "any.png" if aov else word
                self.assert_rendered(self.render("shape:sphere", *aov, output=output), word)
            elif word == "../models":
                os.makedirs(self.path(word), exist_ok=True)

    def made_scenes(self):
        sys.path.insert(0, str(ROOT / "tools"))
        from loading import load_tool

        with contextlib.redirect_stdout(None):
            load_tool("make_scenes").main([self.path("scenes")])

    def runs(self, where, words):
        cluster = words[0] == "sequence" and "--gather" in words  # of what jobs have drawn
        if ELSEWHERE & set(words) or cluster:
            return
        with self.subTest(where=where, command=" ".join(words)):
            for output in (words[i + 1].split("=")[-1] for i, word in enumerate(words[:-1]) if word in OUTPUTS):
                if os.path.dirname(output):
                    os.makedirs(self.path(os.path.dirname(output)), exist_ok=True)
            self.provide(words)
            result = self.run_cli(*reduced(words))
            if "VK_KHR_ray_query" not in result.stderr:  # which this device may lack
                self.assertEqual(result.returncode, 0, result.stderr)
            self.assertNotIn(".part-", " ".join(self.files()))

    def test_pages(self):
        commands = list(commands_of_pages())
        self.assertGreater(len(commands), 15)
        for page, words in commands:
            self.runs(page, words)

    def test_help(self):
        table = json.loads(self.run_cli("help", "--json").stdout)
        for command in table["commands"]:
            text = self.run_cli(command["name"], "--help").stdout
            for line in text.split("\nExamples:\n")[1].splitlines():
                self.runs(command["name"], words_of(line)[1:])


if __name__ == "__main__":
    cli.main()
