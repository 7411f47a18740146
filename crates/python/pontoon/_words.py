"""Words of calls: those that a function does not know are refused with the nearest that it knows."""

from __future__ import annotations

import functools
import inspect
from typing import Any, Callable, TypeVar, cast

from . import _engine
from ._errors import refused

_F = TypeVar("_F", bound=Callable[..., Any])

#: Threads of a call at most.
_MOST_THREADS = 1024


def known_words(function: _F) -> _F:
    """Refuses keywords that a function does not have, in the engine's form."""
    words = [
        name
        for name, word in inspect.signature(function).parameters.items()
        if word.kind in (word.KEYWORD_ONLY, word.POSITIONAL_OR_KEYWORD) and name != "self"
    ]

    @functools.wraps(function)
    def checked(*places: Any, **named: Any) -> Any:
        for name in named:
            if name not in words:
                _engine.refuse_word(f"{function.__name__}()", name, name, words)
        return function(*places, **named)

    return cast(_F, checked)


def threads_of(call: str, threads: Any) -> int:
    """A number of threads, 0 for as many as the machine has."""
    if isinstance(threads, bool) or not isinstance(threads, int) or not 0 <= threads <= _MOST_THREADS:
        raise refused(call, "threads", repr(threads), f"a whole number from 0 to {_MOST_THREADS}")
    return threads
