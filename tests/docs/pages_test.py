"""The pages that people look at, in Chromium without a window, made by an installed program: reports of eight kinds of run, a comparison and a study, wide and
narrow, light and dark. No error of a script, no missing glyph, no empty or clipped figure, no label on another; the drawn curve is that of the CSV file
within a pixel. Screenshots stay in BUILD/pages to be looked at.
Usage: pages_test.py BUILD [unittest's arguments]. Without Chromium it ends with code 77. SPDX-License-Identifier: Apache-2.0"""
import pathlib
import sys
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
sys.path[:0] = [str(ROOT / "tests/src/report"), str(ROOT / "tests/docs")]
sys.dont_write_bytecode = True

import browser
import installed
import synthetic_run

UNFOLD = "document.querySelectorAll('details').forEach(d => { d.open = true; })"
# Characters of the page that are drawn as U+0378 is, which no font has.
MISSING = """(() => {
  const canvas = document.createElement('canvas'); canvas.width = canvas.height = 64;
  const pen = canvas.getContext('2d', {willReadFrequently: true}), family = getComputedStyle(document.body).fontFamily;
  const drawn = c => { pen.clearRect(0, 0, 64, 64); pen.font = '32px ' + family; pen.fillText(c, 8, 44); return pen.getImageData(0, 0, 64, 64).data.join(); };
  const nothing = drawn('\\u0378'), words = document.body.textContent.replace(/\\s/g, '');
  return [...new Set(words)].filter(c => drawn(c) === nothing);
})()"""
# Of each picture: heading, place, labels with theirs, size of what an <img> holds.
FIGURES = """[...document.querySelectorAll('figure')].map(figure => {
  const box = r => [r.left + scrollX, r.top + scrollY, r.right + scrollX, r.bottom + scrollY], picture = figure.querySelector('svg, img');
  return {title: figure.querySelector('h3')?.textContent ?? 'picture', kind: picture.tagName, box: box(picture.getBoundingClientRect()), natural: picture.naturalWidth ?? 1, naturalHeight: picture.naturalHeight ?? 1,
          labels: [...picture.querySelectorAll('text')].map(t => [t.textContent, box(t.getBoundingClientRect())])};
})"""
# Text whose colour is too near to that of the page.
PALE = """(() => {
  const numbers = text => text.match(/[\\d.]+/g).map(Number);
  const light = c => { const [r, g, b] = c.slice(0, 3).map(v => v / 255).map(v => v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4); return 0.2126 * r + 0.7152 * g + 0.0722 * b; };
  const page = light(numbers(getComputedStyle(document.body).backgroundColor));
  return [...document.querySelectorAll('p, td, th, li, h1, h2, h3, dt, dd, figcaption, svg text')].filter(e => {
    const style = getComputedStyle(e), ink = light(numbers(e.tagName === 'text' ? (style.fill.startsWith('rgb') ? style.fill : style.color) : style.color));
    return (Math.max(ink, page) + 0.05) / (Math.min(ink, page) + 0.05) < 3.0; }).map(e => e.textContent.slice(0, 40));
})()"""
# Ticks of the first figure: [x of the page, y of the page, words].
TICKS = """[...document.querySelector('figure svg').querySelectorAll('text')].flatMap(text => {
  const tick = text.parentNode.parentNode, mark = tick.querySelector('use');
  if (!mark || tick.querySelectorAll('text').length > 1) return [];
  const r = mark.getBoundingClientRect();
  return [[r.left + scrollX, r.top + scrollY, r.width, r.height, text.textContent]];
})"""
SCENES = (("leble_barakos/case1_engineering.toml", ()), ("tutorials/own_turbine.toml", ("--until", 20)),
          ("validation/wave_tank/small_tank.toml", ("--until", 0.5, "--set", "sea.fields.interval_s=0.25")),
          ("validation/naca0012/family.toml", ("--set", "aero.flow.generate.refinement=1", "--set", "time.end_s=60.0")),
          ("leble_barakos/rotor_demo.toml", ("--set", "time.end_s=20.0", "--set", "aero.flow.drop=0.0")),
          ("leble_barakos/case3_demo.toml", ("--until", 1, "--set", "start.air_steps=30", "--set", "sea.fields.interval_s=0.5")),
          ("leble_barakos/case3_controlled.toml", ("--until", 20)), ("tutorials/pendulum.toml", ()))


