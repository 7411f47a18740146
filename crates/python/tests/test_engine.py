"""What is solved from Python is what the program solves."""

import filecmp
import json
import math
import os
import pickle
import re
import shutil
import signal
import subprocess
import sys
import textwrap
import threading
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import pontoon as pt

SMOKE = "studies/bridges/smoke.json"
FU = "studies/bridges/fu2005.json"


@pytest.fixture(scope="module")
def bridge():
    return pt.Bridge(Path(__file__).parents[3] / SMOKE)


def program():
    """The program: the one that PONTOON names, else the package's own."""
    named = os.environ.get("PONTOON")
    return [named] if named else [sys.executable, "-m", "pontoon"]


def run_program(study, out):
    subprocess.run([*program(), "run", study, "--out", str(out), "--quiet"], check=True, stdout=subprocess.DEVNULL)


@pytest.mark.parametrize("study", ["studies/smoke", "studies/fu2005"])
def test_crossings_without_a_file_are_those_of_the_tables_to_the_last_bit(study, tmp_path):
    run_program(study, tmp_path / "out")
    spec = json.loads(Path(study, "study.json").read_text())
    bridge = pt.Bridge(Path(study, spec["bridge"]))
    words = {name: spec[name] for name in ("vehicle", "analysis", "record", "design") if name in spec}
    jobs = bridge.cross(**words)
    names = {path.stem for path in (tmp_path / "out").glob("*.parquet")}
    assert set(jobs.tables) == names
    for name in names:
        expected = pq.read_table(tmp_path / "out" / f"{name}.parquet").replace_schema_metadata(None)
        assert pa.table(jobs.tables[name]).equals(expected), name


def test_a_durable_run_leaves_the_bytes_of_the_program(tmp_path):
    run_program("studies/fu2005", tmp_path / "program")
    study = pt.run("studies/fu2005", out=tmp_path / "python")
    assert study.good and study.notes == []
    tables = sorted(path.name for path in (tmp_path / "program").glob("*.parquet"))
    assert "jobs.parquet" in tables and [f"{name}.parquet" for name in sorted(study.tables)] == tables
    for name in [*tables, "summary.csv"]:
        assert filecmp.cmp(tmp_path / "program" / name, tmp_path / "python" / name, shallow=False), name
    assert pa.table(study.jobs).equals(
        pq.read_table(tmp_path / "program" / "jobs.parquet").replace_schema_metadata(None)
    )


def test_a_run_goes_on_from_what_is_recorded(tmp_path):
    assert pt.run("studies/smoke", out=tmp_path / "out").outcome["ran"] == 6
    assert pt.run("studies/smoke", out=tmp_path / "out").outcome["ran"] == 0


def test_a_function_gives_the_numbers_of_the_table(bridge):
    names = ["peak_deflection_m", "peak_tension_n", "dynamic_amplification", "steps"]
    inputs = {"speed_m_s": (2, 20), "gap_tension_m": (0, 0.04)}
    f = bridge.function(inputs, names, load_n=100_000)
    points = np.array([[5, 0.01], [10, 0.0], [5, 0.01], [20, 0.04]])
    found = f(points)
    for row, (speed, gap) in enumerate(points):
        jobs = bridge.cross(speed_m_s=float(speed), gap_tension_m=float(gap), load_n=100_000)
        assert [jobs[name][0] for name in names] == found[row].tolist()
    # what nobody asks for is not computed, and the rest is as before
    alone = bridge.function(inputs, names[:2], load_n=100_000)
    assert np.array_equal(alone(points), found[:, :2])
    assert np.array_equal(alone(points[0]), found[0, :2])
    assert alone(np.empty((0, 2))).shape == (0, 2)


