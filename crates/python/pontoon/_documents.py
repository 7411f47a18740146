"""Values of Python as JSON, in which the engine reads them."""

from __future__ import annotations

import json
import os
from typing import Any, Dict, Mapping

from ._errors import refused


def plain(call: str, path: str, value: Any) -> Any:
    """A value as JSON has it: NumPy's numbers and arrays are numbers and lists."""
    if value is None or isinstance(value, (bool, str)):
        return value
    if isinstance(value, int):
        return int(value)
    if isinstance(value, float):
        number = float(value)
        if number != number or number in (float("inf"), float("-inf")):
            raise refused(call, path, str(number), "a finite number")
        return number
    if isinstance(value, Mapping):
        return {str(key): plain(call, f"{path}.{key}" if path else str(key), of) for key, of in value.items()}
    if isinstance(value, (list, tuple, range)):
        return [plain(call, f"{path}[{number}]", of) for number, of in enumerate(value)]
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    for method in ("tolist", "to_list"):
        # arrays and series of any library, and the numbers in them
        if hasattr(value, method):
            return plain(call, path, getattr(value, method)())
    document = getattr(value, "document", None)
    if isinstance(document, Mapping):
        return plain(call, path, document)
    raise refused(call, path, f"an object of type {type(value).__name__}", "a number, a text, a list or a dict")


def to_json(call: str, value: Any) -> str:
    """The text of a value."""
    return json.dumps(plain(call, "", value), allow_nan=False)


def merged(document: Mapping[str, Any], changes: Mapping[str, Any]) -> Dict[str, Any]:
    """A document with changes: dicts are merged key by key, all else is replaced; ``None`` takes a key away."""
    result = dict(document)
    for key, value in changes.items():
        before = result.get(key)
        if value is None:
            result.pop(key, None)
        elif isinstance(value, Mapping) and isinstance(before, Mapping):
            result[key] = merged(before, value)
        else:
            result[key] = value
    return result
