"""Nodes: an FPGA design with several topics behind one link.

A description in YAML becomes a :class:`Description`. From it follow the circuit, the frames between
the circuit and its host, and the manifest that tells a host what the ids of topics mean.
"""

from firm_hdl.node.description import Description, Link, Qos, Store, Topic
from firm_hdl.node.reading import read_description, read_description_text

__all__ = [
    "Description",
    "Link",
    "Qos",
    "Store",
    "Topic",
    "read_description",
    "read_description_text",
]
