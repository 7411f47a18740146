"""Prints what a call from Python costs beside the program. See scripts/bench-python.

It measures speed and is no part of the tests. Both sides take turns, round after round, and of each the least time
counts, so that a machine that is busy for a moment favours neither. The program's time is that of its process, from its
start to its tables on disk, with operators in its cache; a call's is that from its words to its tables in memory.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pontoon as pt

BRIDGE = "studies/bridges/fu2005.json"
VEHICLE = {"footprint_length_m": 3.35, "track_y_m": [-1.4, 1.4], "inertia": "local"}
ANALYSIS = {"kind": "crossing", "time_step_s": 0.01, "tail_s": 6.0}
# from, to of the axes of the sweep
AXES = {
    "gap_tension_m": (0.0, 0.036),
    "gap_compression_m": (0.0, 0.018),
    "speed_m_s": (3.0, 15.0),
    "load_n": (1e5, 4e5),
}
ASKED_SHARE, ASKED_POINT_MS, ASKED_IMPORT_S, ASKED_GROWTH_MB = 0.03, 1.0, 0.15, 8.0
POINTS, CALLS, IMPORTS = 1000, 200, 7


def timed(work):
    """The seconds that work takes."""
    began = time.perf_counter()
    work()
    return time.perf_counter() - began


def study_of(design, folder):
    """A study in a folder."""
    bridge = os.path.relpath(BRIDGE, folder)
    study = {"name": "bench", "bridge": bridge, "vehicle": VEHICLE, "analysis": ANALYSIS, "design": design}
    (folder / "study.json").write_text(json.dumps(study))


def in_turn(rounds, *sides):
    """The least time of each side over rounds in which they take turns."""
    for side in sides:
        side()
    taken = [[timed(side) for side in sides] for _ in range(rounds)]
    return [min(of) for of in zip(*taken, strict=True)]


def resident_mb():
    """The memory of this process."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return 1e-6 * pages * os.sysconf("SC_PAGE_SIZE")


def sweep(jobs, rounds):
    """Seconds of the program and of `cross` for the same crossings."""
    points = round(jobs**0.25)
    axes = {name: np.linspace(*bounds, points).tolist() for name, bounds in AXES.items()}
    design = [{"grid": axes}]
    bridge = pt.Bridge(BRIDGE)
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        study_of(design, folder)
        run = [os.environ["PONTOON"], "run", str(folder), "--out", str(folder / "out"), "--fresh", "--quiet"]
        program = lambda: subprocess.run(run, check=True, stdout=subprocess.DEVNULL)
        call = lambda: bridge.cross(design=design, vehicle=VEHICLE, analysis=ANALYSIS, progress=False)
        return points**4, *in_turn(rounds, program, call)


def function(threads=0):
    """A function of two axes."""
    inputs = {"speed_m_s": (2, 20), "gap_tension_m": (0, 0.04)}
    fixed = {"load_n": 230_300, "gap_compression_m": 0.0055}
    words = {"vehicle": VEHICLE, "analysis": ANALYSIS, "threads": threads}
    return pt.Bridge(BRIDGE).function(inputs, ["peak_deflection_m"], **words, **fixed)


def many_points(rounds):
    """Seconds of the program and of a function for the same thousand points."""
    numbers = np.random.default_rng(1).random((POINTS, 2)) * [12, 0.036] + [3, 0]
    f = function()
    axes = dict(zip(f.inputs, numbers.T.tolist(), strict=True))
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        study_of([{"zip": {**axes, "load_n": 230_300, "gap_compression_m": 0.0055}}], folder)
        run = [os.environ["PONTOON"], "run", str(folder), "--out", str(folder / "out"), "--fresh", "--quiet"]
        program = lambda: subprocess.run(run, check=True, stdout=subprocess.DEVNULL)
        return in_turn(rounds, program, lambda: f(numbers, progress=False))


def one_point():
    """Milliseconds of a call with one point beyond those in which its crossing is solved, and those."""
    f = function()
    beyond, solved = [], []
    for number in range(CALLS):
        point = [15 - 0.01 * number, 0.028]
        seconds = timed(lambda point=point: f(point))
        solved.append(1e3 * f._last.solved_s)
        beyond.append(1e3 * seconds - solved[-1])
    return statistics.median(beyond), statistics.median(solved)


def imported():
    """Seconds that the import takes in a new process, less those of Python itself."""
    start = lambda text: timed(lambda: subprocess.run([sys.executable, "-c", text], check=True))
    taken = in_turn(IMPORTS, lambda: start("pass"), lambda: start("import pontoon"))
    return taken[1] - taken[0]


def growth():
    """Megabytes that a process grows by over 200 calls, each with 20 points."""
    f = function()
    call = lambda number: f(np.linspace([3, 0.0001 * number], [15, 0.03], 20), progress=False)
    for number in range(20):
        call(number)
    before = resident_mb()
    for number in range(CALLS):
        call(number)
    return resident_mb() - before


def main():
    """Measures and prints."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--jobs", type=int, default=10_000)
    arguments = parser.parse_args()
    short = []

    def row(what, program, call, figure, asked, holds):
        print(
            f"| {what} | {program} | {call} | {figure} | {asked} | {'holds' if holds else 'FALLS SHORT'} |", flush=True
        )
        if not holds:
            short.append(what)

    print("| what | program | from Python | figure | asked | |\n|---|---|---|---|---|---|")
    beyond_ms, solved_ms = one_point()
    what = "one point: beyond the solution of its crossing"
    row(what, "", f"{solved_ms:.1f} ms", f"{beyond_ms:.2f} ms", f"{ASKED_POINT_MS:g} ms", beyond_ms <= ASKED_POINT_MS)
    program, call = many_points(3 * arguments.rounds)
    share, asked = call / program - 1, f"at most +{ASKED_SHARE:.0%}"
    row(f"{POINTS:,} points", f"{program:.2f} s", f"{call:.2f} s", f"{share:+.1%}", asked, share <= ASKED_SHARE)
    jobs, program, call = sweep(arguments.jobs, arguments.rounds)
    share = call / program - 1
    row(f"{jobs:,} crossings", f"{program:.1f} s", f"{call:.1f} s", f"{share:+.1%}", asked, share <= ASKED_SHARE)
    seconds = imported()
    row("import", "", "", f"{seconds:.3f} s", f"{ASKED_IMPORT_S:g} s", seconds <= ASKED_IMPORT_S)
    grown = growth()
    what = f"memory over {CALLS} calls"
    row(what, "", "", f"{grown:+.1f} MB", f"{ASKED_GROWTH_MB:g} MB", grown <= ASKED_GROWTH_MB)
    return 1 if short else 0


if __name__ == "__main__":
    sys.exit(main())
