# amaranth: UnusedElaboratable=no
"""The module between a node and the pins of a board."""

from __future__ import annotations

import shutil
import subprocess

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.node import Node
from firm_hdl.node.bitstream.board import read_board
from firm_hdl.node.bitstream.top import board_top
from firm_hdl.node.bytestream import ByteStreamReader, write_frame
from firm_hdl.node.messages import MessageReceiver, MessageSender, NodeMessage
from firm_hdl.node.top import node_ports
from tests.node.bitstream.samples import PINS, description
from tests.tools import need

# A board with a PLL, a button for the reset, and lamps of both kinds.
BOARD = "like: ulx3s-85f\nreset: {pin: A2, active: low}\npins: {lamp: {pins: D1, active: low}}\n"

UART = "link: {kind: uart, baud: 1250000, memory_bytes: 64, packets: 2}"
PHY = '{kind: rtps, ethernet: rgmii, mac: "02:00:00:00:00:50", address: 192.168.1.50/24}'

BENCH = """\
// The clock of the node is that of the board, which simulates quickest.
module EHXPLLL #(
  parameter CLKI_DIV = 0, CLKFB_DIV = 0, CLKOP_DIV = 0, CLKOP_CPHASE = 0, CLKOS_DIV = 0,
  parameter CLKOS_CPHASE = 0, FEEDBK_PATH = "", CLKOP_ENABLE = "", CLKOS_ENABLE = "",
  parameter OUTDIVIDER_MUXA = "", OUTDIVIDER_MUXB = "", DPHASE_SOURCE = "", PLLRST_ENA = "",
  parameter INTFB_WAKE = "", STDBY_ENABLE = ""
) (
  input CLKI, CLKFB, RST, STDBY, PLLWAKESYNC, ENCLKOP, ENCLKOS, PHASESEL0, PHASESEL1, PHASEDIR,
  input PHASESTEP, PHASELOADREG, output CLKOP, CLKOS, output reg LOCK
);
  assign CLKOP = CLKI;
  assign CLKOS = CLKI;
  initial begin LOCK = 0; #1000 LOCK = 1; end
endmodule

module bench;
  reg clk = 0, reset = 1, rx = 1, button = 0;
  wire tx, constant, bus, wire_;
  wire [1:0] lamps;
  pullup (wire_);
  always #1 clk = ~clk;
  top top (
    .clk(clk), .reset(reset), .constant_L2(constant), .uart_rx(rx), .uart_tx(tx),
    .io_lamps(lamps), .io_button(button), .io_wire(wire_), .io_bus_a(bus)
  );
  reg [7:0] bytes [0:COUNT - 1];
  integer byte_, bit_;
  initial begin
    $readmemh("bytes.hex", bytes);
    #1010 if (top.aresetn) $display("no reset after the start");
    #400 if (!top.aresetn) $display("reset for ever");
    // A lamp of each kind, both with a 1; a constant; a wire that is free, and pulled down.
    $display("%b%b%b", lamps, constant, wire_);
    button = 1;
    #8 $display("%b%b", wire_, bus);
    for (byte_ = 0; byte_ < COUNT; byte_ = byte_ + 1) begin
      rx = 0;
      for (bit_ = 0; bit_ < 8; bit_ = bit_ + 1) #8 rx = bytes[byte_][bit_];
      #8 rx = 1;
      #8;
    end
    #8000 reset = 0;
    #20 if (top.aresetn) $display("the button does not reset");
    $finish;
  end
  reg [7:0] came;
  integer n;
  always @(negedge tx) begin
    #4 for (n = 0; n < 8; n = n + 1) #8 came[n] = tx;
    $display("> %h", came);
    #8;
  end
endmodule
"""


def errors(changed, board="ulx3s-85f"):
    """Return the mistakes of a description for a board, with their places."""
    with pytest.raises(DefinitionError) as raised:
        ports = [vars_of(port) for port in node_ports(Node(changed))]
        board_top(changed, ports, "pins_verilog", read_board(board))
    return [
        f"{p.span.line}:{p.span.column}-{p.span.end - p.span.start}: {p.message}"
        for p in raised.value.diagnostics
    ]


def vars_of(port):
    return {name: getattr(port, name) for name in ("name", "direction", "width", "member")}


