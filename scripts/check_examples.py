"""Tries the notebooks of `examples/` that call the Python package: their types, and each as a whole.

    check_examples.py [--types] [--only WORD]

Exit status 1 where types do not fit, a notebook holds outputs, or one of its cells fails.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = Path(os.environ.get("PONTOON_PACKAGE", ROOT / "crates/python")).resolve()
IMPORT = re.compile(r"^(import|from) pontoon\b", re.MULTILINE)
SECONDS = 300


def code_of(notebook):
    """The code of a notebook as one module, with the numbers of its cells."""
    cells = [(number, cell.source) for number, cell in enumerate(notebook.cells) if cell.cell_type == "code"]
    return "\n".join(f"# cell {number}\n{source}\n" for number, source in cells)


def calls_package(notebook):
    """Whether a notebook calls the package, and does not only read what the program left."""
    return bool(IMPORT.search(code_of(notebook)))


def holds_outputs(notebook):
    """Whether a notebook was kept with what it printed."""
    return any(cell.cell_type == "code" and (cell.outputs or cell.execution_count) for cell in notebook.cells)


def faults_of_types(notebooks, folder):
    """What mypy says of the package, strictly, and of the code of notebooks by their names."""
    files = []
    for name, notebook in notebooks.items():
        files.append(folder / f"{name}.py")
        files[-1].write_text(code_of(notebook))
    cache = f"--cache-dir={folder / 'cache'}"
    environment = os.environ | {"MYPYPATH": str(PACKAGE)}
    faults = []
    for words, place in (([], PACKAGE), (["--ignore-missing-imports", *map(str, files)], folder)):
        done = subprocess.run(
            [sys.executable, "-m", "mypy", "--no-error-summary", cache, *words],
            cwd=place,
            env=environment,
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode:
            faults += (done.stdout + done.stderr).splitlines()
    return faults


def fault_of_run(name, notebook, folder, environment):
    """Why a notebook does not run in a folder; none where it does. The notebook then holds its outputs."""
    from nbclient import NotebookClient
    from nbclient.exceptions import CellExecutionError, CellTimeoutError, DeadKernelError

    client = NotebookClient(
        notebook,
        timeout=SECONDS,
        startup_timeout=SECONDS,
        extra_arguments=["--log-level=40"],
        resources={"metadata": {"path": str(folder / "examples")}},
    )
    try:
        client.execute(env=environment)
    except (CellExecutionError, CellTimeoutError, DeadKernelError) as error:
        return f"{name}: {error}"
    finally:
        kept = os.environ.get("KEEP_NOTEBOOKS")
        if kept:
            import nbformat

            nbformat.write(notebook, Path(kept) / f"{name}.ipynb")
    return None


def main():
    import nbformat

    parser = argparse.ArgumentParser()
    parser.add_argument("--types", action="store_true", help="types alone: runs nothing")
    parser.add_argument("--only", default="", help="notebooks whose name holds this word")
    arguments = parser.parse_args()
    read = {path.stem: nbformat.read(path, as_version=4) for path in sorted((ROOT / "examples").glob("*.ipynb"))}
    notebooks = {name: of for name, of in read.items() if arguments.only in name and calls_package(of)}
    if not notebooks:
        sys.exit("no notebook to try")
    faults = []
    for name, notebook in notebooks.items():
        nbformat.validate(notebook)
        if holds_outputs(notebook):
            faults.append(f"{name}: holds outputs; scripts/check-book --strip takes them out")
    with tempfile.TemporaryDirectory(prefix="pontoon-examples-") as folder:
        folder = Path(folder)
        (folder / "types").mkdir()
        faults += faults_of_types(notebooks, folder / "types")
        for name in () if arguments.types else ("studies", "examples"):
            shutil.copytree(ROOT / name, folder / name)
        environment = os.environ | {
            "PYTHONPATH": str(PACKAGE),
            "PONTOON_CACHE_DIR": str(folder / "cache"),
            # figures are drawn, and stand in the notebooks that are kept
            "MPLBACKEND": "module://matplotlib_inline.backend_inline",
            # what a notebook puts into a temporary folder goes with this one
            "TMPDIR": str(folder),
        }
        for name, notebook in () if arguments.types else notebooks.items():
            began = time.monotonic()
            fault = fault_of_run(name, notebook, folder, environment)
            faults += [fault] if fault else []
            print(f"{name}  {time.monotonic() - began:.1f} s  {'not so' if fault else 'ok'}", flush=True)
    for fault in faults:
        print(fault)
    print(f"{len(notebooks)} notebooks; {len(faults)} not so")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
