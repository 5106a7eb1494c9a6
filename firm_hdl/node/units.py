"""Names of a node's design units: entities, packages and modules, each in a file of its own name.

Names of entities begin with the name of the node, names of packages with those of message types. So
a node with the name of a package would have two files of one name.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import PurePath

from firm_hdl.errors import DefinitionError, Diagnostic
from firm_hdl.node.description import Description

__all__ = ["check_units"]

_SUFFIXES = (".vhd", ".sv")


def check_units(
    description: Description, name: str, *, top: str, files: Mapping[str, Iterable[str]]
) -> None:
    """Refuse a name of a node if two design units would have one name.

    VHDL ignores the case of names (IEEE Std 1076-2008, 15.4.2), and units of VHDL and of
    SystemVerilog may be in one library. So the names of all of them differ in more than case.

    Parameters
    ----------
    name : str
        Name that the outermost entity is to have.
    top : str
        Name that this entity has in VHDL.
    files : mapping of str to iterable of str
        Names of files by what they belong to, such as ``"the messages"``. Those with another
        suffix than ``.vhd`` and ``.sv`` do not count.

    Raises
    ------
    DefinitionError
        At the name of the node in the description.
    """
    if top != name:
        raise _refused(description, f"the VHDL of every node uses the name '{name}' itself")
    owners: dict[str, str] = {}
    for owner, names in files.items():
        for unit in (PurePath(each).stem for each in names if each.endswith(_SUFFIXES)):
            first = owners.setdefault(unit.lower(), owner)
            if first != owner:
                what = f"{first} and {owner} would both have a unit with the name '{unit}'"
                raise _refused(description, what)


def _refused(description: Description, reason: str) -> DefinitionError:
    message = f"{reason}; give the node another name"
    return DefinitionError([Diagnostic(message=message, span=description.node_span)])
