# amaranth: UnusedElaboratable=no
"""Packet parts as designs of their own: their files compile, and their ports do what they say."""

from __future__ import annotations

import json
import shutil
import subprocess

import pytest
from amaranth.sim import Simulator

from firm_hdl import load_message
from firm_hdl.cli import main
from firm_hdl.errors import UserError
from firm_hdl.export.parts import build_part, make_part
from firm_hdl.export.parts.top import PartTop, clocks_of, part_ports
from firm_hdl.vhdl.convert import Vhdl
from tests.export.verilog.test_verilog import WAIVED
from tests.tools import need
from tests.vhdl.ghdl import GHDL, analyse

MEMORY = {"memory_bytes": 32, "packets": 2, "when_full": "drop"}
PARTS = {
    "gate": {"message": load_message("std_msgs/msg/UInt16"), "bus_bytes": 4, **MEMORY},
    "fifo": {"bus_bytes": 2, **MEMORY},
    "width": {"in_bytes": 1, "out_bytes": 4},
    "crossing": {"bus_bytes": 2, "beats": 4},
    "arbiter": {"bus_bytes": 1, "inputs": 3, "side_bits": 5},
    "router": {"bus_bytes": 1, "topics": 3, "topic_bits": 4, "side_bits": 2},
}


@pytest.fixture(scope="module", params=PARTS)
def built(request, tmp_path_factory):
    part = make_part(request.param, **PARTS[request.param])
    return build_part(part, tmp_path_factory.mktemp("out")).folder


def run(command, folder):
    done = subprocess.run(
        command, cwd=folder, capture_output=True, text=True, check=False, timeout=60
    )
    return done.returncode, done.stderr


def verilator_finds(folder, file, top):
    verilator = need("verilator", shutil.which("verilator"))
    # Yosys leaves what nobody reads in the text, without its driver, as counters of a gate's FIFO.
    # Some comparisons of a FIFO are constant for its number of packets.
    waivers = [f"-Wno-{name}" for name in (*WAIVED, "UNDRIVEN", "UNSIGNED")]
    return run([verilator, "--lint-only", "-Wall", *waivers, "--top-module", top, file], folder)


def test_the_verilog_compiles_in_both_languages(built, tmp_path):
    iverilog = need("iverilog", shutil.which("iverilog"))
    file = built / f"{built.name}_verilog.v"
    for language in ("-g2005", "-g2012"):
        assert run([iverilog, language, "-Wall", "-o", "o", file], tmp_path) == (0, "")


def test_verilator_finds_nothing(built, tmp_path):
    top = f"{built.name}_verilog"
    assert verilator_finds(tmp_path, built / f"{top}.v", top) == (0, "")


def test_verilator_finds_a_wire_that_does_not_exist(tmp_path):
    folder = build_part(make_part("width", in_bytes=1, out_bytes=1), tmp_path).folder
    top = f"{folder.name}_verilog"
    text = (folder / f"{top}.v").read_text()
    assert text.count("  assign m_axis_tlast = ") == 1
    (tmp_path / "bad.v").write_text(text.replace("  assign m_axis_tlast", "  assign m_axis_tlost"))
    status, found = verilator_finds(tmp_path, "bad.v", top)
    assert status and "m_axis_tlost" in found


def test_the_vhdl_compiles_in_the_order_of_its_list(built, tmp_path):
    need("ghdl", GHDL)
    names = (built / "vhdl" / "files.txt").read_text().split()
    files = {name: (built / "vhdl" / name).read_text() for name in names}
    analyse(Vhdl(top=built.name, files=files, entities={}), tmp_path)


def test_the_manifest_lists_the_ports_of_the_verilog(built):
    manifest = json.loads((built / "manifest.json").read_text())
    text = (built / manifest["verilog"]["file"]).read_text()
    ports = text.partition("(")[2].partition(")")[0].replace(",", " ").split()
    assert sorted(port["name"] for port in manifest["ports"]) == sorted(ports)
    assert manifest["verilog"]["module"] in text and manifest["part"] in PARTS
    assert all(clock["clock"] in ports for clock in manifest["clocks"])
    assert (built / f"{built.name}.core").read_text().startswith("CAPI=2:\n")


