"""The table of proofs in ``lab/notes/formal.md``."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from lab.formal.catalog import Proof
from lab.formal.solve import Answer

__all__ = ["replace_table", "table"]

_BEGIN = "<!-- proofs: written by `python -m lab.formal --write lab/notes/formal.md` -->"
_END = "<!-- end of proofs -->"


def table(proofs: Mapping[str, Proof], answers: Mapping[str, Answer]) -> str:
    """Return the table of proofs that succeeded, in the order of the catalogue."""
    lines = ["| Block | Property | Method | Depth in cycles | Time in s |"]
    lines += ["| --- | --- | --- | --- | --- |"]
    for key, proof in proofs.items():
        answer = answers.get(key)
        if answer is None or answer.result != "proved":
            continue
        claim = proof.claim
        lines.append(
            f"| {proof.study.block} | {claim.name} | {claim.method} | {claim.reach} "
            f"| {answer.seconds:.1f} |"
        )
    return "\n".join(lines) + "\n"


def replace_table(page: Path, text: str) -> None:
    """Replace the table of a page.

    Raises
    ------
    ValueError
        If the page has no place for it.
    """
    old = page.read_text(encoding="utf-8")
    before, begin, rest = old.partition(_BEGIN)
    _, end, after = rest.partition(_END)
    if not begin or not end:
        raise ValueError(f"{page} has no lines {_BEGIN} and {_END}")
    page.write_text(f"{before}{_BEGIN}\n\n{text}\n{_END}{after}", encoding="utf-8")
