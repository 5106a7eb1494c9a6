"""Decides whether known differences explain a difference from an oracle.

Both readings are compared again without the known differences. If no difference is left, the
difference is known.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TypeAlias

from firm_hdl.errors import DefinitionError
from firm_hdl.model import Interface, closure
from firm_hdl.verify.results.verdict import Failed, KnownDifference, Passed, Verdict
from firm_hdl.verify.ts1.case import DefinitionCase
from firm_hdl.verify.ts1.comparison import Compared, compared
from firm_hdl.verify.ts1.known import KNOWN
from firm_hdl.verify.ts1.known.rule import KnownRule
from firm_hdl.verify.ts1.oracles.oracle import Accepted, Answer, NotJudged, Oracle
from firm_hdl.verify.ts1.universe import Universe

__all__ = ["Explainer"]

_Read: TypeAlias = "Callable[[Universe, DefinitionCase], Interface | Exception]"


class Explainer:
    """Compares the readings of one definition by us and by one oracle, if needed several times.

    Parameters
    ----------
    universe : Universe or None
        Reads changed texts. `None`: no text can be read again, and no difference is known.
    oracle : Oracle
    case : DefinitionCase
    ours : Message, Service, Action or Exception
        Our reading.
    answer : Accepted or Refused
        The oracle's reading.
    read : callable
        Reads a definition with our reader.
    """

    def __init__(
        self,
        universe: Universe | None,
        oracle: Oracle,
        case: DefinitionCase,
        ours: Interface | Exception,
        answer: Answer,
        read: _Read,
    ) -> None:
        self._universe, self._oracle, self._case = universe, oracle, case
        self._ours, self._answer, self._read = ours, answer, read
        self._texts: dict[str, DefinitionCase] = {}
        show = self._show
        self._plain = compared(ours, answer, oracle.alike(case), lambda: show(case))

    def verdict(self) -> tuple[Verdict, bool]:
        """Return the verdict without known differences, and whether both refuse."""
        plain = self._plain
        if not plain.cases:
            return NotJudged("the oracle takes the definition, and says nothing of it"), False
        if not plain.differences:
            # Where the oracle is known to err, we must not agree with it.
            found, _ = self._compared(self._entries(with_mistakes=False))
            if not found.differences:
                return Passed(plain.cases), plain.is_refused
            plain = found
        return self._known(plain)

    def _known(self, plain: Compared) -> tuple[Verdict, bool]:
        # Mistakes that the oracle accepts matter only if we refuse the definition.
        is_refused = isinstance(self._ours, DefinitionError)
        found, touched = self._compared(self._entries(with_mistakes=is_refused))
        if not found.differences and found.cases and touched:
            needed, found = self._needed(touched, found)
            keys = tuple(entry.key for entry in needed)
            return KnownDifference(keys, found.cases), found.is_refused
        left = found if found.differences else plain
        why = next(self._not_judged(), None) if left.is_about_verdict else None
        if why is not None:
            return NotJudged(why), False
        beside = f" (beside {', '.join(entry.key for entry in touched)})" if touched else ""
        return Failed(tuple(f"{each}{beside}" for each in left.differences)), False

    def _entries(self, *, with_mistakes: bool = True) -> list[KnownRule]:
        if self._universe is None:
            return []
        name, release = self._oracle.name, self._oracle.version()
        return [
            entry
            for entry in KNOWN
            if entry.is_about(name, release, self._case) and (with_mistakes or not entry.is_mistake)
        ]

    def _needed(
        self, entries: Sequence[KnownRule], found: Compared
    ) -> tuple[Sequence[KnownRule], Compared]:
        """Drop entries that are not needed: without them, no difference is left either."""
        for entry in entries:
            fewer = [each for each in entries if each is not entry]
            without, _ = self._compared(fewer)
            if fewer and not without.differences and without.cases:
                entries, found = fewer, without
        return entries, found

    def _compared(self, entries: Sequence[KnownRule]) -> tuple[Compared, list[KnownRule]]:
        """Compare without the differences of some entries; list entries that changed anything."""
        if not entries:
            return self._plain, []
        touched: dict[str, KnownRule] = {}

        def change(case: DefinitionCase, only_mistakes: bool = False) -> DefinitionCase:
            self._texts.setdefault(case.spelled_name, case)
            for entry in entries:
                if entry.rewrite is not None and (entry.is_mistake or not only_mistakes):
                    after = entry.changed(case)
                    if after is not case:
                        touched[entry.key] = entry
                    case = after
            return case

        answer = self._asked(change)
        ours, case = self._read_again(lambda case: change(case, True))
        if isinstance(answer, NotJudged):
            return Compared(cases=0), []
        hashed = ours
        for entry in entries:
            if entry.theirs is not None and isinstance(answer, Accepted):
                # Members have the names of the text that we have read.
                mended = entry.theirs(answer.facts, case)
                if repr(mended) != repr(answer.facts):
                    touched[entry.key] = entry
                answer = Accepted(mended)
            if entry.key in touched and entry.hashed and not isinstance(hashed, Exception):
                hashed = entry.hashed(hashed)
        if not touched:
            return self._plain, []
        alike = self._oracle.alike(self._case)
        found = compared(ours, answer, alike, lambda: self._show(case), hashed)
        if found.is_refused and any(entry.is_mistake for entry in touched.values()):
            # The mistake was removed so that the rest can be compared, but both refuse the rest.
            found = Compared(cases=0)
        return found, [entry for entry in entries if entry.key in touched]

    def _asked(self, change: Callable[[DefinitionCase], DefinitionCase]) -> Answer:
        """Ask the oracle about a changed text; reuse its answer if the text stays the same."""
        if change(self._case) is self._case and not self._oracle.changes_needs:
            return self._answer
        return self._oracle.judge_changed(self._case, change)

    def _read_again(
        self, change: Callable[[DefinitionCase], DefinitionCase]
    ) -> tuple[Interface | Exception, DefinitionCase]:
        assert self._universe is not None
        case = change(self._case)
        if not isinstance(self._ours, DefinitionError):
            return self._ours, self._case
        universe = self._universe
        if self._oracle.changes_needs:
            universe = universe.changed(change)
        elif case is self._case:
            return self._ours, self._case
        return self._read(universe, case), case

    def _show(self, case: DefinitionCase) -> str:
        return "" if self._universe is None else self._universe.show(case)

    def _not_judged(self) -> Iterator[str]:
        """Yield reasons why the verdict says nothing about the definition itself."""
        if isinstance(self._ours, DefinitionError):
            for entry in self._entries():
                if entry.unavoidable is not None and any(
                    map(entry.unavoidable, self._texts.values())
                ):
                    yield f"{entry.key}: {entry.text}"
        for need in self._needs():
            if self._is_refused_unread(need):
                why = "which firm-hdl refuses and the oracle does not read"
                yield f"it needs {need.full_name}, {why}"
            keys = self._known_of(need)
            if keys:
                yield f"it needs {need.full_name}, a known difference: {', '.join(keys)}"

    def _needs(self) -> Iterator[DefinitionCase]:
        """Yield needed definitions that the oracle reads from their original files."""
        if self._universe is None or self._oracle.changes_needs:
            return
        if isinstance(self._ours, DefinitionError):
            spans = [each.span for each in self._ours.diagnostics if each.span]
            names = {each.source.name for each in spans if each.source.text != self._case.text}
            for name in sorted(names & self._universe.by_source.keys() if names else ()):
                yield self._universe.by_source[name]
        elif not isinstance(self._ours, Exception):
            for name in _needed_names(self._ours):
                parts = name.split("/")
                need = self._universe.message_case(parts[0], parts[-1])
                if need is not None:
                    yield need

    def _is_refused_unread(self, case: DefinitionCase) -> bool:
        """Whether all that we refuse is in a definition whose language the oracle does not read."""
        if not isinstance(self._ours, DefinitionError) or self._reads(case):
            return False
        spans = [each.span for each in self._ours.diagnostics]
        return all(span is not None and span.source.text == case.text for span in spans)

    def _reads(self, case: DefinitionCase) -> bool:
        return case.language in self._oracle.languages.get(case.dialect, ())

    def _known_of(self, case: DefinitionCase) -> tuple[str, ...]:
        universe = self._universe
        if universe is None or not self._reads(case):
            return ()
        (answer,) = self._oracle.judge([case])
        if isinstance(answer, NotJudged):
            return ()
        ours = self._read(universe, case)
        verdict, _ = Explainer(universe, self._oracle, case, ours, answer, self._read).verdict()
        return verdict.keys if isinstance(verdict, KnownDifference) else ()


def _needed_names(interface: Interface) -> list[str]:
    own = {message.name for message in interface.messages}
    names = [message.name for message in closure(interface.messages)]
    return [name for name in reversed(names) if name not in own]
