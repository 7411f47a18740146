"""Studies in files, their folders of results, and the program's other commands as functions with its words."""

from __future__ import annotations

import json
import os
import sys
from typing import Any, Dict, List, Mapping, Optional, Sequence, Union

from . import _engine
from ._bridges import AnyPath
from ._progress import Progress
from ._tables import JobTable, Table, table_of
from ._words import known_words


def again() -> List[str]:
    """The start of a command line that starts the program as a process of its own."""
    return [sys.executable, "-m", "pontoon"]


class Study:
    """A folder of results, as :func:`run` or the program leaves it.

    >>> import pontoon as pt, tempfile
    >>> study = pt.run("studies/smoke", out=tempfile.mkdtemp(), fresh=True)
    >>> len(study.jobs), study.good
    (6, True)
    """

    def __init__(self, folder: AnyPath) -> None:
        #: The folder.
        self.folder = os.fspath(folder)
        #: Whether nothing fell short in the run that made this object; ``None`` where none did.
        self.good: Optional[bool] = None
        #: What that run noted, lines as the program writes them.
        self.notes: List[str] = []
        #: What that run said as its result.
        self.outcome: Dict[str, Any] = {}

    @property
    def jobs(self) -> JobTable:
        """The table of jobs.

        >>> import pontoon as pt, tempfile
        >>> study = pt.run("studies/smoke", out=tempfile.mkdtemp(), fresh=True)
        >>> study.jobs.failed
        []
        """
        return JobTable(_engine.read_table(self.folder, "jobs"))

    @property
    def tables(self) -> List[str]:
        """Names of the tables that the folder holds.

        >>> import pontoon as pt, tempfile
        >>> pt.run("studies/smoke", out=tempfile.mkdtemp(), fresh=True).tables
        ['jobs', 'positions', 'connectors', 'histories']
        """
        return _engine.table_names(self.folder)

    def table(self, name: str) -> Table:
        """A table by its name.

        >>> import pontoon as pt, tempfile
        >>> len(pt.run("studies/smoke", out=tempfile.mkdtemp(), fresh=True).table("positions"))
        24
        """
        return table_of(name, _engine.read_table(self.folder, name))

    @property
    def manifest(self) -> Dict[str, Any]:
        """What ran, where, when, from which sources.

        >>> import pontoon as pt, tempfile
        >>> study = pt.run("studies/smoke", out=tempfile.mkdtemp(), fresh=True)
        >>> study.manifest["jobs"]
        6
        """
        with open(os.path.join(self.folder, "manifest.json"), encoding="utf-8") as file:
            manifest: Dict[str, Any] = json.load(file)
        return manifest

    @known_words
    def report(
        self,
        out: Optional[AnyPath] = None,
        *,
        with_: Optional[AnyPath] = None,
        plays: Optional[int] = None,
        figures: Optional[AnyPath] = None,
    ) -> Dict[str, Any]:
        """Writes the results as a page, or as ``figures`` into a folder; what was written.

        >>> import pontoon as pt, tempfile, os
        >>> study = pt.run("studies/smoke", out=tempfile.mkdtemp(), fresh=True)
        >>> page = study.report(os.path.join(study.folder, "out.html"), plays=1)
        >>> page["plays"], os.path.exists(page["page"])
        (1, True)
        """
        return _object(_call("report", self.folder, out=out, with_=with_, plays=plays, figures=figures))

    @known_words
    def compare(self, with_: AnyPath, *, tolerance: Optional[AnyPath] = None) -> Comparison:
        """Holds the results against a reference, or against older results.

        >>> import pontoon as pt, tempfile
        >>> study = pt.run("studies/smoke", out=tempfile.mkdtemp(), fresh=True)
        >>> study.compare(study.folder).good
        True
        """
        return compare(self.folder, with_, tolerance=tolerance)

    def export(self, to: AnyPath, **words: Any) -> Dict[str, Any]:
        """Writes a job as files for ParaView, see :func:`export`.

        >>> import pontoon as pt, tempfile
        >>> study = pt.run("studies/smoke", out=tempfile.mkdtemp(), fresh=True)
        >>> study.export(tempfile.mkdtemp(), job=0, count=0, every=100)["files"] > 1
        True
        """
        return export(self.folder, to, **words)

    @known_words
    def indices(
        self, of: Optional[Sequence[str]] = None, *, resamples: Optional[int] = None, seed: Optional[int] = None
    ) -> Dict[str, Any]:
        """Indices of sensitivity of a study with a Saltelli or a Morris design, with their intervals.

        Blocks with a failed row are left out and counted.

        >>> import json, os, pontoon as pt, tempfile
        >>> bridge = os.path.abspath("studies/bridges/smoke.json")
        >>> ranges = {"speed_m_s": [5, 20], "load_n": [50_000, 200_000]}
        >>> design = [{"morris": {"trajectories": 4, "levels": 4, "seed": 1, "ranges": ranges}}]
        >>> study = {"name": "s", "bridge": bridge, "analysis": {"kind": "crossing"}, "design": design}
        >>> folder = tempfile.mkdtemp()
        >>> with open(os.path.join(folder, "study.json"), "w") as file:
        ...     json.dump(study, file)
        >>> indices = pt.run(folder, out=os.path.join(folder, "out")).indices(["peak_deflection_m"])
        >>> indices["designs"][0]["groups"]
        4
        """
        return _object(_call("indices", self.folder, of=of, resamples=resamples, seed=seed))

    @known_words
    def explain(self, job: int) -> Dict[str, Any]:
        """Why a job ran or will run.

        >>> import pontoon as pt, tempfile
        >>> pt.run("studies/smoke", out=tempfile.mkdtemp(), fresh=True).explain(0)["state"]
        'ok'
        """
        return _object(_call("explain", self.folder, str(int(job))))

    def __repr__(self) -> str:
        return f"Study({self.folder!r})"

    def _repr_html_(self) -> str:
        return self.jobs._repr_html_()


