"""schemathesis on a running server: what a document says is sent, and every answer is held against it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path


def examined(
    url: str,
    document: str,
    *,
    most: int,
    off: str,
    token: str = "",
    phases: str = "coverage,fuzzing",
    mode: str = "all",
) -> subprocess.CompletedProcess[str]:
    """What it says of a server by one of its documents, with so many examples an operation, some checks being off."""
    program = Path(sys.executable).parent / "schemathesis"
    signed = ["--header", f"Authorization: Bearer {token}"] if token else []
    return subprocess.run(
        [program, "run", f"{url}{document}", "--max-examples", str(most), "--phases", phases, "--mode", mode,
         "--exclude-checks", off, "--exclude-path-regex", "/events$", "--seed", "1", "--request-timeout", "60",
         *signed],
        capture_output=True, text=True, check=False, timeout=3600,
    )  # fmt: skip
