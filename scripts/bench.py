"""Prints how fast pontoon is: beside OpenSees, on two threads beside one, beside a core's peak. See scripts/bench.

It measures speed and is no part of the tests. Knows what is asked and which clock is read when; models and loops of
OpenSees are those of peers.py. Both sides take turns, round after round, and of each the least time counts, so that a
machine that is busy for a moment favours neither.

A step of OpenSees' is one of a plane chain, weight only, which is the smaller problem: one connector a joint and no
energy balance. There are two chains. The one that somebody would script has 4 elements a module and rigid posts: 225
degrees of freedom. The other has 8 elements a module and posts of beams on every node: 779. Pontoon's step is one of
the bridge in space with everything that it reports. Gaps, load, footprint, speed, time step and tail are the same. Of
OpenSees' equation solvers and algorithms the fastest on these chains stand here; their answers agree within 1e-8.
"""

import argparse
import json
import math
import os
import platform
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import openseespy.opensees as ops
import peers

SPEEDS_M_S = [15.0, 7.0]
MODES = 20
EQUATIONS, ALGORITHM = "ProfileSPD", "KrylovNewton"
# what preparing bridges of so many modules may take, and how it may grow
MODULES = {30: None, 60: None, 120: 20.0, 200: 60.0}
ASKED_EXPONENT, ASKED_MEMORY_GB = 2.3, 4.0
ASKED_THREADS, ASKED_SWEEP_S = 1.9, 12.0
PLAN_OFF = 0.3
# what no case may cost more than before
SLOWER = 1.03
VEHICLE = {
    "footprint_length_m": peers.FOOTPRINT_M,
    "track_y_m": peers.TRACK_Y_M,
    "patch_points": peers.FOOTPRINT_POINTS,
}
KINDS = {"local": "local inertia", "none": "weight only", "convective": "convective inertia"}
TRUCKS = {"on springs": "truck of two axles on springs"}
NAMED = [*KINDS.values(), *TRUCKS.values()]
KEYS = ("lone_step_s", "full_step_s", "mixed_step_s")
# times the chain of 225 degrees of freedom at 15 m/s
ASKED = {
    ("local inertia", "centred", "full_step_s"): 1500,
    ("local inertia", "off the centre", "full_step_s"): 600,
    ("weight only", "centred", "full_step_s"): 3000,
    ("convective inertia", "centred", "full_step_s"): 1000,
    ("truck of two axles on springs", "centred", "full_step_s"): 900,
    ("local inertia", "centred", "lone_step_s"): 400,
}
# from, to of the sweep's axes, each in as many values as the number of jobs asks for
AXES = {
    "gap_tension_m": (0.0, 0.036),
    "gap_compression_m": (0.0, 0.018),
    "speed_m_s": (3.0, 15.0),
    "load_n": (1e5, 4e5),
}


# ---- the table


class Table:
    """Rows of Markdown, and the names of those that fall short of what is asked."""

    def __init__(self):
        self.rows, self.short = [], []

    def row(self, what, ours, other, figure, asked="", holds=True):
        """A line of the table."""
        if not holds:
            self.short.append(f"{what}: {figure}, asked {asked}")
        self.rows.append((what, ours, other, figure, asked, "" if not asked else "holds" if holds else "FALLS SHORT"))

    def ratio(self, what, ours, other, ratio, at_least=None):
        """A line whose figure is how many times faster."""
        asked = "" if at_least is None else f"{at_least:,g}"
        self.row(
            what,
            ours,
            other,
            f"{ratio:,.3g}" if ratio < 1000 else f"{ratio:,.0f}",
            asked,
            at_least is None or ratio >= at_least,
        )

    def print(self):
        """All of it."""
        head = ("what", "pontoon", "beside", "figure", "asked", "")
        for row in (head, ("---",) * len(head), *self.rows):
            print("| " + " | ".join(row) + " |")


def note(text):
    """Says what is being measured."""
    print(text, file=sys.stderr, flush=True)


def micro(seconds):
    """As microseconds."""
    return f"{1e6 * seconds:,.3g} µs" if seconds < 1e-3 else f"{1e6 * seconds:,.0f} µs"


