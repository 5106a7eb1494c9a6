# amaranth: UnusedElaboratable=no
"""The Verilog of designs that are not firm-hdl's own, in Icarus Verilog in the mode of cocotb."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from amaranth.hdl import Cat, Format, Instance, Module, Print, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl import (
    Deserializer,
    PacketCrossing,
    PacketFifo,
    PacketSignature,
    Serializer,
    load_message,
)
from firm_hdl.plan import build_plan, encode
from firm_hdl.sim import to_transfers
from firm_hdl.sim.payloads import packet_beats
from firm_hdl.verilog import convert
from firm_hdl.wire import lay_out
from tests.verilog.icarus import replay, simulate
from tests.vhdl.ghdl import difference, expected, vectors
from tests.vhdl.random_designs import RandomDesign

POINT, TEXT = load_message("geometry_msgs/msg/Point"), load_message("std_msgs/msg/String")
TYPES = {"a": (POINT, 8), "b": (TEXT, 4)}


class Relay(wiring.Component):
    """Packets of two types become messages and packets again, and leave in another clock domain."""

    def __init__(self) -> None:
        super().__init__(
            {
                f"{name}_{way}": flow(PacketSignature(bus_bytes))
                for name, (_, bus_bytes) in TYPES.items()
                for way, flow in (("in", In), ("out", Out))
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        for name, (message, bus) in TYPES.items():
            m.submodules[f"rx_{name}"] = rx = Deserializer(message, bus_bytes=bus)
            m.submodules[f"tx_{name}"] = tx = Serializer(message, bus_bytes=bus)
            crossing = PacketCrossing(bus, write_domain="sync", read_domain="slow")
            m.submodules[f"crossing_{name}"] = crossing
            wiring.connect(m, wiring.flipped(getattr(self, f"{name}_in")), rx.packets)
            wiring.connect(m, rx.message, tx.message)
            wiring.connect(m, tx.packets, crossing.packets_in)
            wiring.connect(m, crossing.packets_out, wiring.flipped(getattr(self, f"{name}_out")))
            m.d.comb += [rx.status.ready.eq(1), tx.status.ready.eq(1)]
        return m


def beats_of(name: str, values: list[Any]) -> list[int]:
    message, bus_bytes = TYPES[name]
    plan = build_plan(lay_out(message), bus_bytes=bus_bytes)
    packets = (encode(plan, to_transfers(plan, message, value))[0] for value in values)
    return [beat for packet in packets for beat in packet_beats(packet, bus_bytes)]


SENDER = """
  reg [{width}:0] {name}_beats [0:{count}-1];
  integer {name}_at = 0;
  wire {name}_ready, {name}_came;
  wire {name}_valid = {name}_at < {count} && !rst;
  wire [{width}:0] {name}_out;
  initial begin {beats} end
  always @(posedge clk) if ({name}_valid && {name}_ready) {name}_at <= {name}_at + 1;
  always @(posedge slow_clk) if ({name}_came) $display("{name} %h", {name}_out);
