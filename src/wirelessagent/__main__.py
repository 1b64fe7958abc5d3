"""The program: ``wirelessagent`` and ``python -m wirelessagent``.

Nothing is imported before :func:`main` runs, so that an interruption while loading is one line, too.
"""

from __future__ import annotations

import signal
import sys


class _Interrupted(KeyboardInterrupt):
    """Ctrl-C. Python ends by the signal, whatever exit code we give, where a KeyboardInterrupt itself went through
    ``exec``, with which compilers are made."""


def _interrupt(*_: object) -> None:
    raise _Interrupted


def main() -> None:
    """Run the command line and exit."""
    try:
        if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            signal.signal(signal.SIGINT, _interrupt)
        from wirelessagent.interfaces.cli import run

        code = run(sys.argv[1:])
    except KeyboardInterrupt:
        print("wirelessagent: interrupted", file=sys.stderr)  # noqa: T201
        code = 130
    sys.exit(code)


if __name__ == "__main__":
    main()
