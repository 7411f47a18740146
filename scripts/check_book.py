"""Tries the book: its links, the paths and items it names, its tables of columns, its patches, and every block of code;
and the notebooks beside it.

    check_book.py [--text] [--figures] [--fill] [--book DIR] [--only WORD]
    check_book.py --strip
    check_book.py --columns

Exit status 1 where something of the book is not so.
"""

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import book_columns
import book_pages
import book_run
from check_examples import calls_package

ROOT = Path(__file__).resolve().parent.parent


def program():
    """The program under trial."""
    found = Path(os.environ.get("PONTOON", ROOT / "target/quick/pontoon")).resolve()
    if not found.is_file():
        sys.exit(f"{found} is no file: build it, or name it by PONTOON")
    if found.name != "pontoon":
        sys.exit(f"{found}: the program must be called pontoon")
    return found


def faults_of_pages(pages, source):
    """What is wrong with the book as a text."""
    summary = pages.get("SUMMARY.md")
    if summary is None:
        return ["SUMMARY.md is missing"]
    listed = {match["to"] for match in book_pages.LINK.finditer(summary.text)}
    faults = [f"{name}: not in SUMMARY.md" for name in sorted(set(pages) - listed - {"SUMMARY.md"})]
    for page in pages.values():
        faults += book_pages.faults_of_text(page, pages, source, ROOT)
        for block in page.blocks:
            wrong = fault_of_block(block, page.prose)
            if wrong:
                faults.append(f"{block.place}: {wrong}")
    return faults + faults_of_names(pages)


def faults_of_names(pages):
    """Studies of one name that are not one study: their results would share a folder."""
    faults, known = [], {}
    for block in (block for page in pages.values() for block in page.blocks):
        if block.language != "json" or "study" not in block.words or "exit" in block.settings:
            continue
        study = json.loads(block.body)
        first, place = known.setdefault(study.get("name", block.place), (study, block.place))
        if first != study:
            faults.append(f"{block.place}: another study is called {study['name']} at {place}")
    return faults


def faults_of_equations(pages, cited):
    """Equations of the theory without a number or with another's, and what the code cites too little or too much.

    `cited` has the place of each number that the code cites; none where no code belongs to the pages.
    """
    faults, numbers = [], {}
    for page in pages.values():
        if not page.name.startswith("theory/"):
            continue
        for match in book_pages.EQUATION.finditer(page.text):
            place = f"{page.name}:{page.text.count(chr(10), 0, match.start()) + 1}"
            tag = book_pages.TAG.search(match[0])
            if tag is None:
                faults.append(f"{place}: an equation without a number")
            elif tag[1] in numbers:
                faults.append(f"{place}: equation ({tag[1]}) is at {numbers[tag[1]]} already")
            else:
                numbers[tag[1]] = place
    if cited is None:
        return faults
    for name in sorted(set(numbers) - set(cited)):
        faults.append(f"{numbers[name]}: equation ({name}) is cited nowhere in the code")
    for name in sorted(set(cited) - set(numbers)):
        faults.append(f"{cited[name]}: ({name}) is no equation of the theory")
    return faults


def cited_in(folder):
    """The equations that comments of Rust files cite, each with the first place."""
    cited = {}
    for path in sorted(folder.rglob("*.rs")):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            _, comment, text = line.partition("//")
            for name in book_pages.CITED.findall(text) if comment else []:
                cited.setdefault(name, f"{path.relative_to(ROOT)}:{number}")
    return cited


