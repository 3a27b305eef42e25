"""The site of the documents: Sphinx with MyST over the Markdown files where they stand. Run by docs/make_site."""
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]

project = "libbrainshift"
author = "The libbrainshift authors"
copyright = "2026, " + author
version = release = re.search(r"project\(brainshift VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]

extensions = ["myst_parser"]
myst_heading_anchors = 4
root_doc = "README"
# Site sources are the documents as they are; examples/head/data and the like hold none.
include_patterns = ["*.md", "docs/**.md", "docs/pictures/**", "docs/charts/**", "examples/*/README.md",
                    "tests/robustness/**.md", "LICENSE", "examples/**"]
exclude_patterns = ["build", "out", ".git", "**/data"]

html_theme = "sphinx_rtd_theme"
html_theme_options = {"navigation_depth": 2}
html_static_path = ["static"]
html_css_files = ["tables.css"]   # cells that break lines
html_copy_source = False
html_show_sphinx = False

# Navigation, which Markdown has no word for: appended to the first page as it is read.
NAVIGATION = [
    ("Begin", ["docs/concepts", "docs/tutorials/cpp", "docs/tutorials/c", "docs/tutorials/python",
               "docs/what_to_leave_out", "docs/file-formats", "examples/own_head/README",
               "examples/head/README", "docs/pictures"]),
    ("Reference", ["docs/theory", "docs/architecture", "docs/c-api", "docs/reference", "docs/decisions/README"]),
    ("Evidence", ["docs/validation", "docs/verification", "docs/numbers", "docs/stability", "docs/speed", "docs/scaling", "docs/peers",
                  "docs/mutations", "tests/robustness/README"]),
    ("Project", ["CONTRIBUTING", "CHANGELOG", "SECURITY", "THIRD_PARTY"]),
]
HIDDEN = {"docs/decisions/README": "docs/decisions", "tests/robustness/README": "tests/robustness"}


def toctree(caption, pages):
    return "\n```{toctree}\n:hidden:\n" + (f":caption: {caption}\n" if caption else "") + "\n" + "\n".join(pages) + "\n```\n"


def add_navigation(app, name, source):
    if name == "README":
        known = {page for _, pages in NAVIGATION for page in pages}
        extra = sorted(str(p.relative_to(ROOT).with_suffix("")) for p in (ROOT / "docs").glob("charts/*.md"))
        source[0] += "".join(toctree(caption, ["/" + page for page in pages]) for caption, pages in NAVIGATION)
        if extra:
            source[0] += toctree("Charts", ["/" + page for page in extra if page not in known])
    elif name in HIDDEN:
        pages = sorted("/" + str(p.relative_to(ROOT).with_suffix("")) for p in (ROOT / HIDDEN[name]).rglob("*.md"))
        source[0] += toctree("", [page for page in pages if page != "/" + name])
    elif name == "docs/reference":   # made by Doxygen beside the site
        source[0] += '\n<p><a href="../reference/html/index.html">To the reference</a></p>\n'


def setup(app):
    app.connect("source-read", add_navigation)
    return {"parallel_read_safe": True}