def test_a_message_comes_back_through_the_pins_of_a_board(node, tmp_path):
    iverilog = need("iverilog", shutil.which("iverilog"))
    wanted = description(PINS.replace("led.0", "lamp.0"))
    (tmp_path / "mine.yaml").write_text(BOARD)
    ports = [vars_of(port) for port in node_ports(Node(wanted))]
    top = board_top(wanted, ports, "pins_verilog", read_board(str(tmp_path / "mine.yaml")))
    assert 'LOCATE COMP "io_lamps[0]" SITE "D1";\n' in top.constraints
    assert 'IOBUF PORT "io_button" IO_TYPE=LVCMOS33 PULLMODE=DOWN;\n' in top.constraints
    text = b"\0\1\0\0\5\0\0\0lamp\0"
    sent = NodeMessage(topic=1, packet=text)
    (frame,) = MessageSender().frames(sent)
    data = write_frame(frame)
    (tmp_path / "bytes.hex").write_text("".join(f"{byte:02x}\n" for byte in data))
    (tmp_path / "bench.v").write_text(BENCH.replace("COUNT", str(len(data))))
    (tmp_path / "top.v").write_text(top.verilog)
    files = ["bench.v", "top.v", node.folder / "pins_verilog.v"]
    command = [iverilog, "-g2005", "-Wall", "-s", "bench", "-o", "o", *files]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stderr) == (0, "")
    command = ["vvp", "-n", "o"]
    lines = subprocess.check_output(command, cwd=tmp_path, text=True, timeout=60).splitlines()
    # `lamp.0` is 1 with 0 V, and `led.1` has a 0.
    assert lines[:2] == ["0011", "00"]
    assert all(line.startswith("> ") for line in lines[2:]), lines
    came = ByteStreamReader().feed(bytes(int(line[2:], 16) for line in lines[2:]))
    receiver = MessageReceiver()
    assert [receiver.take(each) for each in came] == [NodeMessage(topic=2, packet=text)]


def test_each_mistake_is_at_its_place_in_the_description():
    has = "ulx3s-85f has uart, led, button, power, switch, gpio"
    pins = "pins: {lamps: [led.9, L2, led], buton: G3, wire: [M1], bus.a: gpio.0-}\n"
    assert errors(description(pins)) == [
        "5:14-33: 'button' of the accelerator has no pin: write 'pins: {button: [...]}' into the "
        f"description; {has}",
        "10:8-5: 'lamps' has 2 bits, and is given 8 pins",
        "10:16-5: ulx3s-85f has no pin 'led.9'; 'led' has 0, 1, 2, 3, 4, 5, 6, 7",
        f"10:23-2: ulx3s-85f has no pin 'L2'. {has.replace('ulx3s-85f', 'It')}",
        "10:33-5: the accelerator has no member 'buton'; did you mean 'button'?",
        "10:51-2: the pin 'M1' is already that of the link ('uart.rx')",
    ]
    twice = "pins: {lamps: [led.0, B2], button: button.1, wire: gpio.0+, bus.a: C2}\n"
    assert errors(description(twice)) == ["10:23-2: the pin 'B2' is already that of 'lamps'"]


def test_all_mistakes_are_told_at_once():
    pins = "pins: {lamps: [led.0, led.0], button: A1, wire: pmod0.2, bus.a: pmod0.1}\n"
    said = errors(description(pins, {"clock_mhz: 5": "clock_mhz: 1000"}), "ecpix5-85f")
    lacks = "ecpix5-85f has no pin"
    assert [each.partition(" It has")[0] for each in said] == [
        "2:12-4: the clock of ecpix5-85f, 100 MHz, gives no 1000 MHz; the node itself reaches "
        "about 154 MHz on ECP5 LFE5U-45F-8",
        *(f"10:{at}-5: {lacks} 'led.0'; did you mean 'rgb_led.r0'?" for at in (16, 23)),
        f"10:39-2: {lacks} 'A1'; did you mean 'A21'?",
    ]


@pytest.mark.parametrize(
    ("change", "board", "error"),
    [
        (
            {UART: "link: udp"},
            "ulx3s-85f",
            "4:7-3: ulx3s-85f has uart, so the description needs 'link: {kind: uart}'; for 'udp', "
            "the top level is yours to write",
        ),
        (
            {UART: "link: stream"},
            "ecpix5-85f",
            "4:7-6: ecpix5-85f has uart and rgmii, so the description needs 'link: {kind: udp, "
            "ethernet: rgmii, ...}' or 'link: {kind: uart}'; for 'stream', the top level is yours "
            "to write",
        ),
        (
            {UART: f"link: {PHY.replace('rgmii', 'mii')}", "clock_mhz: 5": "clock_mhz: 25"},
            "ecpix5-85f",
            "4:7-79: ecpix5-85f has uart and rgmii, so the description needs 'ethernet: rgmii' or "
            "'link: {kind: uart}'; for 'ethernet: mii', the top level is yours to write",
        ),
        (
            {"clock_mhz: 5": "clock_mhz: 5\nregisters: axi4lite"},
            "ulx3s-85f",
            "3:12-8: ulx3s-85f has no processor for the registers; the top level is yours to write",
        ),
        (
            {"clock_mhz: 5": "clock_mhz: 25"},
            "icebreaker",
            "2:12-2: the clock of icebreaker, 12 MHz, gives no 25 MHz; near is 'clock_mhz: 25.125'",
        ),
    ],
)
def test_a_board_that_does_not_fit_is_refused(change, board, error):
    assert error in errors(description(changes=change), board)


