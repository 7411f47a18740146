"""Whether same_numbers.py finds what differs: made-up results with one fault each must be told apart, others not."""

import contextlib
import io
import math
import shutil
import struct
import sys
import tempfile
from pathlib import Path

import polars as pl
from same_numbers import main as same_numbers

JOBS = {
    "job": [0, 1, 2, 3],
    "speed_m_s": [5.0, 7.0, 10.0, 15.0],
    "peak_deflection_m": [0.1, 0.0, math.nan, None],
    "steps": [400, 0, 300, 200],
    "connection": ["linear", None, "nonlinear", "nonlinear"],
    "opened": [False, True, None, True],
}
POSITIONS = {"job": [0, 0, 1], "position": [1, 2, 1], "peak_deflection_m": [0.1, 0.05, 0.2]}
TOLD = {"pontoon.commit": "1a", "pontoon.instruction_path": "x86-64 avx2 fma"}
SUMMARY = b"speed_m_s,peak_deflection_m\n5,0.1\n7,0.0\n"


def real(bits):
    """The number of some bits."""
    return struct.unpack(">d", bytes.fromhex(bits))[0]


def fill(folder, change=None):
    """Writes the results, changed in one way."""
    results = {"jobs": pl.DataFrame(JOBS), "positions": pl.DataFrame(POSITIONS), "summary": SUMMARY}
    if change is not None:
        change(results)
    folder.mkdir(parents=True)
    summary, told = results.pop("summary"), results.pop("provenance", TOLD)
    if summary is not None:
        (folder / "summary.csv").write_bytes(summary)
    for name, table in results.items():
        path = folder / f"{name}.parquet"
        if isinstance(table, bytes):
            path.write_bytes(table)
        else:
            table.write_parquet(path, metadata=told)


def cell(table, column, row, value):
    """Puts a value into a cell."""

    def change(results):
        frame = results[table]
        cells = frame[column].to_list()
        cells[row] = value
        results[table] = frame.with_columns(pl.Series(column, cells, dtype=frame[column].dtype))

    return change


def frame(table, act):
    """Changes a table as a whole."""

    def change(results):
        results[table] = act(results[table])

    return change


def put(name, content):
    def change(results):
        results[name] = content

    return change


def drop(name):
    def change(results):
        del results[name]

    return change


