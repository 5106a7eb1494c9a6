# amaranth: UnusedElaboratable=no
"""The summary of a node, its top level, and the files of its design."""

from __future__ import annotations

import hashlib
import json
import re
import shutil
import subprocess
from types import SimpleNamespace

import pytest
from amaranth.sim import Simulator

from firm_hdl.cases.stimuli import stimuli
from firm_hdl.cli import main
from firm_hdl.errors import DefinitionError, UserError
from firm_hdl.node import Node
from firm_hdl.node import build as node_build
from firm_hdl.node.benches import link_script
from firm_hdl.node.build import build_node, check_units
from firm_hdl.node.messages import NodeMessage
from firm_hdl.node.summary import facts_of
from firm_hdl.node.top import NodeTop, node_ports
from firm_hdl.vhdl.convert import Vhdl
from tests.export.datasheet.test_page import Page, codes, pictures
from tests.export.strikes import left_when_outdated
from tests.export.test_packaging import run
from tests.node.samples import PACKAGES, RELAY, WHEELS, read
from tests.node.traffic import frames_of
from tests.tools import need
from tests.vhdl.ghdl import GHDL, synthesize


def test_the_manifest_has_what_a_host_needs(relay):
    manifest = json.loads((relay / "manifest.json").read_text())
    facts = facts_of(read(RELAY))
    assert {key: manifest[key] for key in facts} == json.loads(json.dumps(facts))
    assert [(topic["id"], topic["name"]) for topic in manifest["topics"]] == [
        (1, "/in_1"),
        (2, "/alone"),
        (3, "/out_1"),
    ]
    assert manifest["registers"][6] == {
        "number": 16,
        "owner": "link",
        "part": "link",
        "name": "passed",
    }
    names = [port["name"] for port in manifest["ports"]]
    assert names[:3] == ["aclk", "aresetn", "s_axis_tdata"] and len(names) == len(set(names))
    assert "subscribe_in_1_data_data" in names and "m_axis_tdest" in names


def test_the_datasheet_is_whole_and_its_instances_compile(relay, tmp_path):
    iverilog, ghdl = need("iverilog", shutil.which("iverilog")), need("ghdl", GHDL)
    text = (relay / "datasheet.html").read_text()
    page = Page(text)
    assert "script" not in page.elements and page.links == []
    # Blocks, and layout and plan of each type, and a waveform of each of its converters.
    assert len(pictures(text)) == 1 + 2 * 2 + 3
    manifest = json.loads((relay / "manifest.json").read_text())
    for port in manifest["ports"]:
        assert f"<td><code>{port['name']}</code></td>" in text
    for known in (manifest["fingerprint"], "/alone (subscribe)", "std_msgs/msg/UInt8", "dropped"):
        assert known in text
    vhdl, verilog, amaranth = (code for _, code in codes(text))
    assert "m.submodules" in amaranth
    (tmp_path / "top.v").write_text(f"module top(input aclk, aresetn);\n{verilog}endmodule\n")
    command = [iverilog, "-t", "null", "-s", "top", "top.v", f"{relay}/relay_verilog.v"]
    assert run(command, tmp_path) == (0, "")
    context, signals, statements = re.split("-- .*:\n", vhdl)[1:]
    design = "entity top is port (aclk, aresetn : in std_logic); end entity;"
    body = f"architecture a of top is\n{signals}begin\n{statements}end architecture;\n"
    (tmp_path / "top.vhd").write_text(f"{context}{design}\n{body}")
    files = [f"{relay}/vhdl/{name}" for name in (relay / "vhdl" / "files.txt").read_text().split()]
    assert run([ghdl, "-a", "--std=08", *files, "top.vhd"], tmp_path) == (0, "")


def test_the_verilog_compiles_in_both_languages(relay, tmp_path):
    iverilog = need("iverilog", shutil.which("iverilog"))
    for language in ("-g2005", "-g2012"):
        command = [iverilog, language, "-Wall", "-o", tmp_path / "o", relay / "relay_verilog.v"]
        done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)
        assert (done.returncode, done.stderr) == (0, "")


def test_the_vhdl_compiles_in_the_order_of_its_list_and_ghdl_synthesizes_it(relay, tmp_path):
    need("ghdl", GHDL)
    names = (relay / "vhdl" / "files.txt").read_text().split()
    files = {name: (relay / "vhdl" / name).read_text() for name in names}
    made = synthesize(Vhdl(top="relay_records", files=files, entities={}), tmp_path)
    assert "entity relay_records" in made and "latch" not in made.lower()


def test_each_file_goes_when_it_is_outdated(relay, tmp_path):
    assert left_when_outdated(relay, tmp_path / relay.name) == set()


