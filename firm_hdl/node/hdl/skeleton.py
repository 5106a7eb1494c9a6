"""A file to begin an accelerator with: it has every member, takes all, and offers nothing.

Messages of a subscription go to the publication of the same type, if there is one, as
:class:`firm_hdl.node.loop.Loop` sends them.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from typing import TypeAlias

from firm_hdl.errors import UserError
from firm_hdl.files import write_new
from firm_hdl.names.identifiers import identifier
from firm_hdl.node.description import Description
from firm_hdl.node.hdl.members import (
    AcceleratorStream,
    accelerator_streams,
    by_message,
    described,
)
from firm_hdl.node.hdl.ports import AcceleratorPort, accelerator_ports
from firm_hdl.node.hdl.records import message_records, record_ports

__all__ = ["NEW_LANGUAGES", "new_accelerator"]

NEW_LANGUAGES = {
    "amaranth": "py",
    "vhdl": "vhd",
    "verilog": "v",
    "sv": "sv",
    "systemverilog": "sv",
}
"""Suffix of a file by the name of its language."""

RECORDS = {"vhdl": "records", "systemverilog": "structs"}
"""What a language calls the records that its ports may have."""

_Row: TypeAlias = "tuple[AcceleratorPort | None, str]"
"""A port with a comment, or a comment alone, as a declaration has them."""


def new_accelerator(
    description: Description, language: str | None = None, *, with_records: bool = False
) -> tuple[str, str]:
    """Write the skeleton of an accelerator into the folder of a description.

    The description may already name the file.

    * `language`: a key of `NEW_LANGUAGES`. `None`: what the description says, else ``"amaranth"``.
    * `with_records`: messages are ports of records or structs. The description may say so, too.

    Returns: the path of the file, and the value of `accelerator` that names it.

    Raises `UserError` if the description names a file of another language, if there is such a file
    already, or if it cannot be written.
    """
    hdl = description.hdl
    said = hdl.language if hdl else "amaranth" if description.accelerator else None
    wanted = {"sv": "systemverilog"}.get(language or "", language) or said or "amaranth"
    if said is not None and wanted != said:
        raise UserError(f"the accelerator of the description is in {said}, not in {wanted}")
    if with_records and wanted not in RECORDS:
        raise UserError(f"{wanted} has no ports of records: the languages are vhdl and sv")
    if with_records and hdl is not None and not hdl.has_records:
        raise UserError(
            f"the accelerator of the description has plain ports: add 'ports: {RECORDS[wanted]}'"
        )
    with_records = with_records or (hdl is not None and hdl.has_records)
    name = identifier(description.node)
    if wanted == "amaranth":
        module, _, path = description.accelerator.partition(":")
        module, path = module or name, path or name.title().replace("_", "")
        if "." in path:
            raise UserError(f"a class inside another one, '{path}', is not written")
        file = f"{module.replace('.', os.sep)}.py"
        text, value = "".join(_amaranth(description, path)), f"{module}:{path}"
    else:
        file = hdl.files[-1] if hdl else f"{name}.{NEW_LANGUAGES[wanted]}"
        entity = hdl.entity if hdl else name
        write = _with_records if with_records else _plain
        text = "".join(f"{line}\n" for line in write(description, entity, wanted))
        ports = f", ports: {RECORDS[wanted]}" if with_records else ""
        value = f"{{{wanted}: {file}, entity: {entity}{ports}}}"
    place = os.path.normpath(os.path.join(description.folder, file))
    try:
        write_new(place, text.encode())
    except FileExistsError:
        raise UserError(f"'{place}' is already there, and stays as it is") from None
    except OSError as error:
        raise UserError(f"cannot write '{place}': {error.strerror or error}") from None
    return place, value


def _looped(description: Description) -> dict[str, AcceleratorStream]:
    """Return the streams whose data goes on, by the member of the other one; in both ways."""
    streams = {stream.member: stream for stream in accelerator_streams(description)}
    found: dict[str, AcceleratorStream] = {}
    for came, goes in description.loops():
        start = f"subscribe.{came.port}."
        for member, stream in streams.items():
            if member.startswith(start):
                other = streams[f"publish.{goes.port}.{member.removeprefix(start)}"]
                found |= {member: other, other.member: stream}
    return found


def _head(description: Description) -> list[str]:
    return [
        f"The accelerator of the node {description.node}.",
        "A field is transferred when its valid and its ready are 1 at a rising edge of the clock.",
        "valid must not wait for ready, and data stays while valid waits. All fields have to be",
        "taken, also those that are not used.",
    ]


def _verb(streams: Sequence[AcceleratorStream]) -> str:
    """Say what an accelerator does with a message, by its streams."""
    return "takes" if streams[0].direction == "in" else "offers"


def _assigned(
    port: AcceleratorPort, stream: AcceleratorStream, other: AcceleratorStream | None
) -> str:
    """Return the port whose value an output has; ``1`` or ``0`` if it is tied."""
    last = port.member.rpartition(".")[2]
    if other is not None and (same := other.port(last)) is not None:
        return same.name
    return "1" if last == "ready" else "0"


def _plain_rows(ports: Iterable[AcceleratorPort]) -> Iterator[_Row]:
    """Yield clock, reset and time, which are ports of no message."""
    about = {
        "aclk": "Clock; the rising edge is active.",
        "aresetn": "Synchronous reset, active low.",
    }
    for port in ports:
        if port.is_optional:
            time = port.member.partition(".")[2]
            yield port, f"Time of the node: {time}. Leave it out or use it."
        elif port.name in about:
            yield port, about[port.name]


def _declaration(port: AcceleratorPort, language: str, width: int) -> str:
    """Declare a port, with its name in `width` characters."""
    if language == "vhdl":
        return f"{port.name:<{width}} : {port.direction:<3} {port.vhdl_type}"
    kind = "wire" if language == "verilog" else "logic"
    kind += " signed" if port.signed else ""
    kind = f"{port.type} " if port.type else f"{kind} {port.verilog_range}"
    return f"{port.direction + 'put':<6} {kind}{port.name}"


def _file(
    description: Description, entity: str, language: str, rows: Sequence[_Row], body: Iterable[str]
) -> Iterator[str]:
    """Yield the lines of a file: the ports in their order, with comments, and what is in it."""
    is_vhdl = language == "vhdl"
    mark, end = ("--", ";") if is_vhdl else ("//", ",")
    yield from (f"{mark} {line}" for line in _head(description))
    if is_vhdl:
        yield from ("library ieee;", "use ieee.std_logic_1164.all;", "use ieee.numeric_std.all;")
        yield from ("", f"entity {entity} is", "  port (")
    else:
        yield f"module {entity} ("
    ports = [port for port, _ in rows if port is not None]
    width = max(len(port.name) for port in ports)
    was_port = True
    for port, comment in rows:
        if port is None:
            if was_port:
                yield ""
            yield f"    {mark} {comment}"
        else:
            # The last port has no separator.
            line = f"    {_declaration(port, language, width)}{'' if port is ports[-1] else end}"
            yield f"{line}  {mark} {comment}" if comment else line
        was_port = port is not None
    if is_vhdl:
        yield from ("  );", "end entity;", "", f"architecture rtl of {entity} is", "begin")
    else:
        yield ");"
    yield from body
    yield from ("", "end architecture;" if is_vhdl else "endmodule")


def _plain(description: Description, entity: str, language: str) -> Iterator[str]:
    """Yield the lines of a file whose ports are plain vectors."""
    loops = _looped(description)
    rows = list(_plain_rows(accelerator_ports(description)))
    outputs: list[tuple[str, list[tuple[AcceleratorPort, str]]]] = []
    for topic, message, streams in by_message(description):
        heading = f"It {_verb(streams)} {topic.name}: {message}"
        rows.append((None, heading))
        values = []
        for stream in streams:
            for port in stream.ports:
                is_data = port.member.rpartition(".")[2] == "data"
                rows.append((port, stream.type if is_data else ""))
                if port.direction == "out":
                    values.append((port, _assigned(port, stream, loops.get(stream.member))))
        outputs.append((heading, values))
    width = max(len(port.name) for port, _ in rows if port is not None)

    def tied(port: AcceleratorPort, value: str) -> str:
        if value not in ("0", "1"):
            return value
        if language == "vhdl":
            return f"'{value}'" if port.width == 1 else f"(others => '{value}')"
        return f"{port.width}'{'b' if port.width == 1 else 'd'}{value}"

    def body() -> Iterator[str]:
        mark, start, sign = ("--", "", "<=") if language == "vhdl" else ("//", "assign ", "=")
        for heading, values in outputs:
            yield from ("", f"  {mark} {heading}")
            for port, value in values:
                yield f"  {start}{port.name:<{width}} {sign} {tied(port, value)};"

    return _file(description, entity, language, rows, body())


def _with_records(description: Description, entity: str, language: str) -> Iterator[str]:
    """Yield the lines of a file whose ports are records or structs."""
    records = message_records(description, language)
    ports = record_ports(description, language, records)
    rows = list(_plain_rows(ports))
    topics = {f"{topic.kind}.{topic.port}": topic.name for topic in description.topics}
    for each in records:
        verb = "takes" if each.is_taken else "offers"
        topic = topics[".".join(each.port.member.split(".")[:2])]
        rows.append((None, f"It {verb} {topic}: {each.port.message.name}"))
        for node in each.tree.root.leaves():
            assert node.leaf is not None
            what = described(each.port.plan.leaves[node.leaf])
            rows.append((None, f"  {node.access}: {what}"))
        rows += [(p, "") for p in ports if p.name in (each.port.name, each.port.ready)]
    by_member = {each.port.member: each for each in records}
    loops = {f"subscribe.{a.port}": f"publish.{b.port}" for a, b in description.loops()}
    loops |= {goes: came for came, goes in loops.items()}

    def body() -> Iterator[str]:
        start, sign, dot = ("work.", "<=", ".") if language == "vhdl" else ("", "=", "::")
        assign = "" if language == "vhdl" else "assign "
        yield ""
        for each in records:
            other = by_member.get(loops.get(each.port.member, ""))
            constant = f"{start}{each.package}{dot}{each.tree.package.base.upper()}"
            if each.is_taken:
                name, value = each.port.ready, other and other.port.ready
            else:
                name, value = each.port.name, other and other.port.name
            idle = f"{constant}_{'ALL_READY' if each.is_taken else 'IDLE'}"
            yield f"  {assign}{name} {sign} {value or idle};"

    return _file(description, entity, language, rows, body())


def _amaranth(description: Description, name: str) -> Iterator[str]:
    loops = _looped(description)
    yield f'"""The accelerator of the node {description.node}."""\n\n'
    yield "from amaranth.hdl import Module\nfrom amaranth.lib import wiring\n\n"
    yield "from firm_hdl.node import accelerator_signature\n\n\n"
    yield f"class {name}(wiring.Component):\n"
    yield "    def __init__(self, description):\n"
    yield "        super().__init__(accelerator_signature(description))\n\n"
    yield "    def elaborate(self, platform):\n"
    yield "        m = Module()\n"
    yield "        # A field is a stream with payload, valid and ready. All have to be taken.\n"
    yield "        # firm_hdl.accelerator has take_message and offer_message for whole messages.\n"
    yield "        # The time of the node is in self.time.sec and self.time.nanosec.\n"
    for topic, message, streams in by_message(description):
        yield f"\n        # It {_verb(streams)} {topic.name}: {message}\n"
        yield "        m.d.comb += [\n"
        for stream in streams:
            member, other = f"self.{stream.member}", loops.get(stream.member)
            yield f"            # {stream.type}\n"
            if stream.direction == "in":
                ready = "1" if other is None else f"self.{other.member}.ready"
                yield f"            {member}.ready.eq({ready}),\n"
            else:
                source = None if other is None else f"self.{other.member}"
                yield f"            {member}.payload.eq({f'{source}.payload' if source else 0}),\n"
                yield f"            {member}.valid.eq({f'{source}.valid' if source else 0}),\n"
        yield "        ]\n"
    yield "        return m\n"
