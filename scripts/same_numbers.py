"""Whether two folders of results hold the same numbers, bit for bit; scripts/same-numbers tells how it is called.

Every table and column of BEFORE must be in AFTER, with the same type and the same values in the same rows. Floats are
compared by their bits, so that -0.0 is not 0.0 and a NaN is only itself. What is only in AFTER is listed and is no
difference. The order of columns is not looked at, as readers take them by name. The provenance in a table is not
compared: it names the commit. Where it tells of other inputs or instructions, that is noted, as it may be why numbers
differ.
"""

import argparse
import os
import struct
import subprocess
import sys
import tempfile
import traceback
from dataclasses import dataclass, field
from pathlib import Path

import polars as pl

ROOT = Path(__file__).resolve().parent.parent
KEPT = ROOT / "tests" / "data" / "kept_results"
SUMMARY = "summary.csv"
SAME, DIFFERENT, UNREADABLE = 0, 1, 2
# floats and the whole numbers that have the same bits
BITS = {pl.Float64: pl.UInt64, pl.Float32: pl.UInt32}
# rows that are shown of a column
SHOWN = 3
# provenance in which a difference may be why numbers differ
TOLD = {
    "pontoon.instruction_path": "computed on other instructions",
    "pontoon.study_blake3": "another text of the study",
    "pontoon.bridge_blake3": "another text of the bridge",
}


class Unreadable(Exception):
    """Something that cannot be compared."""


@dataclass
class Report:
    """What was compared and what was found."""

    lines: list[str] = field(default_factory=list)
    differences: int = 0
    studies: int = 0
    tables: int = 0
    columns: int = 0
    values: int = 0

    def differs(self, text):
        self.differences += 1
        self.lines.append(f"differs: {text}")

    def note(self, text):
        # all tables of a folder tell the same provenance
        if f"note: {text}" not in self.lines:
            self.lines.append(f"note: {text}")

    def end(self):
        """The last line, and the exit status."""
        compared = (
            f"{self.studies} folders of results, {self.tables} tables, {self.columns} columns, {self.values} values"
        )
        if self.differences:
            return f"different: {self.differences} differences in {compared}", DIFFERENT
        return f"the same: {compared}", SAME


def tables(folder):
    return {path.stem: path for path in sorted(folder.glob("*.parquet")) if path.is_file()}


def read(path):
    try:
        # a name with brackets or an equals sign is a name and no pattern
        return pl.read_parquet(path, glob=False, hive_partitioning=False), pl.read_parquet_metadata(path)
    except (pl.exceptions.PolarsError, pl.exceptions.PanicException, OSError) as cause:
        raise Unreadable(f"{path} cannot be read: {cause}") from cause


def shown(value):
    """A cell with all its digits."""
    if value is None:
        return "null"
    if isinstance(value, float):
        # NaNs look alike but for their bits
        return f"nan of bits {struct.pack('>d', value).hex()}" if value != value else f"{value:.17g}"
    return repr(value)


def relative(before, after):
    """The difference of two cells over the larger of them; none where one is no finite number."""
    if any(isinstance(x, bool) or not isinstance(x, (int, float)) for x in (before, after)):
        return None
    larger = max(abs(before), abs(after))
    share = abs(after - before) / larger if larger else 0.0
    return share if share < float("inf") else None


def unequal_rows(before, after, name):
    """The numbers of the rows in which two columns of one type differ."""
    kind = before.dtype
    if kind in BITS:
        before, after = before.reinterpret(dtype=BITS[kind]), after.reinterpret(dtype=BITS[kind])
    elif not (kind.is_integer() or kind in (pl.Boolean, pl.String)):
        raise Unreadable(f"{name} is of type {kind}, which this comparison does not know")
    return before.ne_missing(after).arg_true().to_list()


