# make demo    installs packages, builds the command line, takes a measurement to two textures (INPUT=file)
# make test    installs tools, builds with sanitizers and optimized, runs every test
# make check   takes a quick look: one build, unit tests, documents
# make python  installs the Python package into build/venv and tests it
# make build   builds the command line: build/release/apps/burnish/burnish
# make deb, make wheel, make sdist, make npm   make packages in build/packages
# make release         makes all packages, the sources and the page
# make release-check   installs each in an empty system and runs it, and builds and tests on bare systems
# make studio          builds the library as WebAssembly, its npm package and the page in build/studio
# make studio-test     tests them
# make site            builds all documents as a searchable site in build/site, beside the studio where build/studio is
# make cluster-test    runs a batch on a real Slurm of two nodes on this machine, killed now and then
# CONTRIBUTING.md describes make bench, compile-cost, fuzz, damaged, report, cost-report, sampling-report,
# area-light-report, shader-report, openpbr-report, frame-cost, surface-report, hw-report, hw-exhaustive and format.
.PHONY: check test-announcement cluster-test compile-cost demo test build reports python deb wheel sdist npm source-archive packaging-deps release release-check studio studio-test build-deps deps test-deps studio-deps bench fuzz damaged report cost-report sampling-report area-light-report shader-report openpbr-report frame-cost surface-report hw-report hw-exhaustive format format-check docs-check include-check api options site site-check
JOBS ?= $(shell nproc)
BURNISH := build/release/apps/burnish/burnish
SUDO := $(if $(filter 0,$(shell id -u)),,sudo)
SOURCES = $(shell find src apps tests examples python -name '*.h' -o -name '*.cpp')
# Warnings are errors in the preset dev and where this is ON, as in CI. Compilers of other systems have other warnings.
WERROR ?= OFF
# These options further configure the preset dev in `make test`.
DEV_OPTIONS ?=
INPUT ?=
OUT ?= out/demo
FUZZ_SECONDS ?= 60

# Each target installs Debian packages. build-deps is for the command line, deps also for the Python package, test-deps
# for everything else, and studio-deps for the library as WebAssembly.
build-deps: PACKAGES := cmake/debian-packages.txt
deps: PACKAGES := cmake/debian-packages.txt cmake/debian-python-packages.txt
test-deps: PACKAGES := cmake/debian-packages.txt cmake/debian-python-packages.txt cmake/debian-test-packages.txt
studio-deps: PACKAGES := cmake/debian-packages.txt cmake/debian-studio-packages.txt
build-deps deps test-deps studio-deps:
	@cmake/install_packages.sh $(PACKAGES)
	@[ $@ != deps ] || echo "Debian's packages for 'make build' and 'pip install .' are looked after; use pip in a venv."
build: build-deps
	@cmake --preset programs -DBURNISH_WERROR=$(WERROR) > /dev/null
	@cmake --build --preset programs -j $(JOBS)

reports: test-deps build
	@cmake --build --preset programs -j $(JOBS) --target all

# Prints the cost of compiling the command line without a compiler cache.
compile-cost: build-deps
	@rm -rf build/compile-cost && CCACHE_DISABLE=1 cmake --preset programs -B build/compile-cost > /dev/null
	@bash -c 'TIMEFORMAT="%U s + %S s of the system, %R s by the clock"; \
	  time cmake --build build/compile-cost -j $(JOBS) --target burnish_cli > /dev/null'

demo: build
	@examples/demo.sh "$(BURNISH)" "$(OUT)" "$(INPUT)"

# Takes a quick look before a commit: the optimized build once, unit tests except those with the label `long`, and
# documents. It checks formatting where this clang-format is.
CHECK_DEPS = cmake/debian-packages.txt cmake/debian-test-packages.txt
check: docs-check include-check
	@cmake/install_packages.sh $(CHECK_DEPS)
	@if clang-format --version 2> /dev/null | grep -q 'version 14\.'; then tests/format/clang_format.sh --check $(SOURCES); \
	else echo "formatting is not checked: that takes clang-format 14 (make format-check brings it)"; fi
	@cmake --preset release -DBURNISH_WERROR=$(WERROR) > /dev/null
	@cmake --build --preset release -j $(JOBS) --target burnish_tests
	@ctest --preset release -j $(JOBS) -R '^burnish_tests\.' -LE long

test-announcement:
	@mkdir -p build && date +%s > $(STARTED)
	@echo "Debian's packages are installed where they are missing (cmake/debian-*packages.txt),"
	@echo "others from PyPI and npm into build/ (python/requirements.txt, tests/web/package.json, clang-format)."

