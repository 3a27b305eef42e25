"""docs/architecture.md names the folders of the tree, and what each of src/ includes: downwards only."""
import os
import pathlib
import re
import unittest

from documents import SOURCE, read


def rows_of(heading):
    """The table under a heading of docs/architecture.md: first cell -> the others, in order."""
    section = read("docs/architecture.md").split(f"\n## {heading}\n")[1].split("\n## ")[0]
    rows = [[cell.strip() for cell in line.strip("|").split("|")]
            for line in section.splitlines() if line.startswith("|")][2:]
    return {row[0].strip("`/"): row[1:] for row in rows}


def folders_of(path):
    return {p.name for p in (SOURCE / path).iterdir() if p.is_dir() and p.name not in ("build", "out", ".git", "__pycache__")}


def included_by(folder):
    """Folders of src/ whose headers a folder's files include."""
    found = set()
    for path, _, files in os.walk(SOURCE / "src" / folder):
        for name in files:
            if name.endswith((".hpp", ".cpp")):
                text = pathlib.Path(path, name).read_text(encoding="utf-8")
                found.update(re.findall(r'^#include "(\w+)/', text, re.M))
    return found - {folder, "brainshift"}


class Architecture(unittest.TestCase):
    def test_folders_of_the_core_are_those_of_the_page(self):
        self.assertEqual(set(rows_of("The core")), folders_of("src"))

    def test_folders_of_the_tree_are_those_of_the_page(self):
        self.assertEqual(set(rows_of("The tree")), folders_of("."))

    def test_includes_are_those_of_the_page(self):
        for folder, (includes, _) in rows_of("The core").items():
            self.assertEqual(set(re.findall(r"`(\w+)`", includes)), included_by(folder), folder)

    def test_includes_go_downwards_only(self):
        order = list(rows_of("The core"))
        for i, folder in enumerate(order):
            self.assertEqual(included_by(folder) - set(order[i + 1:]), set(), folder)

    def test_public_headers_include_nothing_of_the_core(self):
        for path in (SOURCE / "include").rglob("*.h*"):
            inside = re.findall(r'^#include "(?!brainshift/)(.*)"', path.read_text(encoding="utf-8"), re.M)
            self.assertEqual(inside, [], path)

    def test_the_core_includes_nothing_of_its_hosts(self):
        for path in (SOURCE / "src").rglob("*.?pp"):
            outside = re.findall(r'^#include "((?:examples|capi|bench|tests)/.*|\.\..*)"',
                                 path.read_text(encoding="utf-8"), re.M)
            self.assertEqual(outside, [], path)


if __name__ == "__main__":
    unittest.main()
