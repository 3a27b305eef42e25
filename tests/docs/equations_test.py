"""What the code cites of docs/theory.md stands there under that number, and is about the same thing: each
number has its words in equations.txt, and they are looked for on both sides."""
import os
import pathlib
import re
import unittest

from documents import SOURCE, documents, read

THEORY = read("docs/theory.md")
FOLDERS = ["include", "src", "capi", "examples", "bench", "tests"]
NUMBER = r"\((\d{1,2}a?)\)"


def paragraphs(text):
    """(line, lines) of what stands between blank lines."""
    begin, lines = 1, []
    for number, line in enumerate(text.splitlines() + [""], 1):
        if line.strip():
            lines.append(line)
        elif lines:
            yield begin, lines
            lines = []
        if not line.strip():
            begin = number + 1


def equations():
    """Number -> the paragraph with the equation, the one before and the one after."""
    all_of_them = [lines for _, lines in paragraphs(THEORY)]
    found = {}
    for i, lines in enumerate(all_of_them):
        for line in lines:
            number = re.match(r" {4}.*\s{2,}" + NUMBER + "$", line)
            if number:
                if number[1] in found:
                    raise ValueError(f"docs/theory.md has two equations ({number[1]})")
                found[number[1]] = "\n".join(sum(all_of_them[max(i - 1, 0):i + 2], []))
    return found


def source_files():
    for folder in FOLDERS:
        for path, _, files in os.walk(SOURCE / folder):
            for name in files:
                if name.endswith((".hpp", ".cpp", ".h", ".c", ".py")) and not path.endswith("tests/docs"):
                    yield pathlib.Path(path, name)


def comments_that_cite(path):
    """(line, text) of each run of comment lines that names theory.md."""
    lines = path.read_text(encoding="utf-8").splitlines()
    comment = [re.match(r"\s*(//|/?\*|#)|.*//", line) is not None for line in lines]
    for i, line in enumerate(lines):
        if "theory.md" not in line:
            continue
        begin = end = i
        while begin > 0 and comment[begin - 1]:
            begin -= 1
        while end + 1 < len(lines) and comment[end + 1]:
            end += 1
        yield i + 1, re.sub(r"\s*\n\s*(//|\*|#)?\s*", " ", "\n".join(lines[begin:end + 1]))


def cited_numbers(comment):
    numbers = re.findall(NUMBER, comment)
    for first, last in re.findall(NUMBER + " to " + NUMBER, comment):
        numbers += [str(n) for n in range(int(first), int(last))]
    return sorted(set(numbers))


def subjects():
    """equations.txt: number -> pattern."""
    lines = (pathlib.Path(__file__).parent / "equations.txt").read_text(encoding="utf-8").splitlines()
    return dict(re.match(r"(\d+a?): (.+)$", line).groups() for line in lines if line and line[0] != "#")


def faults(equations, subjects, citations):
    for number, pattern in subjects.items():
        if number not in equations:
            yield f"equations.txt: docs/theory.md has no equation ({number})"
        elif not re.search(pattern, equations[number], re.I):
            yield f"docs/theory.md ({number}) is not about '{pattern}'"
    for place, number, comment in citations:
        if number not in equations:
            yield f"{place}: docs/theory.md has no equation ({number})"
        elif number not in subjects:
            yield f"{place}: equations.txt does not say what ({number}) is about"
        elif not re.search(subjects[number], comment, re.I):
            yield f"{place}: cites ({number}), which is about '{subjects[number]}': {comment}"


class Equations(unittest.TestCase):
    EQUATIONS = equations()

    def test_are_numbered_without_a_gap(self):
        numbers = sorted({int(n.rstrip("a")) for n in self.EQUATIONS})
        self.assertEqual(numbers, list(range(1, len(numbers) + 1)))

    def test_cited_ones_are_there_and_about_the_same_thing(self):
        citations = [(f"{path.relative_to(SOURCE)}:{line}", number, comment) for path in source_files()
                     for line, comment in comments_that_cite(path) for number in cited_numbers(comment)]
        self.assertGreater(len(citations), 15)
        self.assertEqual(list(faults(self.EQUATIONS, subjects(), citations)), [])

    def test_those_that_documents_cite_are_there(self):
        for path in documents():
            for number in re.findall(r"theory\.md\)?,? " + NUMBER, read(path)):
                self.assertIn(number, self.EQUATIONS, path)

    def test_cited_sections_are_there(self):
        sections = set(re.findall(r"^## (\d+)\.", THEORY, re.M))
        for path in source_files():
            for line, comment in comments_that_cite(path):
                for number in re.findall(r"theory\.md,? section (\d+)", comment):
                    self.assertIn(number, sections, f"{path}:{line}")

    def test_a_wrong_number_would_be_found(self):
        wrong = list(faults(self.EQUATIONS, subjects(), [("a.cpp:1", "9", "the waterline (9)"),
                                                      ("a.cpp:2", "99", "nothing (99)")]))
        self.assertEqual(len(wrong), 2)


if __name__ == "__main__":
    unittest.main()