def cpu():
    """What the machine calls its processor."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        lines = []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return f"{names[0]}, {os.cpu_count()} cores" if names else f"{platform.processor()}, {os.cpu_count()} cores"


# ---- crossings


# The chains by their degrees of freedom.
CHAINS = {225: {"elements_along_module": 4, "posts": "rigid"}, 779: {}}


def chain_steps_s(chain):
    """For each chain and speed the seconds a step of OpenSees' loop, outputs read, and the largest deflection [m]."""
    found = {}
    for dofs, changes in CHAINS.items():
        for speed_m_s in SPEEDS_M_S:
            crossing = {"connection": "nonlinear", "speed_m_s": speed_m_s}
            ready = peers.ChainCrossing(chain | changes, crossing, chain["time_step_s"], EQUATIONS, ALGORITHM)
            (z_m, _), seconds = peers.timed(ready.run)
            found[dofs, speed_m_s] = seconds / ready.steps, float(-z_m.min())
    return found


def steps_s(program, into):
    """Takes what the program needs for a step of each case; its whole answer."""
    speed = json.loads(subprocess.check_output([program]))
    for c in speed["crossings"]:
        for key in KEYS:
            into.setdefault((c["speed_m_s"], KINDS[c["inertia"]], c["place"], key), []).append(c[key])
    for c in speed["trucks"]:
        kind = TRUCKS.get(c["truck"], f"{c['truck']} truck of two axles")
        for key in KEYS[:2]:
            into.setdefault((c["speed_m_s"], kind, "centred", key), []).append(c[key])
    return speed


def compare_crossings(table, rounds, before):
    """A step alone and in full lanes beside a step of the chain's, medians of rounds; the share of the core's peak."""
    chain = json.loads(peers.CHAIN.read_text())
    ours, earlier, theirs, deflections, peak = {}, {}, {}, {}, 0.0
    for turn in range(rounds):
        note(f"crossings, round {turn + 1} of {rounds}")
        if before:
            steps_s(before, earlier)
        speed = steps_s(os.environ["PONTOON_SPEED"], ours)
        peak = max(peak, speed["peak_flop_per_s"])
        chain |= {"time_step_s": speed["time_step_s"], "tail_s": speed["tail_s"]}
        for case, (seconds, deepest_m) in chain_steps_s(chain).items():
            theirs.setdefault(case, []).append(seconds)
            deflections[case] = deepest_m
    medians = lambda of: {case: statistics.median(seconds) for case, seconds in of.items()}
    ours, earlier, theirs = medians(ours), medians(earlier), medians(theirs)
    how = {
        "lone_step_s": "alone",
        "full_step_s": f"{speed['lanes']} lanes of one speed",
        "mixed_step_s": f"{speed['lanes']} lanes of unlike speeds",
    }
    # what users run first stands first: riding masses, beside the chain that they would script
    order = lambda case: (-case[0], NAMED.index(case[1]) if case[1] in NAMED else len(NAMED))
    for case in sorted(ours, key=order):
        speed_m_s, kind, place, key = case
        for dofs in CHAINS:
            other = theirs[dofs, speed_m_s]
            what = f"step of a crossing at {speed_m_s:g} m/s, {kind}, {place}, {how[key]}"
            beside = f"{micro(other)} chain of {dofs} dofs" + ("" if kind == KINDS["none"] else ", weight only")
            wanted = ASKED.get((kind, place, key)) if (speed_m_s, dofs) == (15.0, 225) else None
            table.ratio(what, micro(ours[case]), beside, other / ours[case], wanted)
        if before:
            ratio = ours[case] / earlier[case]
            beside, limit = f"{micro(earlier[case])} by {Path(before).name}", f"at most {SLOWER:g}"
            table.row(what, micro(ours[case]), beside, f"{ratio:.2f} of it", limit, ratio <= SLOWER)
    told = ", ".join(f"{dofs} dofs at {v:g} m/s {100 * w:.2f} cm" for (dofs, v), w in deflections.items())
    note(f"largest deflection of the chains: {told}")
    for case in speed["breakdown"]:
        if case["lanes"] == speed["lanes"]:
            flop, seconds = (sum(part[key] for part in case["parts"]) for key in ("flop", "seconds"))
            table.row(
                f"floating-point operations at 15 m/s, {case['inertia']}, {case['place']}, lanes full",
                f"{flop:,.0f} a step, {flop / seconds / 1e9:.1f} Gflop/s",
                f"{peak / 1e9:.1f} Gflop/s peak of a core",
                f"{100 * flop / seconds / peak:.0f} %",
            )
    print_breakdown(speed["breakdown"], peak)
    sizes = speed["operator"]
    note(
        f"{sizes['modes']} modes of the whole bridge, {speed['instructions']}; operations: counted where they are made"
    )


