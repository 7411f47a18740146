"""How a bridge shows itself in a notebook."""

from __future__ import annotations

import html
from typing import TYPE_CHECKING, Any, Dict, List, Mapping

if TYPE_CHECKING:
    from ._bridges import Bridge

#: Numbers of a bridge that are shown, by their paths in its document.
_SHOWN = (
    "module.length_m",
    "module.breadth_m",
    "module.depth_m",
    "module.draft_m",
    "connectors.stiffness_n_m",
    "connectors.gap_tension_m",
    "connectors.gap_compression_m",
)


def _at(document: Mapping[str, Any], path: str) -> Any:
    value: Any = document
    for key in path.split("."):
        value = value.get(key) if isinstance(value, Mapping) else None
    return value


def bridge_html(bridge: Bridge) -> str:
    """A table of the bridge's main numbers, and its modules in a row."""
    document: Dict[str, Any] = bridge.document
    width, gap = 640 / bridge.modules, 2
    modules: List[str] = [
        f'<rect x="{number * width + gap / 2:.1f}" y="4" width="{width - gap:.1f}" height="16" rx="2" fill="#8fa3b5"/>'
        for number in range(bridge.modules)
    ]
    water = '<line x1="0" x2="640" y1="13" y2="13" stroke="#2b6cb0" stroke-dasharray="4 3"/>'
    picture = f'<svg viewBox="0 0 640 24" width="640" role="img">{"".join(modules)}{water}</svg>'
    told = [("modules", bridge.modules), ("length_m", bridge.length_m)]
    told += [(path, _at(document, path)) for path in _SHOWN if _at(document, path) is not None]
    rows = "".join(f"<tr><td>{html.escape(name)}</td><td>{html.escape(str(value))}</td></tr>" for name, value in told)
    return f"<p><b>{html.escape(str(document.get('name', 'bridge')))}</b></p>{picture}<table>{rows}</table>"
