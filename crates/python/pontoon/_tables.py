"""Tables of results."""

from __future__ import annotations

import html
from typing import TYPE_CHECKING, Any, Dict, Iterator, List, Mapping, Optional

from . import _engine
from ._errors import refused

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

#: Rows that are shown of a long table, half of them from its end.
_SHOWN = 10
#: Columns that are shown as text.
_COLUMNS = 8


def _written(cell: Any) -> str:
    if cell is None:
        return ""
    return f"{cell:.6g}" if isinstance(cell, float) else str(cell)


class Table:
    """A table: columns of numbers, words or flags.

    It is handed to other libraries without a copy: ``polars.DataFrame(table)``, ``pyarrow.table(table)``, and
    ``duckdb.sql("select * from arrow")`` with ``arrow = pyarrow.table(table)``.

    >>> import pontoon as pt
    >>> bridge = pt.Bridge("studies/bridges/smoke.json")
    >>> jobs = bridge.cross(speed_m_s=[5, 10], load_n=100_000)
    >>> len(jobs), jobs["speed_m_s"]
    (2, [5.0, 10.0])
    >>> jobs.row(0)["status"]
    'ok'
    """

    def __init__(self, table: _engine.EngineTable) -> None:
        self._table = table

    @property
    def columns(self) -> List[str]:
        """Names of the columns in their order.

        >>> import pontoon as pt
        >>> pt.Bridge("studies/bridges/smoke.json").modes(3).columns[:3]
        ['job', 'number', 'frequency_hz']
        """
        return self._table.columns

    def __len__(self) -> int:
        return len(self._table)

    def __contains__(self, name: object) -> bool:
        return name in self.columns

    def __getitem__(self, name: str) -> List[Any]:
        """The cells of a column, ``None`` where there is none."""
        self._check(name)
        return self._table.column(name, 0, len(self))

    def numpy(self, name: str) -> npt.NDArray[np.float64]:
        """A column of numbers as an array; nan where there is none, flags as 0 and 1.

        >>> import pontoon as pt
        >>> jobs = pt.Bridge("studies/bridges/smoke.json").cross(speed_m_s=[5, 10], load_n=100_000)
        >>> jobs.numpy("speed_m_s")
        array([ 5., 10.])
        """
        import numpy

        self._check(name)
        numbers = self._table.numbers(name)
        if numbers is None:
            raise refused("Table", name, "a column of words", "a column of numbers")
        return numpy.frombuffer(numbers).copy()

    def row(self, number: int) -> Dict[str, Any]:
        """A row by its number from 0, or from the end where it is negative.

        >>> import pontoon as pt
        >>> modes = pt.Bridge("studies/bridges/smoke.json").modes(8)
        >>> modes.row(-1)["number"]
        8
        """
        at = number + len(self) if number < 0 else number
        if not 0 <= at < len(self):
            raise IndexError(f"row {number} of a table of {len(self)}")
        return {name: self._table.column(name, at, at + 1)[0] for name in self.columns}

    def __iter__(self) -> Iterator[Dict[str, Any]]:
        columns = self.to_dict()
        for number in range(len(self)):
            yield {name: cells[number] for name, cells in columns.items()}

    def to_dict(self) -> Dict[str, List[Any]]:
        """The columns by their names.

        >>> import pontoon as pt
        >>> sorted(pt.Bridge("studies/bridges/smoke.json").modes(2).to_dict())[:2]
        ['axial_share', 'frequency_hz']
        """
        return {name: self[name] for name in self.columns}

    def to_arrow(self) -> Any:
        """The table as one of pyarrow.

        >>> import pontoon as pt
        >>> pt.Bridge("studies/bridges/smoke.json").modes(3).to_arrow().num_rows
        3
        """
        import pyarrow

        return pyarrow.table(self)

    def to_pandas(self) -> Any:
        """The table as a data frame of pandas, by way of pyarrow.

        >>> import pontoon as pt
        >>> pt.Bridge("studies/bridges/smoke.json").modes(3).to_pandas().shape
        (3, 8)
        """
        return self.to_arrow().to_pandas()

    def to_polars(self) -> Any:
        """The table as a data frame of polars.

        >>> import pontoon as pt
        >>> pt.Bridge("studies/bridges/smoke.json").modes(3).to_polars().height
        3
        """
        import polars

        return polars.DataFrame(self)

    def __arrow_c_stream__(self, requested_schema: Optional[object] = None) -> object:
        return self._table.__arrow_c_stream__(requested_schema)

    def _check(self, name: str) -> None:
        if name not in self.columns:
            _engine.refuse_word("Table", str(name), str(name), self.columns)

    def _cells(self) -> List[List[str]]:
        """The rows that are shown, ``…`` in the place of those left out."""
        half, rows = _SHOWN // 2, len(self)
        ranges = [(0, rows)] if rows <= _SHOWN else [(0, half), (rows - half, rows)]
        lines: List[List[str]] = []
        for part, (first, last) in enumerate(ranges):
            if part > 0:
                lines.append(["…"] * len(self.columns))
            cells = [self._table.column(name, first, last) for name in self.columns]
            lines.extend([_written(cell) for cell in line] for line in zip(*cells))
        return lines

    def __repr__(self) -> str:
        names, rows = self.columns, self._cells()
        # what is empty in all rows that are shown says nothing
        told = [at for at in range(len(names)) if any(line[at] not in ("", "…") for line in rows)][:_COLUMNS]
        lines = [names] + rows
        widths = [max(len(line[at]) for line in lines) for at in told]
        text = "\n".join("  ".join(line[at].rjust(width) for at, width in zip(told, widths)) for line in lines)
        more = f", {len(names) - len(told)} more columns" if len(names) > len(told) else ""
        return f"{text}\n[{len(self)} rows{more}]"

    def _repr_html_(self) -> str:
        def line(tag: str, cells: List[str]) -> str:
            return "<tr>" + "".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in cells) + "</tr>"

        rows = "".join(line("td", cells) for cells in self._cells())
        head = line("th", self.columns)
        return f"<table><thead>{head}</thead><tbody>{rows}</tbody></table><p>{len(self)} rows</p>"


