"""Types that rosbags cannot judge, in GHDL: their packets come from ROS 2 itself."""

from __future__ import annotations

import pytest

from firm_hdl import load_message
from firm_hdl.export.vhdl.bench import packets_text
from tests.depth import by_depth
from tests.export.vhdl.test_layer import analyse, vhdl_of, write
from tests.tools import run_script

# Bytes of ROS 2's own type support (humble, Fast CDR), and bytes derived from them for bounds.
PACKETS = [
    "00010000 01000000 01000000 61000000 02000000 03000000 62000000 e9000000 3dd80000",
    "00010000 ff000000 00000000 00000000 00000000",
    "00010000 00000000 02000000 3dd80000 00de0000 07000000 00000000",
]


@pytest.mark.parametrize("bus_bytes", by_depth([8], [1, 8, 32]))
@pytest.mark.thorough
def test_wstrings_pass(ghdl, tmp_path, bus_bytes):
    folder = tmp_path / "my_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder / "Wide.msg").write_text("uint8 x\nwstring w\nuint8 y\nwstring<=3 b\n")
    message = load_message("my_msgs/msg/Wide", paths=[tmp_path])
    packets = [bytes.fromhex(text) for text in PACKETS]
    made, _ = vhdl_of(message, bus_bytes, packets)
    write(tmp_path / "vhdl", made.files)
    analyse(ghdl, tmp_path / "vhdl", [*made.manifest["files"], *made.manifest["bench"]["files"]])
    status, output = run_script(tmp_path / "vhdl" / "run_ghdl.sh", GHDL=ghdl)
    assert status == 0 and output.startswith("PASS my_msgs/msg/Wide, "), output
    assert (tmp_path / "vhdl" / "work" / "results.txt").read_text() == packets_text(packets)
    # One unit more than the bound, so the output packet differs.
    long = bytes.fromhex("00010000 01000000 00000000 02000000 04000000" + "61000000" * 4)
    (tmp_path / "vhdl" / "stimuli.txt").write_text(packets_text([long]))
    status, output = run_script(tmp_path / "vhdl" / "run_ghdl.sh", GHDL=ghdl)
    assert status != 0 and "FAIL packet 0" in output
