# The two commands of the README: `make run` and `make test`. Both set up, build and then do their work.
BUILD ?= build
JOBS  ?= $(shell nproc)
PYTHON ?= python3
CLANG  ?= clang++-14
SECONDS_EACH ?= 300

.PHONY: all setup build run test format sanitize fuzz figures evidence clean
all: build

setup:            ## installs the Debian packages that are missing
	@.ci/setup

build: setup      ## builds everything into $(BUILD)
	@cmake -S . -B $(BUILD) -G Ninja -DCMAKE_BUILD_TYPE=Release >/dev/null
	@cmake --build $(BUILD) -j $(JOBS)

run: setup        ## the paper's gauge blocks: our Table 3 beside the paper's
	@cmake -S . -B $(BUILD) -G Ninja -DCMAKE_BUILD_TYPE=Release >/dev/null
	@cmake --build $(BUILD) -j $(JOBS) --target abbe
	@examples/gauge_blocks/table3 $(BUILD)/abbe

test: build       ## every test
	@ctest --test-dir $(BUILD) --output-on-failure -j $(JOBS)

format:           ## lays out the C++ files as .clang-format says; needs clang-format 14
	@command -v clang-format-14 >/dev/null || { echo "make format needs clang-format 14: apt-get install clang-format-14"; exit 1; }
	@find engine lang programs tests -name '*.cpp' -o -name '*.hpp' | xargs clang-format-14 -i

sanitize: setup   ## ten times as many random and damaged programs under sanitizers as in `make test`
	@cmake -S . -B $(BUILD) -G Ninja -DCMAKE_BUILD_TYPE=Release >/dev/null
	@cmake --build $(BUILD) -j $(JOBS) --target fuzz_sanitized
	@$(BUILD)/fuzz_sanitized . 20261122 400

fuzz: setup       ## five minutes of libFuzzer on programs and five on machine files; needs clang
	@command -v $(CLANG) >/dev/null || { echo "make fuzz needs $(CLANG): apt-get install clang-14, or CLANG=another clang++"; exit 1; }
	@cmake -S . -B $(BUILD)-fuzz -G Ninja -DCMAKE_CXX_COMPILER=$(CLANG) -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_FLAGS=-O1 -DABBE_FUZZ=ON >/dev/null
	@cmake --build $(BUILD)-fuzz -j $(JOBS) --target fuzz_program fuzz_json
	@mkdir -p $(BUILD)-fuzz/programs $(BUILD)-fuzz/files
	@$(BUILD)-fuzz/fuzz_program -max_total_time=$(SECONDS_EACH) -timeout=30 -artifact_prefix=$(BUILD)-fuzz/ $(BUILD)-fuzz/programs tests/lang/ok
	@$(BUILD)-fuzz/fuzz_json -max_total_time=$(SECONDS_EACH) -artifact_prefix=$(BUILD)-fuzz/ $(BUILD)-fuzz/files examples/machines

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
	@rm -rf $(BUILD) $(BUILD)-fuzz
