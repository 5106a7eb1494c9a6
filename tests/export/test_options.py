# amaranth: UnusedElaboratable=no
"""Options of `build`: their defaults, and that circuits and headers have those of the plan."""

from __future__ import annotations

from firm_hdl.export.backend import Converters
from firm_hdl.plan import build_plan
from firm_hdl.wire import lay_out
from tests.strategies import make

MESSAGE = make("ros2", {"s": "string"})


def converters_of(wire="cdr", **options):
    plan = build_plan(lay_out(MESSAGE, wire), **{"bus_bytes": 1, **options})
    return Converters(message=MESSAGE, plan=plan, name="m")


def test_circuits_of_both_directions_have_the_options():
    default = converters_of().make_circuits()
    made = converters_of(max_message_bytes=100).make_circuits()
    assert [*made] == [*default] == ["deserializer", "serializer"]
    for direction, design in made.items():
        assert design != default[direction] and design.top.name == f"m_{direction}"


def test_a_header_has_the_options_of_the_plan_and_the_hash_of_the_definition():
    # The wire format and the limit are those of the plan, whether or not they were asked for.
    message = make("ros1", {"x": "int8"})
    plan = build_plan(lay_out(message, "cdr"), bus_bytes=4, max_message_bytes=999)
    inputs = {
        "generator": {"firm-hdl": "7.8", "amaranth": "0.5"},
        "distro": "noetic",
        "definition_sha256": "d" * 64,
        "plan_sha256": "p" * 64,
    }
    made = Converters(message=message, plan=plan, name="m", inputs=inputs)
    assert made.header("m_rx", "the deserializer").splitlines() == [
        f"m_rx: the deserializer of {message.name}, made by firm-hdl 7.8.",
        "noetic, wire cdr, bus of 4 bytes, messages of at most 999 bytes",
        f"definition (SHA-256): {'d' * 64}",
        "What each port means: manifest.json.",
    ]
    assert Converters(message=message, plan=plan, name="m").header("m", "a part") == ""
