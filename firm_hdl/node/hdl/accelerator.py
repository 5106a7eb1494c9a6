"""The component around an entity of the user's."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Any

from amaranth.hdl import ClockSignal, Instance, Module, ResetSignal
from amaranth.lib import wiring

from firm_hdl.errors import UserError
from firm_hdl.export.component import parts_of
from firm_hdl.node.accelerator import accelerator_signature
from firm_hdl.node.description import Description
from firm_hdl.node.hdl.ports import AcceleratorPort, accelerator_ports
from firm_hdl.node.hdl.records import (
    NO_FILES,
    Generated,
    generated_packages,
    message_records,
    record_ports,
    wrapped,
)
from firm_hdl.node.hdl.sources import Sources
from firm_hdl.node.hdl.verilog import checked_verilog, preprocessed
from firm_hdl.node.hdl.vhdl import checked_vhdl, verilog_of_vhdl

__all__ = ["HdlAccelerator"]


class HdlAccelerator(wiring.Component):
    """An accelerator that is an entity of VHDL, or a module of Verilog or SystemVerilog.

    Its files are checked by GHDL or by Verilator.

    Parameters
    ----------
    description : Description
        With `hdl`.

    Attributes
    ----------
    generated : Generated
        The wrapper, and packages, if the entity has records as ports.

    Members
    -------
    As `accelerator_signature` has them.

    Raises
    ------
    DefinitionError
        If a file cannot be read, or is wrong; if there is no such entity, or if its ports are not
        those of :func:`accelerator_ports`.
    ProgramMissingError
        If GHDL or Verilator is not installed.
    """

    def __init__(self, description: Description):
        self.sources = Sources(description)  # Its files.
        self.hdl = self.sources.hdl
        check = checked_vhdl if self.hdl.language == "vhdl" else checked_verilog
        if self.hdl.has_records:
            found, self.generated = _with_records(self.sources, check)
        else:
            wanted = accelerator_ports(description)
            found, self.generated = check(self.sources, wanted, {}), NO_FILES
        there = {port.name for port in found}
        # The plain ports, of the entity or of the wrapper around it.
        self.ports: tuple[AcceleratorPort, ...] = tuple(
            port
            for port in accelerator_ports(description)
            if port.name in there or not port.is_optional
        )
        super().__init__(accelerator_signature(description))
        self._MustUse__used = True

    @property
    def entity(self) -> str:
        """Name of the entity or module with plain ports."""
        return self.generated.entity or self.hdl.entity

    @cached_property
    def modules(self) -> Mapping[str, str]:
        """Verilog of the entity for a simulation, by file name.

        Raises `DefinitionError` if the VHDL has something that cannot be translated.
        """
        if self.hdl.language == "vhdl":
            text = verilog_of_vhdl(self.sources, self.ports, self.generated)
            return {"accelerator.sv": text}
        suffix = "v" if self.hdl.language == "verilog" else "sv"
        return {f"accelerator.{suffix}": self._preprocessed[0]}

    @property
    def headers(self) -> Mapping[str, bytes]:
        """The files that those of Verilog include, by absolute path."""
        return {} if self.hdl.language == "vhdl" else self._preprocessed[1]

    @cached_property
    def _preprocessed(self) -> tuple[str, dict[str, bytes]]:
        return preprocessed(self.sources, self.generated)

    def elaborate(self, platform: object) -> Module:
        m = Module()
        values = {".".join(part.path): part.value for part in parts_of(self)}
        connections: dict[str, Any] = {
            "i_aclk": ClockSignal(),
            "i_aresetn": ~ResetSignal(allow_reset_less=True),
        }
        for port in self.ports:
            if port.member:
                connections[f"{port.direction[0]}_{port.name}"] = values[port.member]
        m.submodules.entity = Instance(self.entity, **connections)
        return m


def _with_records(
    sources: Sources, check: Callable[..., Any]
) -> tuple[tuple[AcceleratorPort, ...], Generated]:
    """Check an entity with records as ports; return its ports, and the files around it."""
    description, language = sources.description, sources.hdl.language
    try:
        records = message_records(description, language)
    except UserError as error:
        raise sources.refused(str(error)) from None
    packages = generated_packages(records, language)
    for file in sources.files:
        if os.path.basename(file) in packages:
            raise sources.refused(f"firm-hdl adds '{file}' itself: leave it out")
    found = check(sources, record_ports(description, language, records), packages)
    return found, wrapped(description, records, packages, found)