def test_a_function_is_read_once_and_mixes_with_no_other(bridge):
    """Calls of several functions in turn, with one point or more, have the bits of functions that are called once."""
    path = "bridge.connectors.stiffness_n_m"
    names = ["peak_deflection_m", "peak_compression_n", "steps", "gap_tension_m"]
    other = bridge.with_(connectors={"gap_tension_m": 0.05, "stiffness_n_m": 2e8})
    words = [
        (bridge, {"speed_m_s": (2, 20), "gap_tension_m": (0, 0.04)}, {"load_n": 1e5}),
        (bridge, {"speed_m_s": (5, 30), "gap_tension_m": (0, 0.02)}, {"load_n": 2e5}),
        (bridge, {"gap_tension_m": (0, 0.04), "speed_m_s": (2, 20)}, {"load_n": 1e5}),
        (other, {"speed_m_s": (2, 20), "gap_tension_m": (0, 0.04)}, {"load_n": 1e5}),
        (bridge, {path: (1e8, 1e9), "speed_m_s": (2, 20)}, {"load_n": 1e5}),
        (bridge, {"vehicle.track_y_m[0]": (-2, -1), "speed_m_s": (2, 20)}, {"load_n": 1e5, "connection": "linear"}),
        (bridge, {"speed_m_s": (2, 20), "load_n": (1e4, 2e5)}, {"analysis": {"time_step_s": 0.02}}),
    ]
    rng = np.random.default_rng(1)
    functions, points = [], []
    for of, inputs, more in words:
        fixed = {"vehicle": {"track_y_m": [-1.4, 1.4]}, **more}
        functions.append(lambda of=of, inputs=inputs, fixed=fixed: of.function(inputs, names, **fixed))
        low, high = np.array(list(inputs.values())).T
        points.append(low + (high - low) * rng.random((4, 2)))
    expected = [[function()(point) for point in of] for function, of in zip(functions, points)]
    kept = [function() for function in functions]
    for row in (0, 3, 1, 2, 0):
        for f, of, single in zip(kept, points, expected):
            assert np.array_equal(f(of[row]), single[row], equal_nan=True)
            assert np.array_equal(f(of[[row, 1, row]]), np.array(single)[[row, 1, row]], equal_nan=True)
    assert len({single[0].tobytes() for single in expected}) == len(expected)


def test_a_point_that_is_refused_spoils_no_later_one(bridge):
    f = bridge.function({"speed_m_s": (-20, 20)}, ["peak_deflection_m"], load_n=1e5)
    refused = re.escape("function(): design[0].zip.speed_m_s: found -5, allowed: a finite number above 0")
    for wrong in ([-5], [[5], [-5]], [-5]):
        with pytest.raises(pt.InputError, match=refused):
            f(wrong)
        assert f([5]) == bridge.cross(speed_m_s=5, load_n=1e5)["peak_deflection_m"][0]


def test_points_that_make_one_crossing_have_its_numbers(bridge):
    f = bridge.function({"gap_tension_m": (0, 0.04)}, ["peak_tension_n"], load_n=1e5, speed_m_s=8, connection="linear")
    first, second = f([[0.01], [0.02]]).ravel()
    assert first == second > 0


def test_a_failed_crossing_is_a_row(bridge):
    limited = {"time_step_s": 0.02, "step_limit": 400}
    jobs = bridge.cross(speed_m_s=[2, 20], load_n=1e5, analysis=limited)
    assert jobs["status"] == ["failed", "ok"] and jobs.failed == [0]
    assert jobs["failure"] == ["too_many_steps", None]
    f = bridge.function({"speed_m_s": (2, 20)}, ["peak_deflection_m"], load_n=1e5, analysis=limited)
    found = f([[20], [2], [2]])
    assert np.isnan(found[:, 0]).tolist() == [False, True, True]
    assert f.failures == dict.fromkeys((1, 2), jobs["reason"][0])
    assert found[0, 0] == jobs["peak_deflection_m"][1]
    words = {"load_n": 1e5, "analysis": limited, "on_failure": "raise"}
    strict = bridge.function({"speed_m_s": (2, 20)}, ["peak_deflection_m"], **words)
    with pytest.raises(pt.EngineError, match="1 of 2 crossings failed; row 1: .* time steps, the limit is 400"):
        strict([[20], [2]])
    assert strict([[20]]).shape == (1, 1)


def test_axes_by_their_path_are_inputs_or_fixed(bridge):
    path = "bridge.connectors.stiffness_n_m"
    f = bridge.function({path: (1e8, 1e9)}, ["peak_deflection_m"], load_n=1e5, speed_m_s=8)
    fixed = bridge.function({"speed_m_s": (2, 20)}, ["peak_deflection_m"], load_n=1e5, paths={path: 2e8})
    assert (
        f([2e8])[0] == fixed([8])[0] == bridge.cross(load_n=1e5, speed_m_s=8, paths={path: 2e8})["peak_deflection_m"][0]
    )


def test_a_linear_bridge_takes_a_load_in_proportion():
    """Twice the load moves a linear bridge twice as far; 5 % more load shows, and inertia of the load would."""
    bridge = pt.Bridge(SMOKE)
    vehicle = {"inertia": "none"}
    jobs = bridge.cross(speed_m_s=5, load_n=[1e5, 2e5], connection="linear", vehicle=vehicle)
    once, twice = jobs["peak_deflection_m"]
    assert math.isclose(twice, 2 * once, rel_tol=1e-9)
    other = bridge.cross(speed_m_s=5, load_n=2.1e5, connection="linear", vehicle=vehicle)["peak_deflection_m"][0]
    assert not math.isclose(other, 2 * once, rel_tol=1e-2)


