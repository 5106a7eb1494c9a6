"""The registers of a map behind a bus of words."""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Cat, Module, Mux, Signal, Value
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.component import Component
from firm_hdl.registers.axi_lite import WordBusSignature
from firm_hdl.registers.table import WORD_BYTES, RegisterMap

__all__ = ["RegisterBlock"]


class RegisterBlock(Component):
    """Hold the registers of a map.

    What is written is on the outputs in the cycle after the write. Writing a word that has nothing
    to write, and any use of an address without a register, fails and changes nothing.

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
        # Each register is a case of both switches, so that elaboration takes linear time.
        shown: dict[int, list[tuple[int, Value | int, int]]] = {}
        for name, register, field in self.registers.fields():
            value: Value | int = field.reset
            if field.kind in ("status", "setting", "event"):
                value = getattr(self, name)
            place = shown.setdefault(register.address, [])
            place.append((field.low, value, field.bits))
        m.d.comb += [bus.read_fails.eq(1), bus.write_fails.eq(1)]
        with m.Switch(bus.read_word):
            for address, places in shown.items():
                with m.Case(address // WORD_BYTES):
                    m.d.comb += bus.read_fails.eq(0)
                    m.d.comb += [bus.read_data[low : low + n].eq(v) for low, v, n in places]
        selected: dict[int, Signal] = {}
        with m.Switch(bus.write_word):
            for register in self.registers.registers:
                if register.is_written:
                    here = Signal(name=f"writes_{register.name}")
                    selected[register.address] = here
                    with m.Case(register.address // WORD_BYTES):
                        m.d.comb += [bus.write_fails.eq(0), here.eq(bus.writes)]
        mask = Cat(bit.replicate(8) for bit in bus.write_bytes)
        for name, register, field in self.registers.fields():
            if field.kind not in ("setting", "pulse", "event"):
                continue
            value, bits = getattr(self, name), slice(field.low, field.low + field.bits)
            writes = selected[register.address]
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
