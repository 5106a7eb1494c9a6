"""The header in C++ for a program that talks with a node on a Zynq without the bridge."""

from __future__ import annotations

from pathlib import Path

from firm_hdl.node.description import Description

__all__ = ["zynq_header"]


def zynq_header(description: Description, name: str) -> str:
    """Return the driver, followed by the constants of a node: those that the board has, too.

    * `name`: an identifier, such as `wheels`; the namespace of the constants is `wheels_node`.
    """
    topics = "".join(
        f"constexpr std::uint16_t topic_{topic.port} = {topic.id};  // {topic.name}: {topic.type}\n"
        for topic in description.topics
    )
    driver = (Path(__file__).parent / "zynq.hpp").read_text(encoding="utf-8")
    return f"""\
{driver}
#ifndef {name.upper()}_NODE_ZYNQ_HPP
#define {name.upper()}_NODE_ZYNQ_HPP

namespace {name}_node {{

constexpr std::uint64_t fingerprint = 0x{description.fingerprint:016x};
constexpr std::uint32_t buffer_bytes = {description.link.buffer_bytes};
{topics}
}}  // namespace {name}_node

#endif
"""
