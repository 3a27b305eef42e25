"""The commands of the documents, and who runs each: commands.txt."""
import os
import pathlib
import re

from documents import SOURCE, documents, in_backticks, parse, read

SHELL = ("sh", "bash", "console")
TOOLS = ("apt-get", "c++", "cc", "ccache", "clang-format", "cmake", "ctest", "doxygen", "g++", "gcc", "git",
         "make", "mkdocs", "ninja", "npm", "pip", "pkg-config", "python3", "sphinx-build", "sudo", "chromium")
# Their programs are built and their sh blocks run as they stand, by run_document.py.
RUN_WHOLE = "docs/tutorials/"


def is_command(text):
    words = [w for w in text.split() if not re.match(r"[A-Z_]+=", w)]
    if not words:
        return False
    if words[0] in TOOLS:
        return len(words) > 1
    file = SOURCE / words[0]
    return "/" in words[0] and file.is_file() and os.access(file, os.X_OK) and file.suffix != ".cmake"


def lines_of(block):
    """Commands of a sh block, one per line; comments are off, lines that go on are joined."""
    text = re.sub(r"\\\n\s*", "", block.text)
    for line in text.splitlines():
        line = re.sub(r"(^|\s+)#( .*|$)", "", line).strip()
        if line:
            yield " ".join(line.split())


def commands_of(path):
    """(line, command): all lines of sh blocks that are not run as they stand; and in backticks what begins with a
    program."""
    blocks, prose = parse(read(path))
    for block in blocks:
        if block.language in SHELL and not str(path).startswith(RUN_WHOLE):
            yield from ((block.line, command) for command in lines_of(block))
    yield from ((line, text) for line, text in in_backticks(prose) if is_command(text))


def hidden_commands(path):
    """Lines of other blocks, or indented ones, that are commands: they belong into a sh block."""
    blocks, prose = parse(read(path))
    for block in blocks:
        if not block.language:
            yield from ((block.line, line) for line in block.lines if is_command(line))
    yield from ((line, text.strip()) for line, text in prose if text.startswith("    ") and is_command(text))


def all_commands():
    """Command -> the places where it stands."""
    found = {}
    for path in documents():
        for line, command in commands_of(path):
            found.setdefault(command, []).append(f"{path}:{line}")
    return found


def listed():
    """commands.txt: command -> (how, argument)."""
    found = {}
    for line in (pathlib.Path(__file__).parent / "commands.txt").read_text("utf-8").splitlines():
        if line and not line.startswith("#"):
            command, arrow, how = line.partition(" => ")
            if not arrow or command in found:
                raise ValueError(f"commands.txt: '{line}' stands twice or says not what runs it")
            word, _, argument = how.partition(" ")
            found[command.strip()] = (word, argument)
    return found


if __name__ == "__main__":
    for command, places in sorted(all_commands().items()):
        print(command, "   <-", *places)
