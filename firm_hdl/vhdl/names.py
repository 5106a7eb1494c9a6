"""Names of a netlist as VHDL identifiers.

A name that is a legal identifier stays as it is. Other names lose the characters that VHDL forbids:
double, leading and trailing underscores, ``$``, ``.`` and brackets. The result gets a suffix if it
is a keyword, a name that the generated text uses, or equal to a neighbour, ignoring case.
Therefore, different names get different identifiers.
IEEE Std 1076-2008, clause 15.4 (identifiers) and 12.2 (scope).
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping

from firm_hdl.names.identifiers import first_free, plain
from firm_hdl.names.keywords import KEYWORDS

__all__ = ["AMS", "PREDEFINED", "USED", "Scope", "is_identifier", "legal"]

USED = frozenset(
    """
    ieee std work std_logic_1164 numeric_std textio std_logic std_ulogic std_logic_vector unsigned
    signed boolean integer natural positive real string character bit bit_vector time severity_level
    true false note warning error failure resize shift_left shift_right to_integer to_unsigned
    to_signed to_string to_hstring to_ostring rising_edge falling_edge firm_hdl_pkg sign_extend
    repeat_bit mux to_std_logic lsb saturate floor_div floor_mod to_decimal to_characters rtl
    """.split()
)
"""Identifiers that the generated text uses; a signal of the same name would hide them."""

AMS = frozenset(
    """
    across limit nature noise procedural quantity reference spectrum subnature terminal through
    tolerance
    """.split()
)
"""Reserved words of VHDL-AMS (IEEE Std 1076.1) that are not reserved in VHDL.

They are legal in VHDL, but GHDL warns of them. Only ports of the outermost entity keep such names.
"""

PREDEFINED = frozenset(
    """
    ack append_mode bel binary_read binary_write boolean_vector bread bs bwrite can
    copyrightnotice cr dc1 dc2 dc3 dc4 del delay_length dle em enq eot esc etb etx ff
    file_open_kind file_open_status find_leftmost find_rightmost foreign fs fsp gsp hex_read
    hex_write hr hread ht hwrite integer_vector is_x lf maximum min minimum mode_error ms nak
    name_error now ns nul octal_read octal_write open_ok oread owrite ps read read_mode
    real_vector resolved rotate_left rotate_right rsp sec si so soh status_error std_match
    std_ulogic_vector stx sub syn time_vector to_01 to_binary_string to_bit to_bit_vector
    to_bitvector to_bstring to_bv to_hex_string to_octal_string to_slv to_std_logic_vector
    to_std_ulogic_vector to_stdlogicvector to_stdulogic to_stdulogicvector to_sulv to_ux01
    to_x01 to_x01z u_signed u_unsigned unresolved_signed unresolved_unsigned us usp ux01 ux01z
    vt write write_mode x01 x01z
    """.split()
    + [f"c{number}" for number in range(128, 160)]
)
"""Identifiers of std.standard, ieee.std_logic_1164 and ieee.numeric_std that are not in `USED`.

Nearly every design makes them visible by use clauses. If two use clauses name different
declarations of one name, neither is visible, unless both are subprograms or literals (12.4). For
example, ``5 ns`` is an error after ``use`` of a package with a constant ``NS``.
"""

_IDENTIFIER = re.compile(r"[A-Za-z](?:_?[A-Za-z0-9])*\Z")


def is_identifier(name: str) -> bool:
    """Return whether a name is a basic identifier and not a keyword."""
    return _IDENTIFIER.match(name) is not None and name.lower() not in KEYWORDS


def legal(name: str) -> str:
    """Make a name a basic identifier that is not a keyword, regardless of its neighbours."""
    text = plain(name, "n")
    return f"{text}_sig" if text.lower() in KEYWORDS or text.lower() in USED else text


class Scope:
    """The identifiers of one declarative region.

    * `reserved`: identifiers that are taken already.
    * `avoided`: legal identifiers that this scope does not give to any name, in lower case.
    """

    def __init__(self, reserved: Iterable[str], avoided: Collection[str] = ()) -> None:
        self._taken = {name.lower() for name in reserved}
        self._avoided = avoided

    def give(self, wanted: str) -> str:
        """Take the identifier nearest to `wanted` that is free."""
        text = first_free(self._legal(wanted), self._taken)
        self._taken.add(text.lower())
        return text

    def give_all(self, wanted: Mapping[str, str]) -> dict[str, str]:
        """Take identifiers for many names, by key; legal names come before the others.

        Within each group, the order of `wanted` decides.
        """
        given = {key: self.give(name) for key, name in wanted.items() if self._legal(name) == name}
        given.update((key, self.give(name)) for key, name in wanted.items() if key not in given)
        return {key: given[key] for key in wanted}

    def _legal(self, name: str) -> str:
        text = legal(name)
        return f"{text}_sig" if text.lower() in self._avoided else text