def compare_column(report, name, before, after, jobs):
    rows = unequal_rows(before, after, name)
    if not rows:
        return
    pairs = zip(before.gather(rows), after.gather(rows), strict=True)
    shares = {row: relative(*pair) for row, pair in zip(rows, pairs, strict=True)}
    known = {row: share for row, share in shares.items() if share is not None}
    text = f"{name}: {len(rows)} of {len(before)} rows"
    listed = rows[:SHOWN]
    if known:
        worst = max(known, key=known.get)
        text += f", largest relative difference {known[worst]:.3g} in row {worst}"
        if worst not in listed:
            listed.append(worst)
    for row in listed:
        job = "" if jobs is None else f" (job {jobs[row]})"
        text += f"\n  row {row}{job}: {shown(before[row])} before, {shown(after[row])} after"
    report.differs(text)


def compare_table(report, name, before, after):
    before, told_before = read(before)
    after, told_after = read(after)
    report.tables += 1
    for key, what in TOLD.items():
        if told_before.get(key) != told_after.get(key):
            texts = [told.get(key, "nothing") for told in (told_before, told_after)]
            report.note(f"{name.split('/')[0]}: {what}: {texts[0]} before, {texts[1]} after")
    for column in after.columns:
        if column not in before.columns:
            report.note(f"{name}: column {column} is new")
    if before.height != after.height:
        report.differs(f"{name}: {before.height} rows before, {after.height} after")
    jobs = before["job"] if "job" in before.columns else None
    for column in before.columns:
        if column not in after.columns:
            report.differs(f"{name}: column {column} is missing")
        elif before[column].dtype != after[column].dtype:
            report.differs(f"{name}: column {column} is {before[column].dtype} before, {after[column].dtype} after")
        elif before.height == after.height:
            compare_column(report, f"{name}: column {column}", before[column], after[column], jobs)
            report.columns += 1
            report.values += before.height


def compare_summary(report, name, before, after):
    try:
        texts = [path.read_bytes() if path.exists() else None for path in (before, after)]
    except OSError as cause:
        raise Unreadable(f"{cause.filename} cannot be read: {cause.strerror}") from cause
    if texts[0] == texts[1]:
        return
    if texts[0] is None:
        report.note(f"{name} is new")
    elif texts[1] is None:
        report.differs(f"{name} is missing")
    else:
        lines = [text.splitlines(keepends=True) + [b""] for text in texts]
        first = next(i for i, pair in enumerate(zip(*lines, strict=False)) if pair[0] != pair[1])
        text = f"{name}: its bytes, from line {first + 1}"
        for told, when in zip(lines, ("before", "after"), strict=True):
            text += f"\n  {told[first]!r} {when}"
        report.differs(text)


def compare_results(report, name, before, after):
    """Compares one folder of results with another."""
    report.studies += 1
    old, new = tables(before), tables(after)
    for table in new:
        if table not in old:
            report.note(f"{name}/{table} is a new table")
    for table, path in old.items():
        if table not in new:
            report.differs(f"{name}/{table} is missing")
        else:
            compare_table(report, f"{name}/{table}", path, new[table])
    compare_summary(report, f"{name}/{SUMMARY}", before / SUMMARY, after / SUMMARY)


def folders(path):
    """Whether a path is a folder of results or one of such folders, and those folders by name."""
    try:
        if tables(path):
            return "results", {path.resolve().name: path}
        inside = {below.name: below for below in sorted(path.iterdir()) if below.is_dir() and tables(below)}
    except OSError as cause:
        raise Unreadable(f"{path} cannot be read: {cause.strerror}") from cause
    if not inside:
        raise Unreadable(f"{path} holds no results: no Parquet tables in it or in the folders in it")
    return "folders of results", inside


def compare(report, before, after):
    (kind_before, old), (kind_after, new) = folders(before), folders(after)
    if kind_before != kind_after:
        raise Unreadable(f"{before} holds {kind_before}, but {after} holds {kind_after}")
    if kind_before == "results":
        # two folders of results may have any names
        compare_results(report, *old, *old.values(), *new.values())
        return
    for name in new:
        if name not in old:
            report.note(f"{name} is a new folder of results")
    for name, folder in old.items():
        if name not in new:
            report.differs(f"{name} is missing")
        else:
            compare_results(report, name, folder, new[name])


