"""CONTRIBUTING.md names the labels of the tests, the presets and the groups that are there.

    contributing_test.py BINARY"""
import json
import re
import subprocess
import sys
import unittest

from documents import SOURCE, read

BINARY = ""
PAGE = read("CONTRIBUTING.md")


class Contributing(unittest.TestCase):
    def test_labels_are_those_of_the_tests(self):
        table = PAGE.split("| label |")[1].split("\n\n")[0]
        named = set(re.findall(r"`(\w+)`", " ".join(line.split("|")[1] for line in table.splitlines()[2:])))
        printed = subprocess.run(["ctest", "--test-dir", BINARY, "--print-labels"], capture_output=True, text=True).stdout
        used = set(printed.split("All Labels:")[1].split())
        self.assertGreater(len(used), 4)
        self.assertEqual(used - named, set(), "labels that CONTRIBUTING.md does not name")
        files = "\n".join(p.read_text("utf-8") for p in (SOURCE / "tests").rglob("CMakeLists.txt"))
        self.assertEqual({label for label in named if not re.search(rf"\b{label}\b", files)}, set())

    def test_presets_are_those_of_the_project(self):
        presets = json.loads(read("CMakePresets.json"))["configurePresets"]
        sentence = re.search(r"Other presets.*?\n\n", PAGE, re.S)[0]
        named = set(re.findall(r"`([a-z-]+)`", sentence))
        self.assertGreater(len(named), 4)
        self.assertEqual(named - {p["name"] for p in presets if not p.get("hidden")}, set())


if __name__ == "__main__":
    BINARY = sys.argv.pop(1)
    unittest.main()
