"""Compare two sets of results: which figures changed, and by how much."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from firm_hdl.bench.results import Result

__all__ = ["Change", "compare", "compared"]

# Names of figures, and whether a larger value is better.
FIGURES = {
    "LUT": False,
    "FF": False,
    "carry": False,
    "RAM": False,
    "BRAM": False,
    "MHz": True,
    "beats per cycle": True,
    "latency": False,
    "Gbit/s": True,
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Change:
    """A figure that changed."""

    result: Result  # The newer result of the converter.
    figure: str  # One of `FIGURES`.
    # `None` if there is no figure.
    old: float | None
    new: float | None

    @property
    def share(self) -> float:
        """The change, divided by the old figure; infinite if that is 0 or a figure is missing."""
        if self.old is None or self.new is None or self.old == 0:
            return float("inf")
        return (self.new - self.old) / self.old

    @property
    def is_worse(self) -> bool:
        """Whether the newer figure is worse, or missing."""
        if self.old is None or self.new is None:
            return self.new is None
        return (self.new > self.old) != FIGURES[self.figure]

    def __str__(self) -> str:
        old, new = ("none" if value is None else _number(value) for value in (self.old, self.new))
        by = "" if self.share == float("inf") else f" ({100 * self.share:+.1f} %)"
        worse = "worse" if self.is_worse else "better"
        return f"{worse:7}{self.result.converter}: {self.figure} {old} -> {new}{by}"


def compare(old: Iterable[Result], new: Iterable[Result], threshold: float) -> Iterator[Change]:
    """Yield the figures of converters in both sets that changed by more than a threshold.

    * `threshold`: largest change to ignore, divided by the old figure: 0.02 is two percent.
    """
    before = {result.key: result for result in old}
    for result in new:
        if (other := before.get(result.key)) is None:
            continue
        olds, news = _figures(other), _figures(result)
        for figure in FIGURES:
            change = Change(
                result=result, figure=figure, old=olds.get(figure), new=news.get(figure)
            )
            if change.old != change.new and abs(change.share) > threshold:
                yield change


def compared(old: Iterable[Result], new: Iterable[Result], threshold: float) -> tuple[str, bool]:
    """Compare two sets; return a text, and whether some converter is in both and none is worse.

    The text counts converters in one set only. It names different tools or options, because a
    difference of the figures may then have nothing to do with the circuit.
    """
    olds, news = list(old), list(new)
    before = {result.key: result for result in olds}
    both = [result for result in news if result.key in before]
    changes = list(compare(olds, news, threshold))
    lines = [str(change) for change in changes]
    for result in both:
        conditions = [_made_by(before[result.key]), _made_by(result)]
        if conditions[0] != conditions[1]:
            lines.append(f"not alike: {result.converter}: {conditions[0]}, now {conditions[1]}")
    lines.append(
        f"{len(both)} converters compared, {len(news) - len(both)} are new, "
        f"{len(olds) - len(both)} are not measured now; {len(changes)} figures changed by more "
        f"than {100 * threshold:g} %"
    )
    is_fine = bool(both) and not any(change.is_worse for change in changes)
    return "\n".join(lines), is_fine


def _figures(result: Result) -> dict[str, float]:
    found: dict[str, float] = {}
    if result.measured is not None:
        area = result.measured.area
        names = ("LUT", "FF", "carry", "RAM", "BRAM")
        numbers = (area.lut, area.ff, area.carry, area.lutram, area.bram)
        found.update(zip(names, numbers, strict=True))
    if result.mhz is not None:
        found["MHz"] = result.mhz
    if result.cycles is not None:
        found["beats per cycle"] = 1 / result.cycles.per_beat
        found["latency"] = result.cycles.latency
    if result.gbit_per_s is not None:
        found["Gbit/s"] = result.gbit_per_s
    return found


def _made_by(result: Result) -> str:
    """Describe how figures were made: seeds, tools, options, messages."""
    parts = []
    if (found := result.measured) is not None:
        seeds = " ".join(str(each.seed) for each in found.placed)
        tools = ", ".join(f"{name} {version}" for name, version in sorted(found.tools.items()))
        parts += [tools, found.mapping, found.placement, f"seeds {seeds}"]
    if result.cycles is not None:
        parts.append(str(result.cycles.messages))
    return "; ".join(parts)


def _number(value: float) -> str:
    return f"{value:g}" if value == int(value) else f"{value:.3f}" if value < 10 else f"{value:.1f}"