@pytest.mark.thorough
def test_a_folder_of_another_description_is_replaced_and_files_of_users_stay(tmp_path):
    folder = build_node(read(RELAY), tmp_path).folder
    (folder / "mine.txt").write_text("kept")
    changed = build_node(read(RELAY, clock_mhz="50"), tmp_path)
    assert not changed.was_current and (folder / "mine.txt").read_text() == "kept"


def test_a_folder_of_others_is_left_alone(tmp_path):
    (tmp_path / "relay").mkdir()
    (tmp_path / "relay" / "x").write_text("")
    with pytest.raises(UserError, match="is not a folder that firm-hdl made; move it away"):
        build_node(read(RELAY), tmp_path)


def test_the_ports_of_a_link_to_a_dma_are_those_of_two_streams():
    ports = node_ports(Node(read(RELAY, link="axi_dma")))
    names = {port.name: port.width for port in ports if port.member.startswith("link.")}
    widths = {"tdata": 32, "tkeep": 4, "tlast": 1, "tvalid": 1, "tready": 1}
    assert names == {
        **{f"{way}_axis_{name}": width for way in "sm" for name, width in widths.items()},
        "mm2s_aresetn": 1,
        "s2mm_aresetn": 1,
    }


def through(top, source):
    """Send beats of data, keep and last to a top level whose message ports are connected."""
    out = []

    async def run(ctx):
        async def edge():
            ctx.set(top.aclk, 1)
            await ctx.delay(5e-7)
            ctx.set(top.aclk, 0)
            await ctx.delay(5e-7)

        ctx.set(top.aresetn, 0)
        await edge()
        ctx.set(top.aresetn, 1)
        ctx.set(top.m_axis_tready, 1)
        todo = list(source)
        for _ in range(120):
            data, keep, last = todo[0] if todo else (0, 0, 0)
            ctx.set(top.s_axis_tdata, data)
            ctx.set(top.s_axis_tkeep, keep)
            ctx.set(top.s_axis_tlast, last)
            ctx.set(top.s_axis_tvalid, bool(todo))
            ctx.set(top.publish_out_1_data_data, ctx.get(top.subscribe_in_1_data_data))
            ctx.set(top.publish_out_1_data_valid, ctx.get(top.subscribe_in_1_data_valid))
            await ctx.delay(1e-9)
            ctx.set(top.subscribe_in_1_data_ready, ctx.get(top.publish_out_1_data_ready))
            if todo and ctx.get(top.s_axis_tready):
                todo.pop(0)
            if ctx.get(top.m_axis_tvalid):
                out.append(
                    [
                        ctx.get(getattr(top, f"m_axis_t{n}"))
                        for n in ("data", "keep", "last", "dest")
                    ]
                )
            await edge()

    simulator = Simulator(top)
    simulator.add_testbench(run)
    simulator.run()
    return out


def test_the_top_level_is_axi4_stream():
    """`tkeep` counts bytes in the last beat only, and says how many there are."""
    packet = bytes.fromhex("00010000 1234")
    frame = frames_of([NodeMessage(topic=1, packet=packet)])[0]
    parts = [frame[at : at + 4] for at in range(0, len(frame), 4)]
    source = [(int.from_bytes(part, "little"), 0, 0) for part in parts[:-1]]
    # The first 0 of `tkeep` ends the beat.
    source.append((int.from_bytes(parts[-1], "little"), 0b1011, 1))
    seen = through(NodeTop(Node(read(RELAY))), source)
    data = b"".join(beat[0].to_bytes(4, "little") for beat in seen)[:22]
    assert data == frames_of([NodeMessage(topic=3, packet=packet)])[0]
    assert [beat[1:] for beat in seen] == [[15, 0, 3]] * 5 + [[3, 1, 3]]


@pytest.mark.parametrize(("link", "port"), [("udp", "udp_rx_data"), ("uart", "uart_rx")])
def test_other_links_have_ports_of_their_own(link, port):
    names = {each.name: each for each in node_ports(Node(read(RELAY, link=link)))}
    assert names[port].direction == "in"


def test_the_command_prints_and_writes(relay, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "node.yaml").write_text(WHEELS)
    assert main(["node", "info", "node.yaml", "--path", str(PACKAGES)]) == 0
    assert capsys.readouterr().out.startswith("/robot/wheels: jazzy, cdr, 64-bit bus, 100 MHz\n")
    (tmp_path / "relay.yaml").write_text(RELAY)
    out = ["--out", str(relay.parent), "--path", str(PACKAGES)]
    assert main(["node", "build", "relay.yaml", "--datasheet", *out]) == 0
    assert capsys.readouterr().out.startswith(f"current {relay}\n/relay: jazzy")
    assert (relay / "relay.core").read_text().startswith("CAPI=2:\n")
    (tmp_path / "bad.yaml").write_text(WHEELS.replace("Twist", "Twits"))
    assert main(["node", "info", "bad.yaml", "--path", str(PACKAGES)]) == 1
    assert capsys.readouterr().err.startswith("bad.yaml:5:20: error: type 'Twits' is not defined")


