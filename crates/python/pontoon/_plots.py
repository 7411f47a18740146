"""Drawings by matplotlib: `pip install pontoon-bridge[plot]`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, List, Optional, Tuple

from ._errors import refused

if TYPE_CHECKING:
    from ._tables import Histories, Table


def _axes(ax: Any) -> Any:
    if ax is not None:
        return ax
    try:
        import matplotlib.pyplot as pyplot
    except ImportError as missing:
        raise ImportError("matplotlib is missing: pip install pontoon-bridge[plot]") from missing
    return pyplot.subplots(figsize=(8, 4.5), layout="constrained")[1]


def _number(cell: Any) -> str:
    return f"{cell:g}" if isinstance(cell, float) else str(cell)


def columns(table: Table, x: str, y: str, by: Optional[str], ax: Any) -> Any:
    """A column against another, a line for each value of a third."""
    lines: Dict[Any, List[Tuple[float, float]]] = {}
    groups = table[by] if by is not None else [None] * len(table)
    for group, at, value in zip(groups, table.numpy(x).tolist(), table.numpy(y).tolist()):
        lines.setdefault(group, []).append((at, value))
    ax = _axes(ax)
    for group, points in lines.items():
        points.sort(key=lambda point: point[0])
        label = None if by is None else f"{by} {_number(group)}"
        ax.plot([at for at, _ in points], [value for _, value in points], "o-", label=label)
    ax.set_xlabel(x)
    ax.set_ylabel(y)
    if by is not None:
        ax.legend()
    return ax


def _place(names: List[str], cells: Tuple[Any, ...]) -> str:
    """What a history is of, as its cells say it."""
    return ", ".join(f"{name} {cell}" for name, cell in zip(names, cells) if cell is not None)


def histories(table: Histories, quantity: str, ax: Any) -> Any:
    """A quantity of the histories against time, a line for each place and job."""
    same = ("time_s", "quantity", "value", *(["job"] if len(set(table["job"])) == 1 else []))
    told = [name for name in table.columns if name not in same]
    kinds, places = table["quantity"], [_place(told, cells) for cells in zip(*(table[name] for name in told))]
    times, values = table.numpy("time_s").tolist(), table.numpy("value").tolist()
    lines: Dict[Any, Tuple[List[float], List[float]]] = {}
    for kind, place, time, value in zip(kinds, places, times, values):
        if kind == quantity:
            line = lines.setdefault(place, ([], []))
            line[0].append(time)
            line[1].append(value)
    if not lines:
        raise refused("plot()", "quantity", repr(quantity), ", ".join(sorted(set(kinds))))
    ax = _axes(ax)
    for place, (at, value) in lines.items():
        ax.plot(at, value, label=place)
    ax.set_xlabel("time_s")
    ax.set_ylabel(quantity)
    ax.legend(ncols=2, fontsize="small")
    return ax
