# amaranth: UnusedElaboratable=no
"""Names of nodes that give two design units one name are refused, at their place in the text."""

from __future__ import annotations

import re
from types import SimpleNamespace

import pytest

from firm_hdl.cases.stimuli import stimuli
from firm_hdl.cli import main
from firm_hdl.errors import DefinitionError
from firm_hdl.node import Node
from firm_hdl.node import build as node_build
from firm_hdl.node.build import build_node, check_units
from firm_hdl.node.top import node_ports
from tests.node.samples import RELAY, read

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
