"""Does what a document says: writes the files it holds, runs its sh blocks, and compares what they print with
the text block that follows.

    run_document.py DOCUMENT --prefix PREFIX --libdir lib --head HEAD --work FOLDER

A block after `<!-- file: NAME -->` is a part of that file. PREFIX is where the library is installed."""
import argparse
import difflib
import os
import pathlib
import re
import shutil
import subprocess
import sys

from documents import SOURCE, parse


def environment(prefix, libdir, head):
    library = f"{prefix}/{libdir}"
    return os.environ | {"PREFIX": prefix, "HEAD": head, "PKG_CONFIG_PATH": f"{library}/pkgconfig",
                         "LD_LIBRARY_PATH": library, "PYTHONPATH": f"{library}/brainshift/python",
                         "PYTHONDONTWRITEBYTECODE": "1"}


def run(block, work, env):
    result = subprocess.run(["bash", "-euo", "pipefail", "-c", block.text], cwd=work, env=env, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if result.returncode != 0:
        sys.exit(f"line {block.line}: failed ({result.returncode}):\n{block.text}\n{result.stdout}")
    return result.stdout


def same(expected, printed):
    """The last lines printed are those expected; "..." stands for anything within a line."""
    pattern = ".*".join(re.escape(part) for part in expected.rstrip("\n").split("..."))
    return re.search("(^|\n)" + pattern.replace(r"\n", "\n") + "\n*$", printed) is not None


def do(blocks, work, env):
    """Number of texts that were compared."""
    printed, compared = None, 0
    for block in blocks:
        if block.name:
            with open(work / block.name, "a", encoding="utf-8") as file:
                file.write(block.text + "\n")
        elif block.language == "sh":
            printed = run(block, work, env)
        elif block.language == "text":
            if printed is None:
                sys.exit(f"line {block.line}: no command stands before this text")
            if not same(block.text, printed):
                diff = difflib.unified_diff(block.text.splitlines(), printed.splitlines(), "document", "printed")
                sys.exit(f"line {block.line}: the document says otherwise:\n" + "\n".join(diff))
            printed, compared = None, compared + 1
    return compared


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("document")
    for option in ("--prefix", "--libdir", "--work"):
        parser.add_argument(option, required=True)
    parser.add_argument("--head", default=str(SOURCE / "examples/head/data/coarse"))
    arguments = parser.parse_args()
    work = pathlib.Path(arguments.work)
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    blocks, _ = parse((SOURCE / arguments.document).read_text(encoding="utf-8"))
    compared = do(blocks, work, environment(arguments.prefix, arguments.libdir, arguments.head))
    if compared == 0:
        sys.exit(f"{arguments.document}: nothing was compared")
    print(f"{arguments.document}: {compared} outputs as it says")


if __name__ == "__main__":
    main()
