# amaranth: UnusedElaboratable=no
"""Designs with memories, for proofs and for simulations."""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from amaranth.back import rtlil
from amaranth.hdl import ClockDomain, Module, Shape, Value
from amaranth.lib.data import StructLayout
from amaranth.lib.memory import Memory
from amaranth.lib.wiring import Component, In, Member, Out

from tests.vhdl.ghdl import Steps, expected, vectors

__all__ = ["DESIGNS", "WHOLE", "Store", "Stores", "random_stores", "rtlil_of", "simulated"]

PAIR = StructLayout({"low": 3, "high": StructLayout({"flag": 1, "number": 5})})


@dataclass(frozen=True, kw_only=True)
class Store:
    """A memory whose ports are those of the design.

    Attributes
    ----------
    reads : sequence of str
        Domains of the read ports; ``transparent`` is `sync` with a port that sees writes.
    places : sequence of int
        Constant addresses of further asynchronous read ports.
    """

    shape: Any = 8
    depth: int = 8
    init: Sequence[Any] = ()
    reads: Sequence[str] = ("comb",)
    places: Sequence[int] = ()
    writes: int = 1
    granularity: int | None = None

    def ports(self, name: str) -> dict[str, Member]:
        """Return the ports of a design with this memory."""
        write, *reads = self._signatures()
        found: dict[str, Member] = {}
        for number in range(self.writes):
            for member, flow in (("addr", In), ("data", In), ("en", In)):
                found[f"{name}_w{number}_{member}"] = flow(_width(write, member))
        for number, (domain, read) in enumerate(zip(self.reads, reads, strict=True)):
            found[f"{name}_r{number}_addr"] = In(_width(read, "addr"))
            if domain != "comb":
                found[f"{name}_r{number}_en"] = In(1)
            found[f"{name}_r{number}_data"] = Out(_width(read, "data"))
        for place in self.places:
            found[f"{name}_at{place}_data"] = Out(_width(write, "data"))
        return found

    def _signatures(self) -> list[Any]:
        memory = self._memory()
        write = memory.write_port(granularity=self.granularity).signature
        return [write, *(memory.read_port(domain="comb").signature for _ in self.reads)]

    def _memory(self) -> Memory:
        return Memory(shape=self.shape, depth=self.depth, init=self.init)

    def add(self, m: Module, name: str, outside: Any) -> None:
        """Add the memory to a module, and connect its ports to those of a component."""
        memory = self._memory()
        m.submodules[name] = memory
        writes = []
        for number in range(self.writes):
            port = memory.write_port(granularity=self.granularity)
            _connect(m, port, outside, f"{name}_w{number}")
            writes.append(port)
        for number, domain in enumerate(self.reads):
            see = writes if domain == "transparent" else []
            domain = domain.replace("transparent", "sync")
            _connect(
                m,
                memory.read_port(domain=domain, transparent_for=see),
                outside,
                f"{name}_r{number}",
            )
        for place in self.places:
            read = memory.read_port(domain="comb")
            m.d.comb += read.addr.eq(place)
            _connect(m, read, outside, f"{name}_at{place}")


def _width(signature: Any, member: str) -> int:
    return Shape.cast(signature.members[member].shape).width


def _connect(m: Module, port: Any, outside: Any, name: str) -> None:
    for member in ("addr", "data", "en"):
        signal = getattr(outside, f"{name}_{member}", None)
        if signal is not None:
            value = Value.cast(getattr(port, member))
            out = outside.signature.members[f"{name}_{member}"].flow is Out
            m.d.comb += signal.eq(value) if out else value.eq(signal)


class Stores(Component):
    """Several memories.

    Parameters
    ----------
    stores : dict of str to Store
        The memories by their names.
    deep : bool
        Whether the memories are in a submodule.
    """

    def __init__(self, stores: dict[str, Store], *, deep: bool = False) -> None:
        self._stores = stores
        self._deep = deep
        ports = [store.ports(name) for name, store in stores.items()]
        super().__init__({name: port for each in ports for name, port in each.items()})

    def elaborate(self, platform: object) -> Module:
        m = inner = Module()
        if self._deep:
            m = Module()
            m.submodules.inner = inner
        for name, store in self._stores.items():
            store.add(inner, name, self)
        return m


