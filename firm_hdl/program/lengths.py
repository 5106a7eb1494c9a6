"""The lengths of a message: what each of them counts, and what is decoded from it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from firm_hdl.names.identifiers import first_free
from firm_hdl.plan.tree import Charge, Constant, Loop, Plan
from firm_hdl.program.control import Control

__all__ = ["Length", "NextMap", "length_of", "with_columns"]


@dataclass(frozen=True, slots=True)
class NextMap:
    """The map or word of a state that follows the items of a run."""

    align: int
    last_offset: int  # Distance from its first byte to its last one; -1 if it has none.


@dataclass(frozen=True, slots=True, kw_only=True)
class Length:
    """A length, with which a state begins a loop or a run.

    What is a text names a column of the table of decoded lengths. States whose lengths need the
    same value share a column. So the number of columns grows with the kinds of lengths, not with
    the number of lengths.

    Attributes
    ----------
    leaf : int
    limit : int
        Largest legal number of elements or items.
    level : int or None
        The loop whose elements are counted; `None`: the items of a run.
    lanes, item_bytes : int
        Items of a word, and bytes of an item.
    has_nul : bool
        Whether a NUL follows the items. The length on the wire counts the NUL, too.
    align : int
        Alignment of the first item.
    charge : Charge or None
    counts_nothing : bool
        The elements have no bytes, and nobody asks for them: only their number is checked.
    nexts : tuple of NextMap
        Of a run: what may follow its items.
    over : str
        Column: the value is above `max_count`.
    skips : str
        Column: the body is skipped: no element, no word before the rest, or an illegal length.
    charged : str or None
        Column: the value is large enough to be charged to the budget; `None`: it claims nothing.
    """

    leaf: int
    limit: int
    level: int | None
    lanes: int = 1
    item_bytes: int = 0
    has_nul: bool = False
    align: int = 1
    charge: Charge | None = None
    counts_nothing: bool = False
    nexts: tuple[NextMap, ...] = ()
    over: str = ""
    skips: str = ""
    charged: str | None = None

    @property
    def max_count(self) -> int:
        """The largest legal value on the wire."""
        return self.limit + self.has_nul

    @property
    def most_in_rest(self) -> int:
        """The largest value on the wire of which all items are in the rest."""
        return self.lanes + self.has_nul

    @property
    def kind(self) -> str:
        """What is counted: equal for lengths whose items have one size."""
        if self.level is not None:
            return "nothing" if self.counts_nothing else "elements"
        return "string" if self.has_nul else f"items_of_{self.item_bytes}"

    @property
    def at_most_one_pass(self) -> str:
        """At most one pass of the body."""
        return f"at_most_one_{self.kind}"

    @property
    def two_passes(self) -> str:
        """Two passes of the body; valid only if `at_most_one_pass` is 0."""
        return f"two_{self.kind}"

    @property
    def rest(self) -> str:
        """Items of the rest."""
        return f"rest_{self.kind}"

    def next_last_at(self, following: NextMap) -> str:
        """The last byte of what follows, if all items are in the rest."""
        at = f"_at_{self.align}" if self.align > 1 else ""
        what = f"{following.last_offset + 1}_at_{following.align}"
        return f"last_of_{what}_after_{self.kind}{at}"


def with_columns(lengths: Mapping[int, Length]) -> dict[int, Length]:
    """Name the columns that depend on limits: after what is counted, not after the limits."""
    given: dict[tuple[object, ...], str] = {}

    def name(what: str, length: Length, *key: object) -> str:
        key = what, *key
        if key not in given:
            given[key] = first_free(f"{what}_{length.kind}", given.values())
        return given[key]

    return {
        number: replace(
            each,
            over=name("over", each, each.max_count),
            skips=name("skips", each, each.kind, each.max_count),
            charged=None
            if each.charge is None
            else name("charged", each, each.charge.charged_from),
        )
        for number, each in lengths.items()
    }


def length_of(plan: Plan, control: Control) -> Length | None:
    """Return the length with which a state begins a loop or a run."""
    begin = control.begin
    if begin is None or isinstance(begin.count, Constant):
        return None
    count = begin.count
    if isinstance(begin, Loop):
        return Length(leaf=count.leaf, limit=count.limit, level=control.level, charge=count.charge)
    items = plan.leaves[begin.leaf]
    return Length(
        leaf=count.leaf,
        limit=count.limit,
        level=None,
        lanes=items.lanes,
        item_bytes=items.item_bytes,
        has_nul=count.nul,
        align=begin.align,
        charge=count.charge,
    )
