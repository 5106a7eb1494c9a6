# amaranth: UnusedElaboratable=no
"""The summary of a node, its top level, and the files of its design."""

from __future__ import annotations

import json
import shutil
import subprocess

import pytest
from amaranth.sim import Simulator

from firm_hdl.cases.stimuli import stimuli
from firm_hdl.cli import main
from firm_hdl.errors import UserError
from firm_hdl.node import Node
from firm_hdl.node.build import build_node
from firm_hdl.node.messages import NodeMessage
from firm_hdl.node.summary import facts_of
from firm_hdl.node.top import NodeTop, node_ports
from firm_hdl.vhdl.convert import Vhdl
from tests.export.strikes import left_when_outdated
from tests.node.samples import PACKAGES, WHEELS, read
from tests.node.traffic import frames_of
from tests.tools import need
from tests.vhdl.ghdl import GHDL, synthesize

RELAY = """\
node: relay
distro: jazzy
bus_bytes: 4
subscribe:
  /in_1: {type: std_msgs/msg/UInt16}
publish:
  /out_1: {type: std_msgs/msg/UInt16}
"""


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    out = tmp_path_factory.mktemp("out")
    return build_node(read(RELAY), out, stimuli=stimuli).folder


def test_the_manifest_has_what_a_host_needs(built):
    manifest = json.loads((built / "manifest.json").read_text())
    facts = facts_of(read(RELAY))
    assert {key: manifest[key] for key in facts} == json.loads(json.dumps(facts))
    assert [(topic["id"], topic["name"]) for topic in manifest["topics"]] == [
        (1, "/in_1"),
        (2, "/out_1"),
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


def test_the_verilog_compiles_in_both_languages(built, tmp_path):
    iverilog = need("iverilog", shutil.which("iverilog"))
    for language in ("-g2005", "-g2012"):
        command = [iverilog, language, "-Wall", "-o", tmp_path / "o", built / "relay_verilog.v"]
        done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)
        assert (done.returncode, done.stderr) == (0, "")


def test_the_vhdl_compiles_in_the_order_of_its_list_and_ghdl_synthesizes_it(built, tmp_path):
    need("ghdl", GHDL)
    names = (built / "vhdl" / "files.txt").read_text().split()
    files = {name: (built / "vhdl" / name).read_text() for name in names}
    made = synthesize(Vhdl(top="relay_records", files=files, entities={}), tmp_path)
    assert "entity relay_records" in made and "latch" not in made.lower()


def test_each_file_goes_when_it_is_outdated(built, tmp_path):
    assert left_when_outdated(built, tmp_path / built.name) == set()


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
    assert data == frames_of([NodeMessage(topic=2, packet=packet)])[0]
    assert [beat[1:] for beat in seen] == [[15, 0, 2]] * 5 + [[3, 1, 2]]


@pytest.mark.parametrize(("link", "port"), [("udp", "udp_rx_data"), ("uart", "uart_rx")])
def test_other_links_have_ports_of_their_own(link, port):
    names = {each.name: each for each in node_ports(Node(read(RELAY, link=link)))}
    assert names[port].direction == "in"


def test_the_command_prints_and_writes(built, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "node.yaml").write_text(WHEELS)
    assert main(["node", "info", "node.yaml", "--path", str(PACKAGES)]) == 0
    assert capsys.readouterr().out.startswith("/robot/wheels: jazzy, cdr, 64-bit bus, 100 MHz\n")
    (tmp_path / "relay.yaml").write_text(RELAY)
    out = ["--out", str(built.parent), "--path", str(PACKAGES)]
    assert main(["node", "build", "relay.yaml", *out]) == 0
    assert capsys.readouterr().out.startswith(f"current {built}\n/relay: jazzy")
    assert (built / "relay.core").read_text().startswith("CAPI=2:\n")
    (tmp_path / "bad.yaml").write_text(WHEELS.replace("Twist", "Twits"))
    assert main(["node", "info", "bad.yaml", "--path", str(PACKAGES)]) == 1
    assert capsys.readouterr().err.startswith("bad.yaml:5:20: error: type 'Twits' is not defined")
