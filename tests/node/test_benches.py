# amaranth: UnusedElaboratable=no
"""The benches of a node: they pass in GHDL and in Icarus Verilog, and find each fault."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from importlib.util import find_spec

import pytest

from firm_hdl.cases.stimuli import stimuli
from firm_hdl.node import Node
from firm_hdl.node.benches import bench_files, link_script
from firm_hdl.node.build import build_node
from firm_hdl.node.messages import MessageSender, NodeMessage
from firm_hdl.node.top import node_ports
from tests.depth import by_depth
from tests.node.accelerators import echo_text
from tests.node.samples import RELAY, read
from tests.tools import need, run_script

UDP = "{kind: udp, data_bytes: 1}"
WIDE_UDP = "{kind: udp, data_bytes: 4, host: 10.0.0.7, datagram_bytes: 32}"
# Changes of the description, and the words of the PASS line that say what was compared.
NODES = {
    "stream": {},
    **by_depth(
        {},
        {
            "udp": {"link": UDP},
            "dma": {"link": "{kind: axi_dma, buffer_bytes: 32}"},
            "wide": {"link": WIDE_UDP},
            "narrow": {"bus_bytes": "1"},
            "loop": {"accelerator": "firm_hdl.node.loop:Loop", "link": UDP},
        },
    ),
}


@pytest.fixture(scope="module")
def folders(tmp_path_factory, relay):
    """Return a function that builds a node once."""
    built = {"stream": relay}

    def build(kind):
        if kind not in built:
            out = tmp_path_factory.mktemp("with space")
            text = RELAY
            if kind == "loop":
                text = re.sub("  /alone.*\n", "", text)
            description = read(text, **NODES[kind])
            built[kind] = build_node(description, out, stimuli=stimuli).folder
        return built[kind]

    return build


def in_ghdl(folder, ghdl, work, *, seed=1, stalls=40, patience=3000, frames=None):
    more = {} if frames is None else {"FRAMES": str(frames)}
    options = [f"-gseed={seed}", f"-gstalls={stalls}", f"-gpatience={patience}"]
    return run_script(folder / "vhdl/run_ghdl.sh", *options, GHDL=ghdl, WORK=str(work), **more)


def in_icarus(folder, iverilog, work, *, seed=1, stalls=40, patience=3000, frames=None):
    more = {} if frames is None else {"FRAMES": str(frames)}
    options = [f"+seed={seed}", f"+stalls={stalls}", f"+patience={patience}"]
    path = os.pathsep.join([os.path.dirname(iverilog), os.environ["PATH"]])
    return run_script(folder / "run_iverilog.sh", *options, PATH=path, WORK=str(work), **more)


@pytest.mark.parametrize("kind", NODES)
def test_the_benches_pass(kind, folders, ghdl, iverilog, tmp_path):
    folder = folders(kind)
    lines = (folder / "link.txt").read_text().splitlines()
    sent, wanted = (sum(line.startswith(mark) for line in lines) for mark in "><")
    assert wanted >= 15
    line = rf"PASS node relay: {sent} frames sent, {wanted} frames compared, \d+ cycles\n"
    for seed, stalls in by_depth([(7, 40)], [(7, 40), (8, 80), (9, 0)]):
        both = ((in_ghdl, ghdl), (in_icarus, iverilog))
        for tool, command in by_depth(both[:1], both):
            work = tmp_path / f"{tool.__name__}{seed}"
            status, output = tool(folder, command, work, seed=seed, stalls=stalls)
            assert status == 0 and re.fullmatch(line, output), output


def changed_byte(lines):
    """Change a byte of the message in the last frame of the loop."""
    at = max(n for n, line in enumerate(lines) if line.startswith("< f10") and "0300" in line[:12])
    lines[at] = lines[at][:-1] + ("0" if lines[at][-1] != "0" else "1")


def changed_counter(lines):
    """Change what the last gate has counted."""
    at = max(n for n, line in enumerate(lines) if line.startswith("< "))
    lines[at] = lines[at][:42] + "7f" + lines[at][44:]


def one_more(lines):
    """Expect the last frame twice."""
    lines.append(max(line for line in lines if line.startswith("< ")))


def one_fewer(lines):
    """Do not expect the last frame."""
    at = max(n for n, line in enumerate(lines) if line.startswith("< "))
    del lines[at]


def longer(lines):
    """Expect a byte more."""
    at = max(n for n, line in enumerate(lines) if line.startswith("< "))
    lines[at] += "00"


def not_sent(lines):
    """Do not send a frame to the loop."""
    del lines[next(n for n, line in enumerate(lines) if line.startswith("> f1010100"))]


FAULTS = {
    changed_byte: r"FAIL frame \d+ from the node \(line \d+ of the file\): byte 2[01] is \w\w inst",
    changed_counter: r"FAIL frame \d+ from the node \(line \d+ of the file\): byte 20 is 0\d inst",
    one_more: r"FAIL no frame in 3000 cycles: \d+ were sent, \d+ of \d+ came",
    one_fewer: r"FAIL frame \d+ from the node.*: no such frame is expected",
    longer: r"FAIL frame \d+ from the node \(line \d+ of the file\) has 32 bytes instead of 33",
    not_sent: r"FAIL frame \d+ from the node",
}


@pytest.mark.parametrize("fault", by_depth([changed_byte, one_fewer], FAULTS))
@pytest.mark.sampled(2)
def test_each_fault_is_found(fault, folders, ghdl, iverilog, tmp_path):
    folder = folders("stream")
    lines = (folder / "link.txt").read_text().splitlines()
    fault(lines)
    frames = tmp_path / "frames.txt"
    frames.write_text("\n".join([*lines, ""]))
    for tool, command in ((in_ghdl, ghdl), (in_icarus, iverilog)):
        status, output = tool(folder, command, tmp_path / tool.__name__, frames=frames)
        assert status != 0 and "PASS" not in output, output
        assert re.search(FAULTS[fault], output), output


# Say that a lane that is not kept is not 0.
SPIES = {
    "relay_tb.v": """  integer spy;
  always @(posedge aclk) if (i_valid) for (spy = 0; spy < WORD_BYTES; spy = spy + 1)
    if (!i_keep[spy] && i_data[8 * spy +: 8] != 0) $display("noise");
  // Sends""",
    "vhdl/relay_tb.vhd": """spy : process
  begin
    wait until rising_edge(aclk) and i_valid = '1';
    for lane in i_keep'range loop
      if i_keep(lane) = '0' and i_data(8 * lane + 7 downto 8 * lane) /= x"00" then
        report "noise";
      end if;
    end loop;
  end process;
  sending :""",
}


