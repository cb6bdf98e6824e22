# make demo   installs packages, builds, and takes a measurement to two textures (INPUT=file for your own)
# make test   installs packages, builds with sanitizers and optimized, runs every test
# make python the Python package in build/venv, tested
# make build  the command line at build/release/apps/burnish/burnish
# make bench, make fuzz, make report, make sampling-report, make shader-report, make frame-cost, make hw-report, make hw-exhaustive, make format:
# see CONTRIBUTING.md
.PHONY: demo test build python deps bench fuzz report sampling-report shader-report frame-cost hw-report hw-exhaustive format format-check docs-check
JOBS ?= $(shell nproc)
BURNISH := build/release/apps/burnish/burnish
SUDO := $(if $(filter 0,$(shell id -u)),,sudo)
SOURCES = $(shell find src apps tests examples python -name '*.h' -o -name '*.cpp')
INPUT ?=
OUT ?= out/demo
FUZZ_SECONDS ?= 60

deps:
	@missing=$$(for p in $$(grep -v '^#' cmake/debian-packages.txt); do \
	  dpkg-query -W -f '$${Status}' $$p 2>/dev/null | grep -q 'ok installed' || echo $$p; done); \
	if [ -n "$$missing" ]; then \
	  echo "Installing: $$missing"; \
	  export DEBIAN_FRONTEND=noninteractive; \
	  $(SUDO) apt-get update -qq && $(SUDO) apt-get install -y -qq --no-install-recommends $$missing > /dev/null || \
	  for p in $$missing; do \
	    $(SUDO) apt-get install -y -qq --no-install-recommends $$p > /dev/null || echo "Not available here: $$p"; \
	  done; \
	fi

build: deps
	@cmake --preset release > /dev/null
	@cmake --build --preset release -j $(JOBS)

demo: build
	@examples/demo.sh "$(BURNISH)" "$(OUT)" "$(INPUT)"

test: deps format-check docs-check
	@for preset in dev release; do \
	  cmake --preset $$preset > /dev/null && \
	  cmake --build --preset $$preset -j $(JOBS) && \
	  ctest --preset $$preset -j $(JOBS) || exit 1; \
	  sed -n '/: Skipped$$/{n;p}' build/$$preset/Testing/Temporary/LastTest.log | sort | uniq -c | sed 's/^/skipped/'; \
	done
	@python/check.sh --skip-offline
	@tests/web/check.sh --skip-offline

python: build
	@python/check.sh

bench: deps
	@cmake --preset bench > /dev/null
	@cmake --build --preset bench -j $(JOBS)
	@build/bench/src/burnish/burnish_bench

# Pages of docs/results, by what burnish_reports calls them.
REPORTS := build/release/apps/reports/burnish_reports
report: NAMES := results accuracy
sampling-report: NAMES := sampling
shader-report: NAMES := shaders
frame-cost: NAMES := frame-cost
report sampling-report shader-report frame-cost: build
	@for name in $(NAMES); do $(REPORTS) $$name docs/results || exit 1; done

HW := build/hw-report
LIBRARY := $(CURDIR)/build/release/src/burnish/libburnish.a
hw-report: build
	@command -v nextpnr-ice40 > /dev/null || $(SUDO) apt-get install -y -qq --no-install-recommends nextpnr-ice40 > /dev/null
	@rm -rf $(HW) && mkdir -p $(HW) docs/figures docs/results
	@hw/verify.sh sphere $(CURDIR)/$(BURNISH) $(LIBRARY) $(HW)/sphere $(CURDIR)/$(REPORTS) $(CURDIR)/docs/figures > $(HW)/sphere.txt
	@hw/synthesize.sh $(CURDIR)/$(BURNISH) $(HW)/synthesis > $(HW)/synthesis.txt
	@hw/report.py $(BURNISH) $(HW)/synthesis.txt $(HW)/sphere.txt > $(HW)/hardware.md
	@mv $(HW)/hardware.md docs/results/hardware.md

hw-exhaustive: build
	@hw/verify.sh exhaustive $(CURDIR)/$(BURNISH) $(LIBRARY) build/hw-exhaustive

fuzz: deps
	@tests/fuzz/run.sh $(FUZZ_SECONDS)

format: deps
	@clang-format -i $(SOURCES)

format-check: deps
	@clang-format --dry-run -Werror $(SOURCES)

docs-check:
	@tests/docs/check.py
