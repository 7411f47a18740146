"""What is refused is an exception with a clear text, and the next call is as good as any."""

import re
from pathlib import Path

import numpy as np
import pytest

import pontoon as pt

SMOKE = "studies/bridges/smoke.json"


@pytest.fixture(scope="module")
def bridge():
    return pt.Bridge(Path(__file__).parents[3] / SMOKE)


def function(bridge, **words):
    return bridge.function(
        **{"inputs": {"speed_m_s": (2, 20), "load_n": (1e4, 2e5)}, "outputs": ["peak_deflection_m"], **words}
    )


CALLS = [
    # the engine's own texts, the call in the place of the file
    (
        lambda b: b.cross(speed_m_s=-1, load_n=1e5),
        "cross(): design[0].grid.speed_m_s: found -1, allowed: a finite number above 0",
    ),
    (
        lambda b: b.cross(sped_m_s=1, load_n=1e5),
        "cross(): design[0].grid.sped_m_s: found unknown key `sped_m_s` (nearest known: speed_m_s)",
    ),
    (lambda b: b.cross(load_n=1e5), "cross(): design[0].grid.speed_m_s: missing key `speed_m_s` (required)"),
    (lambda b: b.cross(), "cross(): design[0].grid"),
    (
        lambda b: b.cross(speed_m_s="fast", load_n=1e5),
        'cross(): design[0].grid.speed_m_s: found "fast", allowed: a number',
    ),
    (
        lambda b: b.cross(speed_m_s=5, load_n=1e5, analysis={"kin": 1}),
        "cross(): analysis.kin: found unknown key `kin` (nearest known: kind)",
    ),
    (
        lambda b: b.cross(speed_m_s=5, load_n=1e5, vehicle="no.json"),
        'cross(): vehicle: found "no.json", which is no file',
    ),
    (lambda b: b.cross(speed_m_s=5, load_n=1e5, vehicle={"track_y_m": [9]}), "cross(): vehicle.track_y_m"),
    (lambda b: b.cross(speed_m_s=[], load_n=1e5), "cross(): design[0].grid.speed_m_s: found"),
    (lambda b: b.statics(load_n=1e5), "statics(): design[0].grid"),
    (lambda b: b.modes(0), "modes(): analysis.count: found 0"),
    (lambda b: b.rate(speed_m_s=5, limits={}, find={"largest": "load_n"}), "rate(): "),
    (lambda b: b.with_(connectors={"gap_tension_m": -1}), "smoke.json.with_(): connectors.gap_tension_m: found -1"),
    (lambda b: b.with_(modles=3), "smoke.json.with_(): modles: found unknown key `modles` (nearest known: modules)"),
    (lambda b: pt.Bridge({}), "Bridge(): "),
    (lambda b: pt.Bridge("no.json"), "no.json: found no readable file"),
    (lambda b: pt.Vehicle("no.json"), "no.json: found no readable file"),
    (lambda b: pt.run("studies/no"), "studies/no"),
    (lambda b: pt.run("studies/smoke", shard="2/2"), "invalid value '2/2' for '--shard <K/N>'"),
    (lambda b: pt.run("studies/smoke", threads=-1), "invalid value '-1' for '--threads <N>': -1 is not in 1..=1024"),
    (
        lambda b: pt.run("studies/smoke", fresh=True, retry_failed=True),
        "the argument '--fresh' cannot be used with '--retry-failed'",
    ),
    (
        lambda b: pt.run("studies/smoke", ot="x"),
        "run(): ot: found unknown key `ot` (nearest known: out), allowed: study, out, with_",
    ),
    (lambda b: b.modes(cout=3), "modes(): cout: found unknown key `cout` (nearest known: count)"),
    (lambda b: pt.Study("x").report(paly=3), "report(): paly: found unknown key `paly` (nearest known: plays)"),
    (
        lambda b: b.cross(speed_m_s=5, load_n=1e5, threads=-1),
        "cross(): threads: found -1, allowed: a whole number from 0",
    ),
    (lambda b: b.cross(speed_m_s=5, load_n=1e5, threads=1.5), "cross(): threads: found 1.5, allowed: a whole number"),
    (lambda b: function(b, threads="all"), "function(): threads: found 'all'"),
    (lambda b: pt.Study("studies/smoke").jobs, "studies/smoke: found no results: manifest.json is missing"),
    (lambda b: pt.compare("studies/smoke", "studies/table1"), "studies/smoke: found no results"),
    (lambda b: pt.schema("boat"), "invalid value 'boat' for '<OF>'"),
    (lambda b: function(b, outputs=["peak_deflection"]), None),
    (
        lambda b: function(b, outputs=["peak_deflection"])([[5, 1e5]]),
        'function(): outputs[0]: found unknown "peak_deflection" (nearest known: peak_deflection_m)',
    ),
    (lambda b: function(b, outputs=["status"])([[5, 1e5]]), 'function(): outputs[0]: found unknown "status"'),
    (
        lambda b: function(b, inputs={"sped_m_s": (1, 2)}, load_n=1e5)([[1]]),
        "function(): design[0].zip.sped_m_s: found unknown key `sped_m_s` (nearest known: speed_m_s)",
    ),
    (lambda b: function(b, gap_tensoin_m=0)([[5, 1e5]]), "function(): design[0].zip.gap_tensoin_m: found unknown key"),
    # what only a call can be wrong in
    (
        lambda b: function(b)([[5, 1e5, 3]]),
        "function(): X: found an array of shape (1, 3), allowed: shape (n, 2), a column for each of speed_m_s, load_n",
    ),
    (lambda b: function(b)([5, 1e5, 3]), "function(): X: found an array of shape (3,)"),
    (lambda b: function(b)(5), "function(): X: found an array of shape ()"),
    (
        lambda b: function(b)([["5", "1"]]),
        "function(): X: found a list of what is no number, allowed: numbers of shape (n, 2)",
    ),
    (lambda b: function(b)([[5, None]]), "function(): X"),
    (lambda b: function(b)([[5, 1e5], [5]]), "function(): X: found a list of what is no number"),
    (lambda b: function(b)(np.array([[5 + 1j, 1e5]])), "function(): X: found a ndarray of what is no number"),
    (
        lambda b: function(b)([[5, 1e5], [float("nan"), 1e5]]),
        "function(): X[1, 0]: found nan, allowed: speed_m_s from 2.0 to 20.0",
    ),
    (
        lambda b: function(b)([[5, float("inf")]]),
        "function(): X[0, 1]: found inf, allowed: load_n from 10000.0 to 200000.0",
    ),
    (lambda b: function(b)([[0.5, 1e5]]), "function(): X[0, 0]: found 0.5, allowed: speed_m_s from 2.0 to 20.0"),
    (
        lambda b: function(b, inputs={"speed_m_s": (20, 2)}),
        "function(): inputs.speed_m_s: found (20, 2), allowed: a lower bound below the upper one",
    ),
    (lambda b: function(b, inputs={"speed_m_s": 3}), "function(): inputs.speed_m_s: found 3, allowed: two numbers"),
    (lambda b: function(b, inputs={}), "function(): inputs: found none"),
    (lambda b: function(b, outputs="peak_deflection_m"), "function(): outputs: found 'peak_deflection_m'"),
    (lambda b: function(b, load_n=1e5), "function(): fixed.load_n: found an axis that is an input too"),
    (
        lambda b: b.cross(speed_m_s=float("nan"), load_n=1e5),
        "cross(): design[0].grid.speed_m_s: found nan, allowed: a finite number",
    ),
    (
        lambda b: b.cross(speed_m_s=object(), load_n=1e5),
        "cross(): design[0].grid.speed_m_s: found an object of type object",
    ),
    (
        lambda b: b.crossing(speed_m_s=[5, 6], load_n=1e5),
        "crossing(): axes: found 2 crossings, allowed: one value of each axis",
    ),
    (lambda b: b.modes(3)["shap"], "Table: shap: found unknown key `shap` (nearest known: shape)"),
    (lambda b: b.modes(3).numpy("shape"), "Table: shape: found a column of words"),
    (
        lambda b: b.crossing(speed_m_s=5, load_n=1e5).plot("speed"),
        "plot(): quantity: found 'speed', allowed: deflection_m, force_n",
    ),
]