def run_kept(report, program, kept, out, cache, threads):
    """Runs a program over the studies of the kept results and compares what comes with them."""
    _, old = folders(kept)
    if not (program.is_file() and os.access(program, os.X_OK)):
        raise Unreadable(f"{program} is no program")
    if out.exists() and (not out.is_dir() or any(out.iterdir())):
        # a run goes on from what it finds, and what it finds is no answer of this program
        raise Unreadable(f"{out} is not empty")
    out.mkdir(parents=True, exist_ok=True)
    for name, folder in old.items():
        # from the root, as the kept results were made
        command = [program.resolve(), "run", f"studies/{name}", "--out", out.resolve() / name, "--quiet"]
        command += [] if threads is None else ["--threads", str(threads)]
        try:
            done = subprocess.run(
                command,
                cwd=ROOT,
                env={**os.environ, "PONTOON_CACHE_DIR": str(cache.resolve())},
                capture_output=True,
                text=True,
                check=False,
            )
        except OSError as cause:
            raise Unreadable(f"{program} does not run: {cause.strerror}") from cause
        # every kept study ran to its end without a failed job
        if done.returncode != 0:
            report.differs(f"{name}: the program ends with status {done.returncode}: {done.stderr.strip()}")
        compare_results(report, name, folder, out / name)


def arguments(words):
    parser = argparse.ArgumentParser(
        prog="scripts/same-numbers",
        description="Whether results are the same, bit for bit.",
        epilog="Exit status: 0 the same, 1 different, 2 unreadable or wrong arguments. "
        "--self-test alone tries the comparison itself.",
    )
    parser.add_argument(
        "before", nargs="?", type=Path, metavar="BEFORE", help="a folder of results, or of such folders"
    )
    parser.add_argument("after", nargs="?", type=Path, metavar="AFTER", help="what is held against it")
    parser.add_argument(
        "--kept", type=Path, metavar="PROGRAM", help="run this program over the kept studies and compare"
    )
    parser.add_argument(
        "--out", type=Path, metavar="DIR", help="with --kept: keep what the program writes, in an empty folder"
    )
    parser.add_argument("--threads", type=int, metavar="N", help="with --kept: threads of the program")
    parser.add_argument(
        "--cache",
        type=Path,
        metavar="DIR",
        help="with --kept: the program's cache; else an empty one, so that what is stale cannot help",
    )
    parser.add_argument(
        "--results",
        type=Path,
        default=KEPT,
        metavar="DIR",
        help="with --kept: other kept results than tests/data/kept_results",
    )
    told = parser.parse_args(words)
    if told.kept is None:
        if told.before is None or told.after is None:
            parser.error("BEFORE and AFTER, or --kept PROGRAM")
        if told.out or told.cache or told.threads is not None or told.results != KEPT:
            parser.error("--out, --cache, --threads and --results go with --kept")
    elif told.before is not None:
        parser.error("--kept takes no BEFORE and AFTER")
    return told


def main(words):
    told = arguments(words)
    report = Report()
    try:
        if told.kept is None:
            compare(report, told.before, told.after)
        else:
            with tempfile.TemporaryDirectory() as spare:
                out, cache = told.out or Path(spare) / "results", told.cache or Path(spare) / "cache"
                run_kept(report, told.kept, told.results, out, cache, told.threads)
    except Unreadable as cause:
        print("\n".join(report.lines + [f"no answer: {cause}"]))
        return UNREADABLE
    end, status = report.end()
    print("\n".join([*report.lines, end]))
    return status


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except Exception:  # a fault of the comparison must not look like a difference
        traceback.print_exc()
        sys.exit(UNREADABLE)
