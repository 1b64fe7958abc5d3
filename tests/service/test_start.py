"""What a server is before anybody asks it anything: small."""

from __future__ import annotations

import socket
import subprocess
import sys

from wirelessagent.interfaces.serving import listening_on

HEAVY = ("numpy", "scipy", "numba", "matplotlib", "mcp", "h5py", "wirelessagent.operations.hosted")


def test_the_servers_own_process_loads_nothing_to_compute_with() -> None:
    """Its workers do; a first screen has nothing to wait for, and hostile files never touch it."""
    code = (
        "import sys, wirelessagent.interfaces.serving, wirelessagent.interfaces.http.app, "
        "wirelessagent.service.opening; print(*(set(sys.modules) & set(sys.argv[1:])))"
    )
    done = subprocess.run([sys.executable, "-c", code, *HEAVY], capture_output=True, text=True, check=True)
    assert done.stdout.split() == []


def test_short_answers_do_not_wait_for_an_acknowledgement() -> None:
    with listening_on("127.0.0.1", 0) as listening, socket.create_connection(listening.getsockname()):
        accepted, _ = listening.accept()
        with accepted:
            assert accepted.proto == socket.IPPROTO_TCP, "else asyncio sets no TCP_NODELAY"