def test_another_bridge_is_another_one(bridge):
    wide = bridge.with_(connectors={"gap_tension_m": 0.04}, name="wide")
    assert wide.document["connectors"]["stiffness_n_m"] == bridge.document["connectors"]["stiffness_n_m"]
    assert wide != bridge and wide == pt.Bridge(wide.document)
    [by_bridge] = wide.cross(speed_m_s=8, load_n=1e5)["peak_deflection_m"]
    [by_axis] = bridge.cross(speed_m_s=8, load_n=1e5, gap_tension_m=0.04)["peak_deflection_m"]
    assert by_bridge == by_axis
    assert wide.with_(source=None, modules=2).modules == 2


def test_histories_hold_the_peak(bridge):
    crossing = bridge.crossing(speed_m_s=10, load_n=1e5)
    values = crossing.histories.numpy("value")[np.array(crossing.histories["quantity"]) == "deflection_m"]
    assert values.max() == crossing["peak_deflection_m"]
    assert len(crossing) == len(crossing.tables["jobs"].columns)


def test_vehicles_are_an_axis(bridge):
    truck, rigid = pt.Vehicle("studies/vehicles/truck.json"), pt.Vehicle("studies/vehicles/truck_rigid.json")
    jobs = bridge.cross(speed_m_s=6, vehicle=[truck, rigid])
    assert jobs["vehicle"] == ["truck", "truck_rigid"]
    assert jobs["peak_deflection_m"][0] == bridge.cross(speed_m_s=6, vehicle=truck)["peak_deflection_m"][0]
    by_path = bridge.cross(speed_m_s=6, vehicle="studies/vehicles/truck.json")
    assert by_path["peak_deflection_m"][0] == jobs["peak_deflection_m"][0]


def test_tables_go_to_other_libraries_as_they_are(bridge):
    jobs = bridge.cross(speed_m_s=[5, 10], load_n=1e5)
    table = pa.table(jobs)
    assert table.to_pydict() == jobs.to_dict()
    assert table.schema.field("speed_m_s").type == pa.float64() and table.schema.field("job").type == pa.int64()
    # the stream may be taken more than once, and outlives the table
    again = pa.table(jobs)
    del jobs
    assert again.equals(table)
    empty = pa.table(bridge.modes(3)).slice(0, 0)
    assert empty.num_rows == 0


def test_objects_go_through_pickle(bridge):
    f = bridge.function(
        {"speed_m_s": (2, 20)}, ["peak_deflection_m"], load_n=1e5, vehicle=pt.Vehicle({"inertia": "none"})
    )
    again = pickle.loads(pickle.dumps(f))
    assert np.array_equal(again([[5]]), f([[5]])) and again.inputs == f.inputs
    assert pickle.loads(pickle.dumps(bridge)) == bridge
    with pytest.raises(pt.InputError) as raised:
        pt.Bridge("no.json")
    again = pickle.loads(pickle.dumps(raised.value))
    assert (str(again), again.file, again.kind) == (str(raised.value), "no.json", "file")


def test_two_threads_may_call_at_once(bridge):
    f = bridge.function({"speed_m_s": (2, 20)}, ["peak_deflection_m"], load_n=1e5)
    points = np.linspace(3, 19, 24)[:, None]
    alone, found, failures = f(points), {}, {}

    def work(number):
        own = points[number::2] if number < 2 else [[2.5]]
        other = bridge.with_(connectors={"stiffness_n_m": 1e8 + number})
        other.cross(speed_m_s=5, load_n=1e5)
        found[number], failures[number] = f(own), f.failures

    threads = [threading.Thread(target=work, args=(number,)) for number in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert np.array_equal(found[0], alone[0::2]) and np.array_equal(found[1], alone[1::2])
    assert failures == {0: {}, 1: {}, 2: {}}


def resident_bytes():
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="reads the memory of a process from /proc")
def test_memory_stays_flat_over_many_calls(bridge):
    def call(number):
        speeds = np.linspace(8 + 0.001 * number, 20, 40)
        f([1e-4 * number, 1e5 + number])
        return bridge.cross(speed_m_s=speeds, load_n=1e5 + number, gap_tension_m=1e-4 * number)

    f = bridge.function({"gap_tension_m": (0, 0.04), "load_n": (1e5, 2e5)}, ["peak_deflection_m"], speed_m_s=20)
    kept = [call(number) for number in range(40)]
    del kept

    def grown(numbers):
        before = resident_bytes()
        for number in numbers:
            call(number)
        return resident_bytes() - before

    # the tables of 180 calls are some 45 MB; what each call loses is lost in both halves, what an allocator keeps once
    # is in one of them
    assert min(grown(range(40, 220)), grown(range(220, 400))) < 7.2e6


