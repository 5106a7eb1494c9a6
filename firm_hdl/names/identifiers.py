"""The one table of names: ROS names as identifiers of VHDL and Verilog.

ROS field names such as `range`, `type`, `label` and `reg` are keywords of one language or the
other; ROS 1 allows `a__b`, `a_` and both `A` and `a`, which VHDL does not. One identifier serves
both languages, so that a port has one name wherever a user meets it: legal in VHDL-2008 and in
SystemVerilog-2017, and different from its neighbours even where case does not count.

No two names are ever merged: names that are fine as they are stay, and the others get a suffix
that nobody else has.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Mapping
from typing import TypeVar

from firm_hdl.names.keywords import KEYWORDS

__all__ = ["first_free", "flat_names", "identifier", "plain", "scope_names"]

KEYWORD_SUFFIX = "_field"
"""What a name gets that is a keyword. VHDL forbids the customary trailing underscore."""

_NOT_ALLOWED = re.compile(r"[^A-Za-z0-9]+")
_Key = TypeVar("_Key")


def plain(name: str, initial: str) -> str:
    """Give a name without what VHDL's basic identifiers may not have (IEEE Std 1076-2008, 15.4).

    Parameters
    ----------
    initial : str
        A letter to start with if the name starts with none.
    """
    text = _NOT_ALLOWED.sub("_", name).strip("_")
    return text if text[:1].isalpha() else f"{initial}{text}"


def first_free(
    wanted: str,
    taken: Collection[str],
    derived: Callable[[str], Iterable[str]] = lambda name: (name,),
) -> str:
    """Give a name that nothing has, case not counting: the wanted one, or that with a number.

    Parameters
    ----------
    taken : collection of str
        In lower case.
    derived : callable
        Gives all identifiers that the name leads to, which have to be free, too.

    >>> first_free("Vector", {"vector", "vector_2"})
    'Vector_3'
    """
    text, number = wanted, 2
    while any(name.lower() in taken for name in derived(text)):
        text, number = f"{wanted}_{number}", number + 1
    return text


def identifier(name: str) -> str:
    """Give the identifier for a name on its own: itself, if it is a legal one."""
    text = plain(name, "f")
    return text + KEYWORD_SUFFIX if text.lower() in KEYWORDS else text


def scope_names(names: Iterable[str], reserved: Collection[str] = ()) -> dict[str, str]:
    """Give the identifiers for the names of one scope, such as the fields of a record.

    Parameters
    ----------
    names : iterable of str
        All different.
    reserved : collection of str
        Identifiers that are taken; case does not count.

    Returns
    -------
    dict of str to str
        By name, in the order of `names`. It depends on nothing but the arguments.
    """
    return _give({name: name for name in names}, reserved)


def flat_names(
    paths: Iterable[tuple[str, ...]], reserved: Collection[str] = ()
) -> dict[tuple[str, ...], str]:
    """Give the identifiers for paths: their parts, joined by one underscore.

    Parameters
    ----------
    paths : iterable of tuple of str
        All different.
    reserved : collection of str
        As for :func:`scope_names`.
    """
    return _give({path: "_".join(path) for path in paths}, reserved)


def _give(wanted: Mapping[_Key, str], reserved: Collection[str]) -> dict[_Key, str]:
    taken = {name.lower() for name in reserved}
    given: dict[_Key, str] = {}
    # Names that can stay come first: no neighbour's escape may push them aside.
    for key, text in wanted.items():
        if identifier(text) == text and text.lower() not in taken:
            taken.add(text.lower())
            given[key] = text
    for key in (key for key in wanted if key not in given):
        text = first_free(identifier(wanted[key]), taken)
        taken.add(text.lower())
        given[key] = text
    return {key: given[key] for key in wanted}
