"""What a constructor that raises leaves behind."""

from __future__ import annotations

import gc
import warnings
from collections.abc import Callable
from typing import Any

import pytest
from amaranth.hdl import Fragment, UnusedElaboratable

from firm_hdl import (
    Deserializer,
    MessageBuffer,
    PacketArbiter,
    PacketCrossing,
    PacketFifo,
    PacketGate,
    PacketRouter,
    PacketWidth,
    Parser,
    RecordReader,
    RecordWriter,
    Serializer,
    load_message,
)
from firm_hdl.export.top import Top
from firm_hdl.node import Node
from firm_hdl.sim.fast import FastSimulation

TWIST = load_message("geometry_msgs/msg/Twist")


def unused(make: Callable[[], object]) -> list[str]:
    """Return the warnings of a component that is made and not used."""
    # Amaranth warns only after it has elaborated something.
    Fragment.get(PacketWidth(4, 8), None)
    gc.collect(1)
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always", UnusedElaboratable)
        make()
        gc.collect(1)
    return [str(each.message) for each in found]


REFUSED: list[tuple[Any, tuple[Any, ...], dict[str, Any]]] = [
    (Deserializer, (), {}),
    (Deserializer, (TWIST,), {"bus_bytes": 3}),
    (Serializer, ("geometry_msgs/msg/Twist",), {}),
    (MessageBuffer, (TWIST,), {"bus_bytes": 3}),
    (Parser, (TWIST,), {"max_message_bytes": 1}),
    (RecordReader, (TWIST,), {"fields": "linear"}),
    (RecordWriter, (TWIST,), {"fields": ["speed"]}),
    (PacketFifo, (8, 100, 4), {}),
    (PacketGate, (TWIST,), {"when_full": "never"}),
    (PacketArbiter, (8, 0), {}),
    (PacketRouter, (8, 0), {}),
    (PacketWidth, (3, 8), {}),
    (PacketCrossing, (8, 5), {}),
    (Top, (Parser,), {}),
    (Node, (TWIST,), {}),
]


def test_a_constructor_that_raises_leaves_no_warning() -> None:
    def make() -> None:
        for kind, arguments, options in REFUSED:
            with pytest.raises((TypeError, ValueError)):
                kind(*arguments, **options)

    assert unused(make) == []


def test_a_simulation_that_cannot_start_leaves_no_warning_of_its_design() -> None:
    def make() -> None:
        with pytest.raises(ValueError, match=r"^Engine must be"):
            FastSimulation(PacketWidth(4, 8), engine="quick")  # type: ignore[arg-type]

    assert unused(make) == []


def test_a_component_that_is_never_used_has_its_warning() -> None:
    (warning,) = unused(lambda: PacketFifo(8, 64, 2))
    assert "PacketFifo" in warning
