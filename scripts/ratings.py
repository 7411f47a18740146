"""Ratings by the bridge operator against the reference solver's own ladder on cases drawn at random. See
scripts/ratings."""

import argparse
import itertools
import math
import pathlib
import random
import sys
import tempfile

from accuracy import NUDGE, STEP_S, Table, run, worst

VEHICLE = {"footprint_length_m": 3.35, "inertia": "local"}
BETWEEN_N, LADDER_RATIO, RELATIVE_WIDTH = [50e3, 800e3], 1.05, 0.002
# loads that the program tries at once between one that passes and one that fails
SECTIONS = 15
# loads that are tried at once here beyond those that have to be
TOGETHER = 5
REFERENCE = {"solver": "reference"}
PEAKS = {"edge_sinkage_m": "peak_edge_deflection_m", "joint_compression_n": "peak_compression_n"}
ENDS = ("rated_value", "first_failure")


def drawn(count, seed):
    """Points and their limits: gaps of 5 to 40 mm in tension and 1 to 10 mm in compression, 2 to 20 m/s, lanes from
    -1.5 to 1.5 m; edges that sink 0.25 to 0.4 m, joints of 0.8 to 1.4 MN."""
    draw = random.Random(seed)
    cases = []
    for _ in range(count):
        gaps = {"gap_tension_m": draw.uniform(0.005, 0.04), "gap_compression_m": draw.uniform(0.001, 0.01)}
        speed, lane = draw.uniform(2.0, 20.0), draw.uniform(-1.5, 1.5)
        point = gaps | {"speed_m_s": speed, "vehicle.track_y_m": [lane - 1.4, lane + 1.4]}
        limits = {"edge_sinkage_m": draw.uniform(0.25, 0.4), "joint_compression_n": draw.uniform(0.8e6, 1.4e6)}
        cases.append((point, limits))
    return cases


def rated(folder, number, case):
    """The row of a rating by the program, with how much of the limits each end of its pair uses up. Limits are no axis:
    each case is a study."""
    point, limits = case
    find = {
        "largest": "load_n",
        "between": BETWEEN_N,
        "ladder_ratio": LADDER_RATIO,
        "relative_width": RELATIVE_WIDTH,
    }
    study = {"vehicle": VEHICLE, "limits": limits, "find": find}
    tables = run(folder, f"rating {number}", [point], {"kind": "rating"}, traffic=study)
    row = tables["jobs"].row(0, named=True)
    return row | {"used": (row["utilisation"], max(tables["limits"]["utilisation"]))}


def utilisations(folder, name, cases, places, analysis):
    """How much of their limits crossings use up; `places` are numbers of cases and loads. Reckoned from the peaks, not
    from the program's table of limits."""
    points = [cases[number][0] | {"load_n": load} for number, load in places]
    jobs = run(folder, name, points, analysis, traffic={"vehicle": VEHICLE})["jobs"]
    used = lambda row, limits: max(row[PEAKS[limit]] / most for limit, most in limits.items())
    return [used(row, cases[number][1]) for (number, _), row in zip(places, jobs.iter_rows(named=True), strict=True)]


def ladder():
    """The loads of the ladder."""
    low, high = BETWEEN_N
    rungs = (low * LADDER_RATIO**i for i in itertools.count())
    return [*itertools.takewhile(lambda load: load < high - 1e-9 * (high - low), rungs), high]


def sections(passes, fails):
    """Loads between one that passes and the first that fails; none where they are close enough."""
    parts = math.ceil(math.log(fails / passes) / math.log(1 + RELATIVE_WIDTH) - 1e-6)
    parts = min(max(parts, 1), SECTIONS + 1)
    return [passes * (fails / passes) ** (i / parts) for i in range(1, parts)]


def first_failing(passed, values, failed, together):
    """The last of some loads that passes and the first that fails, from below; `passed` and `failed` where none does.
    Yields loads and is sent what they use up. How many are tried together says what is solved in vain, not what is
    found."""
    while values:
        tried, values = values[:together], values[together:]
        for load, used in zip(tried, (yield tried), strict=True):
            if used > 1:
                return passed, load
            passed = load
        together = TOGETHER
    return passed, failed


def climbed(together):
    """First the ladder, then sections between the last load that passes and the first that fails. An end is none where
    the bracket does not hold it."""
    passed, failed = yield from first_failing(None, ladder(), None, together)
    while passed and failed and (values := sections(passed, failed)):
        passed, failed = yield from first_failing(passed, values, failed, TOGETHER)
    return passed, failed


def by_hand(folder, cases, rows):
    """The pair that the reference solver finds in each case; and all that it tried: numbers of cases and loads, with
    what they use up."""
    # the rungs up to the program's first failure have to be tried unless the reference solver fails before
    searches = [climbed(sum(load < row["first_failure"] for load in ladder()) + 1) for row in rows]
    waiting, pairs, tried = {number: next(search) for number, search in enumerate(searches)}, {}, {}
    for turn in itertools.count(1):
        if not waiting:
            return [pairs[number] for number in range(len(cases))], tried
        places = [(number, load) for number, loads in waiting.items() for load in loads]
        found = utilisations(folder, f"turn {turn}", cases, places, REFERENCE)
        tried |= dict(zip(places, found, strict=True))
        answers, waiting = waiting, {}
        for number, loads in answers.items():
            try:
                waiting[number] = searches[number].send([tried[number, load] for load in loads])
            except StopIteration as end:
                pairs[number] = end.value


