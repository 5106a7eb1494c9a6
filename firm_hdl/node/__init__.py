"""Nodes: an FPGA design with several topics behind one link.

A description in YAML becomes a :class:`Description`. From it follow the circuit, the frames between
the circuit and its host, and the manifest that tells a host what the ids of topics mean.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from firm_hdl.node.description import Description, Link, Store, Topic, TopicQos
from firm_hdl.node.reading import read_description, read_description_text

if TYPE_CHECKING:
    from firm_hdl.node.accelerator import accelerator_signature
    from firm_hdl.node.node import Node

__all__ = [
    "Description",
    "Link",
    "Node",
    "Store",
    "Topic",
    "TopicQos",
    "accelerator_signature",
    "read_description",
    "read_description_text",
]

# Import lazily: Amaranth takes seconds to import, and a host does not need it.
_HOME = {"Node": "node", "accelerator_signature": "accelerator"}


def __getattr__(name: str) -> Any:
    """Import an exported name at its first use."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