@pytest.mark.thorough
def test_lanes_that_are_not_kept_have_noise(folders, ghdl, iverilog, tmp_path):
    folder = shutil.copytree(folders("stream"), tmp_path / "relay")
    for name, spy in SPIES.items():
        text, place = (folder / name).read_text(), spy.splitlines()[-1].strip()
        assert text.count(place) == 1
        (folder / name).write_text(text.replace(place, spy.strip()))
    for tool, command in ((in_ghdl, ghdl), (in_icarus, iverilog)):
        status, output = tool(folder, command, tmp_path / tool.__name__)
        assert status == 0 and output.count("noise") > 10, output


@pytest.mark.thorough
def test_an_accelerator_with_a_fault_fails(folders, ghdl, iverilog, tmp_path):
    """What the bench puts between subscription and publication changes a bit."""
    folder = shutil.copytree(folders("stream"), tmp_path / "relay")
    for name, before, after in (
        ("relay_tb.v", "data = subscribe_in_1_data_data;", "data = ~subscribe_in_1_data_data;"),
        ("vhdl/relay_tb.vhd", "<= subscribe_in_1_data_data;", "<= not subscribe_in_1_data_data;"),
    ):
        text = (folder / name).read_text()
        assert text.count(before) == 1
        (folder / name).write_text(text.replace(before, after))
    for tool, command in ((in_ghdl, ghdl), (in_icarus, iverilog)):
        status, output = tool(folder, command, tmp_path / tool.__name__)
        assert status != 0 and "byte 20 is " in output, output


@pytest.mark.thorough
def test_what_an_accelerator_publishes_is_judged_if_it_is_expected(ghdl, iverilog, tmp_path):
    folder = build_node(read(echo_text()), tmp_path, stimuli=stimuli).folder
    # A string comes back; no line expects the time that is published with it.
    string = bytes.fromhex("00010000" + "03000000" + "616200")
    (came,), (said,) = (
        [frame.hex() for frame in MessageSender(None).frames(NodeMessage(topic=id, packet=string))]
        for id in (1, 2)
    )
    # Flags, the number of the message, and the time at which it leaves.
    expected = f"{said[:2]}--{said[4:16]}{'--' * 8}{said[32:]}"
    either = f"{expected[:4]}--{expected[6:]}"
    frames = tmp_path / "frames.txt"
    for lines, (wanted, line) in {
        (came, expected): (0, "1 frames sent, 1 frames compared, 1 not judged, "),
        (came, expected[:-2] + "01"): (1, "byte 26 is 00 instead of 01"),
        (came, came, expected): (1, "no such frame is expected"),
        (came, either): (1, "has 24 bytes instead of 27|no such frame"),
    }.items():
        frames.write_text("".join(f"{'><'[each != came]} {each}\n" for each in lines))
        for tool, command in ((in_ghdl, ghdl), (in_icarus, iverilog)):
            status, output = tool(folder, command, tmp_path / tool.__name__, frames=frames)
            assert (status != 0) == wanted and re.search(line, output), output
    for tool, command in ((in_ghdl, ghdl), (in_icarus, iverilog)):
        status, output = tool(folder, command, tmp_path / tool.__name__)
        assert status == 0 and "frames compared, 0 not judged, " in output, output


