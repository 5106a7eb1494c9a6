"""Names of a netlist as VHDL identifiers.

A name that is a legal identifier stays as it is; others lose what VHDL forbids (a double, leading
or trailing underscore, ``$``, ``.``, brackets), and whoever then meets a keyword, a name that the
generated text itself uses or, case not counting, a neighbour gets a suffix. No two are merged.
IEEE Std 1076-2008, clause 15.4 (identifiers) and 12.2 (scope).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

from firm_hdl.export.keywords import KEYWORDS
from firm_hdl.export.names import first_free, plain

__all__ = ["USED", "Scope", "is_identifier", "legal"]

USED = frozenset(
    """
    ieee std work std_logic_1164 numeric_std textio std_logic std_ulogic std_logic_vector unsigned
    signed boolean integer natural positive real string character bit bit_vector time severity_level
    true false note warning error failure resize shift_left shift_right to_integer to_unsigned
    to_signed to_string to_hstring to_ostring rising_edge falling_edge firm_hdl_pkg sign_extend
    repeat_bit mux to_std_logic lsb saturate floor_div floor_mod to_decimal to_characters rtl
    """.split()
)
"""Identifiers with a meaning in the text that we write; a signal of that name would hide them."""

_IDENTIFIER = re.compile(r"[A-Za-z](?:_?[A-Za-z0-9])*\Z")


def is_identifier(name: str) -> bool:
    """Tell whether a name is a basic identifier and no keyword."""
    return _IDENTIFIER.match(name) is not None and name.lower() not in KEYWORDS


def legal(name: str) -> str:
    """Make a name a basic identifier that is no keyword, whatever its neighbours are called."""
    text = plain(name, "n")
    return f"{text}_sig" if text.lower() in KEYWORDS or text.lower() in USED else text


class Scope:
    """The identifiers of one declarative region.

    Parameters
    ----------
    reserved : iterable of str
        Identifiers that are taken already.
    """

    def __init__(self, reserved: Iterable[str] = ()) -> None:
        self._taken = {name.lower() for name in reserved}

    def give(self, wanted: str) -> str:
        """Take the identifier nearest to `wanted` that nobody has."""
        text = first_free(legal(wanted), self._taken)
        self._taken.add(text.lower())
        return text

    def give_all(self, wanted: Mapping[str, str]) -> dict[str, str]:
        """Take identifiers for many things, by key; legal names choose before those that are not.

        Of those, the first choose first.
        """
        given = {key: self.give(name) for key, name in wanted.items() if legal(name) == name}
        given.update((key, self.give(name)) for key, name in wanted.items() if key not in given)
        return {key: given[key] for key in wanted}
