"""Both documents of the service held against it by schemathesis, with many examples an operation.

    python benchmarks/bars_documents.py [--examples 500]

The checks that are off are named where the tests of a sample name them (``tests/service``).
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent / "tests" / "support"))

from examining import examined
from servers import started, token_for

RUNS = (
    ("openapi.json", "positive_data_acceptance", "coverage,fuzzing", "all"),
    ("plugin/openapi.json", "ignored_auth,negative_data_rejection,unsupported_method", "fuzzing", "all"),
    ("plugin/openapi.json", "ignored_auth,negative_data_rejection,unsupported_method", "coverage", "positive"),
)


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("--examples", type=int, default=500)
    examples = parser.parse_args().examples
    failed = 0
    for document, off, phases, mode in RUNS:
        with tempfile.TemporaryDirectory() as folder:
            store = Path(folder) / "a.db"
            token = token_for(store, "platform", "operator")
            with started(store, "--requests-per-s", "1000000") as server:
                found = examined(server.url, document, most=examples, off=off, phases=phases, mode=mode, token=token)
        failed += found.returncode != 0
        print(f"\n{document} ({phases}; off: {off}): {'failed' if found.returncode else 'as documented'}")
        print("\n".join(found.stdout.splitlines()[-40:] if found.returncode else found.stdout.splitlines()[-5:]))
    return failed


if __name__ == "__main__":
    sys.exit(main())
