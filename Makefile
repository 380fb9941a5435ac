# The two commands of the README: `make run` and `make test`. Both set up, build and then do their work.
BUILD ?= build
JOBS  ?= $(shell nproc)
PYTHON ?= python3

.PHONY: all setup build run test sanitize figures evidence clean
all: build

setup:            ## installs the Debian packages that are missing
	@.ci/setup

build: setup      ## builds everything into $(BUILD)
	@cmake -S . -B $(BUILD) -G Ninja -DCMAKE_BUILD_TYPE=Release >/dev/null
	@cmake --build $(BUILD) -j $(JOBS)

run: build        ## the paper's gauge blocks: our Table 3 beside the paper's
	@examples/gauge_blocks/table3 $(BUILD)/abbe

test: build       ## every test
	@ctest --test-dir $(BUILD) --output-on-failure -j $(JOBS)

sanitize: setup   ## random and damaged programs under address, leak and undefined-behaviour sanitizers
	@cmake -S . -B $(BUILD) -G Ninja -DCMAKE_BUILD_TYPE=Release >/dev/null
	@cmake --build $(BUILD) -j $(JOBS) --target fuzz_sanitized
	@$(BUILD)/fuzz_sanitized .

figures: build    ## draws the figures of docs/ anew; the only thing here that needs Node
	@command -v npm >/dev/null || { echo "figures need Node 18 or later and npm: apt-get install nodejs npm"; exit 1; }
	@npm ci --ignore-scripts --no-audit --no-fund --loglevel=error
	@mkdir -p docs/figures/effects
	@python3 tests/docs/figures.py $(BUILD)/abbe --write

evidence: build   ## the concealed cases of docs/evidence.md again, its tables and figures; ROUND, SCALE and SECRET change the round
	@command -v npm >/dev/null || { echo "figures need Node 18 or later and npm: apt-get install nodejs npm"; exit 1; }
	@npm ci --ignore-scripts --no-audit --no-fund --loglevel=error
	@$(PYTHON) -B tests/concealed/evidence.py --abbe $(BUILD)/abbe --work $(BUILD)/evidence --jobs $(JOBS) \
	  $(if $(ROUND),--round $(ROUND)) $(if $(SCALE),--scale $(SCALE)) $(if $(SECRET),--secret $(SECRET))

clean:
	@rm -rf $(BUILD)
