"""docs/file-formats.md names the files, arrays, columns and keys that dbs writes.

    formats_test.py RESULTS    a folder of results of dbs on a shipped head"""
import csv
import json
import pathlib
import re
import sys
import unittest

from documents import SOURCE, read

PAGE = read("docs/file-formats.md")
RESULTS = pathlib.Path()


def section(heading):
    return PAGE.split(f"\n## {heading}\n")[1].split("\n## ")[0]


def named(text):
    return set(re.findall(r"`([^`]+)`", text))


def row_of(file):
    """The second cell of the table row whose first one names the file."""
    for line in PAGE.splitlines():
        cells = line.strip("|").split("|")
        if len(cells) == 2 and f"`{file}`" in cells[0]:
            return cells[1]
    raise KeyError(file)


def arrays_of(path):
    text = path.read_bytes().decode("latin-1")
    return set(re.findall(r'<DataArray[^>]*Name="(\w+)"', text)) - {"Points", "connectivity", "offsets", "types"}


def documented_name(path):
    return re.sub(r"_(left|right)", "_SIDE", re.sub(r"stage_[0-9][a-c]?", "stage_N", path.name))


class Formats(unittest.TestCase):
    def test_every_file_that_is_written_is_named(self):
        files = [p for p in RESULTS.iterdir() if p.suffix != ".png"]
        self.assertGreater(len(files), 10)
        self.assertEqual({documented_name(p) for p in files} - named(section("Results of dbs")), set())

    def test_arrays_are_those_that_are_written(self):
        for file in ("stage_N.vtu", "stage_N_SIDE.vtp", "stage_N_SIDE_track.vtp"):
            written = [p for p in RESULTS.iterdir() if documented_name(p) == file]
            self.assertGreater(len(written), 0, file)
            for path in written:
                self.assertEqual(arrays_of(path), named(row_of(file)), path.name)

    def test_arrays_of_the_head_folder_are_those_of_the_shipped_heads(self):
        for size in ("coarse", "medium"):
            folder = SOURCE / "examples/head/data" / size
            for file in ("brain.vtu", "cavity.vtp", "falx.vtp"):
                self.assertEqual(arrays_of(folder / file), named(row_of(file)), file)

    def test_keys_of_stages_json(self):
        stages = json.loads((RESULTS / "stages.json").read_text(encoding="utf-8"))
        table = section("Results of dbs").split("| key | content |")[1]
        keys = set().union(*(named(line.split("|")[1]) for line in table.splitlines() if line.startswith("| ")))
        self.assertEqual(set(stages), keys)
        content = next(line for line in table.splitlines() if line.startswith("| `stages`"))
        self.assertEqual(set(stages["stages"][0]), named(content) - {"stages"})

    def test_heads_of_columns_end_with_their_unit(self):
        without = {"stage", "title", "status", "side", "device", "in_cannula", "active_contacts", "residual",
                   "newton_iterations", "complementarity", "smallest_jacobian", "seconds", "bow_x", "bow_y", "bow_z"}
        for file in ("stages.csv", "electrodes.csv"):
            with open(RESULTS / file, encoding="utf-8", newline="") as lines:
                for name in set(next(csv.reader(lines))) - without:
                    self.assertRegex(name, r"_(mm|mL|mN)$", file)

    def test_magic_word_and_kinds_of_the_bytes(self):
        code = (SOURCE / "src/stepper/bytes.cpp").read_text(encoding="utf-8")
        header = (SOURCE / "src/stepper/bytes.hpp").read_text(encoding="utf-8")
        self.assertIn(f"`{re.search(r'magic.9. = .(.*?).;', code)[1]}`", PAGE)
        kinds = re.search(r"enum class BytesKind.*{ (\w+) = (\d), (\w+) = (\d) }", header).groups()
        self.assertIn("({1} {0}, {3} {2})".format(*kinds), " ".join(PAGE.split()))

    def test_keys_and_events_of_the_progress(self):
        code = (SOURCE / "examples/dbs/progress.cpp").read_text(encoding="utf-8")
        main = (SOURCE / "examples/dbs/main.cpp").read_text(encoding="utf-8")
        keys = set(re.findall(r'object\["(\w+)"\]', code)) | set(re.findall(r'{"(\w+)", ', code))
        events = set(re.findall(r'say\("([^"]+)"\)', code)) | {
            event for call in re.findall(r"meter\.end\((.*)\);", main) for event in re.findall(r'"(\w+)"', call)}
        self.assertGreater(len(keys), 10)
        page = next(p for p in PAGE.split("\n\n") if p.startswith("`--progress json`"))
        self.assertEqual(keys - named(page), set())
        self.assertEqual(events - named(page), set())


if __name__ == "__main__":
    RESULTS = pathlib.Path(sys.argv.pop(1))
    unittest.main()