SIGNED = """\
node: tiny
distro: jazzy
bus_bytes: 4
subscribe:
  /low: {type: std_msgs/msg/Int16}
publish:
  /high: {type: std_msgs/msg/UInt8}
  /nothing: {type: std_msgs/msg/Empty}
"""
OUT, IN = "out", "in"
# Name, direction, bits, and whether the number has a sign, as in docs/reference/node.md.
STREAM = [
    ("s_axis_tdata", IN, 32, False),
    ("s_axis_tkeep", IN, 4, False),
    ("s_axis_tlast", IN, 1, False),
    ("s_axis_tvalid", IN, 1, False),
    ("s_axis_tready", OUT, 1, False),
    ("m_axis_tdata", OUT, 32, False),
    ("m_axis_tkeep", OUT, 4, False),
    ("m_axis_tlast", OUT, 1, False),
    ("m_axis_tvalid", OUT, 1, False),
    ("m_axis_tready", IN, 1, False),
    ("m_axis_tdest", OUT, 16, False),
]
MESSAGES = [
    ("subscribe_low_data_data", OUT, 16, True),
    ("subscribe_low_data_valid", OUT, 1, False),
    ("subscribe_low_data_ready", IN, 1, False),
    ("publish_high_data_data", IN, 8, False),
    ("publish_high_data_valid", IN, 1, False),
    ("publish_high_data_ready", OUT, 1, False),
]
CLOCK = [("aclk", IN, 1, False), ("aresetn", IN, 1, False)]


def ports_of(description):
    return {
        port.name: (port.name, port.direction, port.width, port.signed)
        for port in node_ports(Node(description))
    }


def test_ports_of_a_stream_have_their_directions_and_widths():
    found = ports_of(read(SIGNED))
    wanted = [*CLOCK, *STREAM, *MESSAGES]
    assert [found.get(each[0]) for each in wanted] == wanted
    # All others are those of a message without fields, the time and counters; no port is empty.
    others = [name for name, port in found.items() if port not in wanted]
    assert {name.partition("_")[0] for name in others} == {"publish", "time", "counters"}
    assert {name for name in others if name.startswith("publish")} == {
        f"publish_nothing_structure_needs_at_least_one_member_{part}"
        for part in ("data", "valid", "ready")
    }
    assert all(port[2] > 0 for port in found.values())


def test_a_uart_has_two_ports():
    found = ports_of(read(SIGNED, link="uart"))
    assert {name: port[1:3] for name, port in found.items() if name.startswith("uart")} == {
        "uart_rx": (IN, 1),
        "uart_tx": (OUT, 1),
    }
    assert not any("axis" in name for name in found)


@pytest.fixture
def given(monkeypatch):
    """What :func:`build_node` asks to be written; nothing is, and no circuit is made."""
    asked = []

    def write_design(folder, **options):
        asked.append(SimpleNamespace(folder=folder, **options))

    monkeypatch.setattr(node_build, "write_design", write_design)
    monkeypatch.setattr(node_build.rtlil, "rtlil_of", lambda *_, **__: "circuit")
    monkeypatch.setattr(node_build.rtlil, "netlist_of", lambda circuit: circuit)
    return asked


def test_a_design_is_current_only_with_the_same_frames(given, tmp_path):
    description = read(SIGNED)
    for packets in ([], [b"\0\1\0\0\7\0"]):
        build_node(description, tmp_path, stimuli=lambda *_, found=packets: found)
        script = link_script(description, lambda *_, found=packets: found, has_accelerator=False)
        digest = hashlib.sha256(script.text.encode()).hexdigest()
        assert digest in str(given[-1].inputs)
    assert given[0].inputs != given[1].inputs
    build_node(read(SIGNED, link="uart"), tmp_path)
    assert "'frames_sha256': None" in str(given[-1].inputs)


@pytest.mark.parametrize("force", [False, True])
def test_a_folder_is_written_again_only_if_that_is_asked_for(force, given, tmp_path):
    build_node(read(SIGNED), tmp_path, force=force)
    assert (given[0].force, given[0].folder) == (force, tmp_path / "tiny")


FILES = {
    "the node": ["firm_hdl_pkg.vhd", "relay_node_core.vhd", "relay.vhd"],
    "its messages": ["firm_hdl_types_pkg.vhd", "relay_records.vhd"],
    "its structs": ["firm_hdl_sv_pkg.sv", "../relay_verilog.v", "relay_sv.sv", "files.f"],
    "its benches": ["link.txt", "vhdl/firm_hdl_bench_pkg.vhd", "vhdl/relay_tb.vhd", "relay_tb.v"],
}


def test_units_with_names_of_their_own_are_accepted():
    check_units(read(RELAY), "relay", top="relay", files=FILES)


