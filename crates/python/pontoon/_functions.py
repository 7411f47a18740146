"""Functions of points, for libraries that design experiments, optimise or estimate."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Optional, Sequence, Tuple

from ._documents import plain, to_json
from ._errors import EngineError, refused
from ._words import threads_of

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from ._bridges import Bridge
    from ._engine import FunctionStudy

_CALL = "function()"

#: What becomes of a crossing that fails: its row is nan, or the call raises.
_ON_FAILURE = ("nan", "raise")


class Function:
    """``Y = f(X)``: a row of ``X`` is a point, a column an input; a column of ``Y`` is an output.

    A row of ``Y`` is nan where the crossing failed. A single point may be given by itself: ``f([15, 0.02])`` gives one
    row. Points outside of the bounds are refused. Files that it names are read at the first call.

    >>> import pontoon as pt
    >>> bridge = pt.Bridge("studies/bridges/smoke.json")
    >>> f = bridge.function(inputs={"speed_m_s": (2, 20)}, outputs=["peak_deflection_m", "steps"], load_n=1e5)
    >>> f([[5], [10]]).shape, f([5]).shape
    ((2, 2), (2,))
    >>> f.problem
    {'num_vars': 1, 'names': ['speed_m_s'], 'bounds': [[2.0, 20.0]]}
    """

    def __init__(
        self,
        bridge: Bridge,
        study: Mapping[str, Any],
        inputs: Mapping[str, Sequence[float]],
        outputs: Sequence[str],
        fixed: Mapping[str, Any],
        threads: int,
        on_failure: str = "nan",
    ) -> None:
        if isinstance(outputs, str) or not outputs:
            raise refused(_CALL, "outputs", repr(outputs), "a list of columns of the table of jobs")
        self._bridge = bridge
        self._study: Dict[str, Any] = plain(_CALL, "", study)
        self._fixed: Dict[str, Any] = plain(_CALL, "fixed", fixed)
        self._inputs = {str(name): _bounds(f"inputs.{name}", of) for name, of in inputs.items()}
        self._outputs = [str(output) for output in outputs]
        self._threads = threads_of(_CALL, threads)
        if on_failure not in _ON_FAILURE:
            raise refused(_CALL, "on_failure", repr(on_failure), ", ".join(_ON_FAILURE))
        self._on_failure = on_failure
        self._last = threading.local()
        self._engine: Optional[FunctionStudy] = None
        if not self._inputs:
            raise refused(_CALL, "inputs", "none", "at least one axis with its bounds")
        both = next((name for name in self._inputs if name in self._fixed), None)
        if both is not None:
            raise refused(_CALL, f"fixed.{both}", "an axis that is an input too", "each axis once")

    @property
    def inputs(self) -> Dict[str, Tuple[float, float]]:
        """The inputs with their bounds, in the order of the columns of ``X``.

        >>> import pontoon as pt
        >>> bridge = pt.Bridge("studies/bridges/smoke.json")
        >>> f = bridge.function({"speed_m_s": (2, 20)}, ["peak_deflection_m"], load_n=100_000)
        >>> f.inputs
        {'speed_m_s': (2.0, 20.0)}
        """
        return dict(self._inputs)

    @property
    def outputs(self) -> List[str]:
        """The outputs, in the order of the columns of ``Y``.

        >>> import pontoon as pt
        >>> bridge = pt.Bridge("studies/bridges/smoke.json")
        >>> f = bridge.function({"speed_m_s": (2, 20)}, ["peak_deflection_m"], load_n=100_000)
        >>> f.outputs
        ['peak_deflection_m']
        """
        return list(self._outputs)

    @property
    def problem(self) -> Dict[str, Any]:
        """The inputs as SALib describes them.

        >>> import pontoon as pt
        >>> bridge = pt.Bridge("studies/bridges/smoke.json")
        >>> f = bridge.function({"speed_m_s": (2, 20)}, ["peak_deflection_m"], load_n=100_000)
        >>> f.problem["names"]
        ['speed_m_s']
        """
        bounds = [[low, high] for low, high in self._inputs.values()]
        return {"num_vars": len(bounds), "names": list(self._inputs), "bounds": bounds}

    @property
    def failures(self) -> Dict[int, str]:
        """Why rows failed in the last call of this thread, by their number.

        >>> import pontoon as pt
        >>> bridge = pt.Bridge("studies/bridges/smoke.json")
        >>> f = bridge.function({"speed_m_s": (1, 20)}, ["peak_deflection_m"], load_n=100_000,
        ...                     analysis={"time_step_s": 0.02, "step_limit": 400})
        >>> print(f([[2], [20]])[0], f.failures)
        [nan] {0: '877 time steps, the limit is 400'}
        """
        return dict(getattr(self._last, "failures", {}))

    def __call__(self, X: Any, *, progress: Optional[bool] = None) -> npt.NDArray[np.float64]:
        """The outputs at points.

        >>> import pontoon as pt
        >>> bridge = pt.Bridge("studies/bridges/smoke.json")
        >>> f = bridge.function({"speed_m_s": (2, 20)}, ["peak_deflection_m"], load_n=100_000)
        >>> f([5]).shape
        (1,)
        """
        import numpy

        from ._bridges import _SESSION
        from ._progress import Progress

        points, single = self._points(X)
        self._last.failures = {}
        if len(points) == 0:
            return numpy.empty((0, len(self._outputs)))
        study, lists = self._of_points(points[0]), points.T.tolist()
        with Progress(progress) as told:
            solved = _SESSION.solve_points(study, lists, self._outputs, self._threads, told)
        numbers, failures, self._last.solved_s = solved
        self._last.failures = failures
        if failures and self._on_failure == "raise":
            first, reason = next(iter(failures.items()))
            raise EngineError(f"{len(failures)} of {len(points)} crossings failed; row {first}: {reason}")
        result = numpy.frombuffer(numbers).reshape(-1, len(self._outputs)).copy()
        return result[0] if single else result

    def _of_points(self, first: npt.NDArray[np.float64]) -> FunctionStudy:
        """The engine's study, read at the first call; two threads that read it at once read the same."""
        from ._engine import FunctionStudy

        if self._engine is None:
            axes = dict(zip(self._inputs, first.tolist()))
            text = to_json(_CALL, {**self._study, "design": [{"zip": {**axes, **self._fixed}}]})
            self._engine = FunctionStudy(text, _CALL, self._bridge._engine)
        return self._engine

    def _points(self, X: Any) -> Tuple[npt.NDArray[np.float64], bool]:
        import numpy

        inputs = len(self._inputs)
        try:
            points = numpy.asarray(X)
            if points.dtype.kind not in "fiu":
                points = points.astype(float) if points.dtype.kind == "O" else points.astype("U")
            points = points.astype(float, casting="safe" if points.dtype.kind != "O" else "unsafe")
        except (TypeError, ValueError):
            kind = type(X).__name__
            raise refused(_CALL, "X", f"a {kind} of what is no number", f"numbers of shape (n, {inputs})") from None
        single = points.ndim == 1 and len(points) == inputs
        if single:
            points = points[None, :]
        if points.ndim != 2 or points.shape[1] != inputs:
            allowed = f"shape (n, {inputs}), a column for each of {', '.join(self._inputs)}"
            raise refused(_CALL, "X", f"an array of shape {points.shape}", allowed)
        for column, (name, (low, high)) in enumerate(self._inputs.items()):
            # what is no number is beyond no bound and within none
            beyond = numpy.flatnonzero(~((points[:, column] >= low) & (points[:, column] <= high)))
            if len(beyond) > 0:
                row = int(beyond[0])
                found = repr(float(points[row, column]))
                raise refused(_CALL, f"X[{row}, {column}]", found, f"{name} from {low!r} to {high!r}")
        return points, single

    def __reduce__(self) -> Tuple[Any, ...]:
        words = (self._bridge, self._study, self._inputs, self._outputs, self._fixed, self._threads, self._on_failure)
        return (Function, words)

    def __repr__(self) -> str:
        return f"Function({', '.join(self._inputs)} -> {', '.join(self._outputs)})"


def _bounds(path: str, bounds: Sequence[float]) -> Tuple[float, float]:
    try:
        low, high = (float(bound) for bound in bounds)
    except (TypeError, ValueError):
        raise refused(_CALL, path, repr(bounds), "two numbers, the lower bound and the upper one") from None
    if not low < high:
        raise refused(_CALL, path, f"({low:g}, {high:g})", "a lower bound below the upper one")
    return low, high