JOB_2 = "row 2 (job 2)"
# what is tried, the change, the exit status, words of what is said
TRIALS = [
    ("nothing", None, 0, ["the same: 1 folders of results, 2 tables, 9 columns, 33 values"]),
    (
        "a bit of a float",
        cell("jobs", "peak_deflection_m", 0, math.nextafter(0.1, 1)),
        1,
        [
            "1 of 4 rows",
            "row 0 (job 0): 0.10000000000000001 before, 0.10000000000000002 after",
            "difference 1.39e-16 in row 0",
        ],
    ),
    ("the same float written anew", cell("jobs", "peak_deflection_m", 0, 0.1), 0, []),
    ("-0.0 for 0.0", cell("jobs", "peak_deflection_m", 1, -0.0), 1, ["row 1 (job 1): 0 before, -0 after"]),
    (
        "a NaN of other bits",
        cell("jobs", "peak_deflection_m", 2, real("7ff8000000000001")),
        1,
        [JOB_2, "nan of bits 7ff8000000000000 before, nan of bits 7ff8000000000001 after"],
    ),
    ("a number for NaN", cell("jobs", "peak_deflection_m", 2, 0.3), 1, [JOB_2]),
    ("a null for 0.0", cell("jobs", "peak_deflection_m", 1, None), 1, ["0 before, null after"]),
    ("a null for 0", cell("jobs", "steps", 1, None), 1, ["row 1 (job 1): 0 before, null after"]),
    ("0.0 for a null", cell("jobs", "peak_deflection_m", 3, 0.0), 1, ["null before, 0 after"]),
    ("a null for a NaN", cell("jobs", "peak_deflection_m", 2, None), 1, [JOB_2, "after"]),
    ("another whole number", cell("jobs", "steps", 2, 330), 1, [JOB_2, "300 before, 330 after", "difference 0.0909"]),
    ("another word", cell("jobs", "connection", 2, "linear"), 1, ["'nonlinear' before, 'linear' after"]),
    ("an empty word for a null", cell("jobs", "connection", 1, ""), 1, ["null before, '' after"]),
    ("no for yes", cell("jobs", "opened", 1, False), 1, ["True before, False after"]),
    (
        "more rows than are shown",
        frame("jobs", lambda t: t.with_columns(pl.col("speed_m_s") * pl.Series([2.0, 2, 2, 3]))),
        1,
        ["4 of 4 rows, largest relative difference 0.667 in row 3", "row 3 (job 3): 15 before, 45 after"],
    ),
    (
        "another order of rows",
        frame("positions", lambda t: t[[1, 0, 2]]),
        1,
        ["column position: 2 of 3 rows", "row 0 (job 0)"],
    ),
    ("a row fewer", frame("positions", lambda t: t.head(2)), 1, ["positions: 3 rows before, 2 after"]),
    ("a row more", frame("positions", lambda t: pl.concat([t, t.tail(1)])), 1, ["positions: 3 rows before, 4 after"]),
    ("a column dropped", frame("jobs", lambda t: t.drop("steps")), 1, ["column steps is missing"]),
    (
        "a column of another name",
        frame("jobs", lambda t: t.rename({"steps": "step"})),
        1,
        ["steps is missing", "step is new"],
    ),
    ("a new column", frame("jobs", lambda t: t.with_columns(new=pl.lit(1.0))), 0, ["note: b/jobs: column new is new"]),
    ("another order of columns", frame("jobs", lambda t: t.select(reversed(t.columns))), 0, []),
    (
        "whole numbers turned to floats",
        frame("jobs", lambda t: t.cast({"steps": pl.Float64})),
        1,
        ["is Int64 before, Float64 after"],
    ),
    (
        "floats of half the bits",
        frame("jobs", lambda t: t.cast({"speed_m_s": pl.Float32})),
        1,
        ["is Float64 before, Float32 after"],
    ),
    ("another commit", put("provenance", {**TOLD, "pontoon.commit": "2b"}), 0, ["the same"]),
    (
        "other instructions",
        put("provenance", {**TOLD, "pontoon.instruction_path": "scalar"}),
        0,
        ["note: b: computed on other instructions: x86-64 avx2 fma before, scalar after"],
    ),
    ("a missing table", drop("positions"), 1, ["b/positions is missing"]),
    ("a new table", put("modes", pl.DataFrame({"job": [0]})), 0, ["note: b/modes is a new table"]),
    (
        "a byte of the summary",
        put("summary", SUMMARY.replace(b"0.1", b"0.2")),
        1,
        ["from line 2", r"b'5,0.1\n' before"],
    ),
    ("the summary's last byte", put("summary", SUMMARY[:-1]), 1, ["from line 3"]),
    (
        "a summary's missing line",
        put("summary", b"speed_m_s,peak_deflection_m\n5,0.1\n"),
        1,
        ["from line 3", "b'' after"],
    ),
    ("a missing summary", put("summary", None), 1, ["b/summary.csv is missing"]),
    ("a file that is no table", put("jobs", b"PAR1 no table PAR1"), 2, ["no answer", "jobs.parquet cannot be read"]),
    ("an empty file", put("jobs", b""), 2, ["no answer"]),
]


def call(*words):
    said = io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        try:
            status = same_numbers([str(word) for word in words])
        except SystemExit as end:
            status = end.code
    return status, said.getvalue()


