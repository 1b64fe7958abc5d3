"""The program: ``wirelessagent`` and ``python -m wirelessagent``.

Nothing is imported before :func:`main` runs, so that an interruption while loading is one line, too.
"""

from __future__ import annotations

import sys


def main() -> None:
    """Run the command line and exit."""
    try:
        from wirelessagent.interfaces.cli import run

        code = run(sys.argv[1:])
    except KeyboardInterrupt:
        print("wirelessagent: interrupted", file=sys.stderr)  # noqa: T201
        code = 130
    sys.exit(code)


if __name__ == "__main__":
    main()