def python(text, **more):
    # who starts tests in the background lets them ignore interrupts, which processes inherit
    text = "import signal\nsignal.signal(signal.SIGINT, signal.default_int_handler)\n" + textwrap.dedent(text)
    return subprocess.Popen([sys.executable, "-c", text], stdout=subprocess.PIPE, text=True, **more)


@pytest.mark.skipif(sys.platform == "win32", reason="sends a signal")
def test_an_interrupt_is_an_exception_and_no_end():
    process = python(
        f"""
        import pontoon as pt, numpy as np
        bridge = pt.Bridge("{FU}")
        f = bridge.function({{"speed_m_s": (2, 20)}}, ["peak_deflection_m"], load_n=230_300)
        f([[5]])
        try:
            print("ready", flush=True)
            f(np.linspace(2, 20, 20_000)[:, None])
        except KeyboardInterrupt:
            print("interrupted", f([[5]]).shape, flush=True)
        """
    )
    assert process.stdout.readline() == "ready\n"
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=60)
    assert out == "interrupted (1, 1)\n" and process.returncode == 0


@pytest.mark.skipif(sys.platform == "win32", reason="sends a signal")
def test_an_interrupted_run_goes_on_from_there(tmp_path):
    study = {
        "name": "long",
        "bridge": str(Path(SMOKE).resolve()),
        "analysis": {"kind": "crossing", "time_step_s": 0.001},
        "design": [{"grid": {"speed_m_s": np.linspace(2, 20, 4000).tolist(), "load_n": 1e5}}],
    }
    (tmp_path / "study.json").write_text(json.dumps(study))
    process = python(
        f"""
        import pontoon as pt
        try:
            print("ready", flush=True)
            pt.run("{tmp_path}", out="{tmp_path}/out", progress=False)
        except KeyboardInterrupt:
            print("interrupted", flush=True)
        """
    )
    process.stdout.readline()
    journal = tmp_path / "out"
    while not any(path.stat().st_size > 100_000 for path in journal.glob("journal/*")):
        assert process.poll() is None, "it ended before it was interrupted"
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=60)
    assert out.strip() == "interrupted"
    standing = pt.status(journal)
    assert 0 < standing["done"] < 4000 and not (journal / "manifest.json").exists()
    shutil.rmtree(journal)


def test_the_program_is_in_the_package(tmp_path):
    words = [sys.executable, "-m", "pontoon"]
    version = subprocess.run([*words, "--version"], capture_output=True, text=True, check=True).stdout
    assert version == f"pontoon {pt.__version__}\n"
    refused = subprocess.run([*words, "plan", "no"], capture_output=True, text=True)
    assert refused.returncode == 2 and "no" in refused.stderr
    assert subprocess.run([*words, "--nothing"], capture_output=True).returncode == 2


def test_jobs_that_kill_their_process_are_run_apart_by_python_too(tmp_path):
    """A process that dies over a job leaves it to a process of its own, which is this Python's `-m pontoon`."""
    out = tmp_path / "out"
    words = [sys.executable, "-c", f"import pontoon as pt; pt.run('studies/smoke', out='{out}')"]
    died = subprocess.run(words, env={**os.environ, "PONTOON_FAULT": "job.1:1:die"}, capture_output=True)
    assert died.returncode < 0, died.stderr
    study = pt.run("studies/smoke", out=out)
    assert study.good and study.jobs["status"] == ["ok"] * 6


def test_other_commands_say_what_the_program_says(tmp_path):
    study = pt.run("studies/smoke", out=tmp_path / "out")
    assert pt.status(study.folder)["done"] == 6
    verdicts = study.compare(study.folder)
    assert verdicts.good and set(verdicts["verdict"]) == {"holds"}
    page = study.report(tmp_path / "page.html", plays=1)
    assert Path(page["page"]).stat().st_size > 1e5
    assert study.export(tmp_path / "vtk", job=0, count=0, every=50)["files"] > 1
    modes = subprocess.run(
        [*program(), "modes", SMOKE, "--format", "json", "--model=super-element"], capture_output=True
    )
    told = json.loads(modes.stdout)
    table = pt.Bridge(SMOKE).modes(20)
    assert table["shape"] == [mode["shape"] for mode in told]


def test_indices_of_a_study(tmp_path):
    study = {
        "name": "indices",
        "bridge": str(Path(SMOKE).resolve()),
        "analysis": {"kind": "crossing"},
        "design": [{"saltelli": {"count": 16, "seed": 1, "ranges": {"speed_m_s": [3, 15], "load_n": [5e4, 2e5]}}}],
    }
    (tmp_path / "study.json").write_text(json.dumps(study))
    told = pt.run(tmp_path, out=tmp_path / "out").indices(["peak_deflection_m"], resamples=50)
    assert "peak_deflection_m" in json.dumps(told)
