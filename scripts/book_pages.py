"""The book's pages as their files write them: fenced blocks, links, paths named in the text.

Knows Markdown as far as the book uses it. Does not know what a block means or how it is run.
"""

import re
import shlex
from dataclasses import dataclass, field
from pathlib import Path

FENCE = re.compile(r"^(?P<mark>```+)(?P<info>[^\n`]*)\n(?P<body>.*?)^(?P=mark)[ \t]*$", re.DOTALL | re.MULTILINE)
LINK = re.compile(r"!?\[[^\]]*\]\((?P<to>[^)\s]+)\)")
INCLUDE = re.compile(r"\{\{#include ([^}]+)\}\}")
SPAN = re.compile(r"`([^`\n]+)`")
EQUATION = re.compile(r"\$\$.+?\$\$", re.DOTALL)
# The number of an equation; where the code cites one.
TAG = re.compile(r"\\tag\{([A-Z]\d+)\}")
CITED = re.compile(r"\(([A-Z]\d+)\)")
HEADING = re.compile(r"^#+ +(.+?)\s*$", re.MULTILINE)
# What a path in the text may begin with: folders of the repository.
ROOTS = ("crates/", "studies/", "scripts/", "tests/", "examples/", "book/", "fuzz/", ".ci/")


@dataclass
class Block:
    """A fenced block: its language, the words and settings behind it, where it stands."""

    page: str
    line: int
    language: str
    words: list
    settings: dict
    raw: str
    body: str

    @property
    def place(self):
        return f"{self.page}:{self.line}"


@dataclass
class Page:
    """A page of the book."""

    path: Path
    name: str
    text: str
    blocks: list = field(default_factory=list)

    @property
    def prose(self):
        """The text without fenced blocks and equations, lines where they were."""
        blank = lambda match: "\n" * match[0].count("\n")
        return EQUATION.sub(blank, FENCE.sub(blank, self.text))

    def anchors(self):
        """The anchors of its headings, as mdBook makes them."""
        plain = (re.sub(r"[`*_]", "", heading).lower() for heading in HEADING.findall(self.prose))
        return {re.sub(r"[^\w\- ]", "", heading).strip().replace(" ", "-") for heading in plain}

    def made(self):
        """The paths that its blocks write or name, with the folders above them: they need not be in the repository."""
        words = [word for block in self.blocks if block.language == "console" for word in block.body.split()]
        words += [block.settings["file"] for block in self.blocks if "file" in block.settings]
        return {part.as_posix() for word in words for part in (Path(word), *Path(word).parents)}


def read_page(path, source):
    """The page of a file below the book's source."""
    page = Page(path, path.relative_to(source).as_posix(), path.read_text())
    for match in FENCE.finditer(page.text):
        language, words, settings = "", [], {}
        for i, part in enumerate(shlex.split(match["info"])):
            key, equals, value = part.partition("=")
            if i == 0:
                language = part
            elif equals:
                settings[key] = value
            else:
                words.append(part)
        line = page.text.count("\n", 0, match.start()) + 1
        body = INCLUDE.sub(lambda include: included(path, include[1]), match["body"])
        page.blocks.append(Block(page.name, line, language, words, settings, match["body"], body))
    return page


def included(path, what):
    """The whole file of an include in a block."""
    file = path.parent / what
    return file.read_text().rstrip() if file.is_file() else ""


def faults_of_text(page, pages, source, root):
    """What is wrong with a page's links, includes and paths: one line each."""
    faults = []

    def fault(at, what):
        faults.append(f"{page.name}:{page.prose.count(chr(10), 0, at) + 1}: {what}")

    for match in LINK.finditer(page.prose):
        to, _, anchor = match["to"].partition("#")
        if re.match(r"[a-z]+:", to):
            continue
        target = (page.path.parent / to).resolve() if to else page.path.resolve()
        if not target.is_file():
            fault(match.start(), f"link to {match['to']}, which is no file")
        elif anchor and target.suffix == ".md":
            other = pages.get(target.relative_to(source.resolve()).as_posix())
            if other is None or anchor not in other.anchors():
                fault(match.start(), f"link to {match['to']}: no such heading")
    for match in INCLUDE.finditer(page.text):
        if not (page.path.parent / match[1].split(":")[0]).is_file():
            faults.append(f"{page.name}: include of {match[1]}, which is no file")
    for match in SPAN.finditer(page.prose):
        for word in match[1].split():
            if word.startswith(ROOTS):
                wrong = fault_of_path(word.rstrip(",;:."), root)
                if wrong and Path(word).as_posix() not in page.made():
                    fault(match.start(), wrong)
    return faults


def fault_of_path(word, root):
    """What is wrong with `path` or `path.rs::Item::item`; none where nothing is."""
    path, *items = word.split("::")
    if "*" in path:
        return None if any(root.glob(path)) else f"{path} matches no file"
    if not (root / path).exists():
        return f"{path} does not exist"
    if not items:
        return None
    text = (root / path).read_text()
    for item in items[:-1]:
        if not re.search(rf"\b{re.escape(item)}\b", text):
            return f"{item} does not occur in {path}"
    last = re.escape(items[-1])
    defined = rf"\b(?:fn|struct|enum|trait|type|const|static|mod) {last}\b|^\s+(?:pub(?:\([a-z]+\))? )?{last}\s*[:,({{]"
    return None if re.search(defined, text, re.MULTILINE) else f"{items[-1]} is not defined in {path}"
