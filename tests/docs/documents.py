"""The documents of the project, and what the tests of this folder read in them: fenced blocks, text in
backticks, headings with their anchors, links."""
import os
import pathlib
import re
import unicodedata

SOURCE = pathlib.Path(__file__).resolve().parents[2]
NOT_OURS = {".git", "build", "out"}   # of what lies in the root


def documents():
    """Every *.md of the tree, as paths relative to its root."""
    found = []
    for folder, folders, files in os.walk(SOURCE):
        if pathlib.Path(folder) == SOURCE:
            folders[:] = [f for f in folders if f not in NOT_OURS]
        found += [pathlib.Path(folder, f).relative_to(SOURCE) for f in files if f.endswith(".md")]
    return sorted(found)


def read(path):
    return (SOURCE / path).read_text(encoding="utf-8")


class Block:
    """A fenced block: its language, its lines, the line it begins on (from 1), and the file that a comment
    `<!-- file: NAME -->` on the line before names."""

    def __init__(self, language, line, name):
        self.language, self.line, self.name, self.lines = language, line, name, []

    @property
    def text(self):
        return "".join(line + "\n" for line in self.lines)


def parse(text):
    """Fenced blocks, and the lines outside of them as (number, text)."""
    blocks, prose, block, before = [], [], None, ""
    for number, line in enumerate(text.splitlines(), 1):
        fence = re.match(r"```(\w*)\s*$", line)
        if block is None and fence:
            name = re.match(r"<!-- file: (\S+) -->$", before)
            block = Block(fence[1], number, name and name[1])
        elif block is not None and fence:
            blocks.append(block)
            block = None
        elif block is not None:
            block.lines.append(line)
        else:
            prose.append((number, line))
        before = line
    if block is not None:
        raise ValueError(f"the block that begins on line {block.line} has no end")
    return blocks, prose


def in_backticks(prose):
    """(line, text) of all code within sentences, also where it goes on on the next line."""
    text = "\n".join(line for _, line in prose)
    numbers = [number for number, _ in prose]
    for match in re.finditer(r"(?<!`)`([^`]+)`(?!`)", text):
        yield numbers[text.count("\n", 0, match.start())], " ".join(match[1].split())


def anchors(prose):
    """What GitHub makes of the headings."""
    found, seen = set(), {}
    for _, line in prose:
        heading = re.match(r"#{1,6}\s+(.*?)\s*#*$", line)
        if not heading:
            continue
        words = re.sub(r"!?\[([^]]*)\]\([^)]*\)", r"\1", heading[1]).lower()
        slug = "".join(c for c in words if c in " -_" or unicodedata.category(c)[0] in "LN").replace(" ", "-")
        count = seen[slug] = seen.get(slug, -1) + 1
        found.add(slug if count == 0 else f"{slug}-{count}")
    return found


def links(prose):
    """(line, target) of links and images; text in backticks holds none."""
    for number, line in prose:
        for match in re.finditer(r"\]\(([^()\s]+)\)", re.sub(r"`[^`]*`", "", line)):
            yield number, match[1]