# GHDL 2.0 takes a constant for 0 if its last 32 bits are 0; so last words are not 0.
DESIGNS = {
    "asynchronous": {"mem": Store()},
    "two asynchronous ports": {"mem": Store(reads=("comb", "comb"), depth=16, shape=3)},
    "one bit": {"mem": Store(shape=1, depth=16)},
    "60 bits": {"mem": Store(shape=60, depth=16)},
    "a structure": {"mem": Store(shape=PAIR, init=[{"low": 5}] * 8)},
    "odd depth": {"mem": Store(depth=5, init=[1, 2, 3], places=[4, 5])},
    "one word": {"mem": Store(depth=1, reads=("comb", "sync"))},
    "lanes": {"mem": Store(granularity=2, init=range(8))},
    "synchronous": {"mem": Store(reads=("sync", "comb"), init=range(8))},
    "transparent": {"mem": Store(reads=("transparent",), granularity=4, depth=5)},
    "two write ports": {"mem": Store(writes=2, depth=4, reads=("comb", "transparent"))},
    "contents alone": {"mem": Store(writes=0, init=[1, 2, 3], depth=6, reads=("comb", "sync"))},
    "several": {
        "mem": Store(shape=4, depth=3),
        "data": Store(shape=4, depth=2, init=[3, 9]),
        "signal": Store(shape=4, depth=3),
    },
}
"""Memories by their names."""


def random_stores(seed: int) -> dict[str, Store]:
    """Choose one or two memories at random."""
    chosen = random.Random(seed)
    stores = {}
    for name in ("mem", "other")[: chosen.randint(1, 2)]:
        width, depth = chosen.choice([1, 2, 3, 6, 8, 11]), chosen.choice([1, 2, 3, 4, 5, 7, 8, 9])
        stores[name] = Store(
            shape=width,
            depth=depth,
            init=[*(chosen.getrandbits(width) for _ in range(depth - 1)), 1],
            reads=[chosen.choice(["comb", "sync", "transparent"]) for _ in range(2)],
            places=chosen.sample(range(depth), chosen.randint(0, 1)),
            writes=chosen.randint(0, 2),
            granularity=chosen.choice([n for n in range(1, width + 1) if width % n == 0]),
        )
    return stores


WHOLE = [
    name
    for name, stores in DESIGNS.items()
    if all(store.depth & (store.depth - 1) == 0 for store in stores.values())
]
"""Designs without an address beyond the last word."""


def rtlil_of(stores: dict[str, Store], *, deep: bool = False) -> str:
    """Return memories as RTLIL, on request in a submodule."""
    text: str = rtlil.convert(Stores(stores, deep=deep), name="stores", emit_src=False)
    return text


def simulated(
    stores: dict[str, Store], *, steps: int, seed: int
) -> tuple[dict[str, int], dict[str, int], Steps, Steps]:
    """Simulate memories in Amaranth's simulator with random inputs.

    Returns
    -------
    inputs, outputs, steps, wanted
        Widths of inputs and outputs by name, the inputs of each step, and the outputs after it.
    """
    m = Module()
    m.submodules.dut = dut = Stores(stores)
    m.domains.sync = sync = ClockDomain()
    values = {"clk": sync.clk, "rst": sync.rst}
    outputs = {}
    for name, member in dut.signature.members.items():
        (outputs if member.flow is Out else values)[name] = getattr(dut, name)
    widths = {name: len(value) for name, value in values.items()}
    # Amaranth 0.5's simulator resets the registers of read ports, its netlist does not.
    stimuli = vectors(widths, ["clk"], steps=steps, seed=seed, rare=0)
    wanted = expected(m, values, outputs, stimuli)
    return widths, {name: len(value) for name, value in outputs.items()}, stimuli, wanted
