# amaranth: UnusedElaboratable=no
"""Designs with memories, and ways to break them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from amaranth.back import rtlil
from amaranth.hdl import Module, Signal, Value
from amaranth.lib.data import StructLayout
from amaranth.lib.memory import Memory

__all__ = ["DESIGNS", "Store", "rtlil_of"]

PAIR = StructLayout({"low": 3, "high": StructLayout({"flag": 1, "number": 5})})


@dataclass(frozen=True, kw_only=True)
class Store:
    """A memory whose ports are those of the design.

    Attributes
    ----------
    reads : sequence of str
        Domains of the read ports, in which ``transparent`` is `sync` and sees what is written.
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

    def add(self, m: Module, name: str) -> list[Signal]:
        """Add the memory to a module; return its ports."""
        memory = Memory(shape=self.shape, depth=self.depth, init=self.init)
        m.submodules[name] = memory
        ports: list[Signal] = []
        writes = []
        for number in range(self.writes):
            write = memory.write_port(granularity=self.granularity)
            self._connect(m, ports, write, f"{name}_w{number}", ("addr", "data", "en"), ())
            writes.append(write)
        for number, domain in enumerate(self.reads):
            see = writes if domain == "transparent" else []
            read = memory.read_port(
                domain=domain.replace("transparent", "sync"), transparent_for=see
            )
            inputs = ("addr",) if domain == "comb" else ("addr", "en")
            self._connect(m, ports, read, f"{name}_r{number}", inputs, ("data",))
        for place in self.places:
            read = memory.read_port(domain="comb")
            m.d.comb += read.addr.eq(place)
            self._connect(m, ports, read, f"{name}_at{place}", (), ("data",))
        return ports

    def _connect(
        self,
        m: Module,
        ports: list[Signal],
        port: Any,
        name: str,
        inputs: Sequence[str],
        outputs: Sequence[str],
    ) -> None:
        for member in (*inputs, *outputs):
            value = Value.cast(getattr(port, member))
            signal = Signal(len(value), name=f"{name}_{member}")
            m.d.comb += value.eq(signal) if member in inputs else signal.eq(value)
            ports.append(signal)


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


def rtlil_of(stores: dict[str, Store], *, deep: bool = False) -> str:
    """Give memories as RTLIL, on request in a module of their own."""
    m = Module()
    ports = [port for name, store in stores.items() for port in store.add(m, name)]
    if deep:
        inner, m = m, Module()
        m.submodules.inner = inner
    text: str = rtlil.convert(m, name="stores", ports=ports, emit_src=False)
    return text
