# Everything here bootstraps itself: a system Python 3.11+ with pip is enough.

UV_VERSION := 0.13.8
PYTHON ?= python3
# uv from the path if there is one, else a copy of our own.
UV := $(shell command -v uv 2>/dev/null || echo .tools/uv/bin/uv)
RUN := $(UV) run --frozen --extra plot --extra evaluate --extra llm

export UV_COMPILE_BYTECODE ?= 1

.PHONY: demo test lint bench docs format clean

demo: $(UV)  ## run the chain on measured and on simulated channels and leave the pictures in demo/
	$(UV) sync --frozen --quiet --inexact --no-default-groups --extra plot
	mkdir -p demo
	.venv/bin/wirelessagent ask "Save power for sensors, 4 Mbit/s each" \
		--csi examples/data/measured_wifi.npz --loss random:0.2 --plot demo/measured.png
	.venv/bin/wirelessagent ask "Higher speed for video streaming" --plot demo/simulated.png

test: lint  ## lint, types, import contract, all tests, the third-party example
	$(RUN) pytest -n auto --dist worksteal
	$(UV) pip install --quiet --no-deps --target build/third_party ./examples/third_party_objective
	PYTHONPATH=build/third_party $(RUN) pytest examples/third_party_objective/tests

lint: $(UV)
	$(UV) sync --locked --quiet --extra plot --extra evaluate --extra llm
	$(RUN) ruff format --check .
	$(RUN) ruff check .
	$(RUN) pyright
	$(RUN) lint-imports

bench: $(UV)  ## benchmarks against NumPy and cvxpy in the same run
	$(RUN) --group bench pytest benchmarks --benchmark-only
	$(RUN) --group bench python benchmarks/bench_decide.py

docs: $(UV)  ## build the documentation into site/
	$(RUN) --group docs zensical build

format: $(UV)
	$(RUN) ruff format .
	$(RUN) ruff check --fix .

clean:
	rm -rf .venv .tools build demo site reproduced

.tools/uv/bin/uv:
	$(PYTHON) -m pip install --quiet --disable-pip-version-check --root-user-action=ignore --target .tools/uv "uv==$(UV_VERSION)"
