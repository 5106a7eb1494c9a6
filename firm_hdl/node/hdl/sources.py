"""The user's files, and the errors of tools in them."""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Iterable, Mapping, Sequence

from firm_hdl.errors import DefinitionError, Diagnostic, Source, Span
from firm_hdl.files import read_file
from firm_hdl.node.description import Description
from firm_hdl.node.hdl.ports import AcceleratorPort

__all__ = ["Sources", "listed", "text_of"]

MOST_BYTES = 1 << 24

_PLACE = re.compile(r"(?:%Error(?:-\w+)?: )?([^\n:]+):(\d+):(?:(\d+):)? ?(?:error: ?)?(.*)")
_PACKAGE = re.compile(r"\b\w+_(?:cdr|ros1)_\d+_(?:sv_)?pkg\b")
_MOST_NAMED = 8
_LIBRARY = re.compile(r"^\S*/ieee\w*/(\w+?)(?:-body)?\.vhdl:\d+:\d+:", re.MULTILINE)


class Sources:
    """The files of an accelerator, and the errors of tools in them.

    * `description`: with `hdl`.

    Raises `DefinitionError`: at the name of each file in the description that cannot be read.
    """

    def __init__(self, description: Description):
        assert description.hdl is not None
        self.description, self.hdl = description, description.hdl
        self.files: dict[str, bytes] = {}  # By their names in the description, in compile order.
        # These names by absolute paths.
        self.names = {os.path.abspath(self.path_of(file)): file for file in self.hdl.files}
        problems = []
        for file in self.hdl.files:
            try:
                self.files[file] = read_file(self.path_of(file), MOST_BYTES)
            except OSError as error:
                message = f"cannot read '{self.path_of(file)}': {error.strerror or error}"
                problems.append(Diagnostic(message, description.accelerator_span))
        if problems:
            raise DefinitionError(problems)

    def path_of(self, file: str) -> str:
        """Return the path of a file, which is relative to the description."""
        return os.path.normpath(os.path.join(self.description.folder, file))

    def name_of(self, path: str) -> str | None:
        """Return the name of a file by the path that a tool printed."""
        return self.names.get(os.path.abspath(path))

    def refused(self, message: str) -> DefinitionError:
        """Return an error at the accelerator in the description."""
        return DefinitionError.of(message, self.description.accelerator_span)

    def refused_twice(self, unit: str, *paths: str) -> DefinitionError:
        """Return the error of a unit that two files declare, by the paths that a tool printed."""
        files = " and ".join(repr(self.name_of(path) or path) for path in paths)
        return self.refused(f"{unit} is declared in two files, {files}")

    def problems_of(self, said: str, tool: str) -> DefinitionError:
        """Return the errors that a tool found in the user's files, each at its place.

        * `said`: output of the tool, which got absolute paths.
        """
        problems: list[Diagnostic] = []
        places: set[tuple[str, str]] = set()
        for line in said.splitlines():
            found = _PLACE.match(line)
            if not found or "%Warning" in line or found[4].startswith(("warning:", "note:")):
                continue
            file = self.name_of(found[1])
            if file is None:
                continue
            span = self.span_of(file, int(found[2]), int(found[3] or 1))
            hint = ""
            if not self.hdl.has_records and _PACKAGE.search(found[4]):
                hint = "; with 'ports: records' in its description, firm-hdl adds the packages"
            problem = Diagnostic(f"{found[4]}{hint}", span)
            # Verilator goes on with a constant in place of what it has not found.
            follows = found[4].startswith("Unsupported: Member call on object")
            if problem not in problems and not (follows and (file, found[2]) in places):
                problems.append(problem)
                places.add((file, found[2]))
        if problems:
            return DefinitionError(problems)
        if library := _LIBRARY.search(said):
            # `float_pkg` is an instance of `float_generic_pkg`.
            package = library[1].replace("_generic", "")
            users = [f for f, data in self.files.items() if package in text_of(data).lower()]
            where = f", used in {listed(users)}" if users else ""
            return self.refused(f"{tool} cannot synthesize ieee's package '{package}'{where}")
        lines = [line for line in said.splitlines() if line.strip()]
        return self.refused(f"{tool} failed: {' '.join(lines[:3])[:400]}")

    def span_of(self, file: str, row: int, column: int) -> Span:
        """Return the word at a place in a file that a tool printed, both counted from 1."""
        text = text_of(self.files[file])
        starts = [0, *(match.end() for match in re.finditer("\n", text))]
        start = min(starts[min(row, len(starts)) - 1] + max(0, column - 1), len(text))
        word = re.compile(r"\w+|.?").match(text, start)
        source = Source(name=self.path_of(file), text=text)
        return Span(source, start, word.end() if word else start)

    def places_of(self, names: Iterable[str]) -> dict[str, Span]:
        """Return where the entity declares its ports; at ``""``, the name of the entity itself.

        * `names`: what is not found is not in the result.
        """
        is_vhdl = self.hdl.language == "vhdl"
        ignored = re.compile(r"--[^\n]*|/\*.*?\*/" if is_vhdl else r"//[^\n]*|/\*.*?\*/", re.DOTALL)
        flags = re.IGNORECASE if is_vhdl else 0
        entity = re.escape(self.hdl.entity)
        head = (
            rf"\bentity\s+({entity})\s+is\b" if is_vhdl else rf"\bmodule\s+(?:\w+\s+)?({entity})\b"
        )
        found: dict[str, Span] = {}
        for file, data in self.files.items():
            source = Source(name=self.path_of(file), text=text_of(data))
            # As long as the text.
            code = ignored.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), source.text)
            if (unit := re.search(head, code, flags)) is None:
                continue
            found[""] = Span(source, unit.start(1), unit.end(1))
            for name in filter(None, names):
                if at := re.compile(rf"\b{re.escape(name)}\b", flags).search(code, unit.end()):
                    found[name] = Span(source, at.start(), at.end())
            break
        return found

    def check_ports(
        self,
        found: Sequence[AcceleratorPort],
        wanted: Sequence[AcceleratorPort],
        more_problems: Mapping[str, str] | None = None,
    ) -> tuple[AcceleratorPort, ...]:
        """Compare the ports of an entity with those that it must have.

        * `more_problems`: what else is wrong with ports, by their names.

        Returns: those of `wanted` that the entity has.

        Raises `DefinitionError`: each problem by itself, at the port, or else at the entity.
        """
        entity = self.hdl.entity
        ignores_case = self.hdl.language == "vhdl"

        def key(name: str) -> str:
            return name.lower() if ignores_case else name

        there = {key(port.name): port for port in found}
        needed = {key(port.name): port for port in wanted}
        problems = []
        missing = [p.name for k, p in needed.items() if k not in there and not p.is_optional]
        more = [port.name for name, port in there.items() if name not in needed]
        if missing:
            problems.append(("", f"'{entity}' has no port {listed(missing)}"))
        if more:
            message = f"the description has no member for the port {listed(more)} of '{entity}'"
            problems.append((more[0], message))
        for name, port in there.items():
            want = needed.get(name)
            if want is None:
                continue
            named = f"port '{port.name}' of '{entity}'"
            if port.direction != want.direction:
                problems.append((port.name, f"{named} must be an {want.direction}put"))
            if port.width != want.width:
                has = f"{_bits(want.width)}, not {port.width}"
                kind = f"the type {want.type}, which has {has}" if want.type else has
                problems.append((port.name, f"{named} must have {kind}"))
        problems += [
            (name, text) for name, text in (more_problems or {}).items() if key(name) in there
        ]
        if problems:
            places = self.places_of([name for name, _ in problems])
            else_at = places.get("", self.description.accelerator_span)
            raise DefinitionError(
                [Diagnostic(text, places.get(name, else_at)) for name, text in problems]
            )
        return tuple(port for name, port in needed.items() if name in there)


def text_of(data: bytes) -> str:
    """Decode a file of VHDL, whose standard has Latin-1, or of Verilog, to show it."""
    try:
        return data.decode()
    except UnicodeDecodeError:
        return data.decode("latin-1")


def _bits(width: int) -> str:
    return "1 bit" if width == 1 else f"{width} bits"


def listed(names: Collection[str], quote: str = "'") -> str:
    """Name the first few of many."""
    shown = ", ".join(f"{quote}{name}{quote}" for name in list(names)[:_MOST_NAMED])
    more = len(names) - _MOST_NAMED
    return f"{shown} and {more} more" if more > 0 else shown
