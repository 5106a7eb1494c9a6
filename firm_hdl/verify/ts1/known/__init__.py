"""Deliberate differences between oracles and firm-hdl. docs/reference/errata.md gives the reasons.

Reports name each difference by its key. An entry removes its difference, and the rest is compared
again (`firm_hdl.verify.ts1.explain`). A difference that is left then is a mistake of the oracle or
of firm-hdl.
"""

from __future__ import annotations

from firm_hdl.verify.ts1.known import idl, idl_fit, idl_values, lenient, ros, rosbags
from firm_hdl.verify.ts1.known.rule import KnownRule

__all__ = ["KNOWN"]

KNOWN: tuple[KnownRule, ...] = (
    *(*rosbags.RULES, *lenient.RULES, *ros.MISTAKES, *ros.RULES),
    *(*idl_fit.RULES, *idl.RULES, *idl_values.RULES),
)
"""All entries, in the order in which they are applied."""