def test_a_board_without_rgmii_says_so_once():
    said = errors(description(changes={UART: f"link: {PHY}", "clock_mhz: 5": "clock_mhz: 25"}))
    assert said == [
        "4:7-81: ulx3s-85f has no RGMII; boards that have one: colorlight-5a-75b, colorlight-i5, "
        "colorlight-i9, ecpix5-45f, ecpix5-85f, versa-ecp5, versa-ecp5-5g"
    ]


def test_a_board_of_ones_own_may_lack_a_link_or_some_of_its_pins(tmp_path):
    text = BOARD.replace("lamp:", "uart: {names: rx, pins: M1}, lamp:")
    (tmp_path / "mine.yaml").write_text(text)
    lacks = "4:7-57: mine lacks pins of the link: uart.tx"
    assert lacks in errors(description(), str(tmp_path / "mine.yaml"))
    whole = "title: t\ndevice: LFE5U-25F\npackage: CABGA256\nclock: {pin: P6, mhz: 25}\n"
    (tmp_path / "none.yaml").write_text(f"{whole}speed: 6\npins: {{led: {{pins: A1}}}}\n")
    lacks = "4:7-3: none has no link; for 'udp', the top level is yours to write"
    assert lacks in errors(description(changes={UART: "link: udp"}), str(tmp_path / "none.yaml"))


def test_a_node_without_accelerator_has_no_pins():
    without = description("", {"accelerator: tests.node.bitstream.samples:Pins\n": ""})
    assert errors(without) == [
        "1:7-4: a node whose messages come out of it has too many pins: it needs an 'accelerator', "
        "such as 'firm_hdl.node.loop:Loop', which sends all messages back"
    ]
    with pytest.raises(DefinitionError, match="'pins' are those of an accelerator"):
        description("pins: {a: A1}\n", {"accelerator: tests.node.bitstream.samples:Pins\n": ""})


def test_an_rgmii_has_its_pins_its_clock_and_no_reset():
    ports = [
        {"name": f"rgmii_{name}", "direction": way, "width": width, "member": f"link.rgmii.{name}"}
        for name, way, width in (("rxc", "in", 1), ("rxd", "in", 4), ("txd", "out", 4))
    ]
    # That of a participant of ROS 2, which has no pins.
    ports.append({"name": "nonce", "direction": "in", "width": 32, "member": "link.nonce"})
    pins = "pins: {lamps: [rgmii.txd, rgmii.rst_n]}\n"
    wanted = description(pins, {"clock_mhz: 5": "clock_mhz: 125"})
    with pytest.raises(DefinitionError) as raised:
        lamps = {"name": "io_lamps", "direction": "out", "width": 2, "member": "io.lamps"}
        board_top(wanted, [*ports, lamps], "pins_verilog", read_board("ecpix5-45f"))
    said = [each.message for each in raised.value.diagnostics]
    own = "the pin 'rgmii.rst_n', C13, is already that of the board, which holds it at 1"
    assert own in said, said
    wanted = description("pins: {}\n", {"clock_mhz: 5": "clock_mhz: 125"})
    top = board_top(wanted, ports, "pins_verilog", read_board("ecpix5-45f"))
    for line in (
        'FREQUENCY PORT "rgmii_rxc" 125.000000 MHZ;\n',
        'LOCATE COMP "rgmii_rxd[3]" SITE "A9";\n',
        'LOCATE COMP "rgmii_txd[0]" SITE "D8";\n',
        'LOCATE COMP "constant_C13" SITE "C13";\n',
    ):
        assert line in top.constraints
    assert "assign constant_C13 = 1'b1;\n" in top.verilog
    assert "output wire [3:0] rgmii_txd" in top.verilog
    assert ".nonce(32'd0)" in top.verilog