def print_breakdown(cases, peak):
    """Where the time of a step goes: microseconds and operations of one crossing, and the share of a core's peak."""
    parts = [part["part"] for part in cases[0]["parts"]]
    print("Where the time of a step goes at 15 m/s, for one crossing: us, kflop (share of a core's peak)\n")
    print("| vehicle, lanes at work | " + " | ".join(parts) + " | all |")
    print("|" + "---|" * (len(parts) + 2))
    for case in cases:
        kind = {"none": "weight only"}.get(case["inertia"], case["inertia"])
        cells = [(part["seconds"], part["flop"]) for part in case["parts"]]
        cells.append(tuple(map(sum, zip(*cells, strict=True))))
        # of what takes as long as a look at the clock no share is told
        share = lambda s, f: f" ({100 * f / s / peak:.0f} %)" if f and s > 5e-8 else ""
        told = [f"{1e6 * s:.2f}, {f / 1e3:.1f}{share(s, f)}" for s, f in cells]
        print(f"| {kind}, {case['place']}, {case['lanes']} | " + " | ".join(told) + " |")
    print()


# ---- modes


def compare_modes(table, rounds):
    """The program from file to printed frequencies beside OpenSees' model and eigenvalues."""
    bridge = {key: value for key, value in json.loads(peers.BRIDGE.read_text()).items() if key != "provenance"}
    ours, theirs = [], []
    for turn in range(rounds):
        note(f"modes, round {turn + 1} of {rounds}")
        words = ("modes", peers.BRIDGE, "--model", "full", "--count", MODES, "--format", "json")
        ours.append(peers.timed(peers.pontoon, *words)[1])
        _, made_s = peers.timed(peers.BridgePeer, bridge, "ASDShellQ4", bridge["modules"], True)
        theirs.append((made_s, peers.timed(ops.eigen, "-genBandArpack", MODES)[1]))
    eigen_s, made_s = min(eigen for _, eigen in theirs), min(made for made, _ in theirs)
    table.ratio(
        f"{MODES} modes of the full bridge, the whole program",
        f"{min(ours):.2f} s",
        f"{eigen_s:.2f} s eigenvalues alone ({made_s:.2f} s model)",
        eigen_s / min(ours),
    )


# ---- preparation


def compare_preparation(table):
    """All that a crossing of a longer and longer bridge needs before its first step, on all threads, nothing cached."""
    times = {}
    for modules, asked in MODULES.items():
        note(f"preparation, {modules} modules")
        case = {"connection": "linear", "bridge.modules": modules, "speed_m_s": 15, "load_n": 2e5}
        study = {
            "name": "preparation",
            "bridge": str(peers.BRIDGE),
            "analysis": {"kind": "crossing", "tail_s": 0},
            "design": [{"cases": [case]}],
        }
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "study.json").write_text(json.dumps(study))
            words = [os.environ["PONTOON"], "run", "study.json", "--out", "r", "--quiet"]
            environment = os.environ | {"PONTOON_CACHE_DIR": ""}
            subprocess.run(words, cwd=folder, check=True, stdout=subprocess.DEVNULL, env=environment)
            times[modules] = json.loads((Path(folder) / "r" / "manifest.json").read_text())["offline_s"]
        # the largest of all processes so far, which is this one's
        gigabytes = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1e6
        holds = asked is None or (times[modules] <= asked and gigabytes <= ASKED_MEMORY_GB)
        wanted = "" if asked is None else f"under {asked:g} s, {ASKED_MEMORY_GB:g} GB"
        figure = f"{times[modules]:.1f} s, {gigabytes:.1f} GB"
        table.row(f"preparation of {modules} modules of fu2005", figure, "", figure, wanted, holds)
    logs = [(math.log(modules), math.log(seconds)) for modules, seconds in times.items()]
    means = [sum(values) / len(logs) for values in zip(*logs, strict=True)]
    slope = sum((m - means[0]) * (s - means[1]) for m, s in logs) / sum((m - means[0]) ** 2 for m, _ in logs)
    name = "exponent of preparation against modules, " + ", ".join(map(str, MODULES))
    table.row(name, f"{slope:.2f}", "", f"{slope:.2f}", f"at most {ASKED_EXPONENT}", slope <= ASKED_EXPONENT)


# ---- the sweep


def sides(jobs):
    """The number of values of each axis: as equal as the factors of the number of jobs allow."""
    factors, rest, p = [], jobs, 2
    while rest > 1:
        while rest % p == 0:
            factors.append(p)
            rest //= p
        p += 1
    values = [1] * len(AXES)
    for factor in reversed(factors):
        values[values.index(min(values))] *= factor
    return values


