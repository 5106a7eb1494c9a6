"""VHDL without records: converters with plain ports, and their bench."""

from __future__ import annotations

import re

import pytest

from firm_hdl import load_message
from firm_hdl.cli import main
from firm_hdl.export.backend import Options
from firm_hdl.export.build import build
from firm_hdl.verify.cases.stimuli import stimuli
from tests.depth import by_depth
from tests.export.vhdl.test_layer import analyse, nasty, vhdl_of, write
from tests.tools import run_script


@pytest.mark.parametrize(
    ("name", "bus_bytes"),
    [
        ("sensor_msgs/msg/JointState", 8),
        ("", 1),
        *by_depth([], [("std_msgs/msg/Bool", 1), ("", 8)]),
    ],
)
def test_bench_passes(ghdl, tmp_path, name, bus_bytes):
    message = load_message(name) if name else nasty(tmp_path)
    _, plan = vhdl_of(message, bus_bytes, ports="flat")
    packets = stimuli(message, plan)
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


def test_there_is_no_record_in_the_design(tmp_path):
    made, _ = vhdl_of(nasty(tmp_path), ports="flat")
    for name in made.manifest["files"]:
        assert not re.search(r"\bis\s+record\b", made.files[name]), name
    assert "firm_hdl_types_pkg.vhd" not in made.files
    package = made.files["nasty_msgs_signal_ros1_8_pkg.vhd"]
    assert 'constant LEAST : signed(63 downto 0) := x"8000000000000000"' in re.sub(
        " +:", " :", package
    )
    assert "component nasty_msgs_signal_ros1_8_serializer_flat is\n" in package
    assert made.manifest["record_view"] == {"built": False, "reason": "The ports are flat"}


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


def test_python_callers_choose_too(tmp_path):
    [built] = build(["std_msgs/msg/Bool"], tmp_path, options=Options(ports="flat"))
    assert not (built.folder / "vhdl" / "firm_hdl_types_pkg.vhd").exists()
