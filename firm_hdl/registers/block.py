"""The registers of a map behind a bus of words."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.component import Component
from firm_hdl.registers.axi_lite import WordBusSignature
from firm_hdl.registers.table import WORD_BYTES, Register, RegisterMap

__all__ = ["RegisterBlock"]


class RegisterBlock(Component):
    """Hold the registers of a map.

    What is written is on the outputs in the cycle after the write. Writing a word that has nothing
    to write, or no register, changes nothing. Reading an address without a register fails.

    Parameters
    ----------
    registers : RegisterMap

    Members
    -------
    bus : In(WordBusSignature(registers.address_bits))
    clears : In(1)
        Give all settings their reset values, and clear all events, as a reset does.
    <name> : In or Out
        Each field, by its name in :meth:`RegisterMap.fields`: In of a status, and Out of a setting
        or a pulse. What is constant or unused has no member.
    <name>, sets_<name> : Out and In
        An event, and what sets it. If software clears an event while the hardware sets it, it
        stays set.
    """

    bus: Any
    clears: Value

    def __init__(self, registers: RegisterMap):
        self.registers = registers
        members: dict[str, Any] = {
            "bus": In(WordBusSignature(registers.address_bits)),
            "clears": In(1),
        }
        for name, _, field in registers.fields():
            if field.kind == "event":
                members[f"sets_{name}"] = In(field.bits)
            if field.kind not in ("constant", "unused"):
                flow = In if field.kind == "status" else Out
                members[name] = flow(field.bits, init=field.reset)
        super().__init__(members)

    def elaborate(self, platform: object) -> Module:
        m = Module()
        bus = self.bus
        m.d.comb += bus.read_fails.eq(1)
        with m.Switch(bus.read_word):
            for register, word in self._words():
                with m.Case(register.address // WORD_BYTES):
                    m.d.comb += [bus.read_fails.eq(0), bus.read_data.eq(word)]
        # Comparisons, and no cases: in Amaranth, n signals of n cases take quadratic time.
        selected: dict[int, Signal] = {}
        for register in self.registers.registers:
            if register.is_written:
                here = Signal(name=f"selects_{register.name}")
                selected[register.address] = here
                m.d.comb += here.eq(bus.write_word == register.address // WORD_BYTES)
        mask = Cat(bit.replicate(8) for bit in bus.write_bytes)
        for name, register, field in self.registers.fields():
            if field.kind not in ("setting", "pulse", "event"):
                continue
            value, bits = getattr(self, name), slice(field.low, field.low + field.bits)
            writes = bus.writes & selected[register.address]
            ones = bus.write_data[bits] & mask[bits]
            if field.kind == "setting":
                m.d.sync += value.eq(
                    Mux(
                        self.clears,
                        field.reset,
                        Mux(writes, (value & ~mask[bits]) | ones, value),
                    )
                )
            elif field.kind == "pulse":
                m.d.sync += value.eq(Mux(writes, ones, 0))
            else:
                kept = Mux(writes, value & ~ones, value)
                m.d.sync += value.eq(Mux(self.clears, 0, kept) | getattr(self, f"sets_{name}"))
        return m

    def _words(self) -> Iterator[tuple[Register, Value]]:
        """Yield the registers, and what is read from each."""
        members = {id(field): name for name, _, field in self.registers.fields()}
        for register in self.registers.registers:
            parts: list[Value] = []
            end = 0
            for field in sorted(register.fields, key=lambda field: field.low):
                value: Value = Const(field.reset, field.bits)
                if field.kind in ("status", "setting", "event"):
                    value = getattr(self, members[id(field)])
                elif field.kind == "pulse":
                    value = Const(0, field.bits)
                parts += [Const(0, field.low - end), value]
                end = field.low + field.bits
            yield register, Cat(parts)
