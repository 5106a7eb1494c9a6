"""Timing constraints of the FIFOs that cross clock domains, for Vivado and Quartus.

Amaranth's `AsyncFIFO` sends its positions to the other clock as Gray codes, through two registers.
The other clock must see at most one bit of them change, so their delays differ by less than a
period: UG903, "set_bus_skew Example Two", and UG949, "Constraints on Individual CDC Paths". A text
names registers of the Verilog.
"""

from __future__ import annotations

from collections.abc import Iterator

from firm_hdl.rtlil.ir import Cell, Design, Module

__all__ = ["constraints"]

_XDC = """\
# Crossings of clock domains in {module}, for Vivado:
#
#   read_xdc -ref {module} {name}.xdc
#
# In a project, set USED_IN of this file to implementation: in synthesis, clocks of a block design
# are not there yet.
#
# Do not declare the clocks asynchronous with set_clock_groups, which overrides the delays (UG903,
# "Constraining Asynchronous Signals"). No version of Vivado has read this file yet.
"""

# The highest bits of a Gray code and of its number are equal, and may become one register.
_XDC_FIFO = """
set write [get_property -min PERIOD [get_clocks -of_objects [get_pins \
{PATH/consume_cdc/stage0_reg[0]/C}]]]
set read [get_property -min PERIOD [get_clocks -of_objects [get_pins \
{PATH/produce_cdc/stage0_reg[0]/C}]]]
set period [expr {min($write, $read)}]
set written [get_cells {PATH/produce_w_gry_reg[*] PATH/produce_w_bin_reg[*]}]
set taken [get_cells {PATH/consume_r_gry_reg[*] PATH/consume_r_bin_reg[*]}]
set first_read [get_cells {PATH/produce_cdc/stage0_reg[*]}]
set first_write [get_cells {PATH/consume_cdc/stage0_reg[*]}]
set_max_delay -datapath_only -from $written -to $first_read $period
set_max_delay -datapath_only -from $taken -to $first_write $period
set_bus_skew -from $written -to $first_read $period
set_bus_skew -from $taken -to $first_write $period
set_property ASYNC_REG TRUE [get_cells {PATH/produce_cdc/stage*_reg[*] \
PATH/consume_cdc/stage*_reg[*] PATH/rst_cdc/stage*_reg}]
set_false_path -to [get_pins {PATH/rst_cdc/stage*_reg/PRE}]
# If the memory is made of LUTs, its words cross long after they were written.
set_max_delay -quiet -datapath_only -from [get_cells -quiet {PATH/storage_reg*}] \
-to [get_cells -quiet {PATH/r_port_data*_reg[*]}] $period
"""

_XDC_WORDS = """\
# So do those of the memory whose places the FIFO carries.
set_max_delay -quiet -datapath_only -from [get_cells -quiet {PATH_words_reg*}] $period
"""

_SDC = """\
# Crossings of clock domains in {module}, for the Timing Analyzer of Quartus. Before this file is
# read, set firm_hdl_instance to the path of the instance, with a bar at its end; it is empty by
# default.
# No version of Quartus has read this file yet.

if {{![info exists firm_hdl_instance]}} {{
  set firm_hdl_instance ""
}}
"""

_SDC_FIFO = """
foreach {from to} {
  PATH|produce_w_gry[*] PATH|produce_cdc|stage0[*]
  PATH|consume_r_gry[*] PATH|consume_cdc|stage0[*]
} {
  set from [get_registers $firm_hdl_instance$from]
  set to [get_registers $firm_hdl_instance$to]
  set_net_delay -max -from $from -to $to \\
    -get_value_from_clock_period dst_clock_period -value_multiplier 0.8
  set_max_skew -from $from -to $to \\
    -get_skew_value_from_clock_period min_clock_period -skew_value_multiplier 0.8
  set_false_path -from $from -to $to
}
set_false_path -to [get_registers "${firm_hdl_instance}PATH|rst_cdc|stage*"]
"""

_ECP5 = {"IDDRX1F", "ODDRX1F", "DELAYG"}
"""Cells of an RGMII, which are those of an FPGA that neither Vivado nor Quartus knows."""


def constraints(design: Design, *, name: str, module: str) -> dict[str, str]:
    """Write the constraints of a design; no files, if it has no such FIFO, or cells of the ECP5.

    * `name`: of the files, ``NAME.xdc`` and ``NAME.sdc``.
    * `module`: the outermost module in Verilog.
    """
    fifos = list(_fifos(design, design.top, ()))
    items = (item for each in design.modules.values() for item in each.items)
    if not fifos or any(isinstance(item, Cell) and item.kind in _ECP5 for item in items):
        return {}
    names = {"name": name, "module": module}
    xdc = [
        (_XDC_FIFO + _XDC_WORDS * has_words).replace("PATH", "/".join(path))
        for path, has_words in fifos
    ]
    sdc = [_SDC_FIFO.replace("PATH", "|".join(path)) for path, _ in fifos]
    return {
        f"{name}.xdc": "".join([_XDC.format(**names), *xdc]),
        f"{name}.sdc": "".join([_SDC.format(**names), *sdc]),
    }


def _fifos(
    design: Design, module: Module, path: tuple[str, ...]
) -> Iterator[tuple[tuple[str, ...], bool]]:
    """Yield the path of each `AsyncFIFO`, and whether a memory ``FIFO_words`` is beside it."""
    for cell in module.items:
        if isinstance(cell, Cell) and (inner := design.modules.get(cell.kind)):
            inside, to = {each.name for each in inner.items}, (*path, cell.name)
            if {"produce_cdc", "consume_cdc", "rst_cdc"} <= inside:
                yield to, f"{cell.name}_words" in module.memories
            yield from _fifos(design, inner, to)
