"""The generated test bench in GHDL: passes for correct converters, fails for deliberate faults."""

from __future__ import annotations

from pathlib import Path

import pytest

from firm_hdl import load_message
from firm_hdl.cases import NotJudgedError
from firm_hdl.cases.stimuli import stimuli
from firm_hdl.export.vhdl.bench import packets_text
from tests.depth import by_depth
from tests.export.vhdl.test_layer import nasty, plan_of, vhdl_of, write
from tests.tools import run_script


def write_folder(folder: Path, name: str, distro: str, bus_bytes: int) -> list[bytes]:
    """Write the VHDL folder of a type; return its packets."""
    message = load_message(name, distro=distro)
    packets = stimuli(message, plan_of(message, bus_bytes))
    assert packets
    write(folder, vhdl_of(message, bus_bytes, packets)[0].files)
    return packets


@pytest.mark.parametrize(
    ("name", "distro", "bus_bytes"),
    [
        ("geometry_msgs/msg/Twist", "lyrical", 8),
        (by_depth("std_msgs/msg/MultiArrayLayout", "sensor_msgs/msg/PointCloud2"), "lyrical", 4),
        ("std_msgs/Header", "noetic", 2),
        ("std_msgs/Empty", "noetic", 8),
        *by_depth(
            [],
            [
                ("sensor_msgs/msg/Imu", "humble", 1),
                ("sensor_msgs/msg/PointCloud2", "lyrical", 16),
                ("nav_msgs/Odometry", "noetic", 8),
                ("std_msgs/msg/Empty", "lyrical", 1),
            ],
        ),
    ],
)
@pytest.mark.sampled(4)
def test_passes(ghdl, tmp_path, name, distro, bus_bytes):
    folder = tmp_path / "with space"
    packets = write_folder(folder, name, distro, bus_bytes)
    for seed, stalls in ((1, 40), (2, 0)):
        options = [f"-gseed={seed}", f"-gstalls={stalls}", f"--wave=w {seed}.vcd"]
        status, output = run_script(folder / "run_ghdl.sh", *options, folder=tmp_path, GHDL=ghdl)
        assert status == 0, output
        assert "$var" in (tmp_path / f"w {seed}.vcd").read_text()
        size = sum(map(len, packets))
        assert output.startswith(f"PASS {name}, "), output
        assert f": {len(packets)} packets, {size} bytes, " in output
        assert len(output.splitlines()) == 1, output
    assert (folder / "work" / "results.txt").read_text() == packets_text(packets)
    assert (folder / "work" / "transfers.txt").read_text().count("\n") >= len(packets)


# Other tests have the circuits on a bus of eight bytes, too; test_records.py has such names.
@pytest.mark.thorough
@pytest.mark.parametrize("bus_bytes", [1, 8])
def test_nasty_names_pass(ghdl, tmp_path, bus_bytes):
    message = nasty()
    packets = stimuli(message, plan_of(message, bus_bytes))
    assert packets
    write(tmp_path / "vhdl", vhdl_of(message, bus_bytes, packets)[0].files)
    status, output = run_script(tmp_path / "vhdl" / "run_ghdl.sh", GHDL=ghdl)
    assert status == 0 and output.startswith("PASS "), output


def test_changed_byte_more_and_fewer_packets_fail(ghdl, tmp_path):
    packets = write_folder(tmp_path, "geometry_msgs/msg/Twist", "lyrical", 8)
    changed = [bytearray(packet) for packet in packets]
    changed[2][17] ^= 1
    longer = [packets[0] + b"\0", *packets[1:]]
    for what, wrong, message in (
        ("changed", changed, "FAIL packet 2: byte 17 is "),
        ("longer", longer, "FAIL packet 0 has "),
        ("more", [*packets, packets[0]], "FAIL no beat in 1000 cycles: "),
        ("fewer", packets[:-1], f"FAIL packet {len(packets) - 1}: no such packet is expected"),
    ):
        path = tmp_path / f"{what}.txt"
        path.write_text(packets_text(list(map(bytes, wrong))))
        status, output = run_script(
            tmp_path / "run_ghdl.sh", f"-gexpected={path}", "-gpatience=1000", GHDL=ghdl
        )
        assert status != 0, what
        assert message in output
        assert "PASS" not in output


def test_packet_that_is_not_of_the_type_fails(ghdl, tmp_path):
    packets = write_folder(tmp_path, "geometry_msgs/msg/Twist", "lyrical", 8)
    (tmp_path / "stimuli.txt").write_text(packets_text([packets[0][:-1]]))
    status, output = run_script(tmp_path / "run_ghdl.sh", GHDL=ghdl)
    assert status != 0
    assert "FAIL packet 0" in output


def test_missing_stimuli_and_missing_ghdl_are_reported(tmp_path):
    write_folder(tmp_path, "std_msgs/msg/Empty", "lyrical", 8)
    empty = tmp_path / "empty"
    empty.mkdir()
    for tool in ("dirname", "sh", "mkdir", "cat"):
        (empty / tool).symlink_to(Path("/usr/bin") / tool)
    status, output = run_script(tmp_path / "run_ghdl.sh", PATH=str(empty), GHDL="")
    assert (status, output.count("apt install ghdl")) == (127, 1)
    (tmp_path / "stimuli.txt").unlink()
    status, output = run_script(tmp_path / "run_ghdl.sh", GHDL="true")
    assert (status, output.count("stimuli.txt, one per line")) == (2, 1)


def test_type_that_rosbags_cannot_write_has_no_stimuli(monkeypatch):
    def refuse(*arguments, **options):
        raise NotJudgedError("too odd")

    monkeypatch.setattr("firm_hdl.cases.stimuli.judge_of", refuse)
    message = load_message("std_msgs/msg/String")
    vhdl, plan = vhdl_of(message, hollow=True)
    assert stimuli(message, plan) == []
    assert "stimuli.txt" not in vhdl.files


def test_a_file_of_packets_has_a_line_for_each_packet_and_an_empty_one_for_an_empty_packet():
    text = packets_text([b"\x00\x1f", b"", b"\xff"], "Three packets,\nand one is empty.")
    assert text == "# Three packets,\n# and one is empty.\n001f\n\nff\n"
    assert packets_text([]) == ""
