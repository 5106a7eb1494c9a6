"""What to say about a name that means nothing, and what may have been meant."""

from __future__ import annotations

from difflib import get_close_matches

from firm_hdl.frontend.explain import clip
from firm_hdl.frontend.sources import Sources

__all__ = ["did_you_mean", "similar_types", "unknown_type"]


def unknown_type(sources: Sources, package: str, name: str) -> str:
    """Word the message for a type that is not defined."""
    if package in sources.types:
        return f"type '{clip(name)}' is not defined in package '{clip(package)}'"
    return f"package '{clip(package)}' is not found"


def similar_types(sources: Sources, package: str, name: str) -> list[tuple[str, str]]:
    """List packages and names of the types that may have been meant, the likeliest first.

    The same name in a package that looks alike, then in any other; a name that looks alike in the
    package, if it exists.
    """
    packages = sources.packages_of.get(name, [])
    close = get_close_matches(package, packages, n=len(packages) or 1)
    found = [(other, name) for other in [*close, *packages]]
    own = sources.types.get(package, [])
    found += [(package, other) for other in get_close_matches(name, own)]
    if package not in sources.types and not found:
        for other in get_close_matches(package, sources.types):
            found += [(other, close) for close in get_close_matches(name, sources.types[other])]
    return list(dict.fromkeys(found))


def did_you_mean(message: str, names: list[str]) -> str:
    """Add at most three suggestions to a message."""
    quoted = [f"'{name}'" for name in names[:3]]
    match quoted:
        case []:
            return message
        case [*others, last]:
            choice = f"{', '.join(others)} or {last}" if others else last
            return f"{message}; did you mean {choice}?"
    raise AssertionError
