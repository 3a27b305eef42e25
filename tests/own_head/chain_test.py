"""The commands of examples/own_head/README.md, one after the other: they make the synthetic head, do the
procedure on it, and end in a finished stage table. The other tests look at what they leave."""
import os
import pathlib
import re
import shutil
import subprocess
import unittest

from support import EXAMPLE, SOURCE, WORK


def commands():
    """Lines of the README's sh blocks that call a program of the example."""
    text = (EXAMPLE / "README.md").read_text(encoding="utf-8")
    return [line.strip().split("  #")[0] for line in text.splitlines()
            if re.match(r"^examples/own_head/", line)]


class Chain(unittest.TestCase):
    def test_commands_of_the_readme_end_in_a_finished_stage_table(self):
        shutil.rmtree(WORK, ignore_errors=True)
        WORK.mkdir(parents=True)
        (WORK / "examples").symlink_to(SOURCE / "examples")  # the README's paths are relative
        found = commands()
        self.assertGreaterEqual(len(found), 2)
        for command in found:
            result = subprocess.run(command, shell=True, cwd=WORK, capture_output=True, text=True,
                                    env=os.environ | {"PYTHONDONTWRITEBYTECODE": "1"})
            self.assertEqual(result.returncode, 0, f"{command}\n{result.stdout}{result.stderr}")
            self.assertEqual(result.stderr, "", command)
        folder = WORK / "out/my_head"
        table = (folder / "procedure/table.txt").read_text(encoding="utf-8")
        for stage in ("0  before surgery", "8  left, cannula out", "9  CSF restored"):
            self.assertIn(stage, table)
        self.assertEqual(sorted(p.name for p in folder.iterdir()),
                         ["head", "image", "own_head.json", "procedure"])
        self.assertEqual([p for p in pathlib.Path(WORK / "out").iterdir() if p.name.startswith(".")], [])

    def test_readme_names_every_file_that_is_written(self):
        text = (EXAMPLE / "README.md").read_text(encoding="utf-8")
        for path in (WORK / "out/my_head").rglob("*"):
            if path.is_file():
                name = re.sub(r"stage_[0-9]+[a-c]?", "stage_N", path.name)
                name = re.sub(r"_(left|right)", "_SIDE", name)
                self.assertIn(f"`{name}`", text)


if __name__ == "__main__":
    unittest.main(verbosity=2)
