# make demo   installs packages, builds, and takes a measurement to two textures (INPUT=file for your own)
# make test   installs packages, builds with sanitizers and optimized, runs every test
# make python the Python package in build/venv, tested
# make build  the command line at build/release/apps/burnish/burnish
# make bench, make fuzz, make report, make sampling-report, make format: see docs/developing.md
.PHONY: demo test build python deps bench fuzz report sampling-report format format-check
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
	  $(SUDO) apt-get update -qq && DEBIAN_FRONTEND=noninteractive $(SUDO) apt-get install -y -qq --no-install-recommends $$missing > /dev/null; \
	fi

build: deps
	@cmake --preset release > /dev/null
	@cmake --build --preset release -j $(JOBS)

demo: build
	@examples/demo.sh "$(BURNISH)" "$(OUT)" "$(INPUT)"

test: deps format-check
	@for preset in dev release; do \
	  cmake --preset $$preset > /dev/null && \
	  cmake --build --preset $$preset -j $(JOBS) && \
	  ctest --preset $$preset -j $(JOBS) || exit 1; \
	done
	@python/check.sh --skip-offline

python: build
	@python/check.sh

bench: deps
	@cmake --preset bench > /dev/null
	@cmake --build --preset bench -j $(JOBS)
	@build/bench/src/burnish/burnish_bench

report: build
	@mkdir -p docs/figures
	@build/release/apps/report/burnish_report docs > docs/results.md.partial
	@mv docs/results.md.partial docs/results.md
	@build/release/apps/report/burnish_accuracy docs > docs/accuracy.md.partial
	@mv docs/accuracy.md.partial docs/accuracy.md

sampling-report: build
	@mkdir -p docs/figures
	@build/release/apps/sampling_report/burnish_sampling_report docs > docs/sampling-results.md.partial
	@mv docs/sampling-results.md.partial docs/sampling-results.md

fuzz: deps
	@tests/fuzz/run.sh $(FUZZ_SECONDS)

format: deps
	@clang-format -i $(SOURCES)

format-check: deps
	@clang-format --dry-run -Werror $(SOURCES)
