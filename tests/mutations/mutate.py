#!/usr/bin/python3
"""Applies the mutations of mutations.py in build/mutations. Run by tests/mutations/run."""
import argparse
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

from mutations import MUTATIONS

ROOT = Path(__file__).resolve().parents[2]
WORK = ROOT / "build/mutations"
TREE, BUILD = WORK / "tree", WORK / "release"


def copy_tree():
    files = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, check=True,
                           capture_output=True, text=True).stdout.split("\n")
    for name in filter(None, files):
        source, target = ROOT / name, TREE / name
        if not source.is_file():
            continue
        if target.is_file() and target.read_bytes() == source.read_bytes():
            continue   # unchanged files keep their time, so that little is built again
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(source, target)


def build(programs):
    if not (BUILD / "CMakeCache.txt").is_file():
        command = ["cmake", "-S", TREE, "-B", BUILD, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                   "-DBRAINSHIFT_BUILD_TESTS=ON"]
        if shutil.which("ccache"):
            command.append("-DCMAKE_CXX_COMPILER_LAUNCHER=ccache")
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    run = subprocess.run(["cmake", "--build", BUILD, "--target", *programs], capture_output=True,
                         text=True, check=False)
    if run.returncode != 0:
        sys.exit(run.stdout[-3000:] + run.stderr)


def failures(program, tests):
    """Names of the tests that failed."""
    run = subprocess.run([BUILD / "tests" / program, f"--gtest_filter={tests}", "--gtest_brief=1"],
                         capture_output=True, text=True, check=False, timeout=900)
    found = sorted(set(re.findall(r"\[  FAILED  \] (\w+[./]\w+)", run.stdout)))
    if run.returncode != 0 and not found:
        found = [f"ended with code {run.returncode}"]
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only")
    parser.add_argument("--write-docs", action="store_true")
    options = parser.parse_args()
    chosen = [m for m in MUTATIONS if options.only in (None, m[0])]
    if not chosen:
        sys.exit(f"no mutation is called '{options.only}'")
    copy_tree()
    build(sorted({m[4] for m in chosen}))
    for program, tests in sorted({(m[4], m[5]) for m in chosen}):
        red = failures(program, tests)
        if red:
            sys.exit(f"{program} is red before any mutation: {red}")
    rows = []
    for name, file, old, new, program, tests in chosen:
        start, path = time.monotonic(), TREE / file
        text = path.read_text()
        if text.count(old) != 1:
            sys.exit(f"{name}: '{old}' stands {text.count(old)} times in {file}")
        path.write_text(text.replace(old, new))
        try:
            build([program])
            red = failures(program, tests)
        finally:
            path.write_text(text)
        rows.append((name, file, old, new, red))
        what = f"{len(red)} red, {red[0]} among them" if red else "SURVIVED"
        print(f"{name}: {what} ({time.monotonic() - start:.0f} s)", flush=True)
    if options.write_docs:
        write(rows)
    survivors = [row[0] for row in rows if not row[4]]
    return f"no test noticed: {survivors}" if survivors else 0


def write(rows):
    lines = ["# Mutations", "", "Written by `tests/mutations/run --write-docs`: mistakes put into the library "
             "one at a time, and how", "many tests of the program that should notice went red.", "",
             "| part | file | stands there | put in its place | red | among them |", "|---|---|---|---|---|---|"]
    for name, file, old, new, red in rows:
        old, new = (text.replace("|", "\\|") for text in (old, new))
        lines.append(f"| {name} | {file} | `{old}` | `{new}` | {len(red)} | {red[0] if red else '-'} |")
    (ROOT / "docs/mutations.md").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    sys.exit(main())
