"""Runs a long command of commands.txt in a copy of the tree: what it writes changes nothing here.

    run_in_copy.py NUMBER FOLDER    the NUMBERth line of commands.txt with "=> long", counted from 1

What is built in the copy stays there for the next command; sources are brought up to date, results removed."""
import os
import pathlib
import shutil
import subprocess
import sys

from commands import listed
from documents import SOURCE

KEPT = {"build", ".git"}    # of the copy
LEFT_OUT = {"build", "out", ".git"}


def copy_tree(target):
    """Files that are the same keep their time, so that little is built again."""
    target.mkdir(parents=True, exist_ok=True)
    there = {p.name for p in SOURCE.iterdir()} - LEFT_OUT
    for old in target.iterdir():
        if old.name not in there | KEPT:
            shutil.rmtree(old) if old.is_dir() else old.unlink()
    for name in sorted(there):
        if (SOURCE / name).is_dir():
            for file in (target / name).rglob("*"):
                if not (SOURCE / name / file.relative_to(target / name)).exists() and file.is_file():
                    file.unlink()
            shutil.copytree(SOURCE / name, target / name, symlinks=True, dirs_exist_ok=True)
        else:
            shutil.copy2(SOURCE / name, target / name)


def main():
    number, target = int(sys.argv[1]), pathlib.Path(sys.argv[2])
    command, (_, other) = [item for item in listed().items() if item[1][0] in ("long", "long:")][number - 1]
    copy_tree(target)
    if not (target / ".git").exists():   # tests/mutations asks git for the files that are ours
        subprocess.run(["git", "init", "-q"], cwd=target, check=True)
    print("runs:", other or command, flush=True)
    # Not the settings of the test that this is: tests/run may stand in the command.
    env = {k: v for k, v in os.environ.items() if not k.startswith(("CTEST_", "GTEST_"))}
    sys.exit(subprocess.run(["bash", "-euo", "pipefail", "-c", other or command], cwd=target, env=env).returncode)


if __name__ == "__main__":
    main()
