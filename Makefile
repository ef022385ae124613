# Everything runs in .venv, which "setup" makes; see CONTRIBUTING.md.
BIN := .venv/bin
LOCKBIN := .venv-lock/bin

.DEFAULT_GOAL := help
.PHONY: help setup demo test test-rest test-all test-browser test-peers test-portable calculix \
	coverage mutants check types bench evidence docs wheel lock clean

help: ## list the targets
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' Makefile | expand -t 12

setup: .venv/.ready ## make .venv with everything pinstress needs (run by the targets that need it)

.venv/.ready: requirements.lock pyproject.toml scripts/setup.sh
	@sh scripts/setup.sh

PORTABLE = tests/pinbase/processes/test_workers.py \
	$(addprefix tests/pinstress/,cli/test_output.py study/model/test_read_body.py test_import.py) \
	$(addprefix tests/fea/core/test_,linear.py memory.py) tests/loads/tables/test_regular_file.py

# Status 1 means: done, but a requested accuracy was not reached (printed last).
demo: setup ## run studies/landing_gear.toml and print the path of its report
	@status=0; PINSTRESS_CACHE=build/cache $(BIN)/pinstress run studies/landing_gear.toml || status=$$?; \
	if [ $$status -gt 1 ]; then exit $$status; fi

# Compiled modules are kept, or every process would compile all it imports again.
unexport PYTHONDONTWRITEBYTECODE
# What remains of a file goes to a worker without work, so what its tests share is solved about once.
PYTEST = $(BIN)/python -m pytest -n auto --dist worksteal
# The files with tests of a mark: to import all others takes as long as some of these tests.
marked = $(shell grep -rl 'mark\.$(1)\b' tests --include='*.py')
# Those with tests that take more than a second (tests/seconds.py).
listed = $(shell sed 's/::.*//' tests/seconds.txt)
# After a mark of the targets below: "or long" takes the long tests, too.
WITH =

test: setup ## run the quick tests; ARGS="..." goes to pytest
	$(PYTEST) -m "not slow and not seconds" $(ARGS)

# In one run files are imported once, what they share is solved once, and workers wait once at the end.
test-rest: calculix ## run all others but browser and long ones: those of seconds, slow ones, with CalculiX
	$(PYTEST) -m "seconds or slow or peers" $(sort $(call marked,slow) $(call marked,peers) $(listed)) $(ARGS)

test-all: setup ## run all tests, also the long ones that CI leaves out
	$(PYTEST) -m "long or not long" $(ARGS)
	@$(MAKE) --no-print-directory test-browser test-peers WITH="or long"

test-browser: setup ## run the tests of the report in Chromium, which root gets installed
	@sh scripts/tools.sh test-browser "Chromium or its driver" "chromium chromium-driver" \
		chromium chromedriver
	$(PYTEST) --dist loadfile -m "browser $(WITH)" tests/browser $(ARGS)

calculix: setup
	@sh scripts/tools.sh test-peers CalculiX calculix-ccx ccx

test-peers: calculix ## run the comparisons with CalculiX, which root gets installed
	$(PYTEST) -m "peers $(WITH)" $(call marked,peers) $(ARGS)

test-portable: setup ## run quick tests without what Linux alone has, as on Windows and macOS
	PINSTRESS_PORTABLE=1 $(PYTEST) -m "not slow" $(PORTABLE) $(ARGS)

coverage: setup ## branches of loads, geometry, fea that their own quick tests do not take; fails below 95 %
	@for room in loads geometry fea; do $(BIN)/python -m pytest -q -m "not slow and not peers" --cov=$$room \
	--cov-branch --cov-fail-under=95 --cov-report=term-missing:skip-covered tests/$$room $(ARGS) || exit 1; done

mutants: setup ## changes in files of formulas that no test notices (about an hour; ARGS="--most=10")
	$(BIN)/python -m benchmarks.mutants --record $(ARGS)

check: setup ## lint, format check, types, import contracts, strict docs build
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/lint-imports --no-logo
	@$(MAKE) --no-print-directory --jobs 2 --output-sync types docs

types: setup ## check types
	$(BIN)/mypy

bench: setup ## run all benchmarks and write their tables into docs/measured (about 17 minutes)
	$(BIN)/pip install --quiet --require-hashes -r requirements-bench.lock
	$(BIN)/python -m benchmarks --record

evidence: setup ## predict tests and printed examples, and write docs/evidence.md (about five minutes)
	$(BIN)/python -m benchmarks.evidence

docs: setup ## build the documentation into build/docs; a warning is an error
	$(BIN)/sphinx-build --quiet --nitpicky --fail-on-warning --keep-going -b html docs build/docs

wheel: setup ## build the wheel into dist/
	$(BIN)/python -m hatchling build -t wheel -d dist

COMPILE = $(LOCKBIN)/uv pip compile --quiet --universal --python-version 3.11 --fork-strategy fewest \
	--generate-hashes --no-emit-index-url --no-annotate --custom-compile-command "make lock" $(LOCKFLAGS)

# The second file has the additional packages of the benchmarks, in versions compatible with the first.
lock: ## bring the lock files up to pyproject.toml; LOCKFLAGS=--upgrade takes the newest of all
	@test -x $(LOCKBIN)/uv || { python3 -m venv .venv-lock && $(LOCKBIN)/pip install --quiet uv; }
	$(COMPILE) --extra cluster --extra fatigue --extra pdf --extra dev \
		--output-file requirements.lock pyproject.toml
	$(COMPILE) --extra bench --constraint requirements.lock --output-file requirements-bench.lock \
		pyproject.toml

clean: ## remove .venv, caches and built documents; results in out/ stay
	rm -rf .venv .venv-lock build dist .mypy_cache .pytest_cache .ruff_cache .import_linter_cache \
		.hypothesis .coverage htmlcov
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
