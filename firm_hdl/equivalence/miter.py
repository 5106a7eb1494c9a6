"""The miter: two circuits combined to one whose outputs are 1 where the two differ.

The proof is by induction over clock edges: the registers start equal; and if all registers are
equal, then all outputs and all next states are equal. Registers become inputs that both circuits
share, and their next states become outputs. One combinational question remains: can any output of
the combined circuit ever be 1?
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from firm_hdl.equivalence.circuit import Bit, Bits, Cell, Circuit, Flop, ProofError

__all__ = ["Claim", "Miter", "make_miter"]

Path = tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """Two values that must be equal."""

    what: str  # Description, such as `output m_axis_tvalid` or `next state of core.step`.
    # The values on the two sides.
    amaranth: Bits
    vhdl: Bits


@dataclass(frozen=True, slots=True, kw_only=True)
class Miter:
    """A combined circuit."""

    # Differences that need no solver, such as a missing register or another initial value.
    differences: tuple[str, ...]
    claims: tuple[Claim, ...]  # The claims to be proved.
    # Inputs and registers by name, and `anything`: nets that neither side drives.
    inputs: Mapping[str, Bits]
    cells: list[Cell]
    # Registers that only one side has. They may have any value at any time.
    unmatched: tuple[str, ...]
    registers: int  # Number of register bits that both sides have.

    def netlist(self, *, values: bool) -> dict[str, Any]:
        """Return the circuit in the JSON format of Yosys.

        The inputs are called ``in0`` and so on; claim n is bit n of the output ``differs``.

        * `values`: add outputs with the values of both sides of each claim, ``amaranth0`` and
          ``vhdl0``.
        """
        cells: dict[str, Any] = {}
        net = max(
            (bit for bits in self._all_bits() for bit in bits if isinstance(bit, int)), default=1
        )
        ports: dict[str, Any] = {
            f"in{number}": {"direction": "input", "bits": list(bits)}
            for number, bits in enumerate(self.inputs.values())
        }
        outputs = []
        for number, claim in enumerate(self.claims):
            net += 1
            outputs.append(net)
            cells[f"claim{number}"] = _compare(claim, net)
            if values:
                for side, bits in (("amaranth", claim.amaranth), ("vhdl", claim.vhdl)):
                    ports[f"{side}{number}"] = {"direction": "output", "bits": list(bits)}
        for number, cell in enumerate(self.cells):
            cells[f"cell{number}"] = _json(cell)
        ports["differs"] = {"direction": "output", "bits": outputs}
        module = {"attributes": {"top": 1}, "ports": ports, "cells": cells, "netnames": {}}
        return {"creator": "firm-hdl", "modules": {"miter": module}}

    def _all_bits(self) -> Iterator[Bits]:
        # Include all nets that cells read: a cell reads only inputs and outputs of cells.
        yield from self.inputs.values()
        for cell in self.cells:
            yield from cell.outputs.values()


def _compare(claim: Claim, output: int) -> dict[str, Any]:
    width = len(claim.amaranth)
    parameters = {"A_WIDTH": width, "B_WIDTH": width, "Y_WIDTH": 1, "A_SIGNED": 0, "B_SIGNED": 0}
    inputs = {"A": claim.amaranth, "B": claim.vhdl}
    return _json(Cell(kind="$ne", parameters=parameters, inputs=inputs, outputs={"Y": (output,)}))


def _json(cell: Cell) -> dict[str, Any]:
    directions = {**dict.fromkeys(cell.inputs, "input"), **dict.fromkeys(cell.outputs, "output")}
    return {
        "type": cell.kind,
        "parameters": dict(cell.parameters),
        "port_directions": directions,
        "connections": {
            port: list(bits) for port, bits in [*cell.inputs.items(), *cell.outputs.items()]
        },
    }


def make_miter(
    amaranth: Circuit,
    vhdl: Circuit,
    *,
    ports: Mapping[str, str],
    signals: Mapping[Path, Path],
) -> Miter:
    """Combine two circuits.

    * `ports`: names of ports in VHDL by Amaranth's.
    * `signals`: paths of signals in VHDL by those in the RTLIL.
    """
    return _Maker(amaranth, vhdl, ports, signals).run()


class _Maker:
    def __init__(
        self,
        amaranth: Circuit,
        vhdl: Circuit,
        ports: Mapping[str, str],
        signals: Mapping[Path, Path],
    ) -> None:
        self._amaranth = amaranth
        self._offset = 1 + max(
            (bit for bit in _all_nets(amaranth) if isinstance(bit, int)), default=1
        )
        self._vhdl = _shifted(vhdl, self._offset)
        self._ports = {name: vhdl_name.lower() for name, vhdl_name in ports.items()}
        self._signals = signals
        # Nets of either side that the combined circuit replaces, with their replacement.
        self._aliases: dict[int, Bit] = {}
        self._inputs: dict[str, Bits] = {}
        self._claims: list[tuple[str, Bits, Bits]] = []
        self._differences: list[str] = []
        self._unmatched: list[str] = []
        self._registers = 0

    def run(self) -> Miter:
        self._match_ports()
        paired = self._match_registers()
        self._inputs.update(self._unpaired_registers(paired))
        claims = tuple(
            Claim(what=what, amaranth=self._named(left), vhdl=self._named(right))
            for what, left, right in self._claims
        )
        if not claims and not self._differences:
            raise ProofError("neither side has an output or a register: there is nothing to prove")
        cells = [self._renamed(cell) for cell in [*self._amaranth.cells, *self._vhdl.cells]]
        self._inputs["anything"] = self._undriven(cells, claims)
        return Miter(
            differences=tuple(self._differences),
            claims=tuple(claim for claim in claims if claim.amaranth != claim.vhdl),
            inputs={name: bits for name, bits in self._inputs.items() if bits},
            cells=cells,
            unmatched=tuple(self._unmatched),
            registers=self._registers,
        )

    def _match_ports(self) -> None:
        for what, ours, theirs in (
            ("input", self._amaranth.inputs, self._vhdl.inputs),
            ("output", self._amaranth.outputs, self._vhdl.outputs),
        ):
            named = {self._ports.get(name, name): (name, bits) for name, bits in ours.items()}
            for name in [*named, *theirs]:
                if name not in named or name not in theirs:
                    self._differences.append(f"only one side has the {what} {name}")
                elif len(named[name][1]) != len(theirs[name]):
                    self._differences.append(f"the {what} {name} has two widths")
            for vhdl_name, (name, bits) in named.items():
                if len(theirs.get(vhdl_name, ())) != len(bits):
                    continue
                if what == "input":
                    self._inputs[f"input {name}"] = bits
                    self._aliases.update(zip(_nets(theirs[vhdl_name]), bits, strict=True))
                else:
                    self._claims.append((f"output {name}", bits, theirs[vhdl_name]))

    def _match_registers(self) -> set[int]:
        """Match registers bit by bit; return the nets of those that have a partner."""
        paired: set[int] = set()
        for path, bits in self._amaranth.signals.items():
            name = ".".join(path)
            vhdl_path = self._signals.get(path)
            found = self._vhdl.signals.get(vhdl_path) if vhdl_path is not None else None
            if found is None or len(found) != len(bits):
                continue
            self._register(name, _nets(bits), found, paired)
        return paired

    def _register(self, name: str, bits: tuple[int, ...], found: Bits, paired: set[int]) -> None:
        ours, theirs = self._amaranth.flops, self._vhdl.flops
        left: list[Bit] = []
        right: list[Bit] = []
        shared: list[Bit] = []
        for bit, other in zip(bits, found, strict=True):
            if isinstance(other, str):
                # On the VHDL side, a register that never changes may be a constant.
                if ours[bit].init not in ("x", other):
                    self._differences.append(f"{name} starts with another value")
                if ours[bit].reset is not None and ours[bit].reset_value != other:
                    self._differences.append(f"{name} has another asynchronous reset")
                self._aliases[bit] = other
                right.append(other)
            elif other in theirs:
                self._aliases[other] = bit
                paired.add(other)
                self._compare(name, ours[bit], theirs[other])
                shared += [] if bit in paired else [bit]
                right.append(theirs[other].data)
            else:
                self._differences.append(f"{name} is not a register in the VHDL")
                return
            left.append(ours[bit].data)
            self._registers += bit not in paired
            paired.add(bit)
        self._inputs[f"register {name}"] = tuple(shared)
        self._claims.append((f"next state of {name}", tuple(left), tuple(right)))

    def _compare(self, name: str, ours: Flop, theirs: Flop) -> None:
        if ours.init not in ("x", theirs.init):
            self._differences.append(f"{name} starts with another value")
        if ours.rising != theirs.rising:
            self._differences.append(f"{name} changes at the other edge of its clock")
        self._claims.append((f"clock of {name}", (ours.clock,), (theirs.clock,)))
        if (ours.reset is None) != (theirs.reset is None):
            self._differences.append(f"{name} has an asynchronous reset on one side only")
        elif ours.reset is not None and theirs.reset is not None:
            if (ours.reset_value, ours.reset_level) != (theirs.reset_value, theirs.reset_level):
                self._differences.append(f"{name} has another asynchronous reset")
            self._claims.append((f"reset of {name}", (ours.reset,), (theirs.reset,)))

    def _unpaired_registers(self, paired: set[int]) -> dict[str, Bits]:
        """Return registers without a partner; they may have any value, as if they were inputs."""
        unpaired: dict[str, Bits] = {}
        for side, circuit in (("Amaranth", self._amaranth), ("VHDL", self._vhdl)):
            rest = dict.fromkeys(bit for bit in circuit.flops if bit not in paired)
            for path, bits in circuit.signals.items():
                mine = tuple(bit for bit in bits if isinstance(bit, int) and bit in rest)
                if mine:
                    unpaired[f"register {'.'.join(path)} of the {side} alone"] = mine
                    for bit in mine:
                        del rest[bit]
            if rest:
                unpaired[f"registers without a name of the {side} alone"] = tuple(rest)
        self._unmatched += unpaired
        return unpaired

    def _named(self, bits: Bits) -> Bits:
        return tuple(self._root(bit) for bit in bits)

    def _root(self, bit: Bit) -> Bit:
        while isinstance(bit, int) and bit in self._aliases:
            bit = self._aliases[bit]
        return bit

    def _renamed(self, cell: Cell) -> Cell:
        inputs = {port: self._named(bits) for port, bits in cell.inputs.items()}
        return replace(cell, inputs=inputs)

    def _undriven(self, cells: list[Cell], claims: tuple[Claim, ...]) -> Bits:
        """Return the nets that are read and have no driver; they may have any value."""
        driven = {bit for bits in self._inputs.values() for bit in bits}
        for cell in cells:
            for bits in cell.outputs.values():
                for bit in bits:
                    if bit in driven or not isinstance(bit, int):
                        raise ProofError(f"net {bit} has two drivers")
                    driven.add(bit)
        read = [bit for cell in cells for bits in cell.inputs.values() for bit in bits]
        read += [bit for claim in claims for bit in (*claim.amaranth, *claim.vhdl)]
        return tuple(dict.fromkeys(b for b in read if isinstance(b, int) and b not in driven))


def _all_nets(circuit: Circuit) -> Iterator[Bit]:
    for bits in (*circuit.inputs.values(), *circuit.outputs.values(), *circuit.signals.values()):
        yield from bits
    for cell in circuit.cells:
        for bits in (*cell.inputs.values(), *cell.outputs.values()):
            yield from bits
    for bit, flop in circuit.flops.items():
        yield from (bit, flop.data, flop.clock, *(() if flop.reset is None else (flop.reset,)))


def _nets(bits: Bits) -> tuple[int, ...]:
    result = tuple(bit for bit in bits if isinstance(bit, int))
    if len(result) != len(bits):
        raise ProofError("a port or register has a constant in place of a net")
    return result


def _shifted(circuit: Circuit, offset: int) -> Circuit:
    """Renumber all nets."""

    def one(bit: Bit) -> Bit:
        return bit + offset if isinstance(bit, int) else bit

    def many(bits: Bits) -> Bits:
        return tuple(bit + offset if isinstance(bit, int) else bit for bit in bits)

    def each(named: Mapping[Any, Bits]) -> dict[Any, Bits]:
        return {name: many(bits) for name, bits in named.items()}

    return Circuit(
        inputs=each(circuit.inputs),
        outputs=each(circuit.outputs),
        signals=each(circuit.signals),
        cells=[
            replace(cell, inputs=each(cell.inputs), outputs=each(cell.outputs))
            for cell in circuit.cells
        ],
        flops={
            bit + offset: replace(
                flop,
                data=one(flop.data),
                clock=one(flop.clock),
                reset=None if flop.reset is None else one(flop.reset),
            )
            for bit, flop in circuit.flops.items()
        },
    )
