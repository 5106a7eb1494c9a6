"""The user's files, and the errors of tools in them."""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Mapping, Sequence

from firm_hdl.errors import DefinitionError, Diagnostic, Source, Span
from firm_hdl.files import read_file
from firm_hdl.node.description import Description
from firm_hdl.node.hdl.ports import AcceleratorPort

__all__ = [
    "check_ports",
    "path_of",
    "problems_of",
    "read_sources",
    "refused",
    "refused_twice",
    "text_of",
]

MOST_BYTES = 1 << 24

_PLACE = re.compile(r"(?:%Error(?:-\w+)?: )?([^\n:]+):(\d+):(?:(\d+):)? ?(?:error: ?)?(.*)")
_MOST_NAMED = 8
_LIBRARY = re.compile(r"^\S*/ieee\w*/(\w+?)(?:-body)?\.vhdl:\d+:\d+:", re.MULTILINE)


def path_of(description: Description, file: str) -> str:
    """Return the path of a file, which is relative to the description."""
    return os.path.normpath(os.path.join(description.folder, file))


def read_sources(description: Description) -> dict[str, bytes]:
    """Read the files of an accelerator, by their names in the description.

    Raises
    ------
    DefinitionError
        At the name of each file in the description that cannot be read.
    """
    assert description.hdl is not None
    sources: dict[str, bytes] = {}
    problems = []
    for file in description.hdl.files:
        path = path_of(description, file)
        try:
            sources[file] = read_file(path, MOST_BYTES)
        except OSError as error:
            message = f"cannot read '{path}': {error.strerror or error}"
            problems.append(Diagnostic(message=message, span=description.accelerator_span))
    if problems:
        raise DefinitionError(problems)
    return sources


def refused_twice(description: Description, unit: str, first: str, second: str) -> DefinitionError:
    """Return the error of a unit that two files declare, by the paths that a tool printed."""
    assert description.hdl is not None
    names = {os.path.abspath(path_of(description, file)): file for file in description.hdl.files}
    files = " and ".join(repr(names.get(os.path.abspath(each), each)) for each in (first, second))
    return refused(description, f"{unit} is declared in two files, {files}")


def text_of(data: bytes) -> str:
    """Decode a file of VHDL, whose standard has Latin-1, or of Verilog, to show it."""
    try:
        return data.decode()
    except UnicodeDecodeError:
        return data.decode("latin-1")


def refused(description: Description, message: str) -> DefinitionError:
    """Return an error at the accelerator in the description."""
    return DefinitionError([Diagnostic(message=message, span=description.accelerator_span)])


def problems_of(
    description: Description, said: str, sources: Mapping[str, bytes], tool: str
) -> DefinitionError:
    """Return the errors that a tool found in the user's files, each at its place.

    Parameters
    ----------
    said : str
        Output of the tool, which got absolute paths.
    sources : mapping of str to bytes
        The files by name.
    """
    by_path = {os.path.abspath(path_of(description, file)): file for file in sources}
    problems: list[Diagnostic] = []
    for line in said.splitlines():
        found = _PLACE.match(line)
        if not found or "%Warning" in line or found[4].startswith(("warning:", "note:")):
            continue
        file = by_path.get(os.path.abspath(found[1]))
        if file is None:
            continue
        text = text_of(sources[file])
        starts = [0, *(match.end() for match in re.finditer("\n", text))]
        row = min(int(found[2]), len(starts))
        start = min(starts[row - 1] + max(0, int(found[3] or 1) - 1), len(text))
        word = re.compile(r"\w+|.?").match(text, start)
        source = Source(name=path_of(description, file), text=text)
        span = Span(source=source, start=start, end=word.end() if word else start)
        problem = Diagnostic(message=found[4], span=span)
        if problem not in problems:
            problems.append(problem)
    if problems:
        return DefinitionError(problems)
    if library := _LIBRARY.search(said):
        # `float_pkg` is an instance of `float_generic_pkg`.
        package = library[1].replace("_generic", "")
        users = [f for f, data in sources.items() if package in text_of(data).lower()]
        where = f", used in {_listed(users)}" if users else ""
        return refused(description, f"{tool} cannot synthesize ieee's package '{package}'{where}")
    lines = [line for line in said.splitlines() if line.strip()]
    return refused(description, f"{tool} failed: {' '.join(lines[:3])[:400]}")


def check_ports(
    description: Description,
    found: Sequence[AcceleratorPort],
    wanted: Sequence[AcceleratorPort],
    *,
    ignores_case: bool,
) -> tuple[AcceleratorPort, ...]:
    """Compare the ports of an entity with those that it must have.

    Returns
    -------
    tuple of AcceleratorPort
        Those of `wanted` that the entity has.

    Raises
    ------
    DefinitionError
        At the accelerator in the description; each problem by itself.
    """
    assert description.hdl is not None
    entity = description.hdl.entity

    def key(name: str) -> str:
        return name.lower() if ignores_case else name

    there = {key(port.name): port for port in found}
    needed = {key(port.name): port for port in wanted}
    problems = []
    missing = [p.name for k, p in needed.items() if k not in there and not p.is_optional]
    more = [port.name for name, port in there.items() if name not in needed]
    if missing:
        problems.append(f"'{entity}' has no port {_listed(missing)}")
    if more:
        problems.append(f"the description has no member for the port {_listed(more)} of '{entity}'")
    for name, port in there.items():
        want = needed.get(name)
        if want is None:
            continue
        if port.direction != want.direction:
            problems.append(f"port '{port.name}' of '{entity}' must be an {want.direction}put")
        elif port.width != want.width:
            problems.append(
                f"port '{port.name}' of '{entity}' must have {_bits(want.width)}, not {port.width}"
            )
    if problems:
        span = description.accelerator_span
        raise DefinitionError([Diagnostic(message=each, span=span) for each in problems])
    return tuple(port for name, port in needed.items() if name in there)


def _bits(width: int) -> str:
    return "1 bit" if width == 1 else f"{width} bits"


def _listed(names: Collection[str]) -> str:
    shown = ", ".join(f"'{name}'" for name in list(names)[:_MOST_NAMED])
    more = len(names) - _MOST_NAMED
    return f"{shown} and {more} more" if more > 0 else shown
