"""A known difference between an oracle and firm-hdl.

A rule removes one difference, and nothing else. It changes the text that the oracle reads, the text
that both read, the facts of the oracle, or the model that we hash. Everything else is compared.
So a known difference hides no other difference.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, TypeAlias, TypeVar

from firm_hdl.frontend.sources import Language
from firm_hdl.model import Dialect, Interface, Message, Service, rebuilt
from firm_hdl.verify.ts1.case import DefinitionCase
from firm_hdl.verify.ts1.facts import Facts

__all__ = [
    "KnownRule",
    "Line",
    "Rules",
    "by_lines",
    "each_line",
    "lines_of",
    "mend_constants",
    "mend_members",
    "mend_messages",
    "mend_values",
    "rebuild",
    "types_back",
    "whole_bool",
    "without_hash",
]

F = TypeVar("F", bound=Callable[..., Any])
_Rewrite: TypeAlias = "Callable[[DefinitionCase], str]"
Mend: TypeAlias = "Callable[[Facts, DefinitionCase], Facts]"


@dataclass(frozen=True, slots=True, kw_only=True)
class KnownRule:
    """One deliberate difference.

    Attributes
    ----------
    key : str
        The name of the difference, here and in docs/reference/errata.md.
    oracles : set of str
        The oracles that differ from us.
    text : str
        What differs, in one sentence.
    releases : pattern or None
        A pattern that the oracle's whole release has to match; `None`: all releases match.
    dialect : "ros1", "ros2" or None
        The dialect of the definitions; `None`: both.
    language : Language or None
        The language of the definitions; `None`: any.
    rewrite : callable or None
        Returns the text without the difference. The oracle reads this text instead.
    is_mistake : bool
        Whether the difference is a mistake that we refuse and the oracle accepts. Then we read the
        rewritten text, too.
    theirs : callable or None
        Returns the oracle's facts without the difference. Names and values that `rewrite` has
        replaced are restored.
    hashed : callable or None
        Returns our model with the difference. Only type hashes are computed from the result. It is
        needed if the text of `rewrite` has another hash, or the oracle hashes another type.
    unavoidable : callable or None
        Whether a definition has the difference, if no text can avoid it. If we refuse such a
        definition and the oracle accepts it, it is not judged.
    """

    key: str
    oracles: frozenset[str]
    text: str
    releases: re.Pattern[str] | None = None
    dialect: Dialect | None = None
    language: Language | None = None
    rewrite: _Rewrite | None = None
    is_mistake: bool = False
    theirs: Mend | None = None
    hashed: Callable[[Interface], Interface] | None = None
    unavoidable: Callable[[DefinitionCase], bool] | None = None

    def is_about(self, oracle: str, release: str, case: DefinitionCase) -> bool:
        """Whether this rule can explain a difference from an oracle in a definition."""
        return (
            # The names of newer releases' oracles end in "-" and the version.
            oracle.partition("-")[0] in self.oracles
            and self.dialect in (None, case.dialect)
            and self.language in (None, case.language)
            and (self.releases is None or self.releases.fullmatch(release) is not None)
        )

    def changed(self, case: DefinitionCase) -> DefinitionCase:
        """Return a definition with the text rewritten."""
        text = case.text if self.rewrite is None else self.rewrite(case)
        if text == case.text:
            return case
        return replace(case, text=text, before=case.text if case.before is None else case.before)


class Rules(list[KnownRule]):
    """The known differences of a module, in the order in which they are applied.

    A decorator declares a difference. It decorates the function that removes the difference.

    Parameters
    ----------
    oracles : str
        Names of the oracles that differ, separated by blanks.
    **common
        Default values of attributes of `KnownRule`.
    """

    def __init__(self, oracles: str, **common: Any) -> None:
        super().__init__()
        self._common = {"oracles": oracles, **common}

    def add(self, key: str, text: str, **more: Any) -> None:
        """Declare a difference by attributes of `KnownRule`, with `oracles` as one text."""
        values = {**self._common, **more}
        oracles = frozenset(values.pop("oracles").split())
        self.append(KnownRule(key=key, oracles=oracles, text=text, **values))

    def text(self, key: str, text: str, **more: Any) -> Callable[[F], F]:
        """Declare a difference; the function is its `rewrite`."""
        return self._declared(lambda rewrite: {"rewrite": rewrite}, key, text, more)

    def lines(self, key: str, text: str, **more: Any) -> Callable[[F], F]:
        """Declare a difference; its `rewrite` applies the function to each `Line`."""
        return self._declared(lambda change: {"rewrite": by_lines(change)}, key, text, more)

    def facts(self, key: str, text: str, **more: Any) -> Callable[[F], F]:
        """Declare a difference; the function is its `theirs`."""
        return self._declared(lambda mend: {"theirs": mend}, key, text, more)

    def unavoidable(self, key: str, text: str, **more: Any) -> Callable[[F], F]:
        """Declare a difference that no text avoids; the function is its `unavoidable`."""
        return self._declared(
            lambda has: {"unavoidable": has, "is_mistake": False}, key, text, more
        )

    def _declared(
        self, parts: Callable[[Any], dict[str, Any]], key: str, text: str, more: dict[str, Any]
    ) -> Callable[[F], F]:
        def declare(function: F) -> F:
            self.add(key, text, **more, **parts(function))
            return function

        return declare


@dataclass(frozen=True, slots=True, kw_only=True)
class Line:
    """A line that declares something: ``TYPE NAME``, then ``= VALUE``, a default, or nothing.

    Attributes
    ----------
    indent, type, gap, name, equals, rest : str
        The parts of the line, in order. `equals` is empty if the line declares no constant. `rest`
        is all that follows, including a comment.
    """

    indent: str
    type: str
    gap: str
    name: str
    equals: str
    rest: str

    @property
    def base(self) -> str:
        """The type without sizes and bounds."""
        return re.split(r"[\[<]", self.type, maxsplit=1)[0]

    @property
    def value(self) -> str:
        """The value or default: `rest` without a comment, and without blanks around it."""
        return self.rest.partition("#")[0].strip()

    def with_value(self, value: str) -> Line:
        """Return the line with another value, and the same comment."""
        _, hash_, comment = self.rest.partition("#")
        blank = " " if hash_ else ""
        before = "" if self.equals else " "
        return replace(self, rest=f"{before}{value}{blank}{hash_}{comment}".rstrip(" "))

    def with_code(self, change: Callable[[str], str]) -> Line:
        """Return the line with `rest` changed, except for the comment."""
        code, hash_, comment = self.rest.partition("#")
        return replace(self, rest=f"{change(code)}{hash_}{comment}")

    def without_value(self) -> Line:
        """Return the line without a default, and with the same comment."""
        return replace(self, rest=self.rest[self.rest.find("#") :] if "#" in self.rest else "")

    def __str__(self) -> str:
        return f"{self.indent}{self.type}{self.gap}{self.name}{self.equals}{self.rest}"


_LINE = re.compile(
    r"(?P<indent>[ \t]*)(?P<type>(?:[^\s#=<]|<=?)+)(?P<gap>[ \t]+)(?P<name>[^\s#=]+)"
    r"(?P<equals>[ \t]*=[ \t]*)?(?P<rest>.*)",
    re.DOTALL,
)


def by_lines(change: Callable[[Line, DefinitionCase], Line]) -> _Rewrite:
    """Return a function of ``.msg``, ``.srv`` and ``.action`` texts that changes each line."""

    def rewrite(case: DefinitionCase) -> str:
        def line(text: str) -> str:
            found = _line_of(text)
            return text if found is None else str(change(found, case))

        return each_line(case.text, line)

    return rewrite


def lines_of(text: str) -> list[Line]:
    """Return the lines of a ``.msg``, ``.srv`` or ``.action`` that declare something."""
    found = map(_line_of, re.split(r"\r\n|\r|\n", text))
    return [line for line in found if line is not None]


def _line_of(text: str) -> Line | None:
    match = _LINE.fullmatch(text)
    if match is None:
        return None
    return Line(**{name: part or "" for name, part in match.groupdict().items()})


def each_line(text: str, change: Callable[[str], str]) -> str:
    """Change each line of a text, and keep the line ends."""
    pieces = re.split(r"(\r\n|\r|\n)", text)
    pieces[::2] = map(change, pieces[::2])
    return "".join(pieces)


def mend_messages(change: Callable[[dict[str, Any]], dict[str, Any]]) -> Mend:
    """Return a function of facts that changes each message."""

    def mend(facts: Facts, case: DefinitionCase) -> Facts:
        messages = facts.get("structure")
        if not messages:
            return facts
        return {**facts, "structure": {name: change(each) for name, each in messages.items()}}

    return mend


def mend_members(part: str, change: Callable[[dict[str, Any]], dict[str, Any]]) -> Mend:
    """Return a function of facts that changes each item of ``fields`` or ``constants``."""
    return mend_messages(
        lambda message: (
            {**message, part: [change(each) for each in message[part]]}
            if part in message
            else message
        )
    )


def mend_constants(change: Callable[[dict[str, Any]], dict[str, Any]]) -> Mend:
    """Return a function of facts that changes each constant."""
    return mend_members("constants", change)


def types_back(old: str, new: str) -> Mend:
    """Return a function of facts that restores a primitive that a rule has replaced.

    Only members whose line in a ``.msg`` has the primitive get it back.

    Parameters
    ----------
    old, new : str
        Names of the primitive, and of the other one in the rewritten text.
    """

    def mend(facts: Facts, case: DefinitionCase) -> Facts:
        lines = [line for line in lines_of(case.text) if line.base == old]
        for part, is_constant in (("fields", False), ("constants", True)):
            names = {line.name for line in lines if bool(line.equals) is is_constant}

            def back(member: dict[str, Any], names: set[str] = names) -> dict[str, Any]:
                base = re.split(r"[\[<]", member["type"], maxsplit=1)[0]
                if base != new or member["name"] not in names:
                    return member
                return {**member, "type": old + member["type"].removeprefix(new)}

            facts = mend_members(part, back)(facts, case)
        return facts

    return mend


def rebuild(change: Callable[[Message], Message]) -> Callable[[Interface], Interface]:
    """Return a function of a model that changes each message, as for `KnownRule.hashed`."""

    def of_message(message: Message) -> Message:
        return rebuilt(message, change)

    def of_service(service: Service) -> Service:
        return replace(
            service,
            request=of_message(service.request),
            response=of_message(service.response),
            event=None if service.event is None else of_message(service.event),
        )

    def of_model(interface: Interface) -> Interface:
        match interface:
            case Message():
                return of_message(interface)
            case Service():
                return of_service(interface)
        return replace(
            interface,
            goal=of_message(interface.goal),
            result=of_message(interface.result),
            feedback=of_message(interface.feedback),
            services=tuple(map(of_service, interface.services)),
            wrappers=tuple(map(of_message, interface.wrappers)),
        )

    return of_model


def mend_values(change: Callable[[str, Any], Any]) -> Mend:
    """Return a function of facts that changes the values of constants, and defaults.

    Parameters
    ----------
    change : callable
        Takes the type and the value of a field or of a constant.
    """

    def part(name: str) -> Callable[[dict[str, Any]], dict[str, Any]]:
        return lambda member: {**member, name: change(member["type"], member[name])}

    constants, defaults = mend_constants(part("value")), mend_members("fields", part("default"))
    return lambda facts, case: defaults(constants(facts, case), case)


def whole_bool(constant: dict[str, Any]) -> dict[str, Any]:
    """Convert the value of a bool constant that is written as a number to a bool."""
    value = constant["value"]
    is_number = constant["type"] == "bool" and type(value) is int
    return {**constant, "value": bool(value)} if is_number else constant


def without_hash(facts: Facts) -> Facts:
    """Return facts without the hash, which belongs to another type."""
    return {name: fact for name, fact in facts.items() if name != "hash"}
