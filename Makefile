# The two commands of the README: `make run` and `make test`. Both set up, build and then do their work.
BUILD ?= build
JOBS  ?= $(shell nproc)

.PHONY: all setup build run test clean
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

clean:
	@rm -rf $(BUILD)
