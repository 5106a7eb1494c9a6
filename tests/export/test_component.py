# amaranth: UnusedElaboratable=no
"""Components of users as files: ports like those of converters, records and structs of messages."""

from __future__ import annotations

import json
import shutil
import subprocess

import pytest
from amaranth.hdl import Module, Signal
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out, connect, flipped
from amaranth.sim import Simulator

from firm_hdl import (
    AxiStreamSignature,
    Deserializer,
    MessageSignature,
    PacketCrossing,
    PacketSignature,
    StatusSignature,
    load_message,
)
from firm_hdl.errors import UserError
from firm_hdl.export.component import ComponentTop, PlainPorts, build_component
from firm_hdl.vhdl.convert import Vhdl
from tests.tools import need
from tests.vhdl.ghdl import GHDL, analyse

TIME = load_message("builtin_interfaces/msg/Time")


class Seconds(wiring.Component):
    """Read a time from packets, and add the seconds of others. `m_axis` has another clock."""

    def __init__(self):
        message = MessageSignature(TIME)
        super().__init__(
            {
                "packets": In(PacketSignature(8)),
                "status": Out(StatusSignature()),
                "now": Out(message),
                "inner": In(wiring.Signature({"time": Out(message)})),
                "times": In(message).array(2),
                "m_axis": Out(AxiStreamSignature(1)),
                "sum": Out(32),
                "raw": In(stream.Signature(4)),
            }
        )

    def elaborate(self, platform):
        m = Module()
        m.submodules.rx = rx = Deserializer(TIME)
        connect(m, flipped(self.packets), rx.packets)
        connect(m, rx.message, flipped(self.now))
        connect(m, rx.status, flipped(self.status))
        for time in (self.inner.time, *self.times):
            m.d.comb += [time.sec.ready.eq(1), time.nanosec.ready.eq(1)]
            with m.If(time.sec.valid):
                m.d.sync += self.sum.eq(self.sum + time.sec.payload)
        m.d.link += self.m_axis.tvalid.eq(~self.m_axis.tvalid)
        m.d.comb += self.raw.ready.eq(1)
        return m


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    return build_component(Seconds(), tmp_path_factory.mktemp("out"), name="seconds").folder


def test_ports_have_the_names_that_converters_have(built):
    manifest = json.loads((built / "manifest.json").read_text())
    ports = {port["name"]: (port["direction"], port["width"]) for port in manifest["ports"]}
    assert list(ports)[:4] == ["aclk", "aresetn", "link_aclk", "link_aresetn"]
    assert ports["packets_tdata"] == ("in", 64) and ports["packets_tkeep"] == ("in", 8)
    assert ports["packets_tready"] == ("out", 1)
    assert ports["m_axis_tkeep"] == ("out", 1) and ports["m_axis_tready"] == ("in", 1)
    assert ports["status_data"] == ("out", 3) and ports["raw_valid"] == ("in", 1)
    assert ports["now_sec_data"] == ("out", 32) and ports["now_sec_ready"] == ("in", 1)
    assert ports["times_1_nanosec_data"] == ("in", 32)
    assert not any("__" in name for name in ports)
    records = manifest["records"]
    assert [each["name"] for each in records["ports"]] == [
        "now",
        "inner_time",
        "times_0",
        "times_1",
    ]
    assert {each["message_type"] for each in records["ports"]} == {"time_t"}
    text = (built / "vhdl" / "seconds_records.vhd").read_text()
    package = "work.builtin_interfaces_msg_time_cdr_8_pkg"
    for line in (f": out {package}.time_t", f": in  {package}.time_ready_t"):
        assert line in text.partition("inner_time")[0].partition(" now ")[2]
    assert f": in  {package}.time_t" in text.partition("inner_time ")[2].partition(";")[0]


def test_the_records_compile(built, tmp_path):
    need("ghdl", GHDL)
    names = (built / "vhdl" / "files.txt").read_text().split()
    files = {name: (built / "vhdl" / name).read_text() for name in names}
    assert names[-1] == "seconds_records.vhd"
    analyse(Vhdl(top="seconds_records", files=files, entities={}), tmp_path)