# Prints how long `make test` has run when a step ends.
STARTED := build/test-started
done = echo "make test: $(1), $$(($$(date +%s) - $$(cat $(STARTED)))) s after its start"
test: test-announcement test-deps format-check docs-check include-check
	@mpi=$$(command -v mpicxx > /dev/null && echo ON || echo OFF); \
	for preset in dev release; do \
	  case $$preset in release) options="-DBURNISH_MPI=$$mpi -DBURNISH_WERROR=$(WERROR)" ;; *) options="$(DEV_OPTIONS)" ;; esac; \
	  cmake --preset $$preset $$options > /dev/null && \
	  cmake --build --preset $$preset -j $(JOBS) && $(call done,built the preset $$preset) && \
	  ctest --preset $$preset -j $(JOBS) && $(call done,tested the preset $$preset) || exit 1; \
	  sed -n '/: Skipped$$/{n;p}' build/$$preset/Testing/Temporary/LastTest.log | sort | uniq -c | sed 's/^/skipped/'; \
	done
	@tests/web/check.sh --skip-offline > build/web.log 2>&1 & web=$$!; \
	BURNISH_WERROR=$(WERROR) python/check.sh --skip-offline; others=$$?; \
	wait $$web; web=$$?; cat build/web.log; exit $$((others || web))
	@$(call done,tested the Python package and pages)
	@tests/docs/site.sh --skip-offline --no-notebooks
	@tests/cluster/run.py $(BURNISH) --if-there
	@$(call done,passed)

python: test-deps build
	@BURNISH_WERROR=$(WERROR) python/check.sh

# These targets make packages for people without a compiler.
RELEASE := build/packages
PACKAGING := dpkg-dev file lintian debootstrap python3-venv
packaging-deps:
	@dpkg-query -W $(PACKAGING) > /dev/null 2>&1 || $(SUDO) apt-get install -y -qq --no-install-recommends $(PACKAGING) > /dev/null

