"""CITATION.cff is what the Citation File Format 1.2.0 asks for, and says what the repository says."""
import re
import unittest

from documents import SOURCE, read

try:
    import yaml
except ImportError:
    yaml = None

# The keys that the schema of 1.2.0 knows, and those it asks for.
KNOWN = {"abstract", "authors", "cff-version", "commit", "contact", "date-released", "doi", "identifiers", "keywords",
         "license", "license-url", "message", "preferred-citation", "references", "repository",
         "repository-artifact", "repository-code", "title", "type", "url", "version"}
NEEDED = {"authors", "cff-version", "message", "title"}
REFERENCE_KNOWN = {"authors", "collection-title", "conference", "doi", "end", "pages", "publisher", "start", "title",
                   "type", "url", "volume", "year"}
REFERENCE_NEEDED = {"authors", "title", "type"}
PERSON = {"affiliation", "alias", "email", "family-names", "given-names", "name-particle", "name-suffix", "orcid"}
ENTITY = {"alias", "email", "name", "website"}


def faults(citation):
    yield from (f"'{key}' is missing" for key in NEEDED - set(citation))
    yield from (f"'{key}' is no key of the format" for key in set(citation) - KNOWN)
    if citation.get("cff-version") != "1.2.0":
        yield "cff-version must be 1.2.0"
    if citation.get("type") not in (None, "software", "dataset"):
        yield "type must be software or dataset"
    if not all(isinstance(word, str) for word in citation.get("keywords", [])):
        yield "keywords must be words"
    yield from author_faults(citation.get("authors"), "the project")
    for reference in citation.get("references", []):
        name = reference.get("title", "a reference")
        yield from (f"{name}: '{key}' is missing" for key in REFERENCE_NEEDED - set(reference))
        yield from (f"{name}: '{key}' is no key that is used here" for key in set(reference) - REFERENCE_KNOWN)
        yield from author_faults(reference.get("authors"), name)


def author_faults(authors, of):
    if not isinstance(authors, list) or not authors:
        yield f"{of} has no list of authors"
        return
    for author in authors:
        if not (set(author) <= PERSON or ("name" in author and set(author) <= ENTITY)):
            yield f"{of}: {author} is neither a person nor an entity"


@unittest.skipIf(yaml is None, "python3-yaml is not installed")
class Citation(unittest.TestCase):
    def setUp(self):
        self.citation = yaml.safe_load(read("CITATION.cff"))

    def test_is_valid(self):
        self.assertEqual(list(faults(self.citation)), [])

    def test_a_fault_would_be_found(self):
        self.assertGreaterEqual(len(list(faults({"cff-version": 1.2, "auhtors": [], "type": "book"}))), 5)

    def test_version_and_licence_are_those_of_the_project(self):
        version = re.search(r"project\(brainshift VERSION (\S+)", read("CMakeLists.txt"))[1]
        self.assertEqual(str(self.citation["version"]), version)
        self.assertEqual(self.citation["license"], "BSD-3-Clause")
        self.assertTrue((SOURCE / "LICENSE").read_text(encoding="utf-8").startswith("BSD 3-Clause"))


if __name__ == "__main__":
    unittest.main()
