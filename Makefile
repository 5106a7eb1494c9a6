# What a newcomer types. Everything is installed into .venv, which `make clean` removes.

PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
JOBS   ?= 2
# What `make verify` runs; `VERIFY_ARGS='--bus-bytes 1 sensor_msgs/msg/Imu'` runs one type.
VERIFY_ARGS ?= --bus-bytes 4 --bus-bytes 8

.DEFAULT_GOAL := help
.PHONY: help demo test lint verify verify-ts1 verify-vhdl prove oracles fuzz mutate bench tools ghdl verilog clean

help: ## list the targets
	@awk -F ':.*## ' '/^[a-z0-9-]+:.*## / { printf "make %-11s %s\n", $$1, $$2 }' Makefile

demo: $(VENV)/.installed ghdl ## real ROS messages through generated hardware
	$(BIN)/python examples/demo.py

test: lint ghdl verilog oracles ## linters, types and all tests
	$(BIN)/python -m pytest -n $(JOBS) $(PYTEST_ARGS)

lint: $(VENV)/.installed-dev ## ruff and mypy only
	$(BIN)/ruff check .
	$(BIN)/mypy

# Results and their report go to VERIFY_OUT. `make verify RESUME=1` goes on with a run that was stopped.
VERIFY_OUT ?= build/verify
verify: $(VENV)/.installed ## every type of every distribution against rosbags (10 minutes)
	$(if $(RESUME),,rm -f $(VERIFY_OUT)/ts3.jsonl)
	$(BIN)/python -m firm_hdl.verify $(VERIFY_ARGS) \
	  --results $(VERIFY_OUT)/ts3.jsonl --report $(VERIFY_OUT)/ts3.html

# `TS1_CORPUS=DIR` has folders `ros1/` and `ros2/` with packages, and `invalid/` with others.
TS1_CORPUS ?= $(FIRM_HDL_CORPUS)
TS1 := $(BIN)/python -m firm_hdl.verify --systems ts1
verify-ts1: $(VENV)/.installed oracles ## every definition against ROS's own readers (4 minutes)
	$(TS1)
	$(if $(TS1_CORPUS),$(TS1) --distro noetic --path $(TS1_CORPUS)/invalid/ros1 --path $(TS1_CORPUS)/ros1)
	$(if $(TS1_CORPUS),$(TS1) --distro lyrical --path $(TS1_CORPUS)/invalid/ros2 --path $(TS1_CORPUS)/ros2)

verify-vhdl: $(VENV)/.installed ghdl ## every bench of lyrical and noetic in GHDL (10 minutes)
	$(BIN)/python -m firm_hdl.verify --systems bench --distro lyrical --distro noetic --jobs $(JOBS)

prove: $(VENV)/.installed-dev ghdl ## proofs that VHDL equals RTLIL, for types with all constructs
	$(BIN)/python -m firm_hdl.equivalence --jobs $(JOBS) $(PROVE_ARGS)

fuzz: $(VENV)/.installed-dev ## a million damaged definitions through the front end; FUZZ_ARGS='-n 1000'
	$(BIN)/python -m tests.fuzz_frontend --jobs $(JOBS) $(FUZZ_ARGS)

mutate: $(VENV)/.installed-dev ghdl ## faults in the program, and which tests notice (hours); MUTATE_ARGS='--count 24'
	$(BIN)/python -m tests.mutation --first --jobs $(JOBS) $(MUTATE_ARGS)

bench: $(VENV)/.installed ## cycles per beat of long and short messages, on several bus widths
	$(BIN)/python examples/bench.py

tools: ghdl verilog oracles ## system packages that tests and the demo use

# Tools that no Python package has. Root gets them from Debian or Ubuntu here; whoever cannot goes on
# without: tests that need them are skipped, except in CI.
ghdl:
	@$(call need,ghdl-mcode,command -v ghdl >/dev/null || command -v ghdl-mcode >/dev/null)

verilog:
	@$(call need,iverilog verilator tcl,command -v iverilog >/dev/null \
	  && command -v verilator >/dev/null && command -v tclsh >/dev/null)

# ROS's own readers of definitions, for Debian's Python.
oracles:
	@$(call need,python3-genmsg python3-rosmsg python3-rosidl python3-empy,/usr/bin/python3 -c \
	  'import em; import genmsg; import rosidl_adapter; import rosidl_parser; import rosmsg' 2>/dev/null)

# $(call need,packages,test that they are there)
need = { $(2); } || { \
  if [ "$$(id -u)" = 0 ] && command -v apt-get >/dev/null; then \
    echo "Installing $(1) ..."; \
    { apt-get update && DEBIAN_FRONTEND=noninteractive \
      apt-get install -y --no-install-recommends $(1); } >/dev/null 2>&1 \
      || echo "Failed: apt-get install $(1); going on without." >&2; \
  else \
    echo "Missing, and used by tests: sudo apt-get install $(1)" >&2; \
  fi; }

clean: ## remove .venv and what tools have cached
	rm -rf $(VENV) build dist ./*.egg-info .pytest_cache .hypothesis .mypy_cache .ruff_cache
	find firm_hdl tests examples -name __pycache__ -type d -prune -exec rm -rf {} +

# A stamp is newer than pyproject.toml when what that asks for is installed.
$(VENV)/.installed: pyproject.toml $(VENV)/.created
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable .
	@touch $@

$(VENV)/.installed-dev: pyproject.toml $(VENV)/.created
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev]'
	@touch $@ $(VENV)/.installed

$(VENV)/.created:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 10))' || { \
	  echo "firm-hdl needs Python 3.10 or newer; '$(PYTHON)' is not." >&2; \
	  echo "Install one, or name it: make PYTHON=python3.12 ..." >&2; exit 1; }
	@$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || { \
	  if [ "$$(id -u)" = 0 ] && command -v apt-get >/dev/null; then \
	    apt-get update && apt-get install -y --no-install-recommends python3-venv; \
	  else \
	    echo "Python has no venv; on Debian and Ubuntu: sudo apt-get install python3-venv" >&2; \
	    exit 1; \
	  fi; }
	$(PYTHON) -m venv --clear $(VENV)
	@touch $@
