"""VHDL without records: converters with plain ports, and their bench."""

from __future__ import annotations

import re

import pytest

from firm_hdl import load_message
from firm_hdl.cases.stimuli import stimuli
from firm_hdl.cli import main
from firm_hdl.export.top import Direction
from firm_hdl.export.vhdl.layer import flat_package
from firm_hdl.export.vhdl.wrapper import Core
from firm_hdl.plan import build_plan
from firm_hdl.wire import lay_out
from tests.depth import by_depth
from tests.export.vhdl.test_layer import analyse, nasty, plan_of, vhdl_of, write
from tests.tools import run_script


@pytest.mark.parametrize(
    ("name", "bus_bytes"),
    [
        *by_depth(
            [("std_msgs/msg/Byte", 4)],
            [("", 8), ("sensor_msgs/msg/JointState", 8), ("std_msgs/msg/Bool", 1), ("", 1)],
        ),
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
    made, _ = vhdl_of(message, ports="flat", hollow=True)
    for name in made.manifest["files"]:
        assert not re.search(r"\bis\s+record\b", made.files[name]), name
    assert "firm_hdl_types_pkg.vhd" not in made.files
    package = made.files["nasty_msgs_signal_ros1_8_pkg.vhd"]
    assert 'constant LEAST : signed(63 downto 0) := x"8000000000000000"' in re.sub(
        " +:", " :", package
    )
    assert "component nasty_msgs_signal_ros1_8_serializer_flat is\n" in package
    assert made.manifest["record_view"] == {"built": False, "reason": "The ports are flat"}


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
    states = [line.split()[0] for line in output if line.startswith(("wrote", "current"))]
    assert states == ["wrote", "wrote", "current"]
    with pytest.raises(SystemExit) as caught:
        main([*command, "--ports", "round"])
    assert caught.value.code == 2