def own_movement(folder, cases, places):
    """How far a ten-thousandth of the load, and a tenth of the step, move what the reference solver finds, in percent
    of the limit. `places` are numbers of cases and loads."""
    if not places:
        return []

    def solved(name, factor, step):
        moved = [(number, factor * load) for number, load in places]
        return utilisations(folder, name, cases, moved, REFERENCE | step)

    base, step = solved("base", 1.0, {}), solved("step", 1.0, {"time_step_s": STEP_S})
    more, less = solved("more", 1 + NUDGE, {}), solved("less", 1 - NUDGE, {})
    of_load = [100 * max(abs(m - b), abs(n - b)) for b, m, n in zip(base, more, less, strict=True)]
    of_step = [100 * abs(s - b) for b, s in zip(base, step, strict=True)]
    return list(zip(of_load, of_step, strict=True))


def line(number, case, row, own, judged):
    """A case in the table of cases."""
    point, limits = case
    beyond = lambda used: f"{100 * (used - 1):+.3f}"
    off = "" if None in own else f", {100 * (row['rated_value'] / own[0] - 1):+.3f} %"
    return [
        str(number),
        f"{point['speed_m_s']:.2f}",
        f"{1e3 * point['gap_tension_m']:.1f} / {1e3 * point['gap_compression_m']:.1f}",
        f"{sum(point['vehicle.track_y_m']) / 2:+.2f}",
        f"{limits['edge_sinkage_m']:.3f} m, {limits['joint_compression_n'] / 1e6:.3f} MN",
        f"{row['governing_limit'].split('_')[0]} at {row['governing_time_s']:.2f} s",
        " to ".join(f"{row[end] / 1e3:.2f}" for end in ENDS),
        " to ".join("none" if load is None else f"{load / 1e3:.2f}" for load in own) + off,
        " to ".join(map(beyond, row["used"])),
        " to ".join(map(beyond, judged)),
        f"{100 * row['spread']:.3f}" + (" chaotic" if row["chaotic"] else ""),
        "holds" if judged[0] <= 1 < judged[1] else "apart" if row["chaotic"] else "**short**",
    ]


HEAD = [
    "case",
    "m/s",
    "gaps [mm]",
    "lane [m]",
    "limits",
    "governs",
    "rated to first failure [kN]",
    "by the reference solver, off",
    "beyond the limit [%]",
    "of the same loads the reference solver [%]",
    "spread [%]",
    "pair",
]


def apart(found, judge):
    """How far two lists of what crossings use up are apart."""
    pairs = list(zip(found, judge, strict=True))
    by = sorted(100 * abs(a - b) for a, b in pairs)
    within = lambda share: by[min(int(share * len(by)), len(by) - 1)]
    turned = sum((a > 1) != (b > 1) for a, b in pairs)
    return (
        f"median {within(0.5):.4f}, 90 % within {within(0.9):.4f}, 99 % within {within(0.99):.3f}, "
        f"worst {by[-1]:.3f} %; {turned} pass by one solver and fail by the other"
    )


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--cases", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=pathlib.Path, help="a folder that keeps the studies and their tables")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as place:
        folder = options.keep or pathlib.Path(place)
        folder.mkdir(parents=True, exist_ok=True)
        cases = drawn(options.cases, options.seed)
        rows = [rated(folder, number, case) for number, case in enumerate(cases)]
        own, tried = by_hand(folder, cases, rows)
        ends = [(number, row[end]) for number, row in enumerate(rows) for end in ENDS]
        again = utilisations(folder, "pairs", cases, ends, REFERENCE)
        judged = list(zip(again[::2], again[1::2], strict=True))
        wrong = [place for place, used in zip(ends, again, strict=True) if (used > 1) != (place in ends[1::2])]
        moved = own_movement(folder, cases, wrong)
        operator = utilisations(folder, "operator", cases, list(tried), {})
    print("|", " | ".join(HEAD), "|")
    print("|" + "---|" * len(HEAD))
    for number, case in enumerate(cases):
        print("|", " | ".join(line(number, case, rows[number], own[number], judged[number])), "|")
    print()
    table = Table()
    off = [
        math.inf if None in pair else 100 * abs(row["rated_value"] / pair[0] - 1)
        for row, pair in zip(rows, own, strict=True)
    ]
    # a hair more than the width is rounding
    beyond = [number for number, by in enumerate(off) if by > 100 * RELATIVE_WIDTH * (1 + 1e-6)]
    median, most = worst(off)
    table.row(
        f"{len(cases)} rated loads against the reference solver's own ladder",
        f"{100 * RELATIVE_WIDTH:g} %",
        f"median {median:.3f}, worst {most:.3f} %; beyond: {len(beyond)} {beyond or ''}",
        not beyond,
    )
    short = sorted({number for number, _ in wrong if not rows[number]["chaotic"]})
    table.row(
        "their pairs by the reference solver",
        "one passes, one fails, but for chaotic ones",
        f"short: {len(short)} {short or ''}; chaotic: {sum(row['chaotic'] for row in rows)}",
        not short,
    )
    print("\nOperator against reference solver, in percent of a limit:")
    by_operator = [used for row in rows for used in row["used"]]
    print(f"{len(ends)} ends of pairs: {apart(by_operator, again)}")
    print(f"{len(tried)} crossings of ladders: {apart(operator, tried.values())}\n")
    for (number, load), (of_load, of_step) in zip(wrong, moved, strict=True):
        end = int(load == rows[number]["first_failure"])
        print(
            f"case {number} at {load / 1e3:.2f} kN: {100 * (judged[number][end] - 1):+.3f} % beyond the limit, "
            f"{100 * (rows[number]['used'][end] - 1):+.3f} % by the operator; 0.01 % of the load moves the reference "
            f"solver by {of_load:.3f}, a tenth of the step by {of_step:.3f} %"
        )
    sys.exit(1 if table.short else 0)


if __name__ == "__main__":
    main()
