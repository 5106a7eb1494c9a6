# amaranth: UnusedElaboratable=no
# A failed build leaves converters without elaboration. Amaranth's warning about them does not help.
"""Shared parts of back ends: a type's converters, and the output.

A back end turns a type's converters into files and into entries of the manifest.
"""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from firm_hdl.errors import UserError
from firm_hdl.export.manifest import MANIFEST
from firm_hdl.export.options import Options
from firm_hdl.export.top import DIRECTIONS, Direction, Top, converter_of
from firm_hdl.garbage import search_put_off
from firm_hdl.model import Message
from firm_hdl.plan import Plan
from firm_hdl.program import (
    LEGEND,
    MANY_STATES,
    deserializer_program,
    program_lines,
    serializer_program,
)
from firm_hdl.rtlil import netlist_of, rtlil_of
from firm_hdl.rtlil.ir import Design

if TYPE_CHECKING:
    from firm_hdl.registers import MessageMap

__all__ = ["BuildError", "Converters", "Output", "module_name"]


class BuildError(UserError):
    """A type cannot be built, or a folder cannot be written; the text says why."""


def module_name(folder: str, direction: Direction, *parts: str) -> str:
    """Return the name of a converter's module in Verilog, or of a module around it.

    No VHDL entity has this name in any case, because simulators of both languages keep modules and
    entities in one library and look them up regardless of case.
    """
    return "_".join([folder, direction, *parts, "verilog"])


@dataclass(frozen=True, slots=True, kw_only=True)
class Converters:
    """The converters of a message type; back ends write them in their languages."""

    message: Message
    plan: Plan  # The plan of the converters.
    name: str  # Name of the folder; names of modules and entities start with it.
    options: Options = field(default_factory=Options)
    # Everything that the content of the files depends on; see `firm_hdl.export.manifest.inputs_of`.
    inputs: Mapping[str, Any] = field(default_factory=dict)
    stimuli: Sequence[bytes] = ()  # Packets for test benches.
    # Netlists with named ports, the source of the text in all languages. Empty until
    # `make_circuits` has made them.
    circuits: Mapping[Direction, Design] = field(default_factory=dict)
    # Registers of the message; empty if they were not asked for.
    registers: Mapping[Direction, MessageMap] = field(default_factory=dict)
    # Converters with these registers.
    register_circuits: Mapping[Direction, Design] = field(default_factory=dict)

    def make_circuits(self) -> dict[Direction, Design]:
        """Make the circuits. Back ends give their outermost modules other names."""
        return {direction: self._circuit(direction) for direction in DIRECTIONS}

    @search_put_off()
    def _circuit(self, direction: Direction) -> Design:
        top = Top(converter_of(self.message, self.plan, direction))
        return netlist_of(rtlil_of(top, name=f"{self.name}_{direction}"))

    def header(self, name: str, what: str) -> str:
        """Write the lines of a comment at the head of a file; empty without `inputs`.

        * `name`: name of the module, or of the folder.
        * `what`: description of the file's content, such as ``"the serializer"``.
        """
        if not self.inputs:
            return ""
        return (
            f"{name}: {what} of {self.message.name}, made by "
            f"firm-hdl {self.inputs['generator']['firm-hdl']}.\n"
            f"{self.inputs['distro']}, wire {self.plan.wire}, bus of {self.plan.bus_bytes} bytes, "
            f"messages of at most {self.plan.max_message_bytes} bytes\n"
            f"definition (SHA-256): {self.inputs['definition_sha256']}\n"
            f"What each port means: {MANIFEST}.\n"
        )

    def steps(self, direction: Direction) -> str:
        """Write the steps of a converter, one per line, for a comment at the head of its file."""
        make = deserializer_program if direction == "deserializer" else serializer_program
        program = make(self.plan)
        if len(program.states) > MANY_STATES:
            return f"{len(program.states)} steps: `firm-hdl plan --program` prints them.\n"
        lines = ["Steps, as `firm-hdl plan --program` prints them."]
        lines += [line.removeprefix("# ") for line in LEGEND.splitlines()]
        for line in program_lines(program):
            lines += textwrap.wrap(line, 95, subsequent_indent="      ", break_long_words=False)
        return "".join(f"{line}\n" for line in lines)


@dataclass(frozen=True, slots=True, kw_only=True)
class Output:
    """The output of a back end."""

    files: Mapping[str, str]  # Texts by path in the type's folder.
    # Entries of the manifest about the files, by key.
    manifest: Mapping[str, Any] = field(default_factory=dict)
    # An instance of each converter, to be copied into a design.
    instances: Mapping[Direction, str] = field(default_factory=dict)
