"""The command line as its users meet it: every test runs the program of $PELLUCID_BINARY."""
import os
import subprocess
import sys
import tempfile
import unittest

BINARY = os.environ.get("PELLUCID_BINARY", "pellucid")
SKIPPED = 77  # exit code for "nothing could be tested", as tests/cli/CMakeLists.txt tells ctest

TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"


class CliTest(unittest.TestCase):
    """Each test has a folder of its own, in which the program runs."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="pellucid-cli-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, content):
        with open(self.path(name), "wb") as file:
            file.write(content.encode() if isinstance(content, str) else content)
        return name

    def read(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def files(self):
        return sorted(os.path.relpath(os.path.join(folder, file), self.folder)
                      for folder, _, names in os.walk(self.folder) for file in names)

    def run_cli(self, *arguments, **options):
        return subprocess.run([BINARY, *arguments], cwd=self.folder, stdin=subprocess.DEVNULL,
                              capture_output="stderr" not in options, text=True, errors="replace", timeout=250, **options)

    def render(self, scene, *arguments, output="out.png", size="16x16", **options):
        # A message of the validation layer ends in exit code 1.
        return self.run_cli("render", scene, "-o", output, "--size", size, "--validate", *arguments, **options)

    def assert_rendered(self, result, *files):
        self.assertEqual(result.returncode, 0, result.stderr)
        for file in files or ("out.png",):
            self.assertTrue(os.path.isfile(self.path(file)), file)
        for file in self.files():
            self.assertNotIn(".part-", file)

    def assert_refused(self, result, *words, code=2):
        """One line on stderr with all of `words`, nothing on stdout, and the exit code."""
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertRegex(result.stderr, r"\Apellucid: [^\n]+\n\Z")
        for word in words:
            self.assertIn(word, result.stderr)

    def refuses(self, words, *arguments, scene="shape:sphere", **options):
        """`render` refuses, and leaves no file behind."""
        words = [words] if isinstance(words, str) else words
        before = self.files()
        with self.subTest(scene=scene, arguments=arguments, **options):
            self.assert_refused(self.render(scene, *arguments, **options), *words)
            self.assertEqual(self.files(), before)

    def known_names(self, *arguments):
        """The names that the error about an unknown one lists."""
        message = self.render("shape:sphere", *arguments).stderr
        self.assertIn("known: ", message)
        return message.split("known: ")[1].strip().split(", ")


def main():
    program = unittest.main(module="__main__", exit=False, verbosity=2)
    result = program.result
    if not result.wasSuccessful():
        sys.exit(1)
    sys.exit(SKIPPED if result.testsRun and len(result.skipped) == result.testsRun else 0)
