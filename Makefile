# SPDX-License-Identifier: Apache-2.0
# What a person types. Everything else is CMake: see CMakePresets.json.
JOBS ?= $(shell nproc)
BUILD := build/release

.PHONY: all setup build test demo format clean
all: build

setup:
	@scripts/setup

$(BUILD)/build.ninja: | setup
	cmake --preset release

build: setup $(BUILD)/build.ninja
	cmake --build $(BUILD) -j $(JOBS)

test: build
	ctest --test-dir $(BUILD) --output-on-failure -j $(JOBS)

format:
	git ls-files '*.cpp' '*.hpp' | xargs clang-format -i

clean:
	rm -rf build
