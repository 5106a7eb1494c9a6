"""YAML with the place of every key and value, for errors with a line, a column and a caret.

Only the syntax tree of PyYAML is used. No Python object is made of a tag, and every value is read
by the function that its key asks for. All problems of a text are collected, and reported together.
Texts come from unknown sources: an alias can stand for a large mapping in a thousand places, and a
number can have a million digits. So reading ends after a number of problems, each of which has a
message of limited length, and long numbers are refused.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from difflib import get_close_matches
from typing import Any, TypeVar

import yaml
from yaml.constructor import SafeConstructor

from firm_hdl.errors import MAX_DIAGNOSTICS, DefinitionError, Diagnostic, Source, Span

__all__ = ["Entry", "Marked", "parse"]

T = TypeVar("T")

_KINDS = {
    "tag:yaml.org,2002:str": "text",
    "tag:yaml.org,2002:int": "an integer",
    "tag:yaml.org,2002:float": "a number",
    "tag:yaml.org,2002:bool": "a boolean",
    "tag:yaml.org,2002:null": "empty",
    "tag:yaml.org,2002:timestamp": "a date",
    "tag:yaml.org,2002:merge": "a merge key",
}

_NUMBERS = ("tag:yaml.org,2002:int", "tag:yaml.org,2002:float")

_MOST_DIGITS = 64
"""Most characters of a number. None that is in range needs more."""

_MOST_SHOWN = 400
"""Most characters of a message, which may quote any text."""

_MOST_LEVELS = 100
_TOO_DEEP = "nested too deep"


class Marked:
    """A text, and the problems that were found in it."""

    def __init__(self, source: Source) -> None:
        self.source = source
        # How many problems were noted. What several topics share by an alias counts for each.
        self.noted = 0
        self._problems: dict[Diagnostic, None] = {}

    def span(self, node: yaml.Node) -> Span:
        """Return the place of a value; of a mapping or a list, the place of its first word."""
        start, end = node.start_mark.index, node.end_mark.index
        if not isinstance(node, yaml.ScalarNode):
            line_end = self.source.text.find("\n", start)
            end = min(end, len(self.source.text) if line_end < 0 else line_end)
        return Span(source=self.source, start=start, end=max(start, end))

    def error(self, node: yaml.Node, message: str) -> None:
        """Note a problem at a node."""
        self.note(Diagnostic(message=_shortened(message), span=self.span(node)))

    def error_at_start(self, message: str) -> None:
        """Note a problem of the whole text."""
        start = Span(source=self.source, start=0, end=0)
        self.note(Diagnostic(message=_shortened(message), span=start))

    def note(self, problem: Diagnostic) -> None:
        """Note a problem of this text, or of a definition that it names.

        Raises `DefinitionError`: with all problems, if there are too many.
        """
        self._problems[problem] = None
        self.noted += 1
        if self.noted >= MAX_DIAGNOSTICS:
            message = "too many errors; the rest of the description was not checked"
            self._problems[Diagnostic(message=message, span=problem.span)] = None
            self.check()

    def check(self) -> None:
        """Raise what was found.

        Raises
        ------
        DefinitionError
            With all problems, in the order of the text.
        """
        if self._problems:
            places = sorted(self._problems, key=lambda p: p.span.start if p.span else -1)
            raise DefinitionError(places)

    def mapping(self, node: yaml.Node, what: str, example: str = "") -> dict[str, Entry]:
        """Read a mapping whose keys are texts; a key that occurs twice is a problem.

        * `example`: what such a mapping looks like, for the message.
        """
        if not isinstance(node, yaml.MappingNode):
            such = f", such as {example}" if example else ""
            self.error(node, f"{what} must be a mapping of names to values{such}, not {kind(node)}")
            return {}
        entries: dict[str, Entry] = {}
        for key, value in node.value:
            if not isinstance(key, yaml.ScalarNode) or key.tag != "tag:yaml.org,2002:str":
                is_merge = key.tag == "tag:yaml.org,2002:merge"
                hint = "write all keys out" if is_merge else "put it in quotes"
                self.error(key, f"a key must be text, not {kind(key)}; {hint}")
                continue
            name = str(key.value)
            if name in entries:
                line = self.span(entries[name].key).line
                self.error(key, f"'{name}' is already in line {line}")
                continue
            entries[name] = Entry(marked=self, key=key, value=value)
        return entries

    def known(
        self, entries: Mapping[str, Entry], keys: Collection[str], what: str
    ) -> dict[str, Entry]:
        """Return the entries with a key among `keys`; others are problems."""
        for name in entries.keys() - set(keys):
            close = get_close_matches(name, keys, n=1)
            known = f"; keys are {', '.join(keys)}" if keys else ""
            hint = f"; did you mean '{close[0]}'?" if close else known
            self.error(entries[name].key, f"{what} has no '{name}'{hint}")
        return {name: entry for name, entry in entries.items() if name in keys}


class Entry:
    """A key and its value. The readers return a default, and note a problem, if it is wrong."""

    def __init__(self, *, marked: Marked, key: yaml.Node, value: yaml.Node) -> None:
        self.marked, self.key, self.value = marked, key, value

    @property
    def name(self) -> str:
        """The key."""
        return str(self.key.value)

    def error(self, message: str) -> None:
        """Note a problem at the value; if the value is empty, at the key."""
        empty = self.value.start_mark.index == self.value.end_mark.index
        self.marked.error(self.key if empty else self.value, message)

    def error_at_key(self, message: str) -> None:
        """Note a problem at the key."""
        self.marked.error(self.key, message)

    def text(self, default: str = "") -> str:
        """Read a text."""
        value = self.value
        if isinstance(value, yaml.ScalarNode) and value.tag == "tag:yaml.org,2002:str":
            return str(value.value)
        self._wrong("text")
        return default

    def texts(self) -> list[str]:
        """Read a list of texts, or a single one."""
        if not isinstance(self.value, yaml.SequenceNode):
            return [text] if (text := self.text()) else []
        items = [Entry(marked=self.marked, key=self.key, value=each) for each in self.value.value]
        return [text for item in items if (text := item.text())]

    def words(self) -> list[tuple[str, Span]]:
        """Read words, in a list or with blanks between them; a number is a word as it is written.

        Returns: each word with its place.
        """
        is_list = isinstance(self.value, yaml.SequenceNode)
        found: list[tuple[str, Span]] = []
        for node in self.value.value if is_list else [self.value]:
            if not isinstance(node, yaml.ScalarNode) or not node.value.strip():
                self.error(f"'{self.name}' must be words, not {kind(node)}")
                continue
            whole = self.marked.span(node)
            at = whole.start
            for word in node.value.split():
                # In quotes, a word may be written with escapes.
                start = whole.source.text.find(word, at, whole.end)
                at = max(at, start + len(word))
                span = Span(source=whole.source, start=start, end=at) if start >= 0 else whole
                found.append((word, span))
        return found

    def choice(self, choices: Collection[str], default: T) -> str | T:
        """Read one of some words."""
        before = self.marked.noted
        word = self.text()
        if word in choices:
            return word
        if self.marked.noted == before:
            close = get_close_matches(word, choices, n=1)
            hint = f"; did you mean '{close[0]}'?" if close else ""
            self.error(f"'{self.name}' must be {_either(choices)}, not '{word}'{hint}")
        return default

    def integer(self, default: T, least: int, most: int | None = None) -> int | T:
        """Read an integer between limits, both included; ``0x10`` and ``1_000`` are as in YAML."""
        number = self._number(_NUMBERS[:1])
        if not isinstance(number, int):
            self._wrong("an integer")
            return default
        if number < least or (most is not None and number > most):
            limits = f"at least {least}" if most is None else f"from {least} to {most}"
            self.error(f"'{self.name}' must be {limits}, not {number}")
            return default
        return number

    def number(self, default: T, least: float, most: float) -> float | T:
        """Read a number between limits, both included."""
        number = self._number(_NUMBERS)
        if number is None:
            self._wrong("a number")
            return default
        # PyYAML knows infinite numbers and those that are none, such as ``.inf`` and ``.nan``.
        if not least <= number <= most:
            self.error(f"'{self.name}' must be from {least:g} to {most:g}, not {self.value.value}")
            return default
        return float(number)

    def _number(self, tags: Collection[str]) -> int | float | None:
        """Read a number with one of some tags as PyYAML does; `None` if there is none."""
        value = self.value
        if (
            not isinstance(value, yaml.ScalarNode)
            or value.tag not in tags
            or len(value.value) > _MOST_DIGITS
        ):
            return None
        try:
            if value.tag == _NUMBERS[0]:
                return int(SafeConstructor().construct_yaml_int(value))
            return float(SafeConstructor().construct_yaml_float(value))
        except (ValueError, IndexError):
            # A tag can be written before any text, or before none.
            return None

    def checked(self, problem: Callable[[str], str], default: str = "") -> str:
        """Read a text that `problem` finds nothing wrong with."""
        before = self.marked.noted
        text = self.text(default)
        if self.marked.noted == before and (wrong := problem(text)):
            self.error(wrong)
            return default
        return text

    def _wrong(self, wanted: str) -> None:
        value, found = self.value, kind(self.value)
        if not isinstance(value, yaml.ScalarNode) or found == "empty":
            self.error(f"'{self.name}' must be {wanted}, not {found}")
        elif wanted == "text":
            self.error(f"'{self.name}' must be text, not {found}; put it in quotes")
        elif value.tag in _NUMBERS:
            self.error(f"'{self.name}' must be {wanted}, not '{value.value}'")
        else:
            self.error(f"'{self.name}' must be {wanted}, not {found}")


def kind(node: yaml.Node) -> str:
    """Say what a node is."""
    if isinstance(node, yaml.MappingNode):
        return "a mapping"
    if isinstance(node, yaml.SequenceNode):
        return "a list"
    what = _KINDS.get(node.tag, "a value with a tag")
    return f"{what} ({node.value})" if what in ("a boolean", "an integer", "a date") else what


def _shortened(message: str) -> str:
    """Shorten a message in its middle: what it quotes comes first, and the reason last."""
    # An escape can stand for half a character, which cannot be printed.
    message = message.encode("utf-8", "backslashreplace").decode("utf-8")
    half = _MOST_SHOWN // 2
    return message if len(message) <= _MOST_SHOWN else f"{message[:half]} ... {message[-half:]}"


class _Loader(yaml.SafeLoader):
    """The loader in Python, which counts characters, as spans do.

    Each level of a nested text costs time for each token in it, so their number is limited.
    """

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self._levels = 0

    def compose_node(self, parent: Any, index: Any) -> Any:
        self._levels += 1
        if self._levels > _MOST_LEVELS:
            mark = self.peek_event().start_mark  # type: ignore[no-untyped-call]
            raise yaml.MarkedYAMLError(problem=_TOO_DEEP, problem_mark=mark)
        node = super().compose_node(parent, index)
        self._levels -= 1
        return node


def parse(source: Source) -> tuple[Marked, yaml.Node]:
    """Parse a text.

    Raises `DefinitionError` if the text is not YAML, is nested too deep, or is empty.
    """
    marked = Marked(source)
    try:
        loader = _Loader(source.text)
    except yaml.reader.ReaderError as error:
        raise _failure(source, error.position, f"not YAML: {error.reason}") from None
    try:
        node = loader.get_single_node()
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        at = loader.index if mark is None else mark.index
        what = "not a description" if error.problem == _TOO_DEEP else "not YAML"
        raise _failure(source, at, f"{what}: {error.problem}") from None
    except (ValueError, OverflowError):
        # Python's own, such as for a character with a code that there is not.
        raise _failure(source, loader.index, "not YAML: a number is out of range") from None
    if node is None:
        raise _failure(source, 0, "a description must not be empty")
    return marked, node


def _failure(source: Source, at: int, message: str) -> DefinitionError:
    at = min(at, len(source.text))
    span = Span(source=source, start=at, end=at)
    return DefinitionError([Diagnostic(message=_shortened(message), span=span)])


def _either(choices: Collection[str]) -> str:
    *others, last = (f"'{word}'" for word in choices)
    return f"{', '.join(others)} or {last}" if others else last