def test_the_structs_have_no_warnings(built):
    verilator = need("verilator", shutil.which("verilator"))
    command = [verilator, "--lint-only", "-Wall", "../waivers.vlt", "waivers.vlt"]
    # Users' own logic may have what these warn of: here, a bus that nothing drives.
    command += ["-Wno-UNDRIVEN", "-Wno-UNUSEDSIGNAL", "-F", "files.f"]
    done = subprocess.run(
        [*command, "--top-module", "seconds_sv"],
        cwd=built / "systemverilog",
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert (done.returncode, done.stdout + done.stderr) == (0, "")


class Twice(wiring.Component):
    """A packet crosses from one of two clocks to the other."""

    def __init__(self):
        packets = PacketSignature(2)
        super().__init__({"came": In(packets), "gone": Out(packets)})

    def elaborate(self, platform):
        m = Module()
        m.submodules.crossing = crossing = PacketCrossing(2, 4, read_domain="sync")
        connect(m, flipped(self.came), crossing.packets_in)
        connect(m, crossing.packets_out, flipped(self.gone))
        return m


def test_packets_pass_the_plain_ports_with_tkeep():
    clocks = {"sync": ("aclk", "aresetn"), "write": ("write_aclk", "write_aresetn")}
    top, seen = ComponentTop(PlainPorts(Twice(), kind="design", clocks=clocks)), []

    async def bench(ctx):
        async def edge():
            for level in (1, 0):
                ctx.set(top.aclk, level)
                ctx.set(top.write_aclk, level)
                await ctx.delay(1e-7)

        await edge()
        ctx.set(top.aresetn, 1)
        ctx.set(top.write_aresetn, 1)
        ctx.set(top.gone_tready, 1)
        for _ in range(5):
            await edge()
        sent = [(0x2211, 0b00, 0), (0x33, 0b01, 1)]
        for data, keep, last in sent:
            ctx.set(top.came_tdata, data)
            ctx.set(top.came_tkeep, keep)
            ctx.set(top.came_tlast, last)
            ctx.set(top.came_tvalid, 1)
            assert ctx.get(top.came_tready)
            await edge()
        ctx.set(top.came_tvalid, 0)
        for _ in range(6):
            if ctx.get(top.gone_tvalid):
                seen.append(tuple(map(ctx.get, (top.gone_tdata, top.gone_tkeep, top.gone_tlast))))
            await edge()

    simulator = Simulator(top)
    simulator.add_testbench(bench)
    simulator.run()
    assert seen == [(0x2211, 0b11, 0), (0x33, 0b01, 1)]


def test_a_component_without_messages_has_plain_ports_only(tmp_path):
    built = build_component(Twice(), tmp_path, name="twice")
    manifest = json.loads((built.folder / "manifest.json").read_text())
    assert manifest["records"] == {"built": False, "reason": "The component has no messages"}
    assert manifest["clocks"] == [
        {"clock": "aclk", "reset": "aresetn"},
        {"clock": "write_aclk", "reset": "write_aresetn"},
    ]
    assert not (built.folder / "systemverilog").exists()
    assert build_component(Twice(), tmp_path, name="twice").was_current


def test_mistakes_are_named(tmp_path):
    with pytest.raises(TypeError, match=r"^A component of Amaranth is needed, not \(sig"):
        build_component(Signal(), tmp_path, name="x")
    for name, text in (
        ("entity", "'entity' is not a name in VHDL and Verilog"),
        ("mux", "The VHDL of every design uses the name 'mux' itself"),
    ):
        with pytest.raises(UserError, match=f"^{text}$"):
            build_component(Twice(), tmp_path, name=name)
    assert not list(tmp_path.iterdir())

    class Wide(wiring.Component):
        def __init__(self):
            super().__init__({"bits": In(1 << 16)})

        def elaborate(self, platform):
            return Module()

    with pytest.raises(UserError, match=r"^The design has 65536 input bits, and Amaranth"):
        build_component(Wide(), tmp_path, name="wide")