@pytest.mark.parametrize(("call", "text"), CALLS, ids=[str(number) for number in range(len(CALLS))])
def test_a_wrong_call_is_refused_in_words(bridge, call, text):
    if text is None:
        # what is wrong shows where it is used
        assert call(bridge) is not None
        return
    with pytest.raises(pt.InputError, match=re.escape(text)):
        call(bridge)
    assert bridge.cross(speed_m_s=5, load_n=1e5)["status"] == ["ok"]


def test_a_refusal_names_file_path_and_place(tmp_path):
    text = Path(SMOKE).read_text().replace('"gap_tension_m": 0.028', '"gap_tension_m": -0.028')
    file = tmp_path / "bridge.json"
    file.write_text(text)
    with pytest.raises(pt.InputError) as raised:
        pt.Bridge(file)
    error = raised.value
    assert (error.file, error.path, error.kind) == (str(file), "connectors.gap_tension_m", "not_allowed")
    assert (error.found, error.nearest) == ("-0.028", None) and "0" in error.allowed
    (line, column), (_, end) = error.span
    assert text.splitlines()[line - 1][column - 1 : end - 1] == "-0.028"


def test_a_bridge_cannot_change_under_a_call(bridge):
    document = bridge.document
    document["connectors"]["gap_tension_m"] = 5
    assert bridge.document["connectors"]["gap_tension_m"] != 5
    with pytest.raises(AttributeError):
        bridge.modules = 2


def test_an_unknown_row_is_an_index_error(bridge):
    modes = bridge.modes(3)
    with pytest.raises(IndexError):
        modes.row(3)
    assert modes.row(-3) == modes.row(0)
