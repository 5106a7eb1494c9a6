"""Identifiers of ROS names: the same identifier in VHDL, Verilog and SystemVerilog.

Some names of ROS fields, such as `range`, `type`, `label` and `reg`, are keywords of one of these
languages. ROS 1 also allows `a__b`, `a_`, and both `A` and `a`, which VHDL forbids. Each name gets
one identifier, so that a port has the same name in all languages. The identifier is legal in
VHDL-2008 and in SystemVerilog-2017, and differs from its neighbours in more than case.

Different names get different identifiers: legal names stay, and the others get a suffix.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Mapping
from typing import TypeVar

from firm_hdl.names.keywords import KEYWORDS

__all__ = ["first_free", "flat_names", "identifier", "plain", "scope_names"]

KEYWORD_SUFFIX = "_field"
"""Suffix of a name that is a keyword. VHDL forbids the customary trailing underscore."""

_NOT_ALLOWED = re.compile(r"[^A-Za-z0-9]+")
_Key = TypeVar("_Key")


def plain(name: str, initial: str) -> str:
    """Make a name a basic identifier of VHDL (IEEE Std 1076-2008, 15.4) or a keyword.

    * `initial`: letter to put first if the name does not start with a letter.
    """
    text = _NOT_ALLOWED.sub("_", name).strip("_")
    return text if text[:1].isalpha() else f"{initial}{text}"


def first_free(
    wanted: str,
    taken: Collection[str],
    derived: Callable[[str], Iterable[str]] = lambda name: (name,),
) -> str:
    """Return the wanted name, with a number if the name is taken; case is ignored.

    * `taken`: names in lower case.
    * `derived`: returns all identifiers that are derived from the name. They have to be free, too.
    """
    text, number = wanted, 2
    while any(name.lower() in taken for name in derived(text)):
        text, number = f"{wanted}_{number}", number + 1
    return text


def identifier(name: str) -> str:
    """Return the identifier for a single name: the name itself, if it is legal."""
    text = plain(name, "f")
    return text + KEYWORD_SUFFIX if text.lower() in KEYWORDS else text


def scope_names(names: Iterable[str], reserved: Collection[str] = ()) -> dict[str, str]:
    """Return the identifiers for the names of one scope, such as the fields of a record.

    * `names`: they must be distinct.
    * `reserved`: identifiers that are taken, ignoring case.

    The result is by name, in the order of `names`. It depends on the arguments only.
    """
    return _assign({name: name for name in names}, reserved)


def flat_names(
    paths: Iterable[tuple[str, ...]], reserved: Collection[str] = ()
) -> dict[tuple[str, ...], str]:
    """Return the identifiers for paths: their parts, joined by one underscore.

    * `paths`: they must be distinct.
    * `reserved`: as for :func:`scope_names`.
    """
    return _assign({path: "_".join(path) for path in paths}, reserved)


def _assign(wanted: Mapping[_Key, str], reserved: Collection[str]) -> dict[_Key, str]:
    taken = {name.lower() for name in reserved}
    given: dict[_Key, str] = {}
    # Legal names come first, so that no other name takes a legal one when it is changed.
    for key, text in wanted.items():
        if identifier(text) == text and text.lower() not in taken:
            taken.add(text.lower())
            given[key] = text
    for key in (key for key in wanted if key not in given):
        text = first_free(identifier(wanted[key]), taken)
        taken.add(text.lower())
        given[key] = text
    return {key: given[key] for key in wanted}
