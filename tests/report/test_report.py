"""The page of a report in a headless Chromium, used as people use it: mouse, keyboard, finger, dark, narrow."""
import json
import os
import subprocess
import sys
import tempfile
import unittest

from browser import Browser, find_chromium

SKIPPED = 77  # exit code for "nothing could be tested", as CMakeLists.txt tells ctest

# All text that is seen, with its contrast (WCAG 2) against what is behind it.
CONTRASTS = """(() => {
  const numbers = (color) => color.match(/[\\d.]+/g).map(Number);
  const luminance = (color) => numbers(color).slice(0, 3).map((v) => v / 255)
      .map((v) => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
      .reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
  const background = (node) => {
    for (; node; node = node.parentElement) {
      const color = getComputedStyle(node).backgroundColor, alpha = numbers(color)[3];
      if (alpha === undefined || alpha > 0) return color;
    }
    return "rgb(255, 255, 255)";
  };
  const texts = [...document.body.querySelectorAll("*")].filter((node) => node.checkVisibility() &&
      node.tagName !== "STYLE" && [...node.childNodes].some((child) => child.nodeType === 3 && child.data.trim()));
  return texts.map((node) => {
    const style = getComputedStyle(node);
    const ink = luminance(node instanceof SVGElement ? style.fill : style.color), paper = luminance(background(node));
    return [node.textContent.trim().slice(0, 40), (Math.max(ink, paper) + 0.05) / (Math.min(ink, paper) + 0.05)];
  });
})()"""

# What reaches beyond the window's edges, outside the boxes that scroll by themselves.
BEYOND = """[...document.body.querySelectorAll("*")].filter((node) => {
  const box = node.getBoundingClientRect();
  return node.checkVisibility() && !node.closest(".scroll") && !node.closest("#split") && box.width > 0 &&
      (box.right > innerWidth + 0.5 || box.left < -0.5);
}).map((node) => node.outerHTML.slice(0, 80))"""


class ReportTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        chromium = find_chromium()
        if not chromium:
            raise unittest.SkipTest("there is no chromium on this machine")
        folder = tempfile.TemporaryDirectory(prefix="pellucid-report-")
        cls.addClassCleanup(folder.cleanup)
        subprocess.run([os.environ["PELLUCID_MAKE_REPORT"], folder.name], check=True)
        cls.page = os.path.join(folder.name, "index.html")
        cls.browser = Browser(chromium)
        cls.addClassCleanup(cls.browser.close)

    def setUp(self):
        self.open()

    def tearDown(self):
        self.assertEqual(self.browser.errors, [])

    def open(self, width=1280, **options):
        self.browser.show(width, **options)
        self.browser.open(self.page)
        self.settle()

    def settle(self):
        """Pictures are read, and frames drawn."""
        self.js("Promise.all([...document.images].filter((image) => image.src).map((image) => image.decode()))")
        self.js("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def js(self, expression):
        return self.browser.evaluate(expression)

    def text(self, selector):
        return self.js(f"document.querySelector({json.dumps(selector)}).textContent")

    def choose(self, select, index):
        self.js(f"""(() => {{ const select = document.getElementById({json.dumps(select)});
            select.selectedIndex = {index}; select.dispatchEvent(new Event("change")); }})()""")
        self.settle()

    def centre(self, selector):
        """Of an element that is scrolled into view, in CSS pixels of the window."""
        return self.js(f"""(() => {{ const node = document.querySelector({json.dumps(selector)});
            node.scrollIntoView({{block: "center", behavior: "instant"}}); const box = node.getBoundingClientRect();
            return [box.x + box.width / 2, box.y + box.height / 2, box.width, box.height]; }})()""")

    def click(self, selector):
        x, y, *_ = self.centre(selector)
        self.browser.mouse("mouseMoved", x, y)
        self.browser.mouse("mousePressed", x, y, held=True)
        self.browser.mouse("mouseReleased", x, y)

    def split(self):
        """Where the boundary is drawn, percent of the width, and what is said of it."""
        return self.js("""(() => { const frame = document.getElementById("split").getBoundingClientRect(),
            handle = document.getElementById("handle"), box = handle.getBoundingClientRect();
            return [100 * (box.x + box.width / 2 - frame.x) / frame.width, Number(handle.ariaValueNow)]; })()""")

    def assert_split(self, percent):
        drawn, said = self.split()
        self.assertAlmostEqual(drawn, percent, delta=0.6)
        self.assertEqual(said, round(percent))

    def column(self, table, index):
        return self.js(f"[...document.querySelectorAll('#{table} tbody tr')]"
                       f".map((row) => row.cells[{index}].textContent)")

    def heading(self, table, label):
        return self.js(f"[...document.querySelectorAll('#{table} th')].findIndex("
                       f"(heading) => heading.textContent === {json.dumps(label)})")


class Page(ReportTest):
    def test_names_are_text(self):
        body = self.text("body")
        for name in ("<img src=x onerror=alert(1)>.obj", "shape:\"knot\", 'tied' & \ufffd é", "<b>fast</b> & \"loose\"",
                     "a <i>device</i>", "pellucid compare 'a & b'"):
            self.assertIn(name, body)
        self.assertEqual(self.js("document.querySelectorAll('main img:not([id]), td b, svg b, dd i').length"), 0)

    def test_has_a_title_and_names_what_it_shows(self):
        self.assertIn("one-interface", self.js("document.title"))
        self.assertIn("2 techniques", self.text("#extent"))
        self.assertEqual(self.js("[...document.images].filter((image) => !image.alt).length"), 0)
        self.assertEqual(self.js("[...document.querySelectorAll('select')].filter((s) => !s.labels[0]).length"), 0)
        self.assertEqual(self.js("[...document.querySelectorAll('canvas')].filter((c) => !c.ariaLabel).length"), 0)

    def test_reads_only_the_pictures_on_show(self):
        self.assertEqual(self.js("[...document.images].filter((image) => image.naturalWidth === 96).length"), 2)
        read = self.js("performance.getEntriesByType('resource').map((entry) => entry.name)")
        self.assertLessEqual(len({name for name in read if "/pictures/" in name}), 3)

    def test_plots_the_frontier(self):
        self.assertEqual(self.js("document.querySelectorAll('#frontier .mean:not([fill=none])').length"), 4)
        self.assertEqual(self.js("document.querySelectorAll('#frontier .run').length"), 8)


class Pictures(ReportTest):
    def test_slider_by_keyboard(self):
        self.assert_split(50)
        self.js("document.getElementById('handle').focus()")
        for key, percent in (("ArrowRight", 51), ("ArrowUp", 52), ("ArrowLeft", 51), ("ArrowDown", 50), ("PageUp", 60),
                             ("Home", 0), ("ArrowLeft", 0), ("End", 100), ("ArrowRight", 100), ("PageDown", 90)):
            self.browser.press(key)
            self.assert_split(percent)
        self.browser.press("ArrowLeft", shift=True)
        self.assert_split(80)

    def test_slider_by_mouse(self):
        x, y, width, _ = self.centre("#split")
        self.browser.mouse("mousePressed", x - 0.3 * width, y, held=True)
        self.assert_split(20)
        self.browser.mouse("mouseMoved", x + 0.25 * width, y, held=True)
        self.assert_split(75)
        self.browser.mouse("mouseMoved", x + 3 * width, y, held=True)
        self.assert_split(100)
        self.browser.mouse("mouseReleased", x, y)
        self.browser.mouse("mouseMoved", x, y)
        self.assert_split(100)

    def test_slider_by_finger(self):
        self.open(width=360, touch=True)
        x, y, width, _ = self.centre("#split")
        self.browser.touch("touchStart", (x, y))
        for share in (0.1, 0.2, 0.3):
            self.browser.touch("touchMove", (x + share * width, y))
        self.settle()
        self.assert_split(80)
        self.browser.touch("touchEnd")
        self.open()

    def test_boundary_divides_the_pictures(self):
        # The left picture is clipped at the boundary: its clip follows.
        self.js("document.getElementById('handle').focus()")
        self.browser.press("Home")
        self.assertEqual(self.js("getComputedStyle(document.getElementById('left-picture')).clipPath"),
                         "inset(0px 100% 0px 0px)")

    def test_choices_change_the_pictures(self):
        def shown():
            return self.js("[...document.images].map((image) => image.getAttribute('src'))")
        for select, index in (("scene", 1), ("view", 1), ("right", 2), ("kind", 1)):
            before = shown()
            self.choose(select, index)
            self.assertNotEqual(shown(), before, select)
        self.assertIn("1°", self.text("#legend"))
        self.assertIn("not covered", self.text("#legend"))
        self.choose("kind", 2)  # FLIP, which this technique has not
        self.assertIn("no such map", self.text("#right-caption"))

    def test_worst_region(self):
        self.assertIn("32 × 32 pixels, 8 from the left and 20 from the top; mean error 180.00°", self.text("#worst-where"))
        self.assertEqual(self.js("""[...document.querySelectorAll('#crops canvas')].map((canvas) =>
            [canvas.width, canvas.height, getComputedStyle(canvas).imageRendering])"""), [[32, 32, "pixelated"]] * 2)
        place = self.js("""["left", "top", "width", "height"].map((side) =>
            parseFloat(document.getElementById("region").style[side]))""")
        for value, expected in zip(place, (8 / 96, 20 / 64, 32 / 96, 32 / 64)):
            self.assertAlmostEqual(value, 100 * expected, places=3)


class Tables(ReportTest):
    def test_sorts_by_mouse_and_keyboard(self):
        index = self.heading("runs-table", "Within 1° %")
        button = f"#runs-table th:nth-child({index + 1}) button"
        heading = f"document.querySelector('#runs-table th:nth-child({index + 1})').ariaSort"
        given = [float(value) for value in self.column("runs-table", index)]
        steps = [(lambda: self.click(button), "descending"), (lambda: self.browser.press("Enter", "\r"), "ascending"),
                 (lambda: self.browser.press(" ", " "), "descending")]
        for act, direction in steps:
            act()  # the button keeps the focus for the keys
            self.assertEqual(self.js(heading), direction)
            self.assertEqual([float(value) for value in self.column("runs-table", index)],
                             sorted(given, reverse=direction == "descending"))
        self.assertEqual(self.js("document.querySelectorAll('#runs-table th[aria-sort]').length"), 1)

    def test_what_is_missing_comes_last(self):
        index = self.heading("runs-table", "Frame ms")
        for _ in range(2):
            self.click(f"#runs-table th:nth-child({index + 1}) button")
            self.assertEqual(self.column("runs-table", index)[8:], ["–"] * 4)
            self.assertNotIn("–", self.column("runs-table", index)[:8])

    def test_filters(self):
        self.choose("filter-technique", 2)
        self.assertEqual(self.column("runs-table", 2), ["<b>fast</b> & \"loose\""] * 6)
        self.choose("filter-scene", 1)
        self.assertEqual(len(self.column("runs-table", 2)), 2)
        self.assertEqual(self.text("#runs-note"), "2 of 12 runs")
        self.choose("columns", 1)
        self.assertIn("missing layer", self.text("#runs-table thead"))

    def test_means(self):
        index = self.heading("means-table", "Within 1° %")
        self.assertEqual(self.column("means-table", index), ["40.50", "80.50"])
        self.assertEqual(self.js(f"document.querySelectorAll('#means-table tbody .best')[0].cellIndex"),
                         self.heading("means-table", "Frame ms"))

    def test_a_row_leads_to_its_pictures(self):
        self.click("#runs-table tbody tr:last-child button")
        self.settle()
        self.assertIn("a-scene-of-a-rather-long-name.glb, view 1, <b>fast</b>", self.js("document.images[0].alt"))
        self.assertEqual(self.js("document.activeElement.id"), "handle")


class Looks(ReportTest):
    def test_every_text_can_be_read_in_light_and_dark(self):
        shots = []
        for dark in (False, True):
            self.open(dark=dark)
            self.choose("kind", 1)
            contrasts = self.js(CONTRASTS)
            self.assertGreater(len(contrasts), 100)
            self.assertEqual([(text, ratio) for text, ratio in contrasts if ratio < 4.5], [], f"dark: {dark}")
            shots.append(self.browser.screenshot())
        self.assertNotEqual(*shots)

    def test_fits_every_window(self):
        for width in (320, 360, 600, 768, 1024, 1920):
            self.open(width=width)
            for kind in range(3):
                self.choose("kind", kind)
                self.assertEqual(self.js(BEYOND), [], f"{width} pixels")
                self.assertLessEqual(self.js("document.documentElement.scrollWidth"), width)

    def test_everything_is_reached_by_tab_and_shows_it(self):
        self.js("document.activeElement.blur()")
        reachable = self.js("[...document.querySelectorAll('a, select, button, [tabindex]')]"
                            ".filter((node) => node.checkVisibility()).length")
        seen = []
        for _ in range(reachable):
            self.browser.press("Tab")
            seen.append(self.js("""(() => { const node = document.activeElement, all = [...document.querySelectorAll("*")];
                const outline = (part) => getComputedStyle(node, part).outlineStyle;
                return [all.indexOf(node), outline() !== "none" || outline("::after") !== "none"]; })()"""))
        places = [place for place, _ in seen]
        self.assertEqual(places, sorted(set(places)), "tab order is the order on the page")
        self.assertTrue(all(outlined for _, outlined in seen))


def main():
    program = unittest.main(module="__main__", exit=False, verbosity=2)
    result = program.result
    if not result.wasSuccessful():
        sys.exit(1)
    sys.exit(SKIPPED if result.testsRun == 0 else 0)


if __name__ == "__main__":
    main()
