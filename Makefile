# Everything here bootstraps itself: a system Python 3.11+ with pip is enough.

UV_VERSION := 0.13.8
PYTHON ?= python3
# uv from the path if there is one, else a copy of our own.
UV := $(shell command -v uv 2>/dev/null || echo .tools/uv/bin/uv)
# One worker more than there are cores: a test that waits for a server leaves its core to another.
WORKERS := $(shell echo $$(($$(getconf _NPROCESSORS_ONLN) + 1)))
RUN := $(UV) run --frozen --extra plot --extra evaluate --extra llm --extra serve --extra postgres

export UV_COMPILE_BYTECODE ?= 1

.PHONY: demo serve browser test check quick bars lint code bench docs format clean

demo: $(UV)  ## run the chain on measured and on simulated channels and leave the pictures in demo/
	$(UV) sync --frozen --quiet --inexact --no-default-groups --extra plot
	mkdir -p demo
	.venv/bin/wirelessagent ask "Save power for sensors, 4 Mbit/s each" \
		--csi examples/data/measured_wifi.npz --loss random:0.2 --plot demo/measured.png
	.venv/bin/wirelessagent ask "Higher speed for video streaming" --plot demo/simulated.png

serve: $(UV)  ## open the console on a demonstration cell
	$(UV) sync --frozen --quiet --inexact --no-default-groups --extra plot --extra serve
	.venv/bin/wirelessagent serve --open

# Debian's Chromium, for the tests that look at the console; they are skipped where it cannot be had.
browser:
	@command -v chromium >/dev/null || { [ "$$(id -u)" = 0 ] && apt-get install -qq -y chromium >/dev/null; } || \
		echo "no Chromium here: the console is not looked at"

test: $(UV) browser  ## all that CI needs: lint and types beside compiling, all tests, the third-party example
	$(UV) sync --locked --quiet --extra plot --extra evaluate --extra llm --extra serve --extra postgres
	$(MAKE) --no-print-directory -j2 lint code
	$(RUN) pytest -n $(WORKERS) --dist worksteal
	$(UV) pip install --quiet --no-deps --target build/third_party ./examples/third_party_objective
	WIRELESSAGENT_COMPILE=never PYTHONPATH=build/third_party $(RUN) pytest examples/third_party_objective/tests

check: $(UV)  ## lint, types, and the tests that need no machine code
	$(UV) sync --locked --quiet --extra plot --extra evaluate --extra llm --extra serve --extra postgres
	$(MAKE) --no-print-directory -j2 lint quick

quick:
	$(RUN) pytest -m "not machine_code" tests/interfaces

bars: $(UV) code  ## the full counts behind the figures in the documentation; hours on two cores
	$(RUN) python benchmarks/bars_interpreted.py
	$(RUN) python benchmarks/bars_files.py
	$(RUN) python benchmarks/bars_history.py
	$(RUN) python benchmarks/bars_deadline.py
	$(RUN) python benchmarks/bars_exact.py
	$(RUN) python benchmarks/bars_decide.py
	$(RUN) python benchmarks/bars_promises.py
	$(RUN) python benchmarks/bars_intents.py
	$(RUN) python benchmarks/bars_composed.py
	$(RUN) python benchmarks/bars_service.py
	$(RUN) python benchmarks/bars_documents.py

lint: $(UV)
	$(UV) sync --locked --quiet --extra plot --extra evaluate --extra llm --extra serve --extra postgres
	$(RUN) ruff format --check .
	$(RUN) ruff check .
	$(RUN) lint-imports
	$(RUN) pyright

code: $(UV)  ## compile all kernels, once for all tests
	$(RUN) wirelessagent warm-up --json

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
