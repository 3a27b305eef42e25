"""The report of a run of dbs, as a browser shows it.

    report_test.py HEAD RESULTS [SCREENSHOT]"""
import base64
import csv
import html.parser
import importlib.util
import io
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
REPORT = ROOT / "examples" / "dbs" / "report.py"
HEAD, RESULTS = map(Path, sys.argv[1:3])
SCREENSHOT = Path(sys.argv[3]) if len(sys.argv) > 3 else None
CHROMIUM = shutil.which("chromium")


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(77)


for module in ("numpy", "vtk", "matplotlib", "PIL"):
    if importlib.util.find_spec(module) is None:
        skip(f"no {module} in {sys.executable} (cmake/install-deps.sh docs)")
if not shutil.which("xvfb-run"):
    skip("no xvfb-run (cmake/install-deps.sh docs)")
if CHROMIUM is None:
    skip("no chromium (cmake/install-deps.sh test)")

import numpy as np   # noqa: E402
from PIL import Image   # noqa: E402

# In the page: what a browser made of it. The page's own policy forbids scripts, so this looks from outside.
LOOK = """<!DOCTYPE html><body style="margin:0"><script>
const page = %s, widths = [1280, 400], seen = {};
function look(width) {
  const frame = document.createElement("iframe");
  frame.style.cssText = `width:${width}px;height:600px;border:0`;
  frame.srcdoc = page;
  frame.onload = () => {
    const inside = frame.contentDocument, root = inside.documentElement;
    const wide = [...inside.querySelectorAll("body *")].filter(e => !e.closest(".wide") &&
      e.getBoundingClientRect().right > root.clientWidth + 0.5).map(e => e.tagName);
    seen[width] = {scroll: root.scrollWidth, client: root.clientWidth, wide: wide,
      images: [...inside.images].map(i => [i.complete, i.naturalWidth, i.width, i.alt]),
      background: frame.contentWindow.getComputedStyle(inside.body).backgroundColor,
      colour: frame.contentWindow.getComputedStyle(inside.body).color};
    if (Object.keys(seen).length == widths.length) document.title = JSON.stringify(seen);
  };
  document.body.append(frame);
}
widths.forEach(look);
</script></body>"""


class Page(html.parser.HTMLParser):
    """Cells of the tables, and every address the page names."""

    def __init__(self, text):
        super().__init__()
        self.tables, self.addresses, self.styles, self.tags = {}, [], [], []
        self.table = self.cell = None
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.tags.append(tag)
        self.addresses += [v for k, v in attributes.items() if k in ("src", "href", "srcset", "data", "action",
                                                                     "poster", "background")]
        self.styles += [attributes["style"]] if "style" in attributes else []
        if tag == "table":
            self.table = self.tables.setdefault(attributes["id"], [])
        elif tag == "tr" and self.table is not None:
            self.table.append({"words": []})
        elif tag == "td":
            self.cell = attributes.get("data-key", "")

    def handle_endtag(self, tag):
        if tag == "td":
            self.cell = None
        if tag == "table":
            self.table = None

    def handle_data(self, text):
        if self.cell is None or not self.table:
            return
        if self.cell:
            self.table[-1][self.cell] = text
        else:
            self.table[-1]["words"].append(text)


def rounded_like(text, value):
    """Whether the text is the value, rounded to the digits the text has."""
    digits = len(text.split("e")[0].partition(".")[2])
    if "e" in text:
        return f"{value:.{digits}e}" == text
    return abs(float(text) - value) <= 0.5 * 10.0 ** -digits * (1.0 + 1e-6)


def chromium(*options):
    with tempfile.TemporaryDirectory() as profile:
        return subprocess.run([CHROMIUM, "--headless=new", "--no-sandbox", "--disable-gpu",
                               "--disable-background-networking", "--disable-dev-shm-usage",
                               "--hide-scrollbars", "--force-prefers-color-scheme=dark",
                               f"--user-data-dir={profile}", *options],
                              capture_output=True, text=True, timeout=120)


