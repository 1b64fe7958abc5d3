"""``python -m wirelessagent``."""

from wirelessagent.interfaces.cli import main

main()
