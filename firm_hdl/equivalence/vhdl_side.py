"""Read the VHDL through GHDL's dump, as a flat circuit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import count

from firm_hdl.equivalence.circuit import Bit, Bits, Cell, Circuit, Flop, ProofError
from firm_hdl.equivalence.dump import Instance, Module, Net, parse_dump
from firm_hdl.equivalence.gates import Gate, gate_cells, renamed
from firm_hdl.equivalence.match import word_name

__all__ = ["read_vhdl"]

_FLOPS = frozenset("$dff $idff $adff $iadff".split())
_EDGES = {"$posedge": True, "$negedge": False}
_IGNORED = frozenset("$assert $assume $cover $assert_cover".split())


def read_vhdl(dump: str, memories: Mapping[tuple[str, ...], int] | None = None) -> Circuit:
    """Read the outermost entity of a dump.

    * `dump`: output of ``ghdl --synth -dm --out=dump``.
    * `memories`: numbers of words by path of the memory. Words become signals of their own.

    Names are in lower case, because VHDL ignores case.
    """
    return _Flattener(parse_dump(dump), memories or {}).run()


def _words(path: tuple[str, ...], bits: Bits, count: int) -> dict[tuple[str, ...], Bits]:
    """Split a memory into words; in GHDL, the first element of an array has the highest bits."""
    width, rest = divmod(len(bits), count)
    if rest:
        raise ProofError(f"memory {path[-1]} of the VHDL has not {count} words")
    *entity, name = path
    return {
        (*entity, word_name(name, place)): bits[len(bits) - width * (place + 1) :][:width]
        for place in range(count)
    }


class _Flattener:
    def __init__(
        self, modules: Mapping[str, Module], memories: Mapping[tuple[str, ...], int]
    ) -> None:
        self._modules = modules
        self._memories = memories
        self._numbers = count(2)
        # The bits of each net of the dump, by path and number; then the nets that are aliases.
        self._nets: dict[tuple[tuple[str, ...], int], tuple[int, ...]] = {}
        self._aliases: dict[int, Bit] = {}
        self._cells: list[Cell] = []
        self._signals: dict[tuple[str, ...], Bits] = {}
        self._edges: dict[int, tuple[Bit, bool]] = {}
        self._flops: list[tuple[Instance, Mapping[str, Bits], tuple[int, ...]]] = []

    def run(self) -> Circuit:
        tops = set(self._modules)
        for module in self._modules.values():
            tops -= {instance.kind for instance in module.instances}
        if len(tops) != 1:
            raise ProofError(f"GHDL's netlist has {len(tops)} outermost entities")
        top = self._modules[tops.pop()]
        if top.own is None:
            raise ProofError(f"GHDL's netlist has no content of {top.name}")
        self._module(top, ())
        outputs = {name: self._bits((), net) for name, net in top.own.inputs.items()}
        circuit = Circuit(
            inputs={name.lower(): self._net((), net) for name, net in top.own.outputs.items()},
            outputs={name.lower(): self._resolved(bits) for name, bits in outputs.items()},
            signals=self._all_signals(),
            flops=self._all_flops(),
            cells=[
                replace(
                    cell,
                    inputs={port: self._resolved(bits) for port, bits in cell.inputs.items()},
                )
                for cell in self._cells
            ],
        )
        if not circuit.driven.isdisjoint(self._aliases):
            raise ProofError("GHDL's netlist drives a net twice")
        return circuit

    def _all_signals(self) -> dict[tuple[str, ...], Bits]:
        signals: dict[tuple[str, ...], Bits] = {}
        for path, bits in self._signals.items():
            count = self._memories.get(path)
            found = self._resolved(bits)
            signals.update(_words(path, found, count) if count else {path: found})
        return signals

    def _fresh(self, width: int) -> tuple[int, ...]:
        return tuple(next(self._numbers) for _ in range(width))

    def _net(self, path: tuple[str, ...], net: Net) -> tuple[int, ...]:
        """Return the bits of a net; make them at the first use of the net."""
        bits = self._nets.get((path, net.number))
        if bits is None:
            bits = self._nets[path, net.number] = self._fresh(net.width)
        if len(bits) != net.width:
            raise ProofError(f"GHDL's net {net.number} has two widths")
        return bits

    def _bits(self, path: tuple[str, ...], net: Net) -> Bits:
        return self._net(path, net)

    def _resolved(self, bits: Bits) -> Bits:
        return tuple(self._root(bit) for bit in bits)

    def _root(self, bit: Bit) -> Bit:
        """Follow aliases to the driven net or constant."""
        seen: list[int] = []
        while isinstance(bit, int) and bit in self._aliases:
            seen.append(bit)
            bit = self._aliases[bit]
            if len(seen) > len(self._aliases):
                raise ProofError("a signal of the VHDL is defined by itself")
        for name in seen:
            self._aliases[name] = bit
        return bit

    def _alias(self, names: tuple[int, ...], bits: Bits) -> None:
        if len(names) != len(bits):
            raise ProofError("GHDL's netlist connects nets of different widths")
        for name, bit in zip(names, bits, strict=True):
            if name in self._aliases:
                raise ProofError(f"GHDL's netlist drives a net twice ({name})")
            self._aliases[name] = bit

    def _module(self, module: Module, path: tuple[str, ...]) -> None:
        for instance in module.instances:
            if instance.kind.startswith("$"):
                self._gate(instance, path)
            else:
                self._submodule(instance, path)

    def _submodule(self, instance: Instance, path: tuple[str, ...]) -> None:
        module = self._modules.get(instance.kind)
        if module is None or module.own is None:
            raise ProofError(
                f"the VHDL has an instance of {instance.kind}, which is not in the design"
            )
        inner = (*path, instance.name.lower())
        own = module.own
        if list(instance.inputs) != list(own.outputs) or list(instance.outputs) != list(own.inputs):
            raise ProofError(f"GHDL's instance {instance.name} does not fit its module")
        for port, net in instance.inputs.items():
            self._alias(self._net(inner, own.outputs[port]), self._bits(path, net))
        for port, net in instance.outputs.items():
            self._alias(self._net(path, net), self._bits(inner, own.inputs[port]))
        self._module(module, inner)

    def _gate(self, instance: Instance, path: tuple[str, ...]) -> None:
        if instance.kind in _IGNORED:
            return
        if len(instance.outputs) != 1:
            raise ProofError(f"GHDL's netlist has {instance.kind}, which a proof does not support")

        (net,) = instance.outputs.values()
        output = self._net(path, net)
        inputs = {port: self._bits(path, each) for port, each in instance.inputs.items()}
        if instance.kind in _FLOPS:
            self._flops.append((instance, inputs, output))
            return
        if instance.kind in _EDGES:
            self._edges[output[0]] = (inputs["i"][0], _EDGES[instance.kind])
            return
        gate = Gate(instance, inputs, net.width, self._fresh)
        same = renamed(gate)
        if same is None:
            self._cells += gate_cells(gate, output)
            return
        self._alias(output, same)
        if instance.kind in ("$signal", "$isignal", "$output", "$ioutput"):
            name = (*path, instance.name.lower())
            if name in self._signals:
                raise ProofError(f"GHDL's netlist has two signals {instance.name}")
            self._signals[name] = output

    def _all_flops(self) -> dict[int, Flop]:
        flops: dict[int, Flop] = {}
        for instance, inputs, output in self._flops:
            clock = self._root(inputs["clk"][0])
            if clock not in self._edges:
                raise ProofError(f"a register of the VHDL has no clock edge ({instance.name})")
            source, rising = self._edges[int(clock)]
            found = {port: self._resolved(bits) for port, bits in inputs.items()}
            reset = found["rst"][0] if "rst" in found else None
            for place, bit in enumerate(output):
                init = found["init"][place] if "init" in found else "x"
                value = found["rst_val"][place] if "rst_val" in found else "0"
                if not isinstance(value, str):
                    raise ProofError("an asynchronous reset of the VHDL has no constant value")
                flops[bit] = Flop(
                    data=found["d"][place],
                    clock=self._root(source),
                    rising=rising,
                    init=init if isinstance(init, str) else "x",
                    reset=reset,
                    reset_value=value,
                )
        return flops
