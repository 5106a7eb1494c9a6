"""VHDL without records: converters with plain ports, and their bench."""

from __future__ import annotations

import re

import pytest

from firm_hdl import load_message
from firm_hdl.cases.stimuli import stimuli
from firm_hdl.cli import main
from firm_hdl.export import top
from firm_hdl.export.backend import Options
from firm_hdl.export.build import build
from firm_hdl.export.top import DIRECTIONS, Direction, ports_of
from firm_hdl.export.tree import tree_of
from firm_hdl.export.vhdl.bench import bench
from firm_hdl.export.vhdl.bench_views import flat_view
from firm_hdl.export.vhdl.layer import flat_package
from firm_hdl.export.vhdl.wrapper import Core, stream_wrapper
from firm_hdl.plan import build_plan
from firm_hdl.wire import lay_out
from tests.depth import by_depth
from tests.export.vhdl.test_layer import analyse, nasty, plan_of, vhdl_of, write
from tests.strategies import make
from tests.tools import run_script


@pytest.mark.parametrize(
    ("name", "bus_bytes"),
    [
        ("", 8),
        *by_depth([], [("sensor_msgs/msg/JointState", 8), ("std_msgs/msg/Bool", 1), ("", 1)]),
    ],
)
def test_bench_passes(ghdl, tmp_path, name, bus_bytes):
    message = load_message(name) if name else nasty(is_short=by_depth(True, False))
    packets = stimuli(message, plan_of(message, bus_bytes))
    made, _ = vhdl_of(message, bus_bytes, packets, ports="flat")
    write(tmp_path / "vhdl", made.files)
    analyse(ghdl, tmp_path / "vhdl", [*made.manifest["files"], *made.manifest["bench"]["files"]])
    status, output = run_script(tmp_path / "vhdl" / "run_ghdl.sh", GHDL=ghdl)
    assert status == 0, output
    assert output.startswith("PASS ") and f": {len(packets)} packets, " in output
    flat = (tmp_path / "vhdl" / "work" / "transfers.txt").read_text()
    # The bench of the converters with records takes the same number of cycles.
    made, _ = vhdl_of(message, bus_bytes, packets)
    write(tmp_path / "records", made.files)
    assert run_script(tmp_path / "records" / "run_ghdl.sh", GHDL=ghdl)[0] == 0
    assert (tmp_path / "records" / "work" / "transfers.txt").read_text() == flat


def test_there_is_no_record_in_the_design():
    message = nasty(is_short=by_depth(True, False))
    # With the packets of the test above, for which it is made anyway.
    packets = stimuli(message, plan_of(message))
    made, _ = vhdl_of(message, packets=packets, ports="flat")
    for name in made.manifest["files"]:
        assert not re.search(r"\bis\s+record\b", made.files[name]), name
    assert "firm_hdl_types_pkg.vhd" not in made.files
    package = made.files["nasty_msgs_signal_ros1_8_pkg.vhd"]
    assert 'constant LEAST : signed(63 downto 0) := x"8000000000000000"' in re.sub(
        " +:", " :", package
    )
    assert "component nasty_msgs_signal_ros1_8_serializer_flat is\n" in package
    assert made.manifest["record_view"] == {"built": False, "reason": "The ports are flat"}


def names_before(separator: str, text: str) -> list[str]:
    """Return the names in front of a separator: of declared ports, or of those in port maps."""
    return re.findall(rf"^ +(\w+) +{separator} ", text, re.MULTILINE)


def test_ports_of_a_core_have_the_names_that_vhdl_gave_them():
    message = load_message("geometry_msgs/msg/Point")
    plan = build_plan(lay_out(message))
    tree = tree_of(message, plan)
    names = {
        way: {port.name: f"{port.name}_in_vhdl" for port in ports_of(plan, way)}
        for way in DIRECTIONS
    }
    cores = {way: Core(entity=f"{way}_core", names=names[way]) for way in DIRECTIONS}
    for way in DIRECTIONS:
        wrapper = stream_wrapper(plan, tree, way, entity="e", core=cores[way])
        assert names_before("=>", wrapper) == list(names[way].values())
    wanted = [name for way in DIRECTIONS for name in names[way].values()]
    package, _ = flat_package(message, plan, name="p", cores=cores)
    assert names_before(":", package) == wanted
    text = bench("tb", flat_view(plan, "p", cores), bus_bytes=8, what="points")
    assert set(wanted) <= set(names_before("=>", text))
    assert re.search(r"s_axis_tkeep_in_vhdl +=> i_tkeep,", text)


def test_a_port_that_vhdl_forbids_is_connected_by_its_new_name(monkeypatch):
    monkeypatch.setattr(top, "leaf_names", lambda plan: {("data",): "on__off"})
    # No other test has this type, whose VHDL is kept.
    made, _ = vhdl_of(make("ros2", {"data": "bool"}, "Renamed"), bus_bytes=1, hollow=True)
    for way in DIRECTIONS:
        stem = f"p_msg_renamed_cdr_1_{way}"
        core = made.files[f"{stem}_flat.vhd"].rpartition(f"entity {stem}_flat is")[2]
        ports = names_before(":", core.partition("architecture")[0])
        assert "on_off_data" in ports
        assert set(names_before("=>", made.files[f"{stem}.vhd"])) == set(ports)


def test_no_constant_has_the_name_of_the_package_or_of_a_component(tmp_path):
    (tmp_path / "my_msgs" / "msg").mkdir(parents=True)
    lines = [f"uint8 {name}=1\n" for name in ("PKG", "RX_FLAT", "TX_FLAT", "OTHER")]
    (tmp_path / "my_msgs" / "msg" / "Named.msg").write_text("".join(lines))
    message = load_message("my_msgs/msg/Named", paths=[tmp_path])
    cores: dict[Direction, Core] = {
        "deserializer": Core(entity="Rx_flat", names={}),
        "serializer": Core(entity="tx_flat", names={}),
    }
    _, found = flat_package(message, build_plan(lay_out(message)), name="Pkg", cores=cores)
    assert [each.name for each in found] == [
        "PKG_CONSTANT",
        "RX_FLAT_CONSTANT",
        "TX_FLAT_CONSTANT",
        "OTHER",
    ]


@pytest.mark.usefixtures("hollow")
def test_ports_are_an_option_of_the_command(tmp_path, capsys):
    command = ["build", "std_msgs/msg/Bool", "--out", str(tmp_path)]
    folder = tmp_path / "lyrical" / "std_msgs_msg_Bool_cdr_8" / "vhdl"
    assert main(command) == 0
    assert (folder / "std_msgs_msg_bool_cdr_8_deserializer.vhd").exists()
    # The other kind of ports replaces the first completely.
    assert main([*command, "--ports", "flat"]) == 0
    assert not (folder / "std_msgs_msg_bool_cdr_8_deserializer.vhd").exists()
    assert (folder / "std_msgs_msg_bool_cdr_8_deserializer_flat.vhd").exists()
    assert main([*command, "--ports", "flat"]) == 0
    output = capsys.readouterr().out.splitlines()
    states = [line.split()[0] for line in output if "lyrical" in line]
    assert states == ["wrote", "wrote", "current"]
    with pytest.raises(SystemExit) as caught:
        main([*command, "--ports", "round"])
    assert caught.value.code == 2


@pytest.mark.usefixtures("hollow")
def test_python_callers_choose_too(tmp_path):
    [built] = build(["std_msgs/msg/Bool"], tmp_path, options=Options(ports="flat"))
    assert not (built.folder / "vhdl" / "firm_hdl_types_pkg.vhd").exists()