def through(kind, source, *, ins="s_axis", out="m_axis", extra=(), cycles=30, **parameters):
    """Send beats, as values of ports, to a part; return values of `out` and others of each beat."""
    part = make_part(kind, **parameters)
    top, seen = PartTop(part), []
    names = [port.name for port in part_ports(part)]
    wanted = [f"{out}_{each}" for each in ("tdata", "tkeep", "tlast")] + list(extra)
    clocks = [getattr(top, clock) for clock, _ in clocks_of(part).values()]

    async def bench(ctx):
        async def edge():
            for level in (1, 0):
                for clock in clocks:
                    ctx.set(clock, level)
                await ctx.delay(1e-7)

        for _, reset in clocks_of(part).values():
            ctx.set(getattr(top, reset), 0)
        await edge()
        for _, reset in clocks_of(part).values():
            ctx.set(getattr(top, reset), 1)
        for name in names:
            if name.startswith("m_axis") and name.endswith("_tready"):
                ctx.set(getattr(top, name), 1)
        todo = list(source)
        for _ in range(cycles):
            for name, value in todo[0].items() if todo else ():
                ctx.set(getattr(top, f"{ins}_{name}"), value)
            ctx.set(getattr(top, f"{ins}_tvalid"), bool(todo))
            await ctx.delay(1e-9)
            if todo and ctx.get(getattr(top, f"{ins}_tready")):
                todo.pop(0)
            if ctx.get(getattr(top, f"{out}_tvalid")):
                seen.append(tuple(ctx.get(getattr(top, name)) for name in wanted))
            await edge()

    simulator = Simulator(top)
    simulator.add_testbench(bench)
    simulator.run()
    return seen


def beat(data, keep, last, **others):
    return {"tdata": data, "tkeep": keep, "tlast": last, **others}


def test_tkeep_counts_in_the_last_beat_only():
    beats = [beat(0x2211, 0, 0), beat(0x33, 0b01, 1), beat(0, 0, 1)]
    seen = through("width", beats, in_bytes=2, out_bytes=4)
    assert [(data & (1 << 24) - 1 if keep else 0, keep, last) for data, keep, last in seen] == [
        (0x332211, 0b0111, 1),
        (0, 0, 1),
    ]


def test_tkeep_of_other_beats_is_all_ones_behind_a_part_that_changes_nothing():
    beats = [beat(0x2211, 0, 0, tdest=0), beat(0x4433, 0b01, 0, tdest=1), beat(0x55, 0b01, 1)]
    want = [(0x2211, 0b11, 0), (0x4433, 0b11, 0), (0x55, 0b01, 1)]
    for kind, given in (
        ("crossing", {"beats": 4}),
        ("router", {"topics": 2, "out": "m_axis_0"}),
        ("arbiter", {"inputs": 2, "ins": "s_axis_1"}),
    ):
        left_out = () if kind == "router" else ("tdest",)
        sent = [{k: v for k, v in each.items() if k not in left_out} for each in beats]
        assert [seen[:3] for seen in through(kind, sent, bus_bytes=2, **given)] == want


def test_tuser_of_a_fifo_drops_a_packet_as_a_serializer_asks_for():
    beats = [beat(7, 3, 1, tuser=1), beat(8, 3, 0, tuser=1), beat(9, 1, 1, tuser=0)]
    extra = ("packet_bytes", "count_passed", "count_aborted")
    seen = through("fifo", beats, bus_bytes=2, memory_bytes=16, packets=2, extra=extra)
    assert seen == [(8, 3, 0, 3, 1, 1), (9, 1, 1, 3, 1, 1)]


def test_a_gate_has_a_status_on_a_stream_of_whole_bytes():
    message = load_message("std_msgs/msg/UInt16")
    beats = [beat(0x100, 15, 0), beat(0x1234, 3, 1), beat(0x100, 15, 1)]
    given = {"message": message, "bus_bytes": 4, "memory_bytes": 64}
    assert through("gate", beats, **given) == [(0x100, 15, 0), (0x1234, 3, 1)]
    part = make_part("gate", **given)
    ports = {port.name: port for port in part_ports(part)}
    assert ports["m_axis_status_tdata"].width == 8
    top = PartTop(part)
    assert top.signature.members["m_axis_status_tready"].flow.name == "In"


def test_a_router_sends_to_tdest_and_an_arbiter_says_tid():
    beats = [beat(1, 1, 1, tdest=0), beat(2, 1, 1, tdest=2), beat(3, 1, 1, tdest=9)]
    given = {"bus_bytes": 1, "topics": 3, "topic_bits": 4, "out": "m_axis_2"}
    assert through("router", beats, **given) == [(2, 1, 1)]
    beats = [beat(5, 1, 1, tuser=21)]
    given = {"ins": "s_axis_2", "extra": ("m_axis_tid", "m_axis_tuser"), "side_bits": 5}
    assert through("arbiter", beats, bus_bytes=1, inputs=3, **given) == [(5, 1, 1, 2, 21)]


