"""Read Amaranth's RTLIL through Yosys, as a flat circuit."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from itertools import count
from pathlib import Path
from typing import Any

from firm_hdl.equivalence.circuit import Bit, Bits, Cell, Circuit, Flop, ProofError
from firm_hdl.equivalence.gates import divided
from firm_hdl.equivalence.match import word_name
from firm_hdl.equivalence.memories import MemoryCircuit, memory_of
from firm_hdl.equivalence.tools import Tools, answer_of

__all__ = ["read_rtlil"]

# Processes become multiplexers, nothing is simplified, and simulation messages are deleted.
_SCRIPT = (
    "read_rtlil {name}.il; hierarchy -check; delete t:$print t:$check; proc -noopt -norom; "
    "flatten; write_json {name}.json"
)
_DIVISIONS = frozenset("$div $mod $divfloor $modfloor".split())
_REFUSED = frozenset("$tribuf $anyseq $anyconst $allseq $allconst $initstate".split())
# Cells of registers and memories that Amaranth does not print, but Yosys can make of others.
_STATE = re.compile(r"\$(\w*dff\w*|ff|sr|mem\w*)")


def read_rtlil(text: str, tools: Tools, folder: Path, timeout: float | None) -> Circuit:
    """Read a design.

    * `text`: RTLIL, as `amaranth.back.rtlil.convert` returns it.
    * `folder`: folder for temporary files.
    """
    (folder / "amaranth.il").write_text(text, encoding="utf-8")
    tools.run_yosys(folder, _SCRIPT.format(name="amaranth"), timeout)
    found = json.loads(answer_of("Yosys", folder / "amaranth.json"))
    tops = [m for m in found["modules"].values() if int(m["attributes"].get("top", "0"), 2)]
    if len(tops) != 1:
        raise ProofError(f"the RTLIL has {len(tops)} outermost modules")
    return _Reader(tops[0]).circuit()


def _path(name: str, item: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the path of a wire or memory of the flattened design."""
    return tuple(item["attributes"].get("hdlname", name).split(" "))