deb: packaging-deps build
	@rm -rf $(RELEASE)/*.deb && cpack --config build/release/CPackConfig.cmake -B $(CURDIR)/$(RELEASE) > /dev/null
	@rm -rf $(RELEASE)/_CPack_Packages && ls $(RELEASE)/*.deb

# PYTHONS names the Pythons that make wheels. The default is python3, and a newer one where python3 is older than 3.12.
PYTHONS ?=
wheel: packaging-deps deps
	@BURNISH_WERROR=$(WERROR) python/wheel.sh $(RELEASE) $(PYTHONS)

sdist: packaging-deps
	@python/sdist.sh $(RELEASE)

npm: studio
	@mkdir -p $(RELEASE) && rm -f $(RELEASE)/*.tgz
	@npm pack --silent --pack-destination $(RELEASE) ./build/studio/package > /dev/null && ls $(RELEASE)/*.tgz

# A release is made of the commit that is checked out. Each of its files is named with the version.
VERSION := $(shell sed -n 's/^project.burnish VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
source-archive:
	@mkdir -p $(RELEASE)
	@git archive --prefix=burnish-$(VERSION)/ -o $(RELEASE)/burnish-$(VERSION)-source.tar.gz HEAD
	@ls $(RELEASE)/burnish-$(VERSION)-source.tar.gz

release:
	@tests/release/versions.sh
	@rm -rf $(RELEASE)
	@$(MAKE) -s deb wheel sdist npm source-archive
	@tar -C build/studio --transform 's,^\.,burnish-studio-$(VERSION),' -czf $(RELEASE)/burnish-studio-$(VERSION).tar.gz .
	@tests/notices/check.py $(RELEASE)/*.deb $(RELEASE)/*.whl $(RELEASE)/*.tgz $(RELEASE)/burnish-studio-*.tar.gz
	@tests/release/versions.sh $(RELEASE)
	@cd $(RELEASE) && sha256sum *burnish* > SHA256SUMS && cat SHA256SUMS

SYSTEMS ?= bookworm trixie
release-check: release
	@$(SUDO) env "PYTHONS=$(PYTHONS)" tests/release/check.sh $(RELEASE)
	@for suite in $(SYSTEMS); do $(SUDO) tests/systems/check.sh $$suite || exit 1; done

studio: studio-deps
	@cmake --preset wasm -DBURNISH_WERROR=$(WERROR) > /dev/null
	@cmake --build --preset wasm -j $(JOBS)
	@rm -rf build/studio && mkdir -p build/studio && cp -r web/studio/* build/wasm/package build/studio
	@cp build/studio/package/LICENSE build/studio/package/THIRD_PARTY_NOTICES build/studio/package/burnish.cdx.json build/studio

studio-test: studio test-deps
	@cmake --preset release -DBURNISH_WERROR=$(WERROR) > /dev/null
	@cmake --build --preset release -j $(JOBS) --target burnish_cli burnish_input_files burnish_mesh_frames
	@tests/web/package.sh
	@tests/web/check.sh

cluster-test: build
	@missing=$$(for p in slurmctld slurmd slurm-client munge; do \
	  dpkg-query -W -f '$${Status}' $$p 2>/dev/null | grep -q 'ok installed' || echo $$p; done); \
	[ -z "$$missing" ] || $(SUDO) apt-get install -y -qq --no-install-recommends $$missing > /dev/null
	@if command -v mpicxx > /dev/null; then \
	  cmake --preset programs -DBURNISH_MPI=ON > /dev/null && \
	  cmake --build --preset programs -j $(JOBS) --target burnish_mpi; fi
	@tests/cluster/run.py $(BURNISH)

bench: test-deps
	@cmake --preset bench > /dev/null
	@cmake --build --preset bench -j $(JOBS)
	@build/bench/src/burnish/burnish_bench

# Pages of docs/results are made by their names in burnish_reports. They state the last commit that changed the measured
# code.
MEASURED := src apps hw cmake
COMMIT = $(shell git log -1 --format=%h -- $(MEASURED))$(shell git diff --quiet HEAD -- $(MEASURED) || echo " and changes")
REPORTS := build/release/apps/reports/burnish_reports
report: NAMES := results accuracy measured cost
cost-report: NAMES := cost
sampling-report: NAMES := sampling
area-light-report: NAMES := area-lights
shader-report: NAMES := shaders
openpbr-report: NAMES := openpbr
frame-cost: NAMES := frame-cost
surface-report: NAMES := surfaces
report cost-report sampling-report area-light-report shader-report openpbr-report frame-cost surface-report: reports
	@export BURNISH_COMMIT="$(COMMIT)"; for name in $(NAMES); do $(REPORTS) $$name docs/results || exit 1; done

HW := build/hw-report
LIBRARIES := $(foreach ring,io eval,$(CURDIR)/build/release/src/burnish/libburnish_$(ring).a)
hw-report: test-deps reports
	@command -v nextpnr-ice40 > /dev/null || $(SUDO) apt-get install -y -qq --no-install-recommends nextpnr-ice40 > /dev/null
	@rm -rf $(HW) && mkdir -p $(HW) docs/figures docs/results
	@hw/verify.sh sphere $(CURDIR)/$(BURNISH) "$(LIBRARIES)" $(HW)/sphere $(CURDIR)/$(REPORTS) $(CURDIR)/docs/figures > $(HW)/sphere.txt
	@hw/synthesize.sh $(CURDIR)/$(BURNISH) $(HW)/synthesis > $(HW)/synthesis.txt
	@BURNISH_COMMIT="$(COMMIT)" hw/report.py $(BURNISH) $(HW)/synthesis.txt $(HW)/sphere.txt > $(HW)/hardware.md
	@mv $(HW)/hardware.md docs/results/hardware.md

hw-exhaustive: test-deps build
	@hw/verify.sh exhaustive $(CURDIR)/$(BURNISH) "$(LIBRARIES)" build/hw-exhaustive

fuzz: test-deps
	@JOBS=$(JOBS) tests/fuzz/run.sh $(FUZZ_SECONDS)

damaged: test-deps
	@cmake --preset release > /dev/null && cmake --build --preset release -j $(JOBS) --target burnish_cli make_seeds
	@build/release/tests/fuzz/make_seeds build/damaged/seeds
	@tests/fuzz/damaged.py $(BURNISH) build/damaged/seeds $(BURNISH_DATA)

format:
	@tests/format/clang_format.sh -i $(SOURCES)

format-check: test-deps
	@tests/format/clang_format.sh --check $(SOURCES)

docs-check:
	@tests/docs/check.py
	@tests/docs/comments.py --self-test
	@tests/docs/comments.py
	@docs/api.py --check
	@tests/notices/spdx.py

# Builds the site of docs/ with its own packages from PyPI. site-check looks for violations of axe's rules in a browser.
site:
	@tests/docs/site.sh

site-check: site
	@tests/docs/axe.sh build/site

include-check:
	@tests/includes/check.py
	@tests/includes/check.py --self-test

api:
	@docs/api.py

options: build
	@docs/options.py $(BURNISH)