def test_a_crossing_has_two_clocks():
    beats = [beat(number, 3, number == 4) for number in range(5)]
    assert [seen[0] for seen in through("crossing", beats, bus_bytes=2, beats=4)] == [*range(5)]
    names = [port.name for port in part_ports(make_part("crossing", bus_bytes=2))]
    assert names[:4] == ["s_axis_aclk", "s_axis_aresetn", "m_axis_aclk", "m_axis_aresetn"]


def leaves_after_reset(cycles, phase):
    """Return whether beats leave a crossing after a reset of some cycles of the writing clock.

    The reading clock has a fifth of its rate; `phase` says when the reset begins.
    """
    top, seen = PartTop(make_part("crossing", bus_bytes=1, beats=8)), []
    resets = (top.s_axis_aresetn, top.m_axis_aresetn)
    number = 0

    async def bench(ctx):
        async def steps(count):
            nonlocal number
            for _ in range(count):
                number += 1
                ctx.set(top.s_axis_aclk, 1)
                ctx.set(top.m_axis_aclk, number % 5 == 0)
                await ctx.delay(1e-7)
                ctx.set(top.s_axis_aclk, 0)
                ctx.set(top.m_axis_aclk, 0)
                await ctx.delay(1e-7)
                seen.append(ctx.get(top.m_axis_tvalid))

        for reset in resets:
            ctx.set(reset, 1)
        ctx.set(top.s_axis_tvalid, 1)
        await steps(40 + phase)
        assert any(seen)
        ctx.set(top.s_axis_tvalid, 0)
        for level, count in ((0, cycles), (1, 60)):
            for reset in resets:
                ctx.set(reset, level)
            seen.clear()
            await steps(count)

    simulator = Simulator(top)
    simulator.add_testbench(bench)
    simulator.run()
    return any(seen)


@pytest.mark.parametrize("phase", range(5))
def test_a_reset_of_two_edges_of_the_slower_clock_empties_a_crossing(phase):
    assert not leaves_after_reset(10, phase)


def test_a_shorter_reset_may_not_empty_a_crossing():
    assert any(leaves_after_reset(4, phase) for phase in range(5))


def test_the_command_writes_a_part_once(tmp_path, capsys):
    words = ["part", "crossing", "--bus-bytes", "1", "--out", str(tmp_path)]
    assert main(words) == 0 and main(words) == 0
    folder = tmp_path / "packet_crossing_1"
    assert capsys.readouterr().out == f"wrote   {folder}/\ncurrent {folder}/\n"
    # Another memory is another design.
    assert main([*words, "--beats", "8"]) == 0
    assert capsys.readouterr().out == f"wrote   {folder}/\n"


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("fifo --memory-bytes 100", "Memory size must be a power of two from 16 bytes on, not 100"),
        ("crossing --beats 5", "Number of beats must be a power of two from 4 on, not 5"),
        ("router --topics 3 --topic-bits 1", "3 topics do not fit into 1 bits"),
        ("fifo --name mux", "The VHDL of every part uses the name 'mux' itself"),
        (
            "arbiter --inputs 64 --bus-bytes 64 --side-bits 1000",
            "The part has 100995 input bits, and Amaranth elaborates at most 65535",
        ),
    ],
)
def test_parameters_that_no_part_has_are_refused(words, message, tmp_path, capsys):
    assert main(["part", *words.split(), "--out", str(tmp_path)]) == 1
    assert capsys.readouterr().err == f"error: {message}\n"
    assert not [*tmp_path.iterdir()]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("width --in-bytes 3 --out-bytes 4", "invalid choice: 3"),
        ("width --in-bytes 4", "required: --out-bytes"),
        ("fifo --memory-bytes 33554432", "must be from 1 to 1048576, not 33554432"),
        ("fifo --name entity", "'entity' is not a name in VHDL and Verilog"),
        ("gates a/B", "invalid choice: 'gates'"),
    ],
)
def test_wrong_arguments_are_refused(words, message, capsys):
    with pytest.raises(SystemExit, match="2"):
        main(["part", *words.split()])
    assert message in capsys.readouterr().err


def test_a_folder_of_others_is_left_alone(tmp_path):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "x").write_text("")
    with pytest.raises(UserError, match="is not a folder that firm-hdl made; move it away"):
        build_part(make_part("width", in_bytes=1, out_bytes=2, name="mine"), tmp_path)
