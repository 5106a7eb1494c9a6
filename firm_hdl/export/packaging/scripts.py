"""A script for Vivado and a makefile for GHDL."""

from __future__ import annotations

from firm_hdl.export.packaging.facts import Manifest, own_files, remark, shared_packages

__all__ = ["makefile", "vivado_script"]


def vivado_script(manifest: Manifest) -> str:
    """Write the Tcl that reads a design into Vivado, without its benches."""
    section = manifest["vhdl"]
    others = [*section["common_files"], *(each["file"] for each in shared_packages(manifest))]
    common = "".join(f"  {file}\n" for file in others)
    own = "".join(f"  {file}\n" for file in own_files(section["files"], section))
    return f"""\
# Read the converters of {remark(manifest)} into Vivado:
#
#   source .../vivado.tcl
#
# The files are read in compile order, as VHDL-2008, into the current library. Test benches are left
# out.

set firm_hdl_folder [file dirname [file normalize [info script]]]

# Every type that needs one of these files has it, with the same text: read each file once.
foreach firm_hdl_file {{
{common}}} {{
  if {{[llength [get_files -quiet "*/$firm_hdl_file"]] == 0}} {{
    read_vhdl -vhdl2008 [file join $firm_hdl_folder $firm_hdl_file]
  }}
}}

foreach firm_hdl_file {{
{own}}} {{
  read_vhdl -vhdl2008 [file join $firm_hdl_folder $firm_hdl_file]
}}
"""


def makefile(manifest: Manifest) -> str:
    """Write the makefile that runs the benches in GHDL."""
    bench = manifest["vhdl"]["bench"]
    return f"""\
# Test benches of {remark(manifest)} in GHDL.
#
#   make                        run all benches
#   make SEED=7 STALLS=0        run them with other random stalls (percent)
#   make lint                   analyse with GHDL's warnings as errors
#   make clean

SEED   ?= 1
STALLS ?= 40
# The command of GHDL; empty: the script finds it.
GHDL   ?=

BENCHES := {" ".join(bench["entities"])}
FILES   := $(shell cat files.txt bench_files.txt)
FOUND    = $(firstword $(foreach name,ghdl ghdl-mcode ghdl-llvm ghdl-gcc,\\
  $(shell command -v $(name))))
STRICT  := --warn-error --warn-unused --warn-body

.PHONY: all lint clean $(BENCHES)

all: $(BENCHES)

# Benches run one after the other, because they share a folder.
.NOTPARALLEL:

$(BENCHES):
	@BENCH=$@ GHDL='$(GHDL)' sh ./{bench["script"]} -gseed=$(SEED) -gstalls=$(STALLS)

lint:
	@rm -rf work/lint && mkdir -p work/lint
	'$(or $(GHDL),$(FOUND),ghdl)' -a --std=08 --workdir=work/lint $(STRICT) $(FILES)

clean:
	rm -rf work
"""