class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.path = Path(cls.folder.name) / "report.html"
        run = subprocess.run([sys.executable, "-B", str(REPORT), "--head", str(HEAD), str(RESULTS), "--out",
                              str(cls.path)], capture_output=True, text=True)
        if run.returncode:
            raise RuntimeError(run.stderr)
        cls.text = cls.path.read_text()
        cls.page = Page(cls.text)
        cls.results = json.loads((RESULTS / "stages.json").read_text())

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def rows(self, name):
        return [r for r in self.page.tables[name] if r["words"]]

    def test_nothing_is_fetched(self):
        self.assertGreater(len(self.page.addresses), 40)
        for address in self.page.addresses:
            self.assertTrue(address.startswith("data:image/"), address[:80])
        for tag in ("script", "link", "iframe", "object", "embed", "base", "form"):
            self.assertNotIn(tag, self.page.tags)
        style = "".join(re.findall(r"<style>(.*?)</style>", self.text, re.S)) + "".join(self.page.styles)
        self.assertNotIn("@import", style)
        self.assertNotIn("url(", style)
        self.assertIn("default-src 'none'; img-src data:", self.text)
        for kind, data in re.findall(r'src="data:image/([a-z+]+);base64,([^"]+)"', self.text):
            if kind == "svg+xml":   # a drawing may name others
                drawing = base64.b64decode(data).decode()
                self.assertEqual(re.findall(r'(?:href|src)="(?!#|data:image/png)[^"]*"', drawing), [])
                self.assertNotIn("<script", drawing)

    def test_the_stage_table_is_that_of_the_result_files(self):
        with open(RESULTS / "stages.csv", newline="") as file:
            expected = list(csv.DictReader(file))
        rows = self.rows("stages")
        self.assertEqual([r.pop("words") for r in rows], [[e["stage"], e["title"]] for e in expected])
        for row, numbers in zip(rows, expected):
            self.assertEqual(len(row), 14)
            for key, text in row.items():
                self.assertTrue(rounded_like(text, float(numbers[key])), (numbers["stage"], key, text))

    def test_the_electrode_table_is_that_of_the_result_files(self):
        with open(RESULTS / "electrodes.csv", newline="") as file:
            expected = list(csv.DictReader(file))
        targets = {side: np.array(e["target_mm"]) for side, e in
                   self.results["stages"][-1]["electrodes"].items()}
        ties = {(s["stage"], side): np.linalg.norm(e["track_force_on_tissue_mN"], axis=1).max()
                for s in self.results["stages"] for side, e in s["electrodes"].items()}
        rows = self.rows("electrodes")
        self.assertEqual([r.pop("words")[:2] for r in rows], [[e["stage"], e["side"]] for e in expected])
        for row, numbers in zip(rows, expected):
            vector = {name: np.array([float(numbers[f"{name}_{k}_{unit}"]) for k in "xyz"])
                      for name, unit in (("tip", "mm"), ("skull_force", "mN"))}
            derived = {"tip_off_target_mm": np.linalg.norm(vector["tip"] - targets[numbers["side"]]),
                       "skull_force_mN": np.linalg.norm(vector["skull_force"]),
                       "strongest_tie_mN": ties[numbers["stage"], numbers["side"]]}
            self.assertEqual(len(row), 11)
            for key, text in row.items():
                if key in derived:
                    self.assertTrue(rounded_like(text, derived[key]), (numbers["stage"], key, text))
                    continue
                number = numbers[re.sub("_since_(cannula|surgery)_mm", r"_since_\1_mm", key)]
                self.assertTrue(text == "–" and number == "" or rounded_like(text, float(number)), (key, text))

    def test_every_stage_has_its_pictures_and_they_show_something(self):
        labels = [s["stage"] for s in self.results["stages"]]
        self.assertEqual(re.findall(r'<section id="stage_(\w+)">', self.text), labels)
        pictures = re.findall(r'src="data:image/png;base64,([^"]+)"', self.text)
        self.assertEqual(len(pictures), 4 * len(labels))
        for data in pictures:
            image = np.asarray(Image.open(io.BytesIO(base64.b64decode(data))))
            self.assertGreater(min(image.shape[:2]), 300)
            self.assertGreater(image.std(axis=(0, 1)).min(), 10.0)

    def test_it_says_what_it_is_and_what_it_was_made_of(self):
        for words in ("not a medical device", "<h2>Limits</h2>", "<h2>Versions</h2>", "SHA-256",
                      self.results["library"], "young_kPa"):
            self.assertIn(words, self.text)
        self.assertEqual(len(re.findall("<dt>", self.text)), len(self.results["options"]))

    def test_a_browser_decodes_all_images_and_nothing_hangs_over_the_edge(self):
        wrapper = Path(self.folder.name) / "look.html"
        wrapper.write_text(LOOK % json.dumps(self.text).replace("</", "<\\/"))
        run = chromium("--dump-dom", "--virtual-time-budget=20000", wrapper.as_uri())
        title = re.search("<title>(.*?)</title>", run.stdout)
        self.assertIsNotNone(title, run.stderr[-2000:])
        seen = json.loads(html.unescape(title.group(1)))
        for width in ("1280", "400"):
            self.assertLessEqual(seen[width]["scroll"], int(width))
            self.assertEqual(seen[width]["wide"], [])
            images = seen[width]["images"]
            self.assertEqual(len(images), len(self.page.addresses))
            for complete, natural, shown, words in images:
                self.assertTrue(complete and natural > 0 and words, words)
                self.assertGreaterEqual(shown, 250, words)   # legible on a phone too
            # Dark on light, whatever the reader's browser prefers.
            self.assertEqual(seen[width]["background"], "rgb(255, 255, 255)")
            self.assertEqual(seen[width]["colour"], "rgb(27, 27, 31)")

    def test_its_screenshot_has_the_head_in_it(self):
        shot = SCREENSHOT or Path(self.folder.name) / "shot.png"
        shot.unlink(missing_ok=True)
        run = chromium("--window-size=1280,12000", f"--screenshot={shot}", self.path.as_uri())
        self.assertTrue(shot.is_file(), run.stderr[-2000:])
        image = np.asarray(Image.open(shot).convert("RGB")).astype(int)
        self.assertEqual(image.shape[1], 1280)
        self.assertGreater((image.sum(axis=2) > 700).mean(), 0.3)   # light
        # Down to the last stage: something is drawn in every 1000 pixels.
        for top in range(0, 9000, 1000):
            self.assertGreater(image[top:top + 1000].std(), 5.0, top)


