# What a contributor runs; `make` alone lists it. Every target does the set-up it needs, in .venv,
# from nothing but Python 3.11 or newer, a C and a C++ compiler and make.

PYTHON ?= $(shell for python in python3 python3.14 python3.13 python3.12 python3.11; do \
	$$python -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null \
	&& echo $$python && break; done)
# Sanitized builds of the core: ON, OFF, or AUTO for where the compiler can link them.
SANITIZERS ?= AUTO
PYTEST_ARGS ?= -n 2
JOBS ?= 2

# Make's own default for CXX is one vendor's; c++ is what goes with cc.
ifeq ($(origin CXX),default)
CXX := c++
endif

bin := .venv/bin
installed := .venv/.installed
installed_dev := .venv/.installed-dev
# How long `make fuzz` runs, and its first seed.
FUZZ_SECONDS ?= 60
FUZZ_SEED ?= 1
# How long `make soak` runs.
SOAK_SECONDS ?= 600
core_build := build/core-tests/$(notdir $(CC))
built_from := pyproject.toml CMakeLists.txt core/SOURCES \
	$(shell find core/include core/src engine)

# Threaded BLAS is a hundred times slower as soon as another process wants the core.
export OPENBLAS_NUM_THREADS := 1
export OMP_NUM_THREADS := 1
export MKL_NUM_THREADS := 1
export CC CXX

.DEFAULT_GOAL := help
.PHONY: help venv install demo docs wheel test core-test fuzz soak embedded embedded-table misra lint \
	types bench bench-peers clean distclean

help: ## list the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-14s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

venv: $(bin)/python ## create the virtual environment

install: $(installed_dev) ## install hyst and all development tools; again after a change of C or C++

demo: $(installed) ## the whole story on a simulated stage; results in demo/
	$(bin)/hyst demo -o demo --force

docs: $(installed_dev) ## the documentation site, build/site/index.html; runs its notebooks
	NO_MKDOCS_2_WARNING=1 $(bin)/mkdocs build --quiet
	$(bin)/python docs/make_notebooks.py --run

wheel: $(installed_dev) ## source distribution and wheel into dist/, tried in a fresh environment
	rm -rf dist build/wheel
	CMAKE_BUILD_PARALLEL_LEVEL=$(JOBS) PATH="$(abspath $(bin)):$$PATH" \
		$(bin)/python -m build --no-isolation --outdir build/wheel
	@mkdir -p dist
	cp build/wheel/*.tar.gz dist
	if [ "$$(uname)" = Linux ]; then PATH="$(abspath $(bin)):$$PATH" \
		$(bin)/auditwheel repair --wheel-dir dist build/wheel/*.whl; \
	else cp build/wheel/*.whl dist; fi
	$(bin)/python -m venv build/wheel/fresh
	build/wheel/fresh/bin/python -m pip install --quiet --disable-pip-version-check dist/*.whl
	build/wheel/fresh/bin/python tests/installed/smoke.py examples/stage.csv

test: core-test ## C tests of the core, then pytest, what needs a browser last and by itself
	$(bin)/python -m pytest $(PYTEST_ARGS) -m "not browser"
	$(bin)/python -m pytest -m browser tests/studio tests/report/test_page_in_browser.py

core-test: $(installed_dev) ## C tests of the core: double and float, plain and sanitized
	@$(bin)/cmake -S . -B $(core_build) -G Ninja --log-level=WARNING \
		-DCMAKE_MAKE_PROGRAM=$(abspath $(bin)/ninja) \
		-DHYST_CORE_TESTS=ON -DHYST_SANITIZERS=$(SANITIZERS)
	@$(bin)/cmake --build $(core_build) --parallel $(JOBS) -- --quiet
	@$(bin)/ctest --test-dir $(core_build) --output-on-failure --parallel $(JOBS) \
		--quiet --output-log $(core_build)/ctest.log || { cat $(core_build)/ctest.log; exit 1; }
	@grep 'tests passed' $(core_build)/ctest.log

fuzz: build/fuzz/engines ## random bytes through every engine against the core's loop, sanitized
	build/fuzz/engines $(FUZZ_SECONDS) $(FUZZ_SEED)

soak: $(installed_dev) ## hyst watch on lines with faults among them: its memory stays bounded
	$(bin)/python -m benchmarks watch --soak $(SOAK_SECONDS)

embedded: $(installed_dev) ## exported models on emulated Cortex-M4F and M7: numbers and costs
	PYTHONPATH=tests $(bin)/python -m embedded --jobs $(JOBS)

embedded-table: $(installed_dev) ## the same, and write the table of docs/embedded.md
	PYTHONPATH=tests $(bin)/python -m embedded --jobs $(JOBS) --write

misra: $(installed_dev) ## cppcheck's MISRA C:2012 report on the core against docs/misra.md
	PYTHONPATH=tests $(bin)/python -m embedded.misra

lint: $(installed_dev) ## style, formatting and import direction
	$(bin)/ruff check
	$(bin)/ruff format --check
	$(bin)/lint-imports

types: $(installed_dev) ## strict type check
	$(bin)/mypy

bench: $(installed_dev) ## timings and accuracy against peers, and what got worse since recorded
	$(bin)/python -m benchmarks

bench-peers: $(installed_dev) ## the versions of the peers that ratios are recorded against
	$(bin)/python -m pip install --quiet --disable-pip-version-check -r benchmarks/peers.txt

clean: ## remove everything built, but not .venv
	rm -rf build dist demo .mypy_cache .ruff_cache .pytest_cache .hypothesis .import_linter_cache
	find src tests benchmarks -name __pycache__ -type d -prune -exec rm -rf {} +

distclean: clean ## remove .venv too
	rm -rf .venv

$(bin)/python:
	@test -n "$(PYTHON)" || { echo "hyst needs Python 3.11 or newer and found none;" \
		"install one, or name it: make PYTHON=/path/to/python" >&2; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { \
		echo "hyst needs Python 3.11 or newer, and $(PYTHON) is not;" \
		"name another: make PYTHON=python3.12" >&2; exit 1; }
	@$(PYTHON) -m venv .venv || { rm -rf .venv; echo "$(PYTHON) cannot make virtual environments;" \
		"install its venv module (python3-venv on Debian and Ubuntu)" >&2; exit 1; }

define demand_compilers
@for compiler in $(CC) $(CXX); do command -v $$compiler >/dev/null || { \
		echo "hyst needs a C and a C++ compiler, and there is no $$compiler;" \
		"install one, or name it: make CC=gcc CXX=g++" >&2; exit 1; }; done
endef

build/fuzz/engines: core/SOURCES $(shell find core/include core/src engine)
	sh engine/fuzz/build.sh $(@D)

# pip fetches what builds the package (scikit-build-core, nanobind and, where the machine has none,
# cmake and ninja) into an environment of its own.
$(installed): $(built_from) | $(bin)/python
	$(demand_compilers)
	$(bin)/python -m pip install --quiet --disable-pip-version-check --editable '.[all]'
	@touch $@

$(installed_dev): $(built_from) | $(bin)/python
	$(demand_compilers)
	$(bin)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev]'
	@touch $(installed) $@
