"""Prints paper, prototype and pontoon side by side from the folders that scripts/reproduce filled."""

import json
import sys
from pathlib import Path

import polars as pl

OUT = Path(sys.argv[1])
# Fu, Cui, Chen, Wang: Marine Structures 18 (2005) 85-107, Table 1, full model
MODULE = {"heave": 0.355, "roll": 0.353, "pitch": 0.354}
BRIDGE = {
    "vertical bending 1": 0.362, "vertical bending 2": 0.410, "vertical bending 3": 0.535, "torsion 1": 0.726,
    "vertical bending 4": 0.749, "horizontal bending 1": 0.882, "vertical bending 5": 1.040, "torsion 2": 1.354,
    "vertical bending 6": 1.395, "vertical bending 7": 1.800, "torsion 3": 1.968, "vertical bending 8": 2.241,
    "horizontal bending 2": 2.359, "vertical bending 9": 2.702,
}
# position 7 and joint 7 of an independent prototype: deflection [cm] and compression [kN] by speed [m/s]
PROTOTYPE = {
    ("linear", None, None): [(14.7, 649), (15.0, 632), (14.8, 682), (19.1, 729)],
    ("nonlinear", 0.028, 0.0055): [(21.3, 557), (21.6, 575), (23.3, 640), (31.9, 925)],
    ("nonlinear", 0.028, 0.0): [(19.1, 607), (19.3, 628), (21.1, 780), (30.3, 1110)],
    ("nonlinear", 0.005, 0.0055): [(21.1, 491), (20.5, 489), (20.0, 524), (30.4, 826)],
    ("nonlinear", 0.0, 0.0055): [(18.8, 431), (19.5, 456), (18.4, 472), (29.1, 829)],
}
SPEEDS = [3.0, 7.0, 10.0, 15.0]
SETTING = ["connection", "gap_tension_m", "gap_compression_m"]


def line(name, expected, got, allowed, unit=""):
    deviation = 100.0 * (got / expected - 1.0)
    verdict = "" if allowed is None else ("ok" if abs(deviation) <= allowed else "OFF")
    limit = "" if allowed is None else f"{allowed:g} %"
    print(f"{name:58} {expected:10.4g} {got:10.4g} {unit:4} {deviation:+7.2f} % {limit:>6} {verdict}")


def head(title):
    print(f"\n{title:58} {'expected':>10} {'got':>10} {'':4} {'deviation':>9} {'limit':>6}")


def modes(name):
    table = json.loads((OUT / name).read_text())
    return {mode["shape"]: mode["frequency_hz"] for mode in table}


def read(study, table):
    return pl.read_parquet(OUT / study / f"{table}.parquet")


def at_seven(study):
    position = read(study, "positions").filter(pl.col("position") == 7).select("job", w="peak_deflection_m")
    joint = read(study, "connectors").filter((pl.col("joint") == 7) & pl.col("y_m").is_null())
    joint = joint.select("job", c="peak_compression_n")
    return read(study, "jobs").join(position, on="job").join(joint, on="job")


module, full, condensed = (
    modes(n) for n in ("modesmodulecount6.json", "modescount24.json", "modesmodelsuperelementcount24.json")
)
head("frequencies, full model [Hz], against the paper")
for shape, expected in MODULE.items():
    line(f"module {shape}", expected, module[shape], 1.0)
for shape, expected in BRIDGE.items():
    line(shape, expected, full[shape], 3.0)
head("super-element against full model [Hz]")
for shape in BRIDGE:
    line(shape, full[shape], condensed[shape], 0.2)
    assert condensed[shape] >= full[shape] * (1.0 - 1e-8), f"{shape} lies below the full model's"