def program(path, kept, then=""):
    """A program that answers with kept results, and then does something; it fails where its cache is not empty."""
    path.write_text(
        f'#!/bin/sh\n[ -z "$(ls -A "$PONTOON_CACHE_DIR" 2>/dev/null)" ] || exit 3\n'
        f'cp -r "{kept}/$(basename "$2")" "$4"\n{then}\n'
    )
    path.chmod(0o755)
    return path


def trials(folder):
    """What is tried, arguments, the exit status, words of what is said."""
    fill(folder / "b")
    for i, (what, change, status, words) in enumerate(TRIALS):
        fill(folder / str(i), change)
        yield what, [folder / "b", folder / str(i)], status, words
    # what is new after is missing before
    fill(folder / "wide", frame("jobs", lambda t: t.with_columns(new=pl.lit(1.0))))
    yield "a new column the other way round", [folder / "wide", folder / "b"], 1, ["column new is missing"]

    # floats within lists are not compared by their bits, so they are not compared at all
    fill(folder / "lists", frame("jobs", lambda t: t.with_columns(pl.concat_list("speed_m_s").alias("speed_m_s"))))
    yield "a type that is not known", [folder / "lists", folder / "lists"], 2, ["no answer", "does not know"]

    fill(folder / "old" / "one")
    fill(folder / "old" / "two")
    fill(folder / "more" / "one")
    fill(folder / "more" / "two")
    fill(folder / "more" / "three")
    fill(folder / "fewer" / "one")
    fill(folder / "other" / "one")
    fill(folder / "other" / "two", cell("jobs", "steps", 0, 401))
    (folder / "empty").mkdir()
    old = folder / "old"
    yield "folders of results", [old, old], 0, ["the same: 2 folders of results, 4 tables"]
    yield "a new folder of results", [old, folder / "more"], 0, ["note: three is a new folder"]
    yield "a missing folder of results", [old, folder / "fewer"], 1, ["two is missing"]
    yield (
        "one folder of results that differs",
        [old, folder / "other"],
        1,
        ["two/jobs: column steps", "different: 1 differences"],
    )
    yield "one folder against many", [folder / "b", old], 2, ["no answer"]
    yield "no results", [old, folder / "empty"], 2, ["no answer", "holds no results"]
    yield "no folder", [old, folder / "nowhere"], 2, ["no answer"]
    yield "one argument", [old], 2, ["BEFORE and AFTER"]

    good = program(folder / "good", old)
    kept = ["--results", old, "--kept"]
    yield "a program with the kept numbers", [*kept, good], 0, ["the same: 2 folders of results"]
    yield "a program whose results are kept", [*kept, good, "--out", folder / "out"], 0, []
    yield "a folder of results that is not empty", [*kept, good, "--out", folder / "out"], 2, ["is not empty"]
    stale = folder / "stale"
    stale.mkdir()
    (stale / "file").touch()
    yield (
        "a cache that is told",
        [*kept, good, "--cache", stale],
        1,
        ["the program ends with status 3", "one/jobs is missing"],
    )
    yield (
        "a program with other numbers",
        [*kept, program(folder / "bad", folder / "other")],
        1,
        ["two/jobs: column steps"],
    )
    yield (
        "a program that breaks",
        [*kept, program(folder / "broken", old, "echo no >&2; exit 1")],
        1,
        ["ends with status 1: no"],
    )
    yield (
        "a program that leaves a study out",
        [*kept, program(folder / "less", folder / "fewer", "true")],
        1,
        ["two/jobs is missing"],
    )
    yield "no program", [*kept, folder / "nowhere"], 2, ["is no program"]


def main():
    wrong, tried = [], 0
    folder = Path(tempfile.mkdtemp())
    try:
        for what, words, status, parts in trials(folder):
            tried += 1
            came, said = call(*words)
            if came != status or not all(part in said for part in parts):
                wrong.append(f"{what}: exit status {came} for {status}, said for {parts}:\n{said}")
    finally:
        shutil.rmtree(folder)
    print("\n".join(wrong) if wrong else f"the comparison answers {tried} of {tried} trials as it should")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
