"""The notebook of a project for PYNQ, which simulates the node where there is no board."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from typing import Any

from rosbags.typesys import Stores, get_typestore

from firm_hdl.node.description import Description

__all__ = ["notebook"]

_OPEN = """\
{head}from importlib.util import find_spec

from firm_hdl.node import read_description
from firm_hdl.node.bridge import Client

if "node" in globals():
    node.close()  # While the FPGA is loaded, nothing may read it.
description = read_description({file})
has_board = find_spec("pynq") is not None  # False simulates the node.
if has_board:
    print("PYNQ loads {name}.bit")
    from firm_hdl.node.boards.pynq import NodeOverlay

    board = NodeOverlay("{name}.bit").board(description)
else:
    print("There is no PYNQ: the node is simulated. Compiling it takes minutes at first.")
    from firm_hdl.node.boards import board_of

    board = board_of("sim", description)

node = Client(description, board, report=print).open()"""

_MOST_BYTES = 256
"""Of a packet that is nice to look at."""

_GRAPH = """\
In a graph of ROS 2, the node is there for other nodes. PYNQ needs no ROS for that:

```python
from firm_hdl.node.bridge import Bridge
from firm_hdl.node.graphs import graph_of

Bridge(description, board, graph_of("rtps", description), report=print).run(seconds=3600)
```"""


def notebook(
    description: Description, name: str, file: str, sample: Sequence[bytes]
) -> dict[str, Any]:
    """Return a notebook (nbformat 4.5).

    * `name`: of the files of the overlay.
    * `file`: the description, relative to the notebook. On the board, it is beside it.
    * `sample`: packets of the first subscription. One with many values is sent.
    """
    cells: list[dict[str, Any]] = [
        {
            "cell_type": kind,
            "id": f"cell-{number}",
            "metadata": {},
            **({"execution_count": None, "outputs": []} if kind == "code" else {}),
            "source": text.splitlines(keepends=True),
        }
        for number, (kind, text) in enumerate(_cells(description, name, file, sample))
    ]
    language = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}}
    return {"cells": cells, "metadata": language, "nbformat": 4, "nbformat_minor": 5}


def _cells(
    description: Description, name: str, file: str, sample: Sequence[bytes]
) -> Iterator[tuple[str, str]]:
    yield (
        "markdown",
        f"# The node {description.node}\n\nWhere the module `pynq` is installed, this loads the "
        "overlay. Elsewhere, the node is simulated; to compile it takes a minute or two at first.",
    )
    head, place, copy = "", repr(file), repr(os.path.basename(file))
    if place != copy:
        # On the board, it was copied beside the notebook.
        head, place = "import os\n", f"{copy} if os.path.exists({copy}) else {place}"
    yield "code", _OPEN.format(head=head, file=place, name=name)
    came = next((each for each in description.topics if each.kind == "subscribe"), None)
    sent = next((each for each in description.topics if each.kind == "publish"), None)
    if came is not None and sample:
        packet = max(sample, key=lambda each: (len(each) <= _MOST_BYTES, len({*each})))
        yield "markdown", f"A packet is a serialized message. This one is a {came.type}."
        yield "code", f"packet = bytes.fromhex({packet.hex()!r})"
        if store := _store_of(description, came.type):
            yield (
                "code",
                f"from rosbags.typesys import Stores, get_typestore\n\n"
                f"types = get_typestore(Stores.{store})\n"
                f"types.deserialize_cdr(packet, {came.type!r})",
            )
        yield "code", f"node.send({came.name!r}, packet)"
    if sent is not None:
        yield "code", f"node.receive({sent.name!r}, seconds=10).hex()"
    yield "markdown", "What went, and what was lost:"
    yield (
        "code",
        "from firm_hdl.node.bridge.command import account\n\nnode.close()\n"
        'print(*account(node.bridge), sep="\\n")',
    )
    if description.wire != "ros1":
        yield "markdown", _GRAPH


def _store_of(description: Description, type_name: str) -> str:
    """Return the name of rosbags' store with a type; empty if the type is in none."""
    try:
        store = Stores[f"ROS2_{description.distro.upper()}"]
    except KeyError:
        return ""
    return store.name if type_name in get_typestore(store).fielddefs else ""
