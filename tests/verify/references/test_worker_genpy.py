"""What the process with genpy answers, with a module of this test in place of genpy."""

from __future__ import annotations

import importlib
import sys
from types import SimpleNamespace

import pytest

from firm_hdl.verify.references import genpy_objects


class Message:
    """A message of genpy with a text, whose packet is this text."""

    __slots__ = ["s"]
    mark = b""

    def serialize(self, buffer):
        buffer.write(self.mark + self.s.encode("utf-8", "surrogateescape"))

    def deserialize(self, packet):
        if not packet:
            raise ValueError("x" * 500)
        self.s = packet.removeprefix(self.mark).decode("utf-8", "surrogateescape")


def generate_dynamic(name, text):
    sys.path.insert(0, "/generated")
    return {name: type("Generated", (Message,), {"mark": text.encode()})}


@pytest.fixture
def ask(monkeypatch):
    """A function that sends a request to the readers."""
    # The process that runs the worker has its folder in the search path.
    monkeypatch.setitem(sys.modules, "genpy_objects", genpy_objects)
    worker = importlib.import_module("firm_hdl.verify.references.worker_genpy")
    dynamic = SimpleNamespace(generate_dynamic=generate_dynamic)
    monkeypatch.setitem(sys.modules, "genpy.dynamic", dynamic)
    genpy = SimpleNamespace(dynamic=dynamic, Time=None, Duration=None)
    monkeypatch.setitem(sys.modules, "genpy", genpy)
    judges, modules = worker.readers("")
    assert sorted(judges) == ["decode", "encode", "open"] and modules == ("genpy",)
    return lambda oracle, **request: judges[oracle](request)


def opened(ask, name, text):
    return ask("open", name=name, text=text, table={name: [("s", False, "string")]})


def test_the_type_that_was_opened_last_is_written_and_read(ask):
    before = list(sys.path)
    for name, mark in (("p/A", "a"), ("q/B", "b"), ("p/A", "c")):
        assert opened(ask, name, mark) is None
        assert ask("encode", items=[{"s": "x"}, {"s": ""}]) == [
            {"item": f"{mark}x"},
            {"item": mark},
        ]
        assert ask("decode", items=[f"{mark}y"]) == [{"item": {"s": "y"}}]
    # genpy's folders of generated modules do not collect there.
    assert sys.path == before


def test_each_byte_is_a_character_on_the_way(ask):
    opened(ask, "p/A", "")
    text = bytes(range(256)).decode("latin-1")
    assert ask("encode", items=[{"s": text}]) == [{"item": text}]
    assert ask("decode", items=[text]) == [{"item": {"s": text}}]


def test_an_item_that_is_refused_leaves_the_others_alone(ask):
    opened(ask, "p/A", "")
    one, refused, other = ask("decode", items=["a", "", "b"])
    assert (one, other) == ({"item": {"s": "a"}}, {"item": {"s": "b"}})
    assert refused == {"refused": f"ValueError: {'x' * 288}"}
    (refused,) = ask("encode", items=[{"t": "x"}])
    assert refused == {"refused": "KeyError: 's'"}