def faults_of_patches(source):
    """Patches of the book that do not apply to the sources as they are."""
    faults = []
    for patch in sorted(source.rglob("*.patch")):
        done = subprocess.run(
            ["git", "apply", "--check", patch],
            cwd=ROOT,
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode:
            faults.append(f"{patch.relative_to(source)}: {done.stderr.strip()}")
    return faults


def fault_of_block(block, prose):
    """What is wrong with how a block of a page of that prose is marked; none where nothing is."""
    if block.language not in book_run.LANGUAGES:
        return f"a block of '{block.language}', not of {', '.join(sorted(book_run.LANGUAGES))}"
    if "not-run" in block.settings and not block.settings["not-run"].strip():
        return "not run, without a reason"
    included = all(book_pages.INCLUDE.fullmatch(line.strip()) for line in block.raw.splitlines() if line.strip())
    file = block.settings.get("file")
    if file and not re.search(rf"`{re.escape(file)}`", prose):
        return f"saved as {file}, which the text does not name in backticks"
    if block.language == "rust" and not included:
        return "Rust that is no part of a tested file: include it"
    shows = block.language == "console" or "output" in block.words
    if block.page.startswith("guide/") and shows and "..." in book_run.shown_of(block):
        return "`...` in what the guide shows: show all of it, or part of it by head, tail or lines"
    return None


def run_pages(pages, arguments, source, counts):
    """Runs every block of every page; gives what is not so."""
    faults = []
    with tempfile.TemporaryDirectory(prefix="pontoon-book-") as folder:
        folder = Path(folder)
        for page in pages:
            sandbox = None
            began = time.monotonic()
            for block in page.blocks:
                if "not-run" in block.settings:
                    counts["not run"] += 1
                    continue
                if block.language == "rust":
                    continue
                if block.language == "text" and "output" not in block.words:
                    continue
                if sandbox is None:
                    own = folder / page.name.replace("/", "-")
                    own.mkdir()
                    sandbox = book_run.Sandbox(own, ROOT, program(), Path(sys.executable), folder / "cache")
                    sandbox.fills = arguments.fill
                try:
                    sandbox.run(block)
                    counts[block.language] += 1
                except (book_run.Mismatch, ValueError, KeyError, book_run.subprocess.TimeoutExpired) as wrong:
                    faults.append(f"{block.place}: {wrong}")
            if sandbox:
                if arguments.fill:
                    fill(page, sandbox)
                if arguments.figures:
                    book_run.keep_figures(sandbox, source / "figures")
                sandbox.close()
                print(f"  {page.name}  {time.monotonic() - began:.1f} s", file=sys.stderr)
    return faults


def fill(page, sandbox):
    """Writes what commands have printed in place of what the page shows, where that is not so."""
    lines = page.text.splitlines(keepends=True)
    for block in reversed(page.blocks):
        outputs = sandbox.found.get(block.line, [])
        commands = len(book_run.commands(block.body)) if block.language == "console" else 1
        if len(outputs) == commands:
            lines[block.line : block.line + block.raw.count("\n")] = book_run.refilled(block, outputs)
    page.path.write_text("".join(lines))


def run_notebooks(counts):
    """Runs the notebooks of `examples/` that read results, on results of their own; gives what is not so."""
    import nbformat
    from nbclient import NotebookClient
    from nbclient.exceptions import CellExecutionError

    faults = []
    with tempfile.TemporaryDirectory(prefix="pontoon-notebooks-") as folder:
        folder = Path(folder)
        sandbox = book_run.Sandbox(folder, ROOT, program(), Path(sys.executable), folder / "cache")
        done = sandbox.bash("pontoon run studies/fu2005 --quiet")
        if done.returncode:
            return [f"examples: {done.stderr}"]
        for path in sorted((ROOT / "examples").glob("*.ipynb")):
            notebook = nbformat.read(path, as_version=4)
            # scripts/check-examples runs those
            if calls_package(notebook):
                continue
            nbformat.validate(notebook)
            for cell in notebook.cells:
                if cell.cell_type == "code" and (cell.outputs or cell.execution_count):
                    faults.append(f"{path.name}: holds outputs; scripts/check-book --strip takes them out")
                    break
            client = NotebookClient(
                notebook,
                timeout=300,
                startup_timeout=300,
                extra_arguments=["--log-level=40"],
                resources={"metadata": {"path": str(folder / "examples")}},
            )
            try:
                client.execute()
                counts["notebooks"] += 1
            except CellExecutionError as error:
                faults.append(f"{path.name}: {error}")
            kept = os.environ.get("KEEP_NOTEBOOKS")
            if kept:
                nbformat.write(notebook, Path(kept) / path.name)
    return faults


def strip_notebooks():
    """Takes outputs out of the notebooks."""
    import nbformat

    for path in sorted((ROOT / "examples").glob("*.ipynb")):
        notebook = nbformat.read(path, as_version=4)
        for cell in notebook.cells:
            cell.metadata = {}
            if cell.cell_type == "code":
                cell.outputs, cell.execution_count = [], None
        nbformat.write(notebook, path)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--text", action="store_true", help="links, paths and items alone: runs nothing")
    parser.add_argument("--figures", action="store_true", help="keeps the figures that the pages draw")
    parser.add_argument("--columns", action="store_true", help="writes the tables of columns, and no more")
    parser.add_argument("--fill", action="store_true", help="writes what commands print into the pages")
    parser.add_argument("--strip", action="store_true", help="takes outputs out of the notebooks, and no more")
    parser.add_argument("--book", type=Path, default=ROOT / "book/src", help="the book's source")
    parser.add_argument("--only", help="pages whose name holds this word")
    arguments = parser.parse_args()
    if arguments.strip:
        return strip_notebooks()
    source = arguments.book.resolve()
    read = [book_pages.read_page(path, source) for path in sorted(source.rglob("*.md"))]
    pages = {page.name: page for page in read}
    if arguments.columns:
        registry = book_columns.registered(program())
        for page in read:
            page.path.write_text(book_columns.filled(page.text, registry))
        return 0
    own = source == (ROOT / "book/src").resolve()
    faults = faults_of_pages(pages, source) + faults_of_patches(source)
    faults += faults_of_equations(pages, cited_in(ROOT / "crates") if own else None)
    counts = Counter()
    if not arguments.text:
        faults += book_columns.faults(read, book_columns.registered(program()))
        chosen = [page for page in read if not arguments.only or arguments.only in page.name]
        faults += run_pages(chosen, arguments, source, counts)
        if not arguments.only and arguments.book == ROOT / "book/src":
            faults += run_notebooks(counts)
    for fault in faults:
        print(fault)
    blocks = ", ".join(f"{number} {what}" for what, number in sorted(counts.items()))
    print(f"{len(pages)} pages; {blocks or 'nothing run'}; {len(faults)} not so")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
