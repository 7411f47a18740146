"""Hydroelastic response of floating bridges under moving vehicles, at the speed of the engine.

A bridge is asked without a file; tables go to polars, pandas, pyarrow and DuckDB without a copy:

>>> import pontoon as pt
>>> bridge = pt.Bridge("studies/bridges/smoke.json").with_(connectors={"gap_tension_m": 0.028})
>>> jobs = bridge.cross(speed_m_s=[3, 7, 15], load_n=100_000)
>>> jobs["status"]
['ok', 'ok', 'ok']

A study in a file runs into a folder, whatever becomes of the process:

>>> import tempfile
>>> study = pt.run("studies/smoke", out=tempfile.mkdtemp(), fresh=True)
>>> len(study.jobs)
6
"""

from ._bridges import Bridge, Crossing, Vehicle
from ._engine import __version__
from ._errors import EngineError, InputError
from ._functions import Function
from ._studies import (
    Comparison,
    Study,
    calibrate,
    compare,
    export,
    merge,
    plan,
    rate,
    run,
    schema,
    status,
)
from ._tables import Histories, Jobs, JobTable, Table

__all__ = [
    "Bridge",
    "Comparison",
    "Crossing",
    "EngineError",
    "Function",
    "Histories",
    "InputError",
    "JobTable",
    "Jobs",
    "Study",
    "Table",
    "Vehicle",
    "__version__",
    "calibrate",
    "compare",
    "export",
    "merge",
    "plan",
    "rate",
    "run",
    "schema",
    "status",
]
