"""Test benches in VHDL for each message type, and a script that runs them in GHDL.

Packets from a file go through the deserializer, an accelerator that changes nothing, and the
serializer, all with random stalls. The bench compares the packets that come out byte for byte with
another file. It writes all packets and all transfers of leaves to files. The text does not depend
on whether the converters have records of streams, a record of values, or plain ports: a view has
the connections, and the names of the streams.

Packets are in text files, one per line, with their bytes in hexadecimal in wire order. An empty
line is an empty packet, and a line that starts with ``#`` is a comment.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from firm_hdl.export.primitives import TYPES_NAME, primitive_name
from firm_hdl.export.templates import render, text_of
from firm_hdl.export.top import DIRECTIONS, Direction, Port, leaf_names, ports_of
from firm_hdl.export.vhdl.constants import comment
from firm_hdl.export.vhdl.layer import RecordEntities, UserLayer
from firm_hdl.export.vhdl.wrapper import Core
from firm_hdl.plan import Leaf, Plan

__all__ = [
    "PARTS",
    "RUN_SCRIPT",
    "STIMULI",
    "View",
    "bench",
    "flat_view",
    "packets_text",
    "record_view",
    "run_script",
    "stream_view",
]


PARTS = {
    name: text_of(f"vhdl/{name}")
    for name in ("firm_hdl_bench_pkg.vhd", "firm_hdl_axis_source.vhd", "firm_hdl_axis_sink.vhd")
}
"""Texts by file name, in compile order."""


def packets_text(packets: Iterable[bytes], remark: str = "") -> str:
    """Return the text of a file of packets, as the source and the sink read it.

    >>> packets_text([b"\\x00\\x1f", b""], "Two packets.")
    '# Two packets.\\n001f\\n\\n'
    """
    head = "".join(f"# {line}\n" for line in remark.splitlines())
    return head + "".join(f"{packet.hex()}\n" for packet in packets)


@dataclass(frozen=True, slots=True, kw_only=True)
class Channel:
    """A stream between the converters."""

    label: str  # Name in the file of transfers.
    # Signals of the deserializer and of the serializer: `data`, `valid`, `ready`, and for items
    # `last`.
    rx: Mapping[str, str]
    tx: Mapping[str, str]
    image: str  # VHDL expression of the data as a string.


@dataclass(frozen=True, slots=True, kw_only=True)
class View:
    """The converters as a bench connects them."""

    uses: str  # Use clauses.
    declarations: str  # Declarations of the architecture, such as signals.
    instances: Mapping[Direction, str]  # The unit to instantiate.
    # Signals of the ports on the message side, by port.
    message_ports: Mapping[Direction, Mapping[str, str]]
    channels: Sequence[Channel]
    # Names of ports, where they differ from those of `ports_of`.
    port_names: Mapping[Direction, Mapping[str, str]] = field(default_factory=dict)
    bit_keep: bool = False  # On a bus of one byte, `tkeep` is a bit instead of a vector.


# Names of the message's package are written in full, because constants in it may have the names of
# declarations in `std.textio`. The use clause is for tools that find the compile order of files.
_USES = """\
use work.firm_hdl_bench_pkg.all;
use work.{types}.all;
use work.{package};
use work.{components}.all;
"""


def _uses(layer: UserLayer) -> str:
    components = f"{layer.name}_components_pkg"
    return _USES.format(types=TYPES_NAME, package=layer.package, components=components)


_SIDES: Mapping[Direction, str] = {"deserializer": "rx", "serializer": "tx"}
"""Prefixes of the signals of each converter."""


def stream_view(plan: Plan, layer: UserLayer) -> View:
    """Return the view of converters with a record of streams."""
    root = layer.tree.root
    channels = []
    for node in root.leaves():
        assert node.leaf is not None
        leaf = plan.leaves[node.leaf]
        sides = [
            {
                **{name: f"{side}_msg.{node.access}.{name}" for name in _payload(leaf)},
                "valid": f"{side}_msg.{node.access}.valid",
                "ready": f"{side}_rdy.{node.access}",
            }
            for side in _SIDES.values()
        ]
        data = sides[0]["data"]
        whole = f"to_slv({data})" if leaf.kind == "items" else data
        one_bit = leaf.kind != "items" and primitive_name(leaf) == "bool"
        image = f"to_string({whole})" if one_bit else f"to_hstring({whole})"
        channels.append(Channel(label=str(leaf), rx=sides[0], tx=sides[1], image=image))
    return View(
        uses=_uses(layer),
        declarations=(
            f"  signal rx_msg, tx_msg : work.{layer.package}.{root.type};\n"
            f"  signal rx_rdy, tx_rdy : work.{layer.package}.{root.ready_type};\n"
        ),
        instances=layer.entities,
        message_ports={
            way: {"msg": f"{side}_msg", "rdy": f"{side}_rdy"} for way, side in _SIDES.items()
        },
        channels=channels,
    )


def _payload(leaf: Leaf) -> tuple[str, ...]:
    return ("data", "last") if leaf.kind == "items" else ("data",)


def record_view(layer: UserLayer, record: RecordEntities) -> View:
    """Return the view of converters with a record of values: one stream of whole messages."""
    image = f"to_hstring(work.{layer.package}.to_slv(rx_msg))"
    sides = [
        {"data": f"{side}_msg", "valid": f"{side}_valid", "ready": f"{side}_ready"}
        for side in _SIDES.values()
    ]
    return View(
        uses=_uses(layer),
        declarations=(
            f"  signal rx_msg, tx_msg     : work.{layer.package}.{record.values.name};\n"
            "  signal rx_valid, tx_valid : std_logic;\n"
            "  signal rx_ready, tx_ready : std_logic;\n"
        ),
        instances=record.entities,
        message_ports={
            way: {"msg": f"{side}_msg", "msg_valid": f"{side}_valid", "msg_ready": f"{side}_ready"}
            for way, side in _SIDES.items()
        },
        channels=[Channel(label="msg", rx=sides[0], tx=sides[1], image=image)],
    )


_STATUS = """
  constant STATUS_OK : std_logic_vector(7 downto 0) := x"00";

  function status_name (status : std_logic_vector(7 downto 0)) return string is
  begin
    return "code " & to_hstring(status);
  end function;
