"""Measures a study of a million cases and one with a long text; scripts/million-cases tells how it is called."""

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import duckdb
import pandas as pd
import polars as pl
import pyarrow.parquet as pq

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


def study(name, cases, question):
    design = ",".join(f'{{"load_n":{100_000 + i // 4},"load_position":{1 + i % 4}}}' for i in range(cases))
    head = {"name": name, "question": question, "bridge": str(BRIDGE), "analysis": {"kind": "static"}}
    head["record"] = {"positions": False, "connectors": False}
    return f'{json.dumps(head)[:-1]}, "design": [{{"cases": [{design}]}}]}}'


def rows(table):
    """How many rows each reader finds."""
    return {
        "pandas": len(pd.read_parquet(table)),
        "polars": pl.read_parquet(table).height,
        "pyarrow": pq.read_table(table).num_rows,
        "DuckDB": duckdb.connect().execute("select count(*) from read_parquet(?)", [str(table)]).fetchall()[0][0],
    }


def tried(pontoon, folder, name, cases, question):
    file, out = folder / f"{name}.json", folder / name
    file.write_text(study(name, cases, question))
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
    for reader, found in rows(out / "jobs.parquet").items():
        print(f"{name:8} {reader:8} {found:,} rows")
        if found != cases:
            bad.append(f"{name}: {reader} finds {found} rows of {cases}")
    return bad


def main():
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        bad = tried(sys.argv[1], folder, "cases", CASES, "a million cases")
        bad += tried(sys.argv[1], folder, "text", 1, "q" * TEXT)
    sys.exit("\n".join(bad))


if __name__ == "__main__":
    main()
