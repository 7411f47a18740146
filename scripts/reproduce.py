"""Prints paper and pontoon side by side from the folders that scripts/reproduce filled, then other studies' answers."""

import json
import sys
from pathlib import Path

import polars as pl

OUT = Path(sys.argv[1])
PAPER = ["table1", "fig09_static", "fig10_test_run", "fig12_14_gap_tension", "fig13_15_gap_compression"]
SETTING = ["connection", "gap_tension_m", "gap_compression_m"]
WORDS = {
    "holds": "holds",
    "falls-short": "FALLS SHORT",
    "expected-fail": "fails as expected",
    "now-holds": "CHANGED: holds now",
    "record": "record",
}


def percent(share):
    return "" if share is None else f"{100 * share:+.2f} %"


def rows():
    """A row a check: where from, what, paper, ours, deviation, margin, verdict."""
    for study in PAPER:
        for line in json.loads((OUT / f"{study}.comparison.json").read_text())["lines"]:
            worst = line["worst"]
            ours = " > ".join(f"{value:.4g}" for value in worst["values"])
            paper = line["expected"] if line["expected_value"] is None else f"{line['expected_value']:g}"
            # a limit of ours is no figure of the paper's
            if line["id"].endswith(("super-element over own full", "condensed from above")):
                paper = line["expected"]
            yield (
                study,
                line["id"],
                paper,
                ours,
                percent(worst["deviation"]),
                percent(worst["margin"]),
                WORDS[line["verdict"]],
            )


def table(head, body):
    widths = [max(len(row[i]) for row in [head, *body]) for i in range(len(head))]
    for row in [head, *body]:
        print("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip())


def read(study, name):
    return pl.read_parquet(OUT / study / f"{name}.parquet")


def at_seven(study):
    position = read(study, "positions").filter(pl.col("position") == 7).select("job", w="peak_deflection_m")
    joint = read(study, "connectors").filter((pl.col("joint") == 7) & pl.col("y_m").is_null())
    joint = joint.select("job", c="peak_compression_n")
    return read(study, "jobs").join(position, on="job").join(joint, on="job")


def numbers(document, path=()):
    """All numbers of a document with their paths, its provenance left out."""
    if isinstance(document, dict):
        for key, value in document.items():
            if key != "provenance":
                yield from numbers(value, (*path, key))
    elif isinstance(document, list):
        for i, value in enumerate(document):
            yield from numbers(value, (*path, i))
    elif isinstance(document, (int, float)):
        yield path, float(document)


table(["study", "check", "paper", "ours", "deviation", "margin", "verdict"], list(rows()))

print("\nidentification\n")
print((OUT / "identification.txt").read_text())
own = dict(numbers(json.loads(Path("studies/bridges/fu2005.json").read_text())))
found = dict(numbers(json.loads((OUT / "identified.json").read_text())))
assert own.keys() == found.keys(), "the identified bridge has other keys than studies/bridges/fu2005.json"
worst = max(abs(found[path] - value) / max(abs(value), 1e-300) for path, value in own.items())
print(f"largest difference from studies/bridges/fu2005.json: {worst:.1e} of a number")

jobs = at_seven("fu2005")
print(f"\n{jobs.height} crossings: largest energy residual {jobs['energy_residual'].max():.1e} of the work,", end=" ")
print(f"largest numerical dissipation {100 * jobs['numerical_dissipation'].max():.2f} %")

steps = at_seven("fu2005_time_step")
keys = [*SETTING, "speed_m_s", "load_n"]
coarse, fine = (steps.filter(pl.col("analysis.time_step_s") == h) for h in (0.01, 0.005))
both = coarse.join(fine, on=keys, nulls_equal=True, suffix="_fine")
print(f"halving the time step of {both.height} jobs moves")
for name, column in (("the job's peak deflection", "peak_deflection_m"), ("the compression of joint 7", "c")):
    move = 100.0 * (both[f"{column}_fine"] / both[column] - 1.0).abs()
    worst = both.row(move.arg_max(), named=True)
    print(f"  {name} by at most {move.max():.2f} %, at", {key: worst[key] for key in keys})

lane = read("fu2005_lane", "jobs").sort("job").to_dicts()
forces = read("fu2005_lane", "connectors").filter(pl.col("y_m").is_not_null())
by_job = [
    {
        (r["joint"], r["y_m"]): (r["peak_compression_n"], r["peak_tension_n"])
        for r in forces.filter(pl.col("job") == j).to_dicts()
    }
    for j in range(3)
]
print("one lane (y = 1 and 3 m), super-element against full model")
for name in ("peak_edge_deflection_m", "peak_roll_rad"):
    print(f"  {name}: {lane[0][name]:.6f} against {lane[1][name]:.6f}")
worst = max(abs(a - b) / b for key in by_job[0] for a, b in zip(by_job[0][key], by_job[1][key], strict=True) if b > 0.0)
print(f"  a connector's peak force differs by at most {100 * worst:.2f} %")
mirrored = max(
    abs(a - b) / max(b, 1.0)
    for (joint, y), pair in by_job[0].items()
    for a, b in zip(by_job[2][(joint, -y)], pair, strict=True)
)
print(f"  the mirrored lane's forces differ by at most {mirrored:.1e}")
