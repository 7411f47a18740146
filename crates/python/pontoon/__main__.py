"""The program: ``python -m pontoon run studies/fu2005``, or ``pontoon run studies/fu2005``."""

from __future__ import annotations

import sys
from typing import List

from . import _engine


def _again() -> List[str]:
    """The start of a command line that starts the program as a process of its own."""
    return [sys.executable, "-m", "pontoon"]


def main() -> None:
    """Runs the program with the words of this process's command line."""
    sys.exit(_engine.program(["pontoon", *sys.argv[1:]], _again()))


if __name__ == "__main__":
    main()
