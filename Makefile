# Everything from nothing: `make run` does the main job, `make test` checks all,
# `make verify` compares with references for minutes, `make bench` measures time and memory,
# `make wheel` builds the package and tries it in an empty environment.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/.ready
BUILT := $(VENV)/.built
FAST := $(addprefix tests/,core/test_layout.py core/test_units.py core/test_errors.py surface rubber/test_shift.py theory)
# cargo fmt does not follow modules that a macro declares.
RUST := $(shell find rust -name '*.rs')
SOURCES := Cargo.toml Cargo.lock pyproject.toml $(RUST)

# Runs a command without a word of its own; all it prints is shown if it fails.
quietly = $(1) > $(VENV)/setup.log 2>&1 || { cat $(VENV)/setup.log; exit 1; }

.PHONY: run build test quick verify docs bench wheel clean
.DEFAULT_GOAL := run

run: build
	@$(BIN)/gripscale run examples/road_and_tread/case.toml --output results/road_and_tread --figures

build: $(BUILT)

# One BLAS kernel for all x86 machines, and one thread: sums in the same order, for the numbers that tests keep.
test: export OPENBLAS_CORETYPE := Haswell
test: export OPENBLAS_NUM_THREADS := 1
test: build
	rustfmt --check --edition 2021 $(RUST)
	cargo clippy --locked --features internals --all-targets -- -D warnings
	cargo clippy --locked --features python -- -D warnings
	cargo test --locked
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/python -m mypy.stubtest gripscale._kernel
	PYTHONDONTWRITEBYTECODE= $(BIN)/python -m pytest -q -n logical --maxprocesses 4 --dist worksteal

# What a person runs while working, within a minute: style, types, and fast tests or those of PART.
quick: build
	rustfmt --check --edition 2021 $(RUST)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/python -m pytest -q -n logical --maxprocesses 4 $(if $(PART),$(PART),$(FAST))

verify: build
	$(BIN)/python -m pytest -q -m verification

# The notebooks run for a minute or two; without GRIPSCALE_NOTEBOOKS their pages have no outputs.
docs: build
	GRIPSCALE_NOTEBOOKS=1 NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --strict

bench: build
	$(BIN)/python -m benchmarks

wheel: $(READY)
	rm -rf results/wheel
	$(BIN)/maturin build --release --locked --quiet --out results/wheel
	$(BIN)/python -m benchmarks.wheel results/wheel

$(READY): requirements.lock
	@$(PYTHON) -c 'import sys; assert sys.version_info >= (3, 11), "gripscale needs Python 3.11 or newer; set PYTHON=..."'
	@echo "setting up the environment (a minute)"
	@$(PYTHON) -m venv $(VENV)
	@$(call quietly,$(BIN)/pip install --disable-pip-version-check -r requirements.lock)
	@touch $@

$(BUILT): $(READY) $(SOURCES)
	@echo "compiling the kernel (a few minutes the first time)"
	@$(call quietly,$(BIN)/maturin develop --release --locked)
	@touch $@

clean:
	rm -rf $(VENV) target results
