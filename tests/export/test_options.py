# amaranth: UnusedElaboratable=no
"""Options of `build`: their defaults, and that the circuits have all those of the plan."""

from __future__ import annotations

import pytest

from firm_hdl import Deserializer, Serializer
from firm_hdl.export.backend import Converters
from firm_hdl.export.build import build
from firm_hdl.plan import build_plan
from firm_hdl.wire import lay_out
from tests.strategies import make


def test_files_go_where_the_documentation_looks_for_them(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (built,) = build(["std_msgs/msg/Bool"])
    assert [path.name for path in tmp_path.iterdir()] == ["vhdl_out"]
    folder = tmp_path / "vhdl_out" / "lyrical" / "std_msgs_msg_Bool_cdr_8"
    assert folder.is_dir() and built.folder.resolve() == folder


MESSAGE = make("ros2", {"s": "string"})


def converters_of(wire="cdr", **options):
    plan = build_plan(lay_out(MESSAGE, wire), **{"bus_bytes": 1, **options})
    return Converters(message=MESSAGE, plan=plan, name="m")


@pytest.mark.parametrize(
    "options", [{}, {"wire": "ros1"}, {"bus_bytes": 2}, {"max_message_bytes": 100}]
)
def test_each_option_of_the_plan_is_one_of_the_converters(options):
    made = converters_of(**options)
    for converter in (Deserializer, Serializer):
        assert converter(MESSAGE, **made.parameters()).plan == made.plan


def test_circuits_of_both_directions_have_the_options():
    default = converters_of().make_circuits()
    made = converters_of(max_message_bytes=100).make_circuits()
    assert [*made] == [*default] == ["deserializer", "serializer"]
    for direction, text in made.items():
        assert text != default[direction]
        assert f"module \\m_{direction}\n" in text
