"""What GHDL synthesizes from the VHDL does the same, in every cycle, as the Verilog."""

from __future__ import annotations

import random
import re
import subprocess
from pathlib import Path

import pytest
from amaranth.back import rtlil

from firm_hdl import Deserializer, Serializer
from firm_hdl.export.top import DIRECTIONS, Port, Top, ports_of
from firm_hdl.model import Message
from firm_hdl.plan import DEFAULT_MAX_MESSAGE_BYTES, Plan, build_plan
from firm_hdl.verilog import convert as to_verilog
from firm_hdl.vhdl import convert as to_vhdl
from firm_hdl.wire import lay_out
from tests.gateware.traffic import random_packets
from tests.strategies import make

# `tests/equivalence` proves the same of what GHDL synthesizes, beginning at a reset.
pytestmark = pytest.mark.thorough

TEXT = make("ros2", {"s": "string"}, "Text")
ROW = make("ros2", {"texts": (TEXT, "[]"), "n": "uint64"}, "Row")
MESSAGES = {
    "empty": make("ros2", {}),
    "numbers": make("ros2", {"a": "uint64", "b": "int8", "c": "float64[3]"}),
    "text": TEXT,
    "arrays": make("ros2", {"b": "uint8[]", "d": "float64[]"}),
    "nested": make("ros2", {"rows": (ROW, "[]"), "w": "uint16"}),
}
CORES = {"deserializer": Deserializer, "serializer": Serializer}

# The leaves of the deserializer go to the serializer, through gates that open at random. Inputs
# change after the rising edge, and outputs are compared before the next one. There is a reset in
# the middle of a packet.
BENCH = """
module bench;
  reg aclk = 1, aresetn = 1;
  always #1 aclk = ~aclk;
  integer seed = 1, cycle = 0, next = 0, statuses = 0, sent = 0;
{declarations}
{instances}
  wire same = {same};
  reg [{beat_bits}:0] beats [0:{last_beat}];
  initial $readmemb("beats.txt", beats);
  always @(posedge aclk) begin
    cycle <= cycle + 1;
    aresetn <= cycle != 200;
    if (!same) begin
      $display("cycle %0d:{shown}", cycle{values});
      $finish;
    end
    statuses <= statuses + (d_m_axis_status_tvalid & d_m_axis_status_tready);
    sent <= sent + (s_m_axis_tvalid & s_m_axis_tready & s_m_axis_tlast);
    if (d_s_axis_tvalid & d_s_axis_tready) begin
      next <= next + 1;
      d_s_axis_tvalid <= next != {last_beat} & $random(seed);
    end else d_s_axis_tvalid <= d_s_axis_tvalid | (next <= {last_beat} & $random(seed));
    {{d_m_axis_status_tready, s_m_axis_status_tready, s_m_axis_tready}} <= $random(seed);
{gates}
    if (cycle == {cycles}) begin
      $display("%0d statuses, %0d packets", statuses, sent);
      $finish;
    end
  end
  wire [{beat_bits}:0] beat = beats[next <= {last_beat} ? next : 0];
  always @* {{d_s_axis_tlast, d_s_axis_tkeep, d_s_axis_tdata}} = beat;
endmodule
"""


def beats_of(packet: bytes, bus_bytes: int) -> list[str]:
    """Return the beats of a packet, as bits: last, keep, data."""
    rows = []
    for start in range(0, len(packet), bus_bytes):
        part = packet[start : start + bus_bytes]
        last, keep = start + bus_bytes >= len(packet), (1 << len(part)) - 1
        data = int.from_bytes(part, "little")
        rows.append(f"{last:b}{keep:0{bus_bytes}b}{data:0{8 * bus_bytes}b}")
    return rows


def damaged(packets: list[bytes]) -> list[bytes]:
    """Cut, extend, or change every second packet."""
    rng = random.Random(1)
    result = []
    for index, packet in enumerate(packets):
        data = bytearray(packet)
        match index % 6:
            case 1:
                data = data[: rng.randint(1, len(data))]
            case 3:
                data += rng.randbytes(rng.randint(1, 20))
            case 5:
                data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
        result.append(bytes(data))
    return result