class Comparison(Table):
    """The verdicts of a comparison, a row a check.

    >>> import pontoon as pt, tempfile
    >>> study = pt.run("studies/table1", out=tempfile.mkdtemp(), fresh=True)
    >>> verdicts = study.compare("studies/table1")
    >>> verdicts.good, "falls short" in verdicts["verdict"]
    (True, False)
    """

    def __init__(self, table: _engine.EngineTable, good: bool, told: Mapping[str, Any]) -> None:
        super().__init__(table)
        #: Whether no check falls short.
        self.good = good
        #: The comparison as the program says it in JSON.
        self.told = dict(told)


class _Called:
    """What a command left."""

    def __init__(self, result: str, notes: List[str], good: bool) -> None:
        self.result, self.notes, self.good = result, notes, good


def _call(command: str, *places: AnyPath, progress: Optional[bool] = False, **words: Any) -> _Called:
    """Runs a command of the program; ``None`` and ``False`` are words that are not said."""
    line = [command, "--format", "json"]
    for name, value in words.items():
        option = "--" + name.rstrip("_").replace("_", "-")
        if value is True:
            line.append(option)
        elif isinstance(value, (list, tuple)):
            line.extend(f"{option}={os.fspath(of) if isinstance(of, os.PathLike) else of}" for of in value)
        elif value is not None and value is not False:
            line.append(f"{option}={os.fspath(value) if isinstance(value, os.PathLike) else value}")
    line.append("--")
    line.extend(os.fspath(place) for place in places)
    with Progress(progress) as told:
        return _Called(*_engine.call(line, again(), told))


def _object(called: _Called) -> Dict[str, Any]:
    result: Dict[str, Any] = json.loads(called.result)
    return result


@known_words
def run(
    study: AnyPath,
    *,
    out: Optional[AnyPath] = None,
    with_: Optional[AnyPath] = None,
    threads: Optional[int] = None,
    shard: Optional[str] = None,
    fresh: bool = False,
    retry_failed: bool = False,
    max_failures: Optional[int] = None,
    any_instructions: bool = False,
    progress: Optional[bool] = None,
) -> Study:
    """Runs what is missing of a study and writes its tables: what ``pontoon run`` does, into the same folder.

    An interrupt ends it once jobs under way have ended; the same call goes on from there.

    >>> import pontoon as pt, tempfile
    >>> study = pt.run("studies/smoke", out=tempfile.mkdtemp(), fresh=True)
    >>> study.jobs["status"]
    ['ok', 'ok', 'ok', 'ok', 'ok', 'ok']
    """
    called = _call(
        "run",
        study,
        progress=progress,
        out=out,
        with_=with_,
        threads=threads,
        shard=shard,
        fresh=fresh,
        retry_failed=retry_failed,
        max_failures=max_failures,
        any_instructions=any_instructions,
    )
    outcome = _object(called)
    results = Study(outcome["results"])
    results.good, results.notes, results.outcome = called.good, called.notes, outcome
    return results


@known_words
def rate(
    study: AnyPath,
    *,
    out: Optional[AnyPath] = None,
    threads: Optional[int] = None,
    fresh: bool = False,
    progress: Optional[bool] = None,
) -> Dict[str, Any]:
    """Which vehicle of a study with limits may cross how: the table of ``pontoon rate``.

    >>> import json, os, pontoon as pt, tempfile
    >>> bridge, truck = (os.path.abspath(f"studies/{file}.json") for file in ("bridges/smoke", "vehicles/truck"))
    >>> study = {"name": "s", "bridge": bridge, "vehicle": truck, "analysis": {"kind": "crossing"},
    ...          "limits": {"joint_compression_n": 1e6}, "design": [{"grid": {"speed_m_s": [3, 5]}}]}
    >>> folder = tempfile.mkdtemp()
    >>> with open(os.path.join(folder, "study.json"), "w") as file:
    ...     json.dump(study, file)
    >>> sorted(pt.rate(folder, out=os.path.join(folder, "out")))
    ['results', 'table']
    """
    return _object(_call("rate", study, progress=progress, out=out, threads=threads, fresh=fresh))