head("static, 230.3 kN at position 7, against the paper")
static = {tuple(r[k] for k in SETTING): r for r in read("fu2005_static", "jobs").to_dicts()}
linear, gaps = static[("linear", None, None)], static[("nonlinear", 0.028, 0.0055)]
line("linear peak deflection [m]", 0.141, linear["peak_deflection_m"], 4.0)
line("linear influential length [m]", 74.0, linear["influential_length_m"], 4.0)
line("gaps 28 / 5.5 mm peak deflection [m]", 0.210, gaps["peak_deflection_m"], 5.0)

jobs = at_seven("fu2005")
rows = {(tuple(r[k] for k in SETTING), r["speed_m_s"]): r for r in jobs.filter(pl.col("load_n") == 230300).to_dicts()}
head("position 7 deflection [cm] and joint 7 compression [kN], against the prototype")
for setting, cells in PROTOTYPE.items():
    for speed, (deflection, compression) in zip(SPEEDS, cells):
        row = rows[(setting, speed)]
        name = f"{setting[0]} {setting[1]} {setting[2]} {speed:g} m/s"
        line(f"{name} deflection", deflection, 100.0 * row["w"], 4.0)
        line(f"{name} compression", compression, row["c"] / 1e3, 8.0)
hump = rows[(("nonlinear", 0.028, 0.0055), 15.0)]["w"] / rows[(("nonlinear", 0.028, 0.0055), 3.0)]["w"]
line("hump ratio of position 7, 15 over 3 m/s (paper)", 1.5, hump, 5.3)
print(f"largest energy residual {jobs['energy_residual'].max():.1e} of the work (limit 1e-2)")
print(f"largest numerical dissipation {100 * jobs['numerical_dissipation'].max():.2f} % of the work (limit 5 %)")
crossings = json.loads((OUT / "fu2005" / "manifest.json").read_text())
print("manifest:", {k: v for k, v in crossings.items() if "second" in k or k in ("threads", "condensations", "jobs", "failed")})

steps = at_seven("fu2005_time_step")
keys = [*SETTING, "speed_m_s", "load_n"]
coarse, fine = (steps.filter(pl.col("analysis.time_step_s") == h) for h in (0.01, 0.005))
both = coarse.join(fine, on=keys, nulls_equal=True, suffix="_fine")
print("\nhalving the time step, largest moves over", both.height, "jobs")
for name, column, limit in (("peak deflection of the job", "peak_deflection_m", 0.5), ("compression of joint 7", "c", 3.0)):
    moves = both.select(*keys, move=100.0 * (pl.col(f"{column}_fine") / pl.col(column) - 1.0).abs()).sort("move")
    worst = moves.row(-1, named=True)
    print(f"{name:30} {worst['move']:.2f} % (limit {limit} %) at {worst}")
    for row in moves.filter(pl.col("move") > limit).to_dicts():
        print("   beyond the limit:", row)

lane = read("fu2005_lane", "jobs").sort("job").to_dicts()
forces = read("fu2005_lane", "connectors").filter(pl.col("y_m").is_not_null())
by_job = [
    {(r["joint"], r["y_m"]): (r["peak_compression_n"], r["peak_tension_n"]) for r in forces.filter(pl.col("job") == j).to_dicts()}
    for j in range(3)
]
head("one lane (y = 1 and 3 m), super-element against full model")
line("edge deflection [m]", lane[1]["peak_edge_deflection_m"], lane[0]["peak_edge_deflection_m"], 0.5)
line("roll [rad]", lane[1]["peak_roll_rad"], lane[0]["peak_roll_rad"], 0.5)
worst = max(
    abs(a - b) / b for key in by_job[0] for a, b in zip(by_job[0][key], by_job[1][key]) if b > 0.0
)
print(f"largest deviation of a connector's peak force: {100 * worst:.2f} % (limit 1 %)")
mirrored = max(
    abs(a - b) / max(b, 1.0) for (joint, y), pair in by_job[0].items() for a, b in zip(by_job[2][(joint, -y)], pair)
)
print(f"largest deviation of the mirrored lane's connector forces: {mirrored:.1e}")