def processor_s():
    """Processor time of the programs that have been run."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def sweep_s(folder, threads):
    """Seconds of the sweep's jobs, and of the program from start to end."""
    out, before_s = folder / f"out-{threads}", processor_s()
    _, whole_s = peers.timed(peers.pontoon, "run", folder / "study.json", "--out", out, "--threads", threads, "--quiet")
    manifest = json.loads((out / "manifest.json").read_text())
    if manifest["failed"]:
        sys.exit(f"{manifest['failed']} jobs of the sweep failed")
    # as much on two threads as on one: what is missing of the ratio, other programs took
    note(f"  {manifest['jobs_s']:.1f} s, processor time of the program {processor_s() - before_s:.1f} s")
    return manifest["jobs_s"], whole_s


def compare_threads(table, rounds, jobs, solver, inertia):
    """The program's sweep on one thread and on two."""
    grid = {
        axis: {"linspace": [*AXES[axis], count]} if count > 1 else AXES[axis][1]
        for axis, count in zip(AXES, sides(jobs), strict=True)
    }
    analysis = {"kind": "crossing", "time_step_s": 0.01, "tail_s": 6.0, "solver": solver}
    study = {
        "name": "bench",
        "bridge": "bridge.json",
        "vehicle": VEHICLE | {"inertia": inertia},
        "analysis": analysis,
        "design": [{"grid": {"connection": "nonlinear", **grid}}],
    }
    times = {1: [], 2: []}
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "bridge.json").write_text(peers.BRIDGE.read_text())
        (folder / "study.json").write_text(json.dumps(study))
        told = json.loads(peers.pontoon("plan", folder / "study.json", "--out", folder / "none", "--format", "json"))
        for turn in range(rounds):
            for threads, found in times.items():
                note(f"{jobs:,} jobs on {threads} thread(s), round {turn + 1} of {rounds}")
                found.append(sweep_s(folder, threads))
    one, two = (min(jobs_s for jobs_s, _ in times[threads]) for threads in (1, 2))
    whole = min(whole_s for _, whole_s in times[2])
    what = f"{jobs:,} crossings of a sweep, {KINDS[inertia]}, on two threads"
    table.ratio(what, f"{two:.1f} s", f"{one:.1f} s one thread", one / two, ASKED_THREADS)
    if told["threads"] == 2:
        expected = told["expected_seconds"]
        figure, lies_near = f"{100 * (expected / two - 1):+.0f} %", abs(expected / two - 1) <= PLAN_OFF
        table.row("what `plan` expects of it", f"{expected:.1f} s", f"{two:.1f} s", figure, "within 30 %", lies_near)
    table.row(
        what,
        f"{two:.1f} s",
        f"{whole:.1f} s the whole program",
        f"{two:.1f} s",
        f"under {ASKED_SWEEP_S:g} s",
        two < ASKED_SWEEP_S,
    )


def main():
    """Measures the parts that are asked for; exit status 1 where a figure falls short."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("part", nargs="?", default="all", choices=["crossing", "modes", "preparation", "sweep", "all"])
    parser.add_argument("--jobs", type=int, default=10_000, help="crossings of the sweep")
    parser.add_argument("--rounds", type=int, default=5, help="how often crossings and modes are measured")
    parser.add_argument("--before", help="another example `speed`, beside which each step is held")
    parser.add_argument("--sweep-rounds", type=int, default=1, help="how often the sweep is")
    parser.add_argument("--solver", default="operator", help="the sweep's analysis.solver")
    parser.add_argument("--inertia", default="local", choices=list(KINDS), help="the sweep's vehicle.inertia")
    options = parser.parse_args()
    if min(options.jobs, options.rounds, options.sweep_rounds) < 1:
        parser.error("jobs and rounds are 1 or more")
    busy = os.getloadavg()[0]
    if busy > 0.5:
        note(f"load average {busy:.1f}: other programs are running, the ratios will be too low")
    table, start = Table(), time.perf_counter()
    with tempfile.NamedTemporaryFile() as log:
        ops.logFile(log.name, "-noEcho")
        if options.part in ("crossing", "all"):
            compare_crossings(table, options.rounds, options.before)
        if options.part in ("modes", "all"):
            compare_modes(table, options.rounds)
        if options.part in ("preparation", "all"):
            compare_preparation(table)
        if options.part in ("sweep", "all"):
            compare_threads(table, options.sweep_rounds, options.jobs, options.solver, options.inertia)
    rounds = f"medians of {options.rounds} rounds in turns, of the sweep the least of {options.sweep_rounds}"
    print(f"Speed, no test of anything else: {cpu()}, OpenSeesPy {ops.version()}; {rounds}.\n")
    table.print()
    print(f"\n{time.perf_counter() - start:.0f} s; short of what is asked: {len(table.short)}")
    for name in table.short:
        print(f"  {name}")
    sys.exit(1 if table.short else 0)


if __name__ == "__main__":
    main()
