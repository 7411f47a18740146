"""Bridges, vehicles, and what is asked of them without a file."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any, Dict, Iterator, Mapping, Optional, Sequence, Tuple, Union

from . import _engine
from ._documents import merged, plain, to_json
from ._errors import refused
from ._functions import Function
from ._progress import Progress
from ._tables import Histories, Jobs, Table
from ._words import known_words, threads_of

#: A path, as a text or an object.
AnyPath = Union[str, "os.PathLike[str]"]

#: Solves studies, and keeps what one prepared for the next.
_SESSION = _engine.Session()


class Vehicle:
    """A vehicle: the path of its file relative to the working folder, or its document as a dict.

    >>> import pontoon as pt
    >>> truck = pt.Vehicle("studies/vehicles/truck.json")
    >>> truck.name, len(truck.document["axles"])
    ('truck', 2)
    >>> pt.Vehicle({"footprint_length_m": 3.35, "track_y_m": [-1.4, 1.4]}).name
    'vehicle'
    """

    def __init__(self, vehicle: Union[AnyPath, Mapping[str, Any]], *, name: Optional[str] = None) -> None:
        if isinstance(vehicle, Mapping):
            self._json = to_json("Vehicle()", vehicle)
            self._name = name or "vehicle"
        else:
            self._json = _engine.vehicle_json(os.fspath(vehicle))
            self._name = name or Path(os.fspath(vehicle)).stem

    @property
    def name(self) -> str:
        """Its name in tables: that of its file.

        >>> import pontoon as pt
        >>> pt.Vehicle("studies/vehicles/mlc60_tracked.json").name
        'mlc60_tracked'
        """
        return self._name

    @property
    def document(self) -> Dict[str, Any]:
        """Its document, a copy.

        >>> import pontoon as pt
        >>> pt.Vehicle({"track_y_m": [-1, 1]}).document
        {'track_y_m': [-1, 1]}
        """
        result: Dict[str, Any] = json.loads(self._json)
        return result

    def __repr__(self) -> str:
        return f"Vehicle({self._name!r})"

    def __reduce__(self) -> Tuple[Any, ...]:
        return (_vehicle_again, (self.document, self._name))


def _vehicle_again(document: Dict[str, Any], name: str) -> Vehicle:
    return Vehicle(document, name=name)


class Crossing(Mapping[str, Any]):
    """One crossing: the row of its job as a mapping, and its histories.

    >>> import pontoon as pt
    >>> crossing = pt.Bridge("studies/bridges/smoke.json").crossing(speed_m_s=10, load_n=100_000)
    >>> crossing["status"], len(crossing.histories) > 1000
    ('ok', True)
    """

    def __init__(self, jobs: Jobs) -> None:
        self._row = jobs.row(0)
        #: The tables that it left, ``positions`` and ``connectors`` among them.
        self.tables = jobs.tables

    def __getitem__(self, name: str) -> Any:
        return self._row[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._row)

    def __len__(self) -> int:
        return len(self._row)

    @property
    def histories(self) -> Histories:
        """What was recorded in each time step.

        >>> import pontoon as pt
        >>> crossing = pt.Bridge("studies/bridges/smoke.json").crossing(speed_m_s=10, load_n=100_000)
        >>> crossing.histories.columns
        ['job', 'time_s', 'quantity', 'position', 'value']
        """
        histories = self.tables["histories"]
        assert isinstance(histories, Histories)
        return histories

    def plot(self, quantity: str = "deflection_m", *, ax: Any = None) -> Any:
        """Draws a quantity of the histories against time, a line for each place; the axes of matplotlib.

        >>> import pontoon as pt
        >>> pt.Bridge("studies/bridges/smoke.json").crossing(speed_m_s=10, load_n=100_000).plot("force_n").get_ylabel()
        'force_n'
        """
        return self.histories.plot(quantity, ax=ax)

    def __repr__(self) -> str:
        told = {name: value for name, value in self._row.items() if value is not None}
        return f"Crossing({told})"

    def _repr_html_(self) -> str:
        return self.tables["jobs"]._repr_html_()


class Bridge:
    """A bridge: the path of its file relative to the working folder, or its document as a dict.

    >>> import pontoon as pt
    >>> bridge = pt.Bridge("studies/bridges/smoke.json")
    >>> bridge.modules
    3
    >>> jobs = bridge.cross(speed_m_s=[3, 7, 15], load_n=100_000)
    >>> len(jobs)
    3
    """

    def __init__(self, bridge: Union[AnyPath, Mapping[str, Any]]) -> None:
        if isinstance(bridge, Mapping):
            self._engine = _engine.BridgeDocument.parse("Bridge()", to_json("Bridge()", bridge))
        else:
            self._engine = _engine.BridgeDocument.read(os.fspath(bridge))

    @property
    def document(self) -> Dict[str, Any]:
        """Its document, a copy.

        >>> import pontoon as pt
        >>> pt.Bridge("studies/bridges/smoke.json").document["connectors"]["gap_tension_m"]
        0.028
        """
        result: Dict[str, Any] = json.loads(self._engine.json)
        return result

    @property
    def modules(self) -> int:
        """Number of modules.

        >>> import pontoon as pt
        >>> pt.Bridge("studies/bridges/fu2005.json").modules
        15
        """
        return self._engine.modules

    @property
    def length_m(self) -> float:
        """Length of the bridge in m.

        >>> import pontoon as pt
        >>> pt.Bridge("studies/bridges/smoke.json").length_m > 10
        True
        """
        return self._engine.length_m

    def with_(self, **changes: Any) -> Bridge:
        """Another bridge with some keys changed: dicts are merged, all else is replaced, ``None`` takes a key away.

        >>> import pontoon as pt
        >>> bridge = pt.Bridge("studies/bridges/smoke.json").with_(connectors={"gap_tension_m": 0.028})
        >>> bridge.document["connectors"]["gap_tension_m"]
        0.028
        """
        call = f"{self._engine.name.replace('.with_()', '')}.with_()"
        document = merged(self.document, plain(call, "", changes))
        other = object.__new__(Bridge)
        other._engine = _engine.BridgeDocument.parse(call, json.dumps(document))
        return other

    def cross(
        self,
        *,
        vehicle: Union[Vehicle, AnyPath, Mapping[str, Any], Sequence[Vehicle], None] = None,
        analysis: Optional[Mapping[str, Any]] = None,
        limits: Optional[Mapping[str, Any]] = None,
        record: Optional[Mapping[str, Any]] = None,
        traffic: Optional[Sequence[Mapping[str, Any]]] = None,
        column: Optional[Mapping[str, Any]] = None,
        roughness: Optional[Mapping[str, Any]] = None,
        wear: Optional[Mapping[str, Any]] = None,
        design: Optional[Sequence[Mapping[str, Any]]] = None,
        paths: Optional[Mapping[str, Any]] = None,
        threads: int = 0,
        progress: Optional[bool] = None,
        **axes: Any,
    ) -> Jobs:
        """Crossings of every combination of the axes' values, a row a crossing; a failed one is a row too.

        ``axes`` are those of the study file by name, each one value or a list: ``speed_m_s``, ``load_n``,
        ``gap_tension_m``. ``paths`` are axes by their path: ``{"bridge.module.draft_m": [0.6, 0.7]}``. All other keys
        are those of the study file; ``design`` holds designs of points in the place of axes.

        >>> import pontoon as pt
        >>> bridge = pt.Bridge("studies/bridges/smoke.json")
        >>> jobs = bridge.cross(speed_m_s=[5, 10], load_n=100_000, gap_tension_m=[0, 0.02])
        >>> len(jobs), jobs["status"][0]
        (4, 'ok')
        """
        study = self._study("crossing", analysis, vehicle, axes, paths, design)
        _put(study, limits=limits, record=record, traffic=traffic, column=column, roughness=roughness, wear=wear)
        return self._solve("cross()", study, threads, progress)

    def crossing(
        self,
        *,
        vehicle: Union[Vehicle, AnyPath, Mapping[str, Any], None] = None,
        analysis: Optional[Mapping[str, Any]] = None,
        limits: Optional[Mapping[str, Any]] = None,
        record: Optional[Mapping[str, Any]] = None,
        traffic: Optional[Sequence[Mapping[str, Any]]] = None,
        column: Optional[Mapping[str, Any]] = None,
        roughness: Optional[Mapping[str, Any]] = None,
        wear: Optional[Mapping[str, Any]] = None,
        paths: Optional[Mapping[str, Any]] = None,
        progress: Optional[bool] = None,
        **axes: Any,
    ) -> Crossing:
        """One crossing with the histories of all positions and joints, or of those that ``record`` names.

        >>> import pontoon as pt
        >>> bridge = pt.Bridge("studies/bridges/smoke.json")
        >>> crossing = bridge.crossing(speed_m_s=10, load_n=100_000)
        >>> crossing["peak_deflection_m"] == max(
        ...     row["value"] for row in crossing.histories if row["quantity"] == "deflection_m")
        True
        """
        call = "crossing()"
        study = self._study("crossing", analysis, vehicle, axes, paths, None)
        _put(study, limits=limits, record=record, traffic=traffic, column=column, roughness=roughness, wear=wear)
        recorded = dict(study.get("record") or {})
        joints = list(range(2, self.modules + 1))
        recorded.setdefault("histories", {"positions": list(range(1, self.modules + 2)), "joints": joints})
        study["record"] = recorded
        jobs = self._solve(call, study, 1, progress)
        if len(jobs) != 1:
            raise refused(call, "axes", f"{len(jobs)} crossings", "one value of each axis; cross() takes several")
        return Crossing(jobs)

    def rate(
        self,
        *,
        limits: Mapping[str, Any],
        find: Mapping[str, Any],
        vehicle: Union[Vehicle, AnyPath, Mapping[str, Any], Sequence[Vehicle], None] = None,
        analysis: Optional[Mapping[str, Any]] = None,
        record: Optional[Mapping[str, Any]] = None,
        traffic: Optional[Sequence[Mapping[str, Any]]] = None,
        column: Optional[Mapping[str, Any]] = None,
        roughness: Optional[Mapping[str, Any]] = None,
        wear: Optional[Mapping[str, Any]] = None,
        paths: Optional[Mapping[str, Any]] = None,
        threads: int = 0,
        progress: Optional[bool] = None,
        **axes: Any,
    ) -> Jobs:
        """Ratings of every combination: the largest or smallest value of an axis at which a crossing keeps all limits.

        >>> import pontoon as pt
        >>> bridge = pt.Bridge("studies/bridges/smoke.json")
        >>> rated = bridge.rate(speed_m_s=[5, 10], limits={"joint_compression_n": 6e5},
        ...                     find={"largest": "load_n", "between": [5e4, 4e5]})
        >>> [5e4 < value < 4e5 for value in rated["rated_value"]]
        [True, True]
        """
        study = self._study("rating", analysis, vehicle, axes, paths, None)
        _put(study, limits=limits, find=find, record=record, traffic=traffic, column=column)
        _put(study, roughness=roughness, wear=wear)
        return self._solve("rate()", study, threads, progress)

    def statics(
        self,
        *,
        vehicle: Union[Vehicle, AnyPath, Mapping[str, Any], Sequence[Vehicle], None] = None,
        analysis: Optional[Mapping[str, Any]] = None,
        record: Optional[Mapping[str, Any]] = None,
        wear: Optional[Mapping[str, Any]] = None,
        paths: Optional[Mapping[str, Any]] = None,
        threads: int = 0,
        progress: Optional[bool] = None,
        **axes: Any,
    ) -> Jobs:
        """Static cases of every combination of the axes' values: ``load_n`` at ``load_position`` or ``load_x_m``.

        >>> import pontoon as pt
        >>> bridge = pt.Bridge("studies/bridges/smoke.json")
        >>> cases = bridge.statics(load_n=100_000, load_position=[1, 2])
        >>> len(cases.tables["positions"])
        8
        """
        study = self._study("static", analysis, vehicle, axes, paths, None)
        _put(study, record=record, wear=wear)
        return self._solve("statics()", study, threads, progress)

    @known_words
    def modes(
        self,
        count: int = 20,
        *,
        analysis: Optional[Mapping[str, Any]] = None,
        paths: Optional[Mapping[str, Any]] = None,
        threads: int = 0,
        progress: Optional[bool] = None,
    ) -> Table:
        """The lowest modes of the bridge, linearly connected; with ``paths`` those of every combination.

        >>> import pontoon as pt
        >>> modes = pt.Bridge("studies/bridges/smoke.json").modes(7)
        >>> modes["shape"][2:4]
        ['yaw', 'roll']
        """
        asked = {"count": count, **(analysis or {})}
        study = self._study("modes", asked, None, {}, paths, None)
        return self._solve("modes()", study, threads, progress).tables["modes"]

    def function(
        self,
        inputs: Mapping[str, Sequence[float]],
        outputs: Sequence[str],
        *,
        vehicle: Union[Vehicle, AnyPath, Mapping[str, Any], None] = None,
        analysis: Optional[Mapping[str, Any]] = None,
        limits: Optional[Mapping[str, Any]] = None,
        record: Optional[Mapping[str, Any]] = None,
        traffic: Optional[Sequence[Mapping[str, Any]]] = None,
        column: Optional[Mapping[str, Any]] = None,
        roughness: Optional[Mapping[str, Any]] = None,
        wear: Optional[Mapping[str, Any]] = None,
        paths: Optional[Mapping[str, Any]] = None,
        threads: int = 0,
        on_failure: str = "nan",
        **fixed: Any,
    ) -> Function:
        """A function of points: ``Y = f(X)`` with a column of ``X`` for each input and one of ``Y`` for each output.

        ``inputs`` are axes by name or path with their bounds, ``outputs`` columns of the table of jobs, ``fixed`` axes
        with one value, those by their path in ``paths``. A crossing that fails leaves a row of nan, which other
        libraries may take for a safe one; with ``on_failure="raise"`` the call raises :class:`EngineError`.

        >>> import pontoon as pt
        >>> bridge = pt.Bridge("studies/bridges/smoke.json")
        >>> f = bridge.function(inputs={"speed_m_s": (2, 20), "gap_tension_m": (0, 0.04)},
        ...                     outputs=["peak_deflection_m"], load_n=100_000)
        >>> Y = f([[5, 0.01], [10, 0.01]])
        >>> Y.shape, f.failures
        ((2, 1), {})
        """
        study = self._study("crossing", analysis, vehicle, {}, None, None)
        _put(study, limits=limits, record=record, traffic=traffic, column=column, roughness=roughness, wear=wear)
        return Function(self, study, inputs, outputs, {**fixed, **(paths or {})}, threads, on_failure)

    def _study(
        self,
        kind: str,
        analysis: Optional[Mapping[str, Any]],
        vehicle: Any,
        axes: Mapping[str, Any],
        paths: Optional[Mapping[str, Any]],
        design: Optional[Sequence[Mapping[str, Any]]],
    ) -> Dict[str, Any]:
        grid = {**axes, **(paths or {})}
        study: Dict[str, Any] = {"name": "call", "bridge": "", "analysis": {"kind": kind, **(analysis or {})}}
        if isinstance(vehicle, (list, tuple)):
            study["vehicles"] = {of.name: of.document for of in vehicle}
            grid["vehicle"] = [of.name for of in vehicle]
        elif vehicle is not None:
            study["vehicle"] = vehicle
        study["design"] = [*(design or []), *([{"grid": grid}] if grid or not design else [])]
        return study

    def _solve(self, call: str, study: Mapping[str, Any], threads: int, progress: Optional[bool]) -> Jobs:
        threads = threads_of(call, threads)
        with Progress(progress) as told:
            return Jobs(_SESSION.solve(to_json(call, study), call, self._engine, threads, told))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Bridge) and self._engine.json == other._engine.json

    def __hash__(self) -> int:
        return hash(self._engine.json)

    def __reduce__(self) -> Tuple[Any, ...]:
        return (_bridge_again, (self._engine.name, self._engine.json))

    def __repr__(self) -> str:
        return f"Bridge({self._engine.name!r}, {self.modules} modules, {self.length_m:g} m)"

    def _repr_html_(self) -> str:
        from ._pictures import bridge_html

        return bridge_html(self)


def _bridge_again(name: str, text: str) -> Bridge:
    bridge = object.__new__(Bridge)
    bridge._engine = _engine.BridgeDocument.parse(name, text)
    return bridge


def _put(study: Dict[str, Any], **keys: Any) -> None:
    """Puts the keys that are given."""
    study.update({name: value for name, value in keys.items() if value is not None})
