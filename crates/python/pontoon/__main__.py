"""The program: ``python -m pontoon run studies/fu2005``, or ``pontoon run studies/fu2005``."""

from __future__ import annotations

import signal
import sys

from . import _engine
from ._studies import again


def main() -> None:
    """Runs the program with the words of this process's command line."""
    # an interrupt is the program's, which answers it or ends: Python's own handler would wait for the program's end
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_engine.program(["pontoon", *sys.argv[1:]], again()))


if __name__ == "__main__":
    main()