@pytest.mark.parametrize(
    ("owner", "file", "first"),
    [
        ("its messages", "relay.vhd", "the node"),
        ("its messages", "Relay.vhd", "the node"),
        ("its structs", "relay_node_core.sv", "the node"),
        ("its benches", "vhdl/firm_hdl_types_pkg.vhd", "its messages"),
    ],
)
def test_two_units_of_one_name_are_refused(owner, file, first):
    files = {**FILES, owner: [*FILES[owner], file]}
    unit = file.removeprefix("vhdl/").partition(".")[0]
    message = f"{first} and {owner} would both have a unit with the name '{unit}'; give the node"
    with pytest.raises(DefinitionError, match=message):
        check_units(read(RELAY), "relay", top="relay", files=files)


def test_the_entity_of_an_accelerator_is_the_one_to_rename():
    files = {**FILES, "its accelerator": ["Relay_node_core.vhd"]}
    with pytest.raises(DefinitionError, match="; give the entity of the accelerator another name"):
        check_units(read(RELAY), "relay", top="relay", files=files)


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("name", "reason"),
    [
        # `test_the_files_of_each_kind_are_compared` has names of this kind, without the command.
        pytest.param(
            "Std_msgs_msg_uint16_cdr_4_pkg",
            "the node and its messages would both have a unit with the name "
            "'std_msgs_msg_uint16_cdr_4_pkg'",
            marks=pytest.mark.thorough,
        ),
        ("mux", "the VHDL of every node uses the name 'mux' itself"),
    ],
)
def test_the_command_shows_the_place_and_writes_nothing(
    name, reason, tmp_path, capsys, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    head = f"distro: jazzy\nnode:  {name}  # its name\n"
    text = RELAY.replace("node: relay\ndistro: jazzy\n", head)
    (tmp_path / "node.yaml").write_text(text)
    assert main(["node", "build", "node.yaml"]) == 1
    assert capsys.readouterr().err == (
        f"node.yaml:2:8: error: {reason}; give the node another name\n"
        f"node:  {name}  # its name\n       {'^' * len(name)}\n"
    )
    assert [each.name for each in tmp_path.iterdir()] == ["node.yaml"]


@pytest.mark.parametrize(
    ("name", "owner"),
    [
        ("firm_hdl_types_pkg", "its messages"),
        ("firm_hdl_sv_pkg", "its structs"),
        ("firm_hdl_bench_pkg", "its benches"),
        ("std_msgs_msg_uint16_cdr_4_sv_pkg", "its structs"),
    ],
)
def test_the_files_of_each_kind_are_compared(name, owner, monkeypatch, tmp_path):
    """The circuit is left out: its only unit is the node itself."""

    def convert(circuit, *, name, header):
        ports = {port.name: port.name for port in node_ports(Node(read(RELAY)))}
        entity = SimpleNamespace(ports=ports)
        return SimpleNamespace(top=name, files={f"{name}.vhd": ""}, entities={name: entity})

    monkeypatch.setattr(node_build, "convert", convert)
    monkeypatch.setattr(node_build.rtlil, "rtlil_of", lambda *_, **__: "circuit")
    monkeypatch.setattr(node_build.rtlil, "netlist_of", lambda circuit: circuit)
    message = f"the node and {owner} would both have a unit with the name '{name}'"
    with pytest.raises(DefinitionError, match=message):
        build_node(read(RELAY, node=name), tmp_path)
    assert not [*tmp_path.iterdir()]


@pytest.mark.thorough
@pytest.mark.parametrize(
    "name",
    [
        "firm_hdl_pkg",
        "firm_hdl_types_pkg",
        "firm_hdl_bus_4_pkg",
        "firm_hdl_sv_pkg",
        "firm_hdl_bus_4_sv_pkg",
        "firm_hdl_bench_pkg",
        "std_msgs_msg_uint16_cdr_4_sv_pkg",
    ],
)
def test_every_package_of_a_node_is_known(name, tmp_path):
    with pytest.raises(DefinitionError, match=re.escape(f"name '{name}'")):
        build_node(read(RELAY, node=name), tmp_path, stimuli=stimuli)
    assert not [*tmp_path.iterdir()]


@pytest.mark.thorough
def test_a_name_near_that_of_a_package_is_accepted(tmp_path):
    """The packages of another bus are not in the folder."""
    name = "std_msgs_msg_uint16_cdr_8_pkg"
    folder = build_node(read(RELAY, node=name), tmp_path).folder / "vhdl"
    listed = (folder / "files.txt").read_text().split()
    assert {f"{name}.vhd", "std_msgs_msg_uint16_cdr_4_pkg.vhd"} <= set(listed)
    assert len(listed) == len(set(listed)) and all((folder / each).is_file() for each in listed)