TEXTS = """\
node: relay
distro: jazzy
bus_bytes: 4
subscribe:
  /in_1: {type: std_msgs/msg/String, memory_bytes: 1024, packets: 12}
  /alone: {type: std_msgs/msg/Char, memory_bytes: 256, packets: 8}
publish:
  /out_1: {type: std_msgs/msg/String, memory_bytes: 256}
"""
# Behind is a memory of 256 bytes, of which a quarter is used: 64 bytes, in whole beats of 4 bytes.
# At most a quarter of 12 packets, and at most eight packets in all; 65 bytes have no room.
GROUPS = ((2, 3, 4), (5,), (57,), (24, 40), (64,))
SIZES = (2, 65, 3, 4, 5, 57, 24, 40, 64, 9)


def exchanged(script):
    """Return the packets of each wait of a script, by topic: those sent, and those to come."""
    groups = [({}, {})]
    for line in script.lines:
        if line == "=":
            groups.append(({}, {}))
        elif line[0] in "<>":
            frame = bytes.fromhex(line[2:].replace("--", "00"))
            topic, length = (
                int.from_bytes(frame[at:end], "little") for at, end in ((2, 4), (4, 8))
            )
            assert (frame[0], length) == (0xF1, len(frame) - 16)
            groups[-1]["><".index(line[0])].setdefault(topic, []).append(frame[16:])
    return groups


def test_packets_are_chosen_that_have_room_on_their_whole_way():
    description = read(TEXTS)
    given = [bytes([number]) * size for number, size in enumerate(SIZES)]
    script = link_script(description, lambda *_: given, has_accelerator=False)
    groups = [group for group in exchanged(script) if group[0].keys() - {0}]
    for sizes, (asked, came) in zip(GROUPS, groups, strict=False):
        good = [packet for packet in given if len(packet) in sizes]
        assert asked == {1: [part for packet in good for part in (packet, packet[:-1])]}
        assert came == {3: good}
    # Nothing comes back of the other topic, so its memory is filled once.
    alone = [part for packet in (given[0], given[2]) for part in (packet, packet[:-1])]
    assert groups[len(GROUPS) :] == [({2: alone}, {})]
    # The counters are those of packets that were sent.
    counted = dict(re.findall(r"# Register \d+: ('\w+' of /\w+)\.\n> .*\n< (.*)", script.text))
    values = {name: bytes.fromhex(text)[20:24] for name, text in counted.items()}
    assert {name: int.from_bytes(value, "little") for name, value in values.items()} == {
        "'passed' of /in_1": 8,
        "'truncated' of /in_1": 8,
        "'passed' of /alone": 2,
        "'truncated' of /alone": 2,
    }


@pytest.mark.parametrize(
    ("published", "most"),
    [
        ("publish:\n  /out_1: {type: std_msgs/msg/String, memory_bytes: 4096}\n", 16 + 4096),
        ("", 16 + 1024),
    ],
)
def test_a_bench_has_room_for_the_frames_of_an_accelerator(published, most):
    # The user's own frames may be as large as the memory of any topic.
    description = read(TEXTS.partition("publish:")[0] + published)
    script = link_script(description, None, has_accelerator=True)
    ports = node_ports(Node(description))
    names = {port.name: port.name for port in ports}
    files = bench_files(
        description, "relay", ports, script,
        module="relay_verilog", vhdl_ports=names, vhdl_files=[], header="",
    )  # fmt: skip
    assert f"localparam MOST_BYTES = {most};" in files["relay_tb.v"]
    assert f"constant MOST_BYTES : positive := {most};" in files["vhdl/relay_tb.vhd"]


@pytest.mark.thorough
@pytest.mark.parametrize("target", ["sim", "sim_verilog"])
def test_fusesoc_runs_the_benches(target, folders, ghdl, iverilog, tmp_path):
    need("FuseSoC", "here" if find_spec("fusesoc") else None)
    command = [sys.executable, "-m", "fusesoc.main", "--cores-root", str(folders("stream"))]
    path = os.pathsep.join([os.path.dirname(ghdl), os.path.dirname(iverilog), os.environ["PATH"]])
    done = subprocess.run(
        [*command, "run", f"--target={target}", "firm-hdl:node:relay"],
        cwd=tmp_path,
        env={**os.environ, "PATH": path},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    output = done.stdout + done.stderr
    assert done.returncode == 0 and "PASS node relay: " in output, output