def bench(plan: Plan, names: dict[str, str], beats: int, cycles: int) -> str:
    """Return a bench with the Verilog and the netlist of both converters; `names` are the tops'."""
    declarations, instances, same, differing, gates = [], [], [], [], []
    gated = [leaf for leaf in ports_of(plan, "serializer") if leaf.member == "valid"]
    opens = {port.name.removesuffix("_valid") for port in gated}

    def declared(port: Port, prefix: str) -> str:
        return f"[{port.width - 1}:0] {prefix}{port.name}"

    for direction in DIRECTIONS:
        ports = [port for port in ports_of(plan, direction) if port.name not in ("aclk", "aresetn")]
        first = direction[0]
        for port in ports:
            if port.direction == "out":
                declarations += [f"wire {declared(port, f'{x}_')};" for x in (first, first + "n")]
                same.append(f"{first}_{port.name} === {first}n_{port.name}")
                differing += [f"{x}_{port.name}" for x in (first, first + "n")]
            elif port.member in ("", "ready" if direction == "serializer" else "valid"):
                declarations.append(f"reg {declared(port, f'{first}_')} = 0;")
            elif port.member in ("data", "last"):
                declarations.append(f"wire {declared(port, 's_')} = d_{port.name};")
        for prefix, module in ((first, direction), (first + "n", names[direction])):
            wires = [
                f".{port.name}({(first if port.direction == 'in' else prefix)}_{port.name})"
                for port in ports
            ]
            instances.append(
                f"{module} {prefix} (.aclk(aclk), .aresetn(aresetn), {', '.join(wires)});"
            )
    for leaf in sorted(opens):
        declarations += [
            f"reg open_{leaf} = 0;",
            f"wire s_{leaf}_valid = d_{leaf}_valid & open_{leaf};",
            f"wire d_{leaf}_ready = s_{leaf}_ready & open_{leaf};",
        ]
        taken = f"(open_{leaf} & ~(s_{leaf}_valid & s_{leaf}_ready))"
        gates.append(f"    open_{leaf} <= {taken} | $random(seed);")
    bus = plan.bus_bytes
    return BENCH.format(
        declarations="\n".join(f"  {line}" for line in sorted(declarations, key=len)),
        instances="\n".join(f"  {line}" for line in instances),
        same=" & ".join(f"({each})" for each in same),
        shown="".join(f" {each}=%b" for each in differing),
        values="".join(f", {each}" for each in differing),
        beat_bits=9 * bus,
        last_beat=beats - 1,
        gates="\n".join(gates),
        cycles=cycles,
    )


def output(folder: Path, *command: str) -> str:
    """Run a command, which must succeed; return what it printed."""
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def compared(
    folder: Path, ghdl: str, message: Message, count: int, limit: int = DEFAULT_MAX_MESSAGE_BYTES
) -> tuple[str, int]:
    """Return what the bench printed, and how many packets it had; `limit` is that of the VHDL."""
    plan = build_plan(lay_out(message))
    packets = damaged(random_packets(plan, count))
    beats = [beat for packet in packets for beat in beats_of(packet, plan.bus_bytes)]
    (folder / "beats.txt").write_text("".join(f"{beat}\n" for beat in beats))
    texts, names = [], {}
    for direction, core in CORES.items():
        circuit = rtlil.convert(Top(core(message)), name=direction, emit_src=False)
        texts.append(to_verilog(circuit, name=direction))
        design = Top(core(message, max_message_bytes=limit))
        circuit = rtlil.convert(design, name=direction, emit_src=False)
        vhdl = to_vhdl(circuit, name=f"{direction}_netlist")
        for name, text in vhdl.files.items():
            (folder / name).write_text(text)
        options = ["--std=08", "--out=verilog"]
        texts.append(output(folder, ghdl, "--synth", *options, *vhdl.files, "-e", vhdl.top))
        names[direction] = vhdl.top
    texts.append(bench(plan, names, len(beats), 300 + 6 * len(beats)))
    (folder / "all.v").write_text("\n".join(texts))
    output(folder, "iverilog", "-g2012", "-o", "bench", "-s", "bench", "all.v")
    return output(folder, "vvp", "-n", "bench"), len(packets)


@pytest.mark.usefixtures("iverilog")
@pytest.mark.parametrize("message", MESSAGES.values(), ids=MESSAGES)
def test_netlist_of_vhdl_is_the_verilog_in_every_cycle(ghdl, tmp_path, message):
    printed, count = compared(tmp_path, ghdl, message, 100)
    found = re.fullmatch(r"(\d+) statuses, (\d+) packets\n", printed)
    assert found, printed[:2000]
    # The reset loses at most one packet.
    assert int(found[1]) >= count - 1 and int(found[2]) >= count // 2


@pytest.mark.usefixtures("iverilog")
def test_netlist_of_another_circuit_is_found(ghdl, tmp_path):
    """Its limit of a length is smaller."""
    printed, _ = compared(tmp_path, ghdl, TEXT, 12, limit=16)
    assert not re.fullmatch(r"(\d+) statuses, (\d+) packets\n", printed)