class JobTable(Table):
    """The table of jobs: a row a job, a failed one too.

    >>> import pontoon as pt
    >>> jobs = pt.Bridge("studies/bridges/smoke.json").cross(speed_m_s=5, load_n=[100_000, 120_000])
    >>> jobs["status"], jobs.failed
    (['ok', 'ok'], [])
    """

    @property
    def failed(self) -> List[int]:
        """Numbers of the rows that failed.

        >>> import pontoon as pt
        >>> pt.Bridge("studies/bridges/smoke.json").cross(speed_m_s=5, load_n=100_000).failed
        []
        """
        return list(self._table.failures())

    def plot(
        self, x: str = "speed_m_s", y: str = "peak_deflection_m", *, by: Optional[str] = None, ax: Any = None
    ) -> Any:
        """Draws a column against another, a line for each value of the column ``by``; the axes of matplotlib.

        >>> import pontoon as pt
        >>> jobs = pt.Bridge("studies/bridges/smoke.json").cross(speed_m_s=[5, 10], load_n=[1e5, 2e5])
        >>> [line.get_label() for line in jobs.plot(by="load_n").get_lines()]
        ['load_n 100000', 'load_n 200000']
        """
        from ._plots import columns

        return columns(self, x, y, by, ax)


class Jobs(JobTable):
    """The table of the jobs of a call, with the other tables that it left.

    >>> import pontoon as pt
    >>> jobs = pt.Bridge("studies/bridges/smoke.json").cross(speed_m_s=5, load_n=[100_000, 120_000])
    >>> sorted(jobs.tables)
    ['connectors', 'jobs', 'positions']
    >>> len(jobs.tables["positions"])
    8
    """

    #: All tables by their names, ``positions`` and ``connectors`` among them.
    tables: Mapping[str, Table]

    def __init__(self, tables: Mapping[str, _engine.EngineTable]) -> None:
        super().__init__(tables["jobs"])
        others = {name: table_of(name, table) for name, table in tables.items() if name != "jobs"}
        self.tables = {"jobs": self, **others}


class Histories(Table):
    """Recorded histories: a row for each quantity, place and time.

    >>> import pontoon as pt
    >>> histories = pt.Bridge("studies/bridges/smoke.json").crossing(speed_m_s=10, load_n=100_000).histories
    >>> histories.columns
    ['job', 'time_s', 'quantity', 'position', 'value']
    """

    def plot(self, quantity: str = "deflection_m", *, ax: Any = None) -> Any:
        """Draws a quantity against time, a line for each place and job; the axes of matplotlib.

        >>> import pontoon as pt
        >>> crossing = pt.Bridge("studies/bridges/smoke.json").crossing(speed_m_s=10, load_n=100_000)
        >>> len(crossing.histories.plot().get_lines())
        4
        """
        from ._plots import histories

        return histories(self, quantity, ax)


def table_of(name: str, table: _engine.EngineTable) -> Table:
    """A table of the engine by its name."""
    kinds = {"jobs": JobTable, "histories": Histories}
    return kinds.get(name, Table)(table)
