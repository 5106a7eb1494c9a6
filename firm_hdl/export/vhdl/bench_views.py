"""Views of a pair of converters for test benches: the streams from one to the other.

The text of a bench does not depend on whether the converters have records of streams, a record of
values, or plain ports. A view has the connections, and the names of the streams.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from firm_hdl.export.primitives import TYPES_NAME, primitive_name
from firm_hdl.export.top import DIRECTIONS, Direction, Port, leaf_names, ports_of
from firm_hdl.export.vhdl.layer import RecordEntities, UserLayer
from firm_hdl.export.vhdl.wrapper import Core
from firm_hdl.plan import Leaf, Plan

__all__ = ["View", "flat_view", "record_view", "stream_view"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Channel:
    """A stream between the converters.

    Attributes
    ----------
    label : str
        Name in the file of transfers.
    rx, tx : mapping of str to str
        Signals of the deserializer and of the serializer: ``data``, ``valid``, ``ready``, and for
        items ``last``.
    image : str
        VHDL expression of the data as a string.
    """

    label: str
    rx: Mapping[str, str]
    tx: Mapping[str, str]
    image: str


@dataclass(frozen=True, slots=True, kw_only=True)
class View:
    """The converters as a bench connects them.

    Attributes
    ----------
    uses : str
        Use clauses.
    declarations : str
        Declarations of the architecture, such as signals.
    instances : mapping of direction to str
        The unit to instantiate.
    message_ports : mapping of direction to mapping of str to str
        Signals of the ports on the message side, by port.
    channels : list of Channel
    port_names : mapping of direction to mapping of str to str
        Names of ports, where they differ from those of :func:`ports_of`.
    bit_keep : bool
        On a bus of one byte, ``tkeep`` is a bit instead of a vector.
    """

    uses: str
    declarations: str
    instances: Mapping[Direction, str]
    message_ports: Mapping[Direction, Mapping[str, str]]
    channels: Sequence[Channel]
    port_names: Mapping[Direction, Mapping[str, str]] = field(default_factory=dict)
    bit_keep: bool = False


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
    kind = f"std_logic_vector({port.width - 1} downto 0)" if port.width > 1 else "std_logic"
    return f"  signal rx_{port.name}, tx_{port.name} : {kind};\n"
