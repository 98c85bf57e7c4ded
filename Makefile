# SPDX-License-Identifier: Apache-2.0
# What a person types. Everything else is CMake: see CMakePresets.json.
JOBS ?= $(shell nproc)
BUILD := build/release
VERSINE := $(BUILD)/apps/versine/versine

.PHONY: all setup build test demo accuracy figures benchmarks format clean
all: build

setup:
	@scripts/setup

$(BUILD)/build.ninja: | setup
	cmake --preset release

build: setup $(BUILD)/build.ninja
	cmake --build $(BUILD) -j $(JOBS)

test: build
	ctest --test-dir $(BUILD) --output-on-failure -j $(JOBS)

# A survey of 1 km of slab track with a total station: simulated, processed, compared with the truth.
demo: build
	rm -rf out/demo && mkdir -p out
	$(VERSINE) simulate examples/scenarios/slab-1km.toml -o out/demo/recording
	$(VERSINE) survey out/demo/recording/survey.toml -o out/demo/result
	$(VERSINE) compare out/demo/result out/demo/recording/truth_trajectory.csv
	@echo; echo "The result is in out/demo/result: trajectory.h5, trajectory.csv, run.json."

# Accuracy on the real recordings (docs/accuracy.md); VERSINE_DATA names their folder.
accuracy: build
	VERSINE_DATA=$${VERSINE_DATA:-../shared/data} benchmarks/accuracy_real.py $(VERSINE)

# The pictures of the documentation.
figures: benchmarks
	$(BUILD)/benchmarks/versine_simulation_figures docs/images
	benchmarks/planning_figures.sh $(VERSINE) docs/images

# The programs of benchmarks/, for accuracy tables and timings.
benchmarks: build
	cmake -B $(BUILD) -DVERSINE_BENCHMARKS=ON
	cmake --build $(BUILD) -j $(JOBS)

format:
	git ls-files '*.cpp' '*.hpp' | xargs clang-format -i

clean:
	rm -rf build