class ByDbs(unittest.TestCase):
    """dbs --report: the same page with the run that it is about."""

    def dbs(self, folder, *options):
        return subprocess.run([os.environ["DBS"], "--head", str(HEAD), "--out", f"{folder}/results", "--report",
                               f"{folder}/out/page.html", *options], capture_output=True, text=True)

    def test_it_is_written_after_the_run(self):
        with tempfile.TemporaryDirectory() as folder:
            run = self.dbs(folder, "--sides", "right", "--no-devices")
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertEqual(run.stdout.splitlines()[-1], f"{folder}/out/page.html")
            page = Page(Path(folder, "out/page.html").read_text())
            stages = json.loads(Path(folder, "results/stages.json").read_text())["stages"]
            self.assertEqual([row["words"][0] for row in page.tables["stages"] if row["words"]],
                             [stage["stage"] for stage in stages])

    def test_what_leaves_nothing_to_report_is_refused_at_once(self):
        for option in ("--no-files", "--no-vtk", "--plan"):
            with tempfile.TemporaryDirectory() as folder:
                run = self.dbs(folder, option)
                self.assertEqual((run.returncode, run.stdout), (1, ""))
                self.assertIn("leave --no-files, --no-vtk and --plan out", run.stderr)

    def test_a_page_that_cannot_be_written_is_told_and_the_results_stay(self):
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "out").write_text("in the way")
            run = self.dbs(folder, "--sides", "right", "--no-devices")
            self.assertEqual(run.returncode, 1)
            self.assertIn("page.html: was not written", run.stderr)
            self.assertTrue(Path(folder, "results/stages.json").is_file())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
