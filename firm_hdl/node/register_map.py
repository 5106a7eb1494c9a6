"""The registers of a node on a bus of its chip: a table, from which circuit and files are made."""

from __future__ import annotations

from firm_hdl.names.identifiers import identifier
from firm_hdl.node.control import (
    COUNTERS_FROM,
    IDENTITY,
    RATE_FRACTION_BITS,
    counter_path,
    nominal_rate,
    registers,
)
from firm_hdl.node.description import Description
from firm_hdl.registers import Register, RegisterMap, system_rdl, table_c_header
from firm_hdl.registers.head import (
    BODY_ADDRESS,
    bits,
    control_register,
    identity_registers,
    interrupt_registers,
    word,
)
from firm_hdl.registers.table import WORD_BYTES

__all__ = ["counter_registers", "register_files", "register_map"]

_FUNCTIONS = """\
/* Read the clock of the node. Latches the counters, too. */
static inline void {name}_get_time(
  volatile uint32_t *registers, uint32_t *sec, uint32_t *nanosec)
{{
  registers[{prefix}_CONTROL / 4] = {prefix}_CONTROL_LATCH_MASK;
  *sec = registers[{prefix}_TIME_SEC / 4];
  *nanosec = registers[{prefix}_TIME_NANOSEC / 4];
}}

/* Let the clock of the node continue from a time; nanosec is below 1,000,000,000. */
static inline void {name}_set_time(volatile uint32_t *registers, uint32_t sec, uint32_t nanosec)
{{
  registers[{prefix}_NEW_SEC / 4] = sec;
  registers[{prefix}_NEW_NANOSEC / 4] = nanosec;
  registers[{prefix}_CONTROL / 4] = {prefix}_CONTROL_SET_TIME_MASK;
}}

/* Let the clock advance by a rate in each cycle; {nominal} is the nominal one. */
static inline void {name}_set_rate(volatile uint32_t *registers, uint32_t rate)
{{
  registers[{prefix}_NEW_RATE / 4] = rate;
  registers[{prefix}_CONTROL / 4] = {prefix}_CONTROL_SET_RATE_MASK;
}}
"""


def counter_registers(description: Description) -> dict[str, tuple[str, str]]:
    """Return the counters: by name in the table, the path in the node's structure of counters."""
    paths = [counter_path(description, each) for each in registers(description)[len(IDENTITY) :]]
    return {"_".join(path): path for path in paths}


def register_map(description: Description) -> RegisterMap:
    """Return the registers of a node. A counter is at 4 times its number in control messages."""
    assert WORD_BYTES * COUNTERS_FROM == BODY_ADDRESS
    counters = counter_registers(description)
    now = "of the clock, as at the last latch."
    steps = f"in steps of 2^-{RATE_FRACTION_BITS} ns per cycle."
    words = [
        word(BODY_ADDRESS + WORD_BYTES * number, name, "status", "A counter, as at the last latch.")
        for number, name in enumerate(counters)
    ]
    head: tuple[Register, ...] = (
        *identity_registers(description.fingerprint, "Of the description of the node."),
        control_register(
            bits("pulse", "set_time", 0, 1, "Set the clock to new_sec and new_nanosec."),
            bits("pulse", "set_rate", 3, 1, "Set the rate of the clock to new_rate."),
            latch="Latch the clock and all counters.",
            reset="Reset the node, as its reset port does.",
        ),
        *interrupt_registers("A message came or was sent.", "A counter of losses went up."),
        word(0x20, "time_sec", "status", f"Seconds {now}"),
        word(0x24, "time_nanosec", "status", f"Nanoseconds {now}"),
        word(0x28, "rate", "status", f"Of the clock, {steps}"),
        word(0x2C, "clock_hz", "constant", "Cycles per second.", round(description.clock_hz)),
        word(0x30, "new_sec", "setting", "Seconds for set_time."),
        word(0x34, "new_nanosec", "setting", "Below 1,000,000,000, else set_time does nothing."),
        word(
            0x38,
            "new_rate",
            "setting",
            f"For set_rate, {steps}",
            nominal_rate(description.clock_hz),
        ),
        word(0x3C, "counters", "constant", "Number of counters.", len(counters)),
    )
    return RegisterMap(
        # No word of C or SystemRDL ends so.
        name=f"{identifier(description.node)}_node",
        registers=(*head, *words),
        meaning=f"The node {description.node}.",
    )


def register_files(description: Description, name: str, header: str) -> dict[str, str]:
    """Write SystemRDL and a header for C, as ``NAME_registers.rdl`` and ``NAME_registers.h``."""
    table = register_map(description)
    functions = _FUNCTIONS.format(
        name=table.name, prefix=table.name.upper(), nominal=f"{table.name.upper()}_NEW_RATE_RESET"
    )
    return {
        f"{name}_registers.rdl": system_rdl(table, header),
        f"{name}_registers.h": table_c_header(
            table,
            header,
            types=[""],
            same=("fingerprint_low", "fingerprint_high", "clock_hz", "counters"),
            functions=functions,
        ),
    }
