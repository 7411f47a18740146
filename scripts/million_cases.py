"""Measures a study of a million cases and one with a long text; scripts/million-cases tells how it is called.

A process that is started counts the memory of the one that starts it as its own: this one stays small, writes studies
in pieces, and lets another one read the tables.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

BRIDGE = Path(__file__).resolve().parent.parent / "studies" / "bridges" / "smoke.json"
CASES = 1_000_000
TEXT = 101_000_000
# what each command may take: seconds, none where only memory counts, and MB
MOST = {"run": (None, 1500), "explain": (2, 500), "status": (2, 500)}


def measured(*words):
    """Runs a command; its seconds and its largest memory in MB."""
    began = time.monotonic()
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = status
    if status:
        sys.exit(f"{' '.join(words)}: status {status}")
    return time.monotonic() - began, used.ru_maxrss / (1024 if sys.platform == "linux" else 1024**2)


def write_study(file, name, cases, text):
    """Writes a study of so many cases, and a question of so many bytes."""
    head = {"name": name, "bridge": str(BRIDGE), "analysis": {"kind": "static"}}
    head["record"] = {"positions": False, "connectors": False}
    with file.open("w") as to:
        to.write(f'{json.dumps(head)[:-1]}, "question": "')
        for _ in range(text // 1000):
            to.write("q" * 1000)
        to.write('", "design": [{"cases": [')
        for i in range(cases):
            comma = "," if i else ""
            to.write(f'{comma}{{"load_n":{100_000 + i // 4},"load_position":{1 + i % 4}}}')
        to.write("]}]}")


# how many rows each reader finds of the table that the first argument names
READERS = {
    "pandas": "import pandas; print(len(pandas.read_parquet(table)))",
    "polars": "import polars; print(polars.read_parquet(table).height)",
    "pyarrow": "import pyarrow.parquet as pq; print(pq.read_table(table).num_rows)",
    "DuckDB": "import duckdb; print(duckdb.read_parquet(table).count('*').fetchall()[0][0])",
}


def rows(table):
    """How many rows each reader finds."""
    for name, read in READERS.items():
        words = [sys.executable, "-c", f"import sys; table = sys.argv[1]; {read}", str(table)]
        told = subprocess.run(words, capture_output=True, text=True, check=False)
        yield name, told.stdout.strip() or told.stderr.strip().splitlines()[-1]


def tried(pontoon, folder, name, cases, text):
    file, out = folder / f"{name}.json", folder / name
    write_study(file, name, cases, text)
    bad = []
    for command, words in {
        "run": ["run", str(file), "--out", str(out), "--quiet"],
        "explain": ["explain", str(out), str(cases - 1)],
        "status": ["status", str(out)],
    }.items():
        seconds, mb = measured(pontoon, *words)
        most_s, most_mb = MOST[command]
        print(f"{name:8} {command:8} {seconds:6.2f} s {mb:7.0f} MB")
        if mb > most_mb or (most_s and seconds > most_s):
            bad.append(f"{name}: {command} took {seconds:.2f} s and {mb:.0f} MB")
    for reader, found in rows(out / "jobs.parquet"):
        print(f"{name:8} {reader:8} {found} rows")
        if found != str(cases):
            bad.append(f"{name}: {reader} finds {found}, not {cases} rows")
    return bad


def main():
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        bad = tried(sys.argv[1], folder, "cases", CASES, 0)
        bad += tried(sys.argv[1], folder, "text", 1, TEXT)
    sys.exit("\n".join(bad) or 0)


if __name__ == "__main__":
    main()
