"""How a run of test systems ends: what was not judged, by name, and whether all is well.

What was asked for by name has to be judged. Of all types, those that nobody can judge are listed
and do not count; but a run that judged nothing at all is no pass either.
"""

from __future__ import annotations

from collections.abc import Sequence

from firm_hdl.verify.results.verdict import Failed, NotJudged
from firm_hdl.verify.systems.system import Judged

__all__ = ["concluded", "is_well"]


def is_well(found: Sequence[Judged], *, is_named: bool) -> bool:
    """Say whether a run is a success, which its exit status tells.

    Parameters
    ----------
    is_named : bool
        Whether what was tested was asked for by name, and not all that there is.
    """
    verdicts = [each.verdict for each in found]
    if any(isinstance(verdict, Failed) for verdict in verdicts):
        return False
    silent = sum(isinstance(verdict, NotJudged) for verdict in verdicts)
    return silent < len(verdicts) and not (is_named and silent)


def concluded(found: Sequence[Judged], *, is_named: bool) -> list[str]:
    """Return lines for the end of a run: each test that was not judged, and what that means."""
    silent = [(each.what, each.verdict) for each in found if isinstance(each.verdict, NotJudged)]
    lines = [f"not judged: {what}: {verdict.reason}" for what, verdict in silent]
    if len(silent) == len(found):
        return [*lines, "nothing was judged: this is no pass"]
    if silent:
        were = "was" if len(silent) == 1 else "were"
        meaning = ", although named: this is no pass" if is_named else ""
        lines.append(f"{len(silent)} of {len(found)} tests {were} not judged{meaning}")
    return lines
