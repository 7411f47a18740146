"""What can go wrong, as exceptions."""

from __future__ import annotations

from typing import Optional, Tuple

_Place = Tuple[int, int]


class InputError(ValueError):
    """An input that was refused; its text is the program's own.

    >>> import pontoon as pt
    >>> try:
    ...     pt.Bridge("studies/bridges/smoke.json").with_(connectors={"gap_tensoin_m": 0.02})
    ... except pt.InputError as error:
    ...     print(error.path, error.nearest)
    connectors.gap_tensoin_m gap_tension_m
    """

    #: The file, or the call that stands for it.
    file: Optional[str]
    #: Path of the key in the file, ``design[0].grid.speed_m_s``; empty where the whole file is meant.
    path: str
    #: What is wrong, as a word: ``missing``, ``unknown_key``, ``not_allowed``.
    kind: Optional[str]
    #: What was found.
    found: Optional[str]
    #: What is allowed.
    allowed: Optional[str]
    #: The nearest known name.
    nearest: Optional[str]
    #: Line and column of the beginning and behind the end in the file, counted from 1.
    span: Optional[Tuple[_Place, _Place]]

    def __init__(
        self,
        message: str,
        *,
        file: Optional[str] = None,
        path: str = "",
        kind: Optional[str] = None,
        found: Optional[str] = None,
        allowed: Optional[str] = None,
        nearest: Optional[str] = None,
        span: Optional[Tuple[_Place, _Place]] = None,
    ) -> None:
        super().__init__(message)
        self.file = file
        self.path = path
        self.kind = kind
        self.found = found
        self.allowed = allowed
        self.nearest = nearest
        self.span = span

    def __reduce__(self):  # type: ignore[no-untyped-def]
        return (_again, (str(self), self.__dict__.copy()))


def _again(message: str, told: dict) -> InputError:  # type: ignore[type-arg]
    error = InputError(message)
    error.__dict__.update(told)
    return error


class EngineError(RuntimeError):
    """What went wrong that no input is to blame for: a file that cannot be written, damaged results.

    >>> import pontoon as pt, tempfile, os
    >>> study = pt.run("studies/smoke", out=tempfile.mkdtemp(), fresh=True)
    >>> with open(os.path.join(study.folder, "jobs.parquet"), "ab") as file:
    ...     _ = file.write(b"more")
    >>> try:
    ...     study.jobs
    ... except pt.EngineError as error:
    ...     print("damaged results" in str(error))
    True
    """


def refused(call: str, path: str, found: str, allowed: str) -> InputError:
    """The refusal of an argument of a call, in the form that the engine's have."""
    text = f"{call}: {path}: found {found}, allowed: {allowed}"
    return InputError(text, file=call, path=path, kind="not_allowed", found=found, allowed=allowed)
