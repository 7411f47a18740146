"""Indices of sensitivity by the program against SALib on the same points and outputs. See scripts/indices."""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import polars as pl
from accuracy import ROOT, Table
from SALib.analyze import morris, sobol
from SALib.util import _compute_delta

RANGES = {
    "speed_m_s": [2, 20],
    "gap_tension_m": [0, 0.04],
    "gap_compression_m": [0, 0.01],
    "load_n": [50e3, 400e3],
}
# so many that no two points are equal: each has a row of its own
LEVELS = 100
# how far an index may be off: of shares, and of effects in the largest effect
ASKED = 1e-10
PROBLEM = {"num_vars": len(RANGES), "names": list(RANGES), "bounds": list(RANGES.values())}
# beyond so many steps a crossing fails: of a slow one
STEP_LIMITS = {"all jobs solved": None, "slow jobs failed": 500}


def designs(rows, seed):
    """Designs by what they are called, each with the points of a group."""
    spec = {"seed": seed, "ranges": RANGES}
    k = len(RANGES)
    return {
        "saltelli": ({"saltelli": spec | {"count": rows}}, k + 2),
        "saltelli with pairs": ({"saltelli": spec | {"count": rows, "second_order": True}}, 2 * k + 2),
        "morris": ({"morris": spec | {"trajectories": rows, "levels": LEVELS}}, k + 1),
    }


def pontoon(*words):
    """What the program prints; jobs that failed are no fault."""
    done = subprocess.run([os.environ["PONTOON"], *map(str, words)], capture_output=True, text=True)
    if done.returncode not in (0, 1):
        sys.exit(f"pontoon {words[0]}: {done.stderr}")
    return done.stdout


def ran(folder, name, design, step_limit):
    """The table of jobs and the indices of one design."""
    limit = {"step_limit": step_limit} if step_limit else {}
    study = {
        "name": name.replace(" ", "-").replace(",", ""),
        "bridge": str(ROOT / "studies/bridges/smoke.json"),
        "vehicle": {"footprint_length_m": 3.35, "inertia": "local"},
        "analysis": {"kind": "crossing", "time_step_s": 0.02, "tail_s": 2.0} | limit,
        "design": [design],
    }
    file, out = folder / f"{name}.json", folder / name
    file.write_text(json.dumps(study))
    pontoon("run", file, "--out", out, "--quiet")
    found = json.loads(pontoon("indices", out, "--format", "json", "--resamples", 100))
    return pl.read_parquet(out / "jobs.parquet"), found["designs"][0]


def stand_as_sampled(name, groups):
    """Whether the points of each group, divided by ranges, stand as those of SALib's samples."""
    k = len(RANGES)
    low, high = np.array(PROBLEM["bounds"]).T
    unit = (groups - low) / (high - low)
    if name == "morris":
        steps = np.diff(unit, axis=1)
        delta = _compute_delta(LEVELS)
        moved = np.abs(steps) > 1e-9
        even = np.abs(np.abs(steps[moved]) - delta).max() < 1e-9
        return even and (moved.sum(axis=1) == 1).all() and (moved.sum(axis=2) == 1).all()
    a, b = groups[:, 0], groups[:, -1]
    a_b = [np.where(np.arange(k) == i, b, a) for i in range(k)]
    b_a = [np.where(np.arange(k) == i, a, b) for i in range(k)] if "pairs" in name else []
    return np.array_equal(groups, np.stack([a, *a_b, *b_a, b], axis=1))


def by_salib(name, x, y):
    """SALib's indices of whole groups, by the keys that the program has."""
    if name == "morris":
        found = morris.analyze(PROBLEM, x.reshape(-1, len(RANGES)), y.ravel(), num_levels=LEVELS, seed=1)
        return {key: np.asarray(found[key], dtype=float) for key in ("mu", "mu_star", "sigma")}
    pairs = "pairs" in name
    found = sobol.analyze(PROBLEM, y.ravel(), calc_second_order=pairs, seed=1)
    upper = np.triu_indices(len(RANGES), 1)
    return {key.lower(): found[key] for key in ("S1", "ST")} | ({"s2": found["S2"][upper]} if pairs else {})


def by_program(output):
    """The program's indices of an output, by key."""
    (form,) = output["indices"].values()
    keys = lambda entries: [key for key, x in entries[0].items() if isinstance(x, float) and "conf" not in key]
    lists = [form["factors"], *([form["pairs"]] if form.get("pairs") else [])]
    return {key: np.array([entry[key] for entry in entries]) for entries in lists for key in keys(entries)}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--rows", type=int, default=64)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    table = Table()
    with tempfile.TemporaryDirectory() as place:
        for state, step_limit in STEP_LIMITS.items():
            for name, (design, points) in designs(options.rows, options.seed).items():
                jobs, found = ran(pathlib.Path(place), f"{name}, {state}", design, step_limit)
                if len(jobs) != points * options.rows:
                    sys.exit(f"{name}: {len(jobs)} jobs of {points * options.rows} points")
                x = jobs.select(list(RANGES)).to_numpy().reshape(options.rows, points, -1)
                if not step_limit:
                    table.row(f"{name}: order of points", "SALib's", "as SALib's samples", stand_as_sampled(name, x))
                # of each index the largest deviation, and the smallest of one that is 5 % wrong
                off, wrong, left_out = {}, {}, set()
                for output in found["outputs"]:
                    y = jobs[output["column"]].cast(float).to_numpy().reshape(options.rows, points)
                    whole = np.isfinite(y).all(axis=1)
                    left_out.add((output["left_out"], int((~whole).sum())))
                    own = by_program(output)
                    for key, expected in by_salib(name, x[whole], y[whole]).items():
                        scale = np.abs(expected).max() if name == "morris" else 1.0
                        by = lambda share, own=own[key], of=expected, to=scale: np.abs(own - share * of).max() / to
                        off[key] = max(off.get(key, 0.0), by(1.0))
                        wrong[key] = min(wrong.get(key, np.inf), by(1.05))
                for key, by in off.items():
                    what = f"{name}, {state}: {key} of {len(found['outputs'])} outputs"
                    table.row(what, f"{ASKED:g}", f"{by:.1e}", by <= ASKED < wrong[key])
                told = ", ".join(str(ours) for ours, _ in sorted(left_out))
                good = all(ours == theirs for ours, theirs in left_out) and (left_out != {(0, 0)}) == bool(step_limit)
                table.row(f"{name}, {state}: groups left out", "those with a failed job", told, good)
    sys.exit(1 if table.short else 0)


if __name__ == "__main__":
    main()
