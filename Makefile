# SPDX-License-Identifier: Apache-2.0
# What a person types. Everything else is CMake: see CMakePresets.json.
JOBS ?= $(shell nproc)
BUILD := build/release
VERSINE := $(BUILD)/apps/versine/versine

# The folder of real recordings; jobs would take a relative one from their own folder.
VERSINE_DATA ?= ../shared/data
override VERSINE_DATA := $(abspath $(VERSINE_DATA))
export VERSINE_DATA

.PHONY: all setup build test headers sanitize demo screenshots report-images accuracy figures benchmarks format clean accuracy-positioning accuracy-georef accuracy-track
all: build

setup:
	@scripts/setup

$(BUILD)/build.ninja: | setup
	cmake --preset release

build: setup $(BUILD)/build.ninja
	cmake --build $(BUILD) -j $(JOBS)

test: build
	ctest --test-dir $(BUILD) --output-on-failure -j $(JOBS)

# Each public header compiles by itself, without precompiled headers.
headers: setup $(BUILD)/build.ninja
	cmake --build $(BUILD) -j $(JOBS) --target versine_headers

# Text readers, integrity checks, georeferencing and stationing under the address and undefined-behaviour sanitizers.
sanitize: setup
	JOBS=$(JOBS) scripts/sanitize

# Limits of the demo's survey and of the 10 km line.
LIMITS := --set geometry.quality.limits=$(CURDIR)/data/limits
DEMO_LIMITS := $(LIMITS)/china-ballastless.toml --set geometry.quality.speed_kmh=300 --set geometry.adjustment.on=true
LINE_LIMITS := $(LIMITS)/en13848-5.toml --set geometry.quality.speed_kmh=120 --set geometry.adjustment.on=true

# A survey of 1 km of slab track with a total station: simulated, processed, compared with the truth.
demo: build
	rm -rf out/demo && mkdir -p out
	$(VERSINE) simulate examples/scenarios/slab-1km.toml -o out/demo/recording
	$(VERSINE) survey out/demo/recording/survey.toml -o out/demo/result $(DEMO_LIMITS)
	$(VERSINE) compare out/demo/result out/demo/recording/truth_trajectory.csv
	$(VERSINE) report out/demo/result --format html,pdf --quiet
	@echo; echo "The result is in out/demo/result. Look at it: $(VERSINE) view out/demo/result"
	@echo "The report: out/demo/result/report.html (opens by double click), report.pdf"

# Pictures of docs/viewer.md: the demo and 10 km of line with faults, in a real browser.
BRUSSELS := $(if $(wildcard $(VERSINE_DATA)/brussels-airport),out/brussels)
# So poor that a path is in doubt.
POOR_GNSS := --set gnss.sigma_horizontal_m=4 --set gnss.correlated_horizontal_m=6 --set gnss.correlation_time_s=300
screenshots: demo
	rm -rf out/line && $(VERSINE) simulate examples/scenarios/line-10km.toml -o out/line/recording
	$(VERSINE) survey out/line/recording/survey.toml -o out/line/result $(LINE_LIMITS)
	rm -rf out/harbour && $(VERSINE) simulate examples/scenarios/harbour-day.toml -o out/harbour/recording $(POOR_GNSS)
	$(VERSINE) georef out/harbour/recording/georef.toml -o out/harbour/result
	$(if $(BRUSSELS),$(VERSINE) georef examples/georef/brussels.toml -o $(BRUSSELS))
	mkdir -p docs/images
	VERSINE=$(VERSINE) VERSINE_SOURCE_DIR=. VERSINE_PAGE=$(abspath $(BUILD))/viewer/page \
	  node viewer/tests/screenshots.mjs docs/images out/demo/result out/line/result out/harbour/result $(BRUSSELS)

# Accuracy on the real recordings (docs/accuracy.md); VERSINE_DATA names their folder.
accuracy: build
	benchmarks/accuracy_real.py $(VERSINE)

# The pictures of the documentation.
figures: benchmarks
	$(BUILD)/benchmarks/versine_simulation_figures docs/images
	benchmarks/planning_figures.sh $(VERSINE) docs/images

# The programs of benchmarks/, for accuracy tables and timings.
benchmarks: build
	cmake -B $(BUILD) -DVERSINE_BENCHMARKS=ON
	cmake --build $(BUILD) -j $(JOBS)

# Total station and GNSS: the tables of docs/total-station.md and docs/gnss.md.
accuracy-positioning: setup
	cmake --preset release -DVERSINE_BENCHMARKS=ON
	cmake --build $(BUILD) -j $(JOBS) --target versine versine_station_accuracy versine_positioning_real
	$(BUILD)/benchmarks/versine_station_accuracy benchmarks/scenarios/station-tunnel.toml
	$(BUILD)/benchmarks/versine_station_accuracy benchmarks/scenarios/station-line.toml
	$(BUILD)/benchmarks/versine_positioning_real $(VERSINE_DATA)
	benchmarks/rinex_hour.py out/hour
	time -p $(VERSINE) gnss out/hour/job.toml -o out/hour/result
	benchmarks/rinex_hour.py --compare out/hour out/hour/result

# Pages of reports as pictures (docs/report.md); with VERSINE_DATA also of the Brussels journeys.
report-images: build
	benchmarks/report_images.sh $(VERSINE) docs/images

# Georeferencing: real logs, then 500 simulated recordings on each of two networks with the diagram of path
# probabilities (docs/accuracy.md).
accuracy-georef: setup
	cmake --preset release -DVERSINE_BENCHMARKS=ON
	cmake --build $(BUILD) -j $(JOBS) --target versine_georef_brussels versine_georef_accuracy
	$(BUILD)/benchmarks/versine_georef_brussels $(VERSINE_DATA)
	$(BUILD)/benchmarks/versine_georef_accuracy --data $(VERSINE_DATA) --svg docs/images/georef-reliability.svg

# Track geometry of simulated surveys against the true rails, 20 seeds each (docs/track-geometry.md).
accuracy-track: setup
	cmake --preset release -DVERSINE_BENCHMARKS=ON
	cmake --build $(BUILD) -j $(JOBS) --target versine_track_accuracy
	$(BUILD)/benchmarks/versine_track_accuracy 20 $(addprefix benchmarks/scenarios/track-,ts120.toml ts60.toml gnss.toml)

format:
	git ls-files '*.cpp' '*.hpp' | xargs clang-format -i

clean:
	rm -rf build