"""


def flat_view(plan: Plan, package: str, cores: Mapping[Direction, Core]) -> View:
    """Return the view of converters with plain ports, without any record."""
    names = leaf_names(plan)
    ports = {
        way: [port for port in ports_of(plan, way) if port.leaf is not None] for way in DIRECTIONS
    }
    widths = {port.name: port.width for port in ports["deserializer"]}
    channels = []
    for leaf in plan.leaves:
        base = names[leaf.path]
        rx, tx = (
            {name: f"{side}_{base}_{name}" for name in (*_payload(leaf), "valid", "ready")}
            for side in _SIDES.values()
        )
        image = "to_hstring" if widths[f"{base}_data"] > 1 else "to_string"
        channels.append(Channel(label=str(leaf), rx=rx, tx=tx, image=f"{image}({rx['data']})"))
    return View(
        uses=f"use work.firm_hdl_bench_pkg.all;\nuse work.{package};\n",
        declarations="".join(map(_signals, ports["deserializer"])) + _STATUS,
        instances={way: f"component work.{package}.{cores[way].entity}" for way in cores},
        message_ports={
            way: {port.name: f"{side}_{port.name}" for port in ports[way]}
            for way, side in _SIDES.items()
        },
        channels=channels,
        port_names={way: core.names for way, core in cores.items()},
        bit_keep=True,
    )


def _signals(port: Port) -> str:
    return f"  signal rx_{port.name}, tx_{port.name} : {port.vhdl_type};\n"


STIMULI = "stimuli.txt"
"""The file with packets, in the folder of the script."""

RUN_SCRIPT = "run_ghdl.sh"


def bench(
    top: str, view: View, *, bus_bytes: int, what: str, files: str = "", header: str = ""
) -> str:
    """Write a test bench.

    * `top`: name of the entity.
    * `what`: description of the converters, for the last line that the bench prints.
    * `files`: suffix of the names of the files that the bench writes.
    * `header`: lines of a comment at the head of the file.
    """
    title = f"Test bench of the converters of {what}. Simulation only."
    return render(
        "vhdl/bench.vhd",
        head="".join([*comment(header, ""), *comment(title, "")]),
        top=top,
        view=view,
        converters=[_converter(view, direction, bus_bytes) for direction in DIRECTIONS],
        bus_bytes=bus_bytes,
        what=what,
        files=files,
    )


def _converter(view: View, direction: Direction, bus_bytes: int) -> tuple[str, str, str]:
    """Return an instance of a converter: its label, the unit, and the lines of its port map."""
    if direction == "deserializer":
        side, bench, axis = "rx", "i", "s_axis"
        beat = ["tdata", "tkeep", "tlast", "tvalid", "tready"]
    else:
        side, bench, axis = "tx", "o", "m_axis"
        beat = ["tdata", "tkeep", "tlast", "tuser", "tvalid", "tready"]
    signals = {"aclk": "aclk", "aresetn": "aresetn"}
    signals |= {f"{axis}_{name}": f"{bench}_{name}" for name in beat}
    if view.bit_keep and bus_bytes == 1:
        signals[f"{axis}_tkeep"] += "(0)"
    signals |= view.message_ports[direction]
    signals |= {f"m_axis_status_{name}": f"{side}_{name}" for name in ("tdata", "tvalid", "tready")}
    names = view.port_names.get(direction, {})
    ports = {names.get(port, port): signal for port, signal in signals.items()}
    width = max(map(len, ports))
    lines = ",\n".join(f"      {port:{width}} => {signal}" for port, signal in ports.items())
    return side, view.instances[direction], lines


def run_script(files: Iterable[str], top: str) -> str:
    """Write the script that runs the benches in GHDL.

    * `files`: names of the files in compile order, in the folder of the script.
    * `top`: entity of the bench that runs by default.
    """
    return render(
        "vhdl/run_ghdl.sh", files=list(files), top=top, script=RUN_SCRIPT, stimuli=STIMULI
    )
