"""Parts of all VHDL test benches: a source and a sink of packets that stall at random.

Packets are in text files, one per line, with their bytes in hexadecimal in wire order. An empty
line is an empty packet, and a line that starts with ``#`` is a comment. Simulation only.
"""

from __future__ import annotations

from collections.abc import Iterable

from firm_hdl.export.templates import text_of

__all__ = ["PARTS", "packets_text"]

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