class _Reader:
    def __init__(self, module: Mapping[str, Any]) -> None:
        self._module = module
        self._nets = module["netnames"]
        used = [bit for net in self._nets.values() for bit in net["bits"]]
        used += [
            bit
            for cell in module["cells"].values()
            for bits in cell["connections"].values()
            for bit in bits
        ]
        self._numbers = count(max((bit for bit in used if isinstance(bit, int)), default=1) + 1)

    def circuit(self) -> Circuit:
        ports: dict[str, dict[str, Bits]] = {"input": {}, "output": {}}
        for name, port in self._module["ports"].items():
            if port["direction"] not in ports:
                raise ProofError(f"{name} is a port of mode inout, which a proof does not support")
            if port["bits"]:
                ports[port["direction"]][name] = self._bits(port["bits"])
        cells: list[Cell] = []
        flops: dict[int, Flop] = {}
        inits = self._inits()
        memories = self._memories()
        for memory in memories.values():
            cells += memory.cells
            flops.update(memory.flops)
        for name, cell in self._module["cells"].items():
            if cell["type"] in ("$dff", "$adff"):
                flops.update(self._flops(cell, inits))
            elif memory_of(cell) is None:
                cells += self._cell(name, cell)
        return Circuit(
            inputs=ports["input"],
            outputs=ports["output"],
            signals=self._signals(flops, memories),
            cells=cells,
            flops=flops,
        )

    def _fresh(self, width: int) -> tuple[int, ...]:
        return tuple(next(self._numbers) for _ in range(width))

    def _bits(self, bits: Sequence[Bit]) -> Bits:
        """Replace each undefined bit by a new net, which may have any value."""
        return tuple(
            bit if isinstance(bit, int) or bit in ("0", "1") else next(self._numbers)
            for bit in bits
        )

    def _inits(self) -> dict[int, str]:
        """Return initial values by net."""
        inits: dict[int, str] = {}
        for name, net in self._nets.items():
            init = net["attributes"].get("init")
            if init is None:
                continue
            for bit, value in zip(net["bits"], reversed(init), strict=True):
                if not isinstance(bit, int) or inits.setdefault(bit, value) != value:
                    raise ProofError(f"{name} has an initial value, but is not a register")
        return inits

    def _flops(self, cell: Mapping[str, Any], inits: Mapping[int, str]) -> dict[int, Flop]:
        parameters, ports = cell["parameters"], cell["connections"]
        reset = None
        value = "0" * len(ports["Q"])
        if cell["type"] == "$adff":
            reset = self._bits(ports["ARST"])[0]
            value = parameters["ARST_VALUE"]
        return {
            bit: Flop(
                data=self._bits([data])[0],
                clock=self._bits(ports["CLK"])[0],
                rising=bool(int(parameters["CLK_POLARITY"], 2)),
                init=inits.get(bit, "x"),
                reset=reset,
                reset_level=bool(int(parameters.get("ARST_POLARITY", "1"), 2)),
                reset_value=start,
            )
            for bit, data, start in zip(ports["Q"], ports["D"], reversed(value), strict=True)
        }

    def _memories(self) -> dict[str, MemoryCircuit]:
        """Return the memories by their names in the flattened design."""
        memories = {
            name: MemoryCircuit(name, memory["width"], memory["size"], self._fresh)
            for name, memory in self._module.get("memories", {}).items()
        }
        ports: dict[str, list[Mapping[str, Any]]] = {name: [] for name in memories}
        for cell in self._module["cells"].values():
            owner = memory_of(cell)
            if owner is not None:
                ports[owner].append(cell)
        for name, memory in memories.items():
            if self._module["memories"][name]["start_offset"]:
                raise ProofError(f"memory {name} does not start at address 0")
            memory.add(ports[name], self._bits)
        return memories

    def _signals(
        self, flops: Mapping[int, Flop], memories: Mapping[str, MemoryCircuit]
    ) -> dict[tuple[str, ...], Bits]:
        """Return the registers: wires with an initial value or of a read port, and words."""
        reads = {read for memory in memories.values() for read in memory.reads}
        signals: dict[tuple[str, ...], Bits] = {}
        for name, net in self._nets.items():
            bits = tuple(net["bits"])
            if bits in reads or ("init" in net["attributes"] and all(bit in flops for bit in bits)):
                signals[_path(name, net)] = bits
        for name, memory in memories.items():
            *path, own = _path(name, self._module["memories"][name])
            for place, word in enumerate(memory.words):
                if word and all(bit in flops for bit in word):
                    signals[(*path, word_name(own, place))] = word
        named = {bit for bits in signals.values() for bit in bits}
        for bit in flops:
            if bit not in named:
                raise ProofError(f"a register of the RTLIL has no name (net {bit})")
        return signals

    def _cell(self, name: str, cell: Mapping[str, Any]) -> list[Cell]:
        kind = cell["type"]
        if not kind.startswith("$"):
            raise ProofError(f"the design has an instance of {kind}, which is not in the design")
        if kind in _REFUSED or _STATE.fullmatch(kind):
            raise ProofError(f"the design has {kind}, which a proof does not support")
        ways = cell["port_directions"]
        ports = {port: self._bits(bits) for port, bits in cell["connections"].items()}
        inputs = {port: bits for port, bits in ports.items() if ways[port] == "input"}
        outputs = {port: bits for port, bits in ports.items() if ways[port] == "output"}
        result = tuple(bit for bit in outputs.get("Y", ()) if isinstance(bit, int))
        if kind in _DIVISIONS:
            signed = bool(int(cell["parameters"]["A_SIGNED"], 2))
            return divided(kind, signed, ports["A"], ports["B"], result, self._fresh)
        return [Cell(kind=kind, parameters=cell["parameters"], inputs=inputs, outputs=outputs)]
