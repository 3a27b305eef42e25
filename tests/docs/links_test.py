"""Links within the documents lead to files and headings that are there."""
import re
import unittest

from documents import SOURCE, anchors, documents, in_backticks, links, parse, read


def broken(path):
    _, prose = parse(read(path))
    for line, target in links(prose):
        if "://" in target or target.startswith("mailto:"):
            continue
        name, _, anchor = target.partition("#")
        file = (SOURCE / path).parent / name if name else SOURCE / path
        if not file.exists():
            yield f"{path}:{line}: there is no {name}"
        elif anchor and (file.suffix != ".md" or anchor not in anchors(parse(file.read_text("utf-8"))[1])):
            yield f"{path}:{line}: {file.name} has no heading '{anchor}'"


class Links(unittest.TestCase):
    def test_lead_to_files_and_headings_that_are_there(self):
        self.assertEqual([fault for path in documents() for fault in broken(path)], [])

    def test_files_that_are_named_are_there(self):
        """In backticks what begins with a folder of the tree is a file of it, or a pattern that some fit."""
        folders = {p.name for p in SOURCE.iterdir() if p.is_dir()} - {"build", "out", ".git"}
        gone = []
        for path in documents():
            for line, text in in_backticks(parse(read(path))[1]):
                if re.fullmatch(r"[\w./*-]+", text) and text.partition("/")[0] in folders and "/" in text:
                    places = (SOURCE, (SOURCE / path).parent, SOURCE / "examples")
                    if not any(True for place in places for _ in place.glob(text.rstrip("/"))):
                        gone.append(f"{path}:{line}: {text}")
        self.assertEqual(gone, [])

    def test_every_document_is_reached_from_the_readme(self):
        reached, open_ends = set(), [SOURCE / "README.md"]
        while open_ends:
            file = open_ends.pop()
            if file in reached:
                continue
            reached.add(file)
            for _, target in links(parse(file.read_text("utf-8"))[1]):
                linked = (file.parent / target.partition("#")[0]).resolve()
                if linked.suffix == ".md" and linked.exists():
                    open_ends.append(linked)
        self.assertEqual([str(p) for p in documents() if (SOURCE / p).resolve() not in reached], [])

    def test_a_broken_one_would_be_found(self):
        _, prose = parse("# A, `b` & c-d\n[x](#a-b--c-d) `[y](z)`\n```\n[p](q)\n```\n[s](t.md#u)\n")
        self.assertEqual(anchors(prose), {"a-b--c-d"})
        self.assertEqual(list(links(prose)), [(2, "#a-b--c-d"), (6, "t.md#u")])


if __name__ == "__main__":
    unittest.main()
