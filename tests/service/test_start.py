"""What a server is before anybody asks it anything: small."""

from __future__ import annotations

import subprocess
import sys

HEAVY = ("numpy", "scipy", "numba", "matplotlib", "mcp", "h5py", "wirelessagent.operations.hosted")


def test_the_servers_own_process_loads_nothing_to_compute_with() -> None:
    """Its workers do; a first screen has nothing to wait for, and hostile files never touch it."""
    code = (
        "import sys, wirelessagent.interfaces.serving, wirelessagent.interfaces.http.app, "
        "wirelessagent.service.opening; print(*(set(sys.modules) & set(sys.argv[1:])))"
    )
    done = subprocess.run([sys.executable, "-c", code, *HEAVY], capture_output=True, text=True, check=True)
    assert done.stdout.split() == []