@known_words
def plan(study: AnyPath, *, out: Optional[AnyPath] = None) -> Dict[str, Any]:
    """Checks every job of a study and says what would run, how long it takes, and what of it is done.

    >>> import pontoon as pt
    >>> pt.plan("studies/smoke", out="/nonexistent")["jobs"]
    6
    """
    return _object(_call("plan", study, out=out))


def status(*folders: AnyPath) -> Dict[str, Any]:
    """How far runs have come.

    >>> import pontoon as pt, tempfile
    >>> study = pt.run("studies/smoke", out=tempfile.mkdtemp(), fresh=True)
    >>> pt.status(study.folder)["done"]
    6
    """
    return _object(_call("status", *folders))


@known_words
def merge(*folders: AnyPath, out: AnyPath, any_instructions: bool = False) -> Study:
    """Puts shards of a study together.

    >>> import pontoon as pt, tempfile, os
    >>> place = tempfile.mkdtemp()
    >>> shards = [pt.run("studies/smoke", shard=f"{k}/2", out=os.path.join(place, str(k))).folder for k in (0, 1)]
    >>> len(pt.merge(*shards, out=os.path.join(place, "whole")).jobs)
    6
    """
    called = _call("merge", *folders, out=out, any_instructions=any_instructions)
    results = Study(_object(called)["results"])
    results.good, results.notes = called.good, called.notes
    return results


@known_words
def compare(results: AnyPath, with_: AnyPath, *, tolerance: Optional[AnyPath] = None) -> Comparison:
    """Holds a folder of results against a reference, or against older results: the verdicts as a table.

    >>> import pontoon as pt, tempfile
    >>> study = pt.run("studies/smoke", out=tempfile.mkdtemp(), fresh=True)
    >>> pt.compare(study.folder, study.folder).good
    True
    """
    called = _call("compare", results, with_=with_, tolerance=tolerance)
    told = _object(called)
    rows = [_verdict(line) for line in told["lines"]]
    return Comparison(_engine.table_of_rows(json.dumps(rows)), called.good, told)


def _verdict(line: Dict[str, Any]) -> Dict[str, Any]:
    """A check as a row: its worst case stands for it."""
    worst = line.get("worst") or {}
    values = worst.get("values") or [None]
    return {
        "check": line["id"],
        "statement": line["statement"],
        "role": line["role"],
        "verdict": line["verdict"],
        "expected": line["expected"],
        "expected_value": line["expected_value"],
        "value": values[0],
        "deviation": worst.get("deviation"),
        "margin": worst.get("margin"),
        "reason": worst.get("reason"),
        "cases": len(line["cases"]),
    }


@known_words
def calibrate(
    bridge: AnyPath,
    *,
    with_: Union[AnyPath, Sequence[AnyPath]],
    parameters: AnyPath,
    out: AnyPath,
    threads: Optional[int] = None,
    progress: Optional[bool] = None,
) -> Dict[str, Any]:
    """Identifies parameters of a bridge from references, and writes the bridge found: ``pontoon calibrate``.

    >>> import pontoon as pt
    >>> try:
    ...     pt.calibrate("studies/bridges/fu2005.json", with_="studies/table1", parameters="no.json", out="/tmp/b.json")
    ... except pt.InputError as error:
    ...     print(error.file)
    no.json
    """
    references = [with_] if isinstance(with_, (str, os.PathLike)) else list(with_)
    called = _call(
        "calibrate", bridge, progress=progress, with_=references, parameters=parameters, out=out, threads=threads
    )
    return _object(called)


@known_words
def export(
    source: AnyPath,
    to: AnyPath,
    *,
    count: Optional[int] = None,
    supports: bool = False,
    load_n: Optional[float] = None,
    load_x_m: Optional[float] = None,
    load_position: Optional[int] = None,
    connection: Optional[str] = None,
    gap_tension_m: Optional[float] = None,
    gap_compression_m: Optional[float] = None,
    job: Optional[int] = None,
    every: Optional[int] = None,
    stresses: bool = False,
) -> Dict[str, Any]:
    """Writes mode shapes, a static case of a bridge file, or a job of a folder of results, as files for ParaView.

    >>> import pontoon as pt, tempfile
    >>> written = pt.export("studies/bridges/smoke.json", tempfile.mkdtemp(), count=2)
    >>> written["files"]
    4
    """
    words: Dict[str, Any] = {
        "count": count,
        "supports": supports,
        "load_n": load_n,
        "load_x_m": load_x_m,
        "load_position": load_position,
        "connection": connection,
        "gap_tension_m": gap_tension_m,
        "gap_compression_m": gap_compression_m,
        "job": job,
        "every": every,
        "stresses": stresses,
    }
    return _object(_call("export", source, to=to, **words))


@known_words
def schema(of: str) -> Dict[str, Any]:
    """The JSON schema of a file: ``study``, ``bridge``, ``vehicle``, ``reference``, ``parameters``, or of ``tables``.

    >>> import pontoon as pt
    >>> "connectors" in pt.schema("bridge")["properties"]
    True
    """
    return _object(_call("schema", of))