def widened(mask, pixels):
    """The mask and all within so many pixels of it."""
    out, reach = mask.copy(), int(np.ceil(pixels))
    for dy in range(-reach, reach + 1):
        for dx in range(-reach, reach + 1):
            if dx * dx + dy * dy <= pixels * pixels:
                out |= np.roll(mask, (dy, dx), axis=(0, 1))
    return out


class Pages(installed.Prefix):
    build = BUILD

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.browser = browser.Browser()
        cls.addClassCleanup(cls.browser.close)

    def look_at(self, page):
        text = page.read_text(encoding="utf-8")
        self.assertNotRegex(text, r"\$\\?math|\ufffd|>nan<|>None<")
        self.assertNotRegex(text, r"https?://(?!www\.w3\.org)", "a page that needs a network")
        self.assertLess(len(text), 10 << 20)
        self.assertIn('class="headline"', text)
        for width, dark in ((1280, False), (1280, True), (420, False)):
            form = f"{page.parent.name}_{page.stem}_{'dark' if dark else 'light' if width > 1000 else 'narrow'}"
            with self.subTest(form):
                self.browser.open(page, width, dark)
                self.browser.screenshot(self.pages / f"{form}.png")
                self.browser.run(UNFOLD)
                self.browser.fit()
                pixels = self.browser.screenshot(self.pages / f"{form}_unfolded.png")
                self.assertEqual(self.browser.complaints, [])
                self.assertEqual(self.browser.run(MISSING), [], "glyphs that no font has")
                self.assertNotRegex(self.browser.run("document.querySelector('main').innerText"), r"<(svg|figure|p|div)\b|base64", "markup shown as text")
                self.assertEqual(self.browser.run(PALE), [], "text that hardly differs from the page")
                self.assertLessEqual(self.browser.run("document.documentElement.scrollWidth"), width, "cut off at the right")
                self.assertEqual(bool(pixels[0, 0].mean() < 0.5), dark)
                found = self.browser.run(FIGURES)
                self.assertTrue(found, "no figure")
                for figure in found:
                    self.look_at_figure(figure, pixels, width)
        with self.subTest(f"{page.parent.name} on paper"):
            self.look_at_print(page)

    def look_at_print(self, page):
        """On paper: white, without the navigation, nothing cut off at the right, folds closed."""
        self.browser.open(page, 794)
        self.browser.ask("Emulation.setEmulatedMedia", media="print", features=[{"name": "prefers-color-scheme", "value": "light"}])
        self.browser.fit()
        pixels = self.browser.screenshot(self.pages / f"{page.parent.name}_{page.stem}_print.png")
        self.browser.ask("Emulation.setEmulatedMedia", media="")
        self.assertGreater(pixels[0, 0].mean(), 0.95)
        self.assertEqual(self.browser.complaints, [])
        self.browser.ask("Emulation.setEmulatedMedia", media="print")
        self.assertEqual(self.browser.run("getComputedStyle(document.querySelector('nav')).display"), "none")
        self.assertLessEqual(self.browser.run("document.documentElement.scrollWidth"), 794, "cut off at the right")
        self.browser.ask("Emulation.setEmulatedMedia", media="")

    def look_at_figure(self, figure, pixels, width):
        title, (left, top, right, bottom) = figure["title"], figure["box"]
        self.assertGreater(min(right - left, bottom - top), 30, f"{title}: nothing of it is laid out")
        self.assertTrue(0 <= left and right <= width + 0.5, f"{title}: outside of the page")
        self.assertGreater(figure["natural"], 0, f"{title}: the picture cannot be read")
        left, top, right, bottom = int(left), int(top), int(np.ceil(right)), int(np.ceil(bottom))
        # What lies below the tallest screenshot has one of its own.
        part = pixels[top:bottom, left:right] if bottom <= len(pixels) else self.browser.part((left, top, right, bottom))
        paper = np.median(part.reshape(-1, 3), axis=0) if figure["kind"] == "img" else pixels[0, 0]
        inked = np.abs(part - paper).max(axis=2) > 0.1
        self.assertGreater(inked[8:-8, 8:-8].mean(), 0.004, f"{title}: empty")
        edges = ("left", inked[:, 0]), ("right", inked[:, -1]), ("top", inked[0]), ("bottom", inked[-1])
        if figure["kind"] == "img":
            wide, high = figure["natural"], figure["naturalHeight"]
            self.assertAlmostEqual((right - left) / (bottom - top), wide / high, delta=0.02 * wide / high, msg=f"{title}: stretched")
            if np.concatenate([edge for _, edge in edges]).mean() > 0.3:
                return   # a view that fills its frame
        for side, edge in edges:
            self.assertFalse(edge.any(), f"{title}: clipped at the {side}")
        for n, (words, a) in enumerate(figure["labels"]):
            self.assertTrue(left - 1 <= a[0] and a[2] <= right + 1 and top - 1 <= a[1] and a[3] <= bottom + 1, f"{title}: '{words}' is cut off")
            for other, b in figure["labels"][n + 1:]:
                wide, high = min(a[2], b[2]) - max(a[0], b[0]), min(a[3], b[3]) - max(a[1], b[1])
                self.assertFalse(wide > 1.0 and high > 3.0, f"{title}: '{words}' lies on '{other}'")

    def test_reports(self):
        for name, more in SCENES:
            with self.subTest(name):
                self.look_at(self.run_scene(name, *more) / "report.html")

    def test_comparison_and_study(self):
        first = self.run_scene("leble_barakos/case1_engineering.toml")
        done = installed.start(self.program, "report", first, self.run_scene("leble_barakos/case2_engineering.toml"))
        self.assertIn("comparison.html", done.stdout)
        self.look_at(first / "comparison.html")
        done = installed.start(self.program, "study", self.inputs / "tutorials/steps.toml", "--out", self.runs / "steps")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.look_at(self.runs / "steps/study.html")

    def test_the_drawn_curve_is_that_of_the_file(self):
        """By the pixels of the screen, with values read off the axes' own ticks. One row of the series is a spike, which has to be seen."""
        for rows in (700, 2801, 6001, 60_001):
            with self.subTest(rows=rows):
                t = np.linspace(0.0, 600.0, rows)
                values = np.sin(0.05 * t) + 0.4 * np.sin(1.7 * t) + 0.002 * t
                values[rows // 3] = 4.0
                folder = self.runs / f"rows_{rows}"
                synthetic_run.write(folder, table={"time_s": t, "a.x_m": values}, scene="", log="")
                self.assertEqual(installed.start(self.program, "report", folder).returncode, 0)
                self.curve(folder / "report.html", t, values)

    def curve(self, page, t, values, scale=2):
        self.browser.open(page, 1280, scale=scale)
        pixels = self.browser.screenshot(self.pages / f"{page.parent.name}.png")
        ticks = [(x, y, wide, float(words.replace("−", "-"))) for x, y, wide, high, words in self.browser.run(TICKS)]
        across = np.array([(x, value) for x, y, wide, value in ticks if wide < 1.0])
        up = np.array([(y, value) for x, y, wide, value in ticks if wide >= 1.0])
        self.assertGreaterEqual(min(len(across), len(up)), 2)
        x = scale * np.polyval(np.polyfit(across[:, 1], across[:, 0], 1), t)
        y = scale * np.polyval(np.polyfit(up[:, 1], up[:, 0], 1), values)
        # What the file has, as places a quarter of a pixel apart.
        along = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
        fine = np.arange(0.0, along[-1], 0.25)
        wanted = np.zeros(pixels.shape[:2], bool)
        wanted[np.interp(fine, along, y).astype(int), np.interp(fine, along, x).astype(int)] = True
        # What is seen: pixels that are more of the curve's blue, #1f6fae, than of the page's white.
        box = np.s_[int(y.min()) - 30:int(y.max()) + 30, int(x[0]) - 8:int(x[-1]) + 30]
        seen = np.zeros_like(wanted)
        seen[box] = pixels[box][..., 2] - pixels[box][..., 0] > 0.5 * (0xae - 0x1f) / 255.0
        half = 0.5 * 1.1 * scale * 4 / 3   # of the line's width
        self.assertEqual((seen & ~widened(wanted, half + scale)).sum(), 0, "drawn where the file has nothing")
        self.assertEqual((wanted & ~widened(seen, scale)).sum(), 0, "in the file, but not drawn")


if __name__ == "__main__":
    if browser.WHY_NOT:
        print(f"skipped: {browser.WHY_NOT}")
        sys.exit(77)
    unittest.main()