"""
PORTS = """, .{name}_in__payload({name}_beats[{name}_at]), .{name}_in__valid({name}_valid),
  .{name}_in__ready({name}_ready), .{name}_out__payload({name}_out),
  .{name}_out__valid({name}_came), .{name}_out__ready(1'b1)"""


@pytest.mark.usefixtures("iverilog")
@pytest.mark.parametrize("standard", ["-g2005", "-g2012"])
@pytest.mark.sampled(2)
def test_converters_in_a_design_of_two_types_and_two_clocks(standard: str, tmp_path: Path) -> None:
    sent = {
        "a": beats_of("a", [dict.fromkeys("xyz", 0.5 * k) for k in range(175)]),
        "b": beats_of("b", [{"data": "é" * (k % 7)} for k in range(30)]),
    }
    assert len(sent["a"]) == 700
    bench, ports = "", ""
    for name, beats in sent.items():
        width = 8 * TYPES[name][1] + TYPES[name][1].bit_length()
        stores = " ".join(f"{name}_beats[{n}] = {width + 1}'h{b:x};" for n, b in enumerate(beats))
        bench += SENDER.format(name=name, width=width, count=len(beats), beats=stores)
        ports += PORTS.format(name=name)
    # A second design in the same text: no two modules have one name.
    text = convert(Relay(), name="relay") + convert(PacketFifo(8, 64, 2), name="fifo")
    modules = re.findall(r"^module (\S+?)\s*\(", text, re.MULTILINE)
    assert len(set(modules)) == len(modules) and {"relay", "fifo"} <= set(modules)
    text += f"""
module bench;
  reg clk = 0, slow_clk = 0, rst = 1;
  always #5 clk = !clk;
  always #7 slow_clk = !slow_clk;
  initial begin #100 rst = 0; #20000 $finish; end
{bench}
  relay dut(.clk(clk), .rst(rst), .slow_clk(slow_clk), .slow_rst(rst){ports});
endmodule
"""
    lines = [line.split() for line in simulate(text, standard, tmp_path)]
    for name, beats in sent.items():
        assert [int(row[1], 16) for row in lines if row[0] == name] == beats


@pytest.mark.usefixtures("iverilog")
@pytest.mark.parametrize("seed", [5, 8, 14, 15, 40, 59])
@pytest.mark.sampled(6)
def test_any_design_behaves_as_in_amaranth(seed: int, tmp_path: Path) -> None:
    written, simulated = RandomDesign(seed), RandomDesign(seed)
    inputs = {signal.name: signal for signal in simulated.inputs}
    outputs = {signal.name: signal for signal in simulated.outputs}
    widths = {name: len(signal) for name, signal in inputs.items()}
    clocks = [clock.name for clock in simulated.clocks]
    steps = vectors(widths, clocks, steps=100, seed=seed)
    want = expected(simulated, inputs, outputs, steps)
    text = convert(written, name="dut", ports=written.ports)
    lengths = {name: len(signal) for name, signal in outputs.items()}
    rows = replay(text, "dut", widths, lengths, steps, "-g2012", tmp_path)
    # What was read beyond the last word of a memory is not known.
    got = [{name: int(bits, 2) for name, bits in row.items() if "x" not in bits} for row in rows]
    assert sum(map(len, got)) > 0.9 * sum(map(len, rows))
    known = [{name: row[name] for name in seen} for row, seen in zip(want, got, strict=True)]
    assert difference(known, got) is None


class Foreign(wiring.Component):
    """A module that others write, with keywords as names; ports with names that VHDL reserves."""

    def __init__(self) -> None:
        super().__init__({"out": Out(1), "next": In(1), "wait": In(1), "reg": In(1)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        inner = Signal(name="signal", attrs={"keep": 1, "ASYNC_REG": "TRUE"})
        m.submodules.process = Instance(
            "begin", p_WAIT=3, i_IN=self.next, i_reg=self.reg, o_out=inner
        )
        m.d.sync += [self.out.eq(inner), Print(Format("saw {}", self.wait))]
        return m


def test_names_of_others_and_attributes_stay() -> None:
    text = convert(Foreign(), name="foreign", header="Mine.")
    assert text.startswith("// Mine.\n")
    ports = re.findall(r"^  (?:in|out)put wire +(\w+),?$", text, re.MULTILINE)
    assert ports == ["clk", "rst", "next", "wait_sig", "reg_sig", "out"]
    assert '  (* keep = 1 *)\n  (* ASYNC_REG = "TRUE" *)\n  wire signal_sig;' in text
    for part in ("  \\begin  #(.WAIT(3)) process_sig (", ".IN    (next)", ".\\reg  (reg_sig)"):
        assert part in text
    assert '$write("saw %0d\\n"' in text


@pytest.mark.parametrize(
    ("design", "options", "error"),
    [
        (PacketFifo, {}, "TypeError: A design must be an Amaranth component .*, not <class"),
        (POINT, {}, "TypeError: A design must be an Amaranth component"),
        (Module(), {}, "TypeError: .* is no component .*, so its ports must be given"),
        ("module top;", {}, "ValueError: RTLIL line 1: expected a module"),
        (Foreign(), {"name": 1}, "TypeError: Name of a design must be a text, not 1"),
        (Foreign(), {"name": "my design"}, "ValueError: Name .* must be one word, not 'my design'"),
        (Foreign(), {"name": "2nd"}, "ValueError: .* identifier of SystemVerilog, not '2nd'"),
        (Foreign(), {"name": "module"}, "ValueError: .* identifier of SystemVerilog, not 'module'"),
    ],
)
def test_what_cannot_be_converted_is_refused(design: Any, options: Any, error: str) -> None:
    kind, _, text = error.partition(": ")
    with pytest.raises((TypeError, ValueError), match=text) as raised:
        convert(design, **options)
    assert type(raised.value).__name__ == kind


class Shifted(wiring.Component):
    """The low bits of a shifted value, which an operator reads."""

    def __init__(self) -> None:
        super().__init__({"a": In(8), "n": In(3), "c": In(4), "same": Out(1), "both": Out(8)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.d.comb += self.same.eq((self.a >> self.n)[:4] == self.c)
        m.d.comb += self.both.eq(Cat((self.a >> self.c[:2])[:4], self.c))
        return m


@pytest.mark.usefixtures("iverilog")
def test_what_is_read_of_a_shifted_value_has_no_more_bits(tmp_path: Path) -> None:
    widths, steps = (
        {"a": 8, "n": 3, "c": 4},
        [{"a": 0xA5, "n": 1, "c": 2}, {"a": 0xF3, "n": 2, "c": 12}],
    )
    got = replay(
        convert(Shifted()), "top", widths, {"same": 1, "both": 8}, steps, "-g2005", tmp_path
    )
    assert [int(row["same"], 2) for row in got] == [1, 1]
    want = [s["a"] >> s["c"] % 4 & 15 | s["c"] << 4 for s in steps]
    assert [int(row["both"], 2) for row in got] == want
