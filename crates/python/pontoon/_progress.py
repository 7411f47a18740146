"""Progress of a call: a bar by tqdm where it is installed, else a line on a terminal."""

from __future__ import annotations

import sys
import time
from typing import Any, Optional

#: Seconds that a call may take before anything is shown, and between two lines.
_QUIET_S = 0.5


def _shows() -> bool:
    """Whether somebody looks: a terminal or a notebook."""
    if sys.stderr is not None and sys.stderr.isatty():
        return True
    shell = sys.modules.get("IPython")
    return bool(shell and getattr(shell.get_ipython(), "kernel", None))


class Progress:
    """Is told of a call by the engine; used as ``with Progress(shown) as told``."""

    def __init__(self, shown: Optional[bool]) -> None:
        self._shown = _shows() if shown is None else shown
        self._last = time.monotonic()
        self._text = ""
        self._bar: Any = None
        self._line = False

    def __enter__(self) -> Optional[Progress]:
        return self if self._shown else None

    def __call__(self, stage: str, done: int, failed: int, total: int) -> None:
        now, text = time.monotonic(), stage if total == 0 else f"{done}/{total} jobs, {failed} failed"
        if now - self._last < _QUIET_S or text == self._text:
            return
        self._last, self._text = now, text
        if self._bar is None and not self._line:
            try:
                from tqdm.auto import tqdm
            except ImportError:
                self._line = True
            else:
                self._bar = tqdm(total=total or None, unit="job", leave=False)
        if self._bar is not None:
            self._bar.total = total or None
            self._bar.set_description(stage if total == 0 else "", refresh=False)
            if failed:
                self._bar.set_postfix(failed=failed, refresh=False)
            self._bar.update(done - self._bar.n)
        elif sys.stderr is not None:
            sys.stderr.write(f"\r{text:<60}")
            sys.stderr.flush()

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()
        if self._line and sys.stderr is not None:
            sys.stderr.write("\r" + " " * 60 + "\r")
            sys.stderr.flush()
