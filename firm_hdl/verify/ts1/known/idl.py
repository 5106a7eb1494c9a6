"""Deliberate differences from rosidl_parser in reading IDL."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from firm_hdl.verify.ts1.case import DefinitionCase
from firm_hdl.verify.ts1.facts import Facts
from firm_hdl.verify.ts1.known.idl_text import blanked, changed, in_code, modules_of
from firm_hdl.verify.ts1.known.rule import Rules, mend_values, without_hash
from firm_hdl.verify.ts1.known.texts import renamed

__all__ = ["RULES"]

RULES = Rules("rosidl_parser", language="idl")
"""Known differences from rosidl_parser in IDL."""

# Names.

# On purpose not those of `firm_hdl.frontend`, which rosidl_parser judges.
_PARTS = ("Request", "Response", "Goal", "Result", "Feedback")


@RULES.facts(
    "idl-names", "A type in IDL is called by its package and its file, whatever its modules say."
)
def _named_as_file(facts: Facts, case: DefinitionCase) -> Facts:
    """Name the message by its package and folder if the text has other modules around it."""
    if "names" not in facts:
        return _parts_named_as_file(facts, case)
    (name,) = facts["names"]
    *modules, base = name.split("/")
    is_written = set(modules) <= modules_of(blanked(case.text))
    return {**facts, "names": [f"{case.package}/{case.kind}/{base}"]} if is_written else facts


def _parts_named_as_file(facts: Facts, case: DefinitionCase) -> Facts:
    """Name the messages of a service or of an action by their package and folder."""
    messages = facts.get("structure", {})
    scopes = {name.rpartition("/")[0] for name in messages}
    own = f"{case.package}/{case.kind}"
    if len(scopes) != 1 or scopes == {own} or len(messages) == 1:
        return facts
    (scope,) = scopes
    if not set(scope.split("/")) <= modules_of(blanked(case.text)):
        return facts

    def named(name: str) -> str:
        base = re.split(r"[\[<]", name, maxsplit=1)[0]
        return name.replace(scope, own, 1) if base in messages else name

    mended = {
        named(name): {
            **message,
            "fields": [{**each, "type": named(each["type"])} for each in message.get("fields", [])],
        }
        for name, message in messages.items()
    }
    return {**facts, "structure": mended}


@RULES.text(
    "idl-file-names",
    "A file in IDL must declare what it is called; rosidl_parser does not see file names.",
    is_mistake=True,
)
def _called_as_file(case: DefinitionCase) -> str:
    """Rename the declared type to the name of the file."""
    found = re.findall(r"\bstruct\s+(\w+)", blanked(case.text))
    bases = {re.sub(rf"_(?:{'|'.join(_PARTS)})$", "", name) for name in found}
    if len(bases) != 1 or case.name in found:
        return case.text
    (base,) = bases
    ends = rf"(?=(?:_(?:{'|'.join(_PARTS)}))?(?:_Constants)?\b)"
    return in_code(case.text, rf"\b{base}{ends}", case.name)


# Constants.

_DECLARED = re.compile(r"\bconst\s+[\w :<>,]*?\b(\w+)\s*=\s*([^;]*);")


_NAMED_BOUND = re.compile(r"\bwstring\s*<\s*(?P<name>[A-Za-z_][\w:]*)")


def _scopes(text: str) -> Iterator[tuple[int, int]]:
    """Yield the innermost pairs of braces."""
    for match in re.finditer(r"\{[^{}]*\}", text):
        yield match.span()


def _declared(code: str) -> Iterator[tuple[str, str, str]]:
    """Yield constants: module, name and value. A module with other braces in it has no name."""
    modules = {}
    for begin, end in _scopes(code):
        if module := re.search(r"\bmodule\s+(\w+)\s*$", code[:begin]):
            modules[begin, end] = module[1]
    for match in _DECLARED.finditer(code):
        inner = [name for (begin, end), name in modules.items() if begin < match.start() < end]
        yield "".join(inner), match[1], match[2].strip()


def _named_bounds(case: DefinitionCase) -> Iterator[tuple[re.Match[str], str | None]]:
    """Yield bounds of wstrings that are names, with the values of their constants.

    The value is `None` if the struct sees no such constant: neither in the modules around the
    struct nor in those of constants, of which its own comes first.
    """
    code = blanked(case.text)
    declared = [each for text in case.included for each in _declared(blanked(text))]
    declared += _declared(code)
    for match in _NAMED_BOUND.finditer(code):
        scope, _, name = match["name"].rpartition("::")
        found = {module: value for module, each, value in declared if each == name}
        own = "".join(re.findall(r"\bstruct\s+(\w+)", code[: match.start()])[-1:])
        others = [module for module in found if module.endswith("_Constants")]
        # Of several others, none is meant.
        others = others if len(others) == 1 else []
        order = [scope.rpartition("::")[2], ""] if scope else ["", f"{own}_Constants", *others]
        yield match, next((found[module] for module in order if module in found), None)


@RULES.text(
    "idl-unseen-bounds",
    "rosidl_parser takes a wstring whose bound is no constant that its struct sees.",
    is_mistake=True,
)
def _bounds_that_are_seen(case: DefinitionCase) -> str:
    """Write 1 for a bound that is the name of no constant in sight."""
    unseen = [match.span("name") for match, value in _named_bounds(case) if value is None]
    return changed(case.text, [(*span, "1") for span in unseen])


@RULES.text(
    "idl-bounds-by-name",
    "rosidl_parser keeps the name of a constant that bounds a wstring; we have its value.",
)
def _bounds_by_value(case: DefinitionCase) -> str:
    """Write the value of a constant that bounds a wstring in place of its name."""
    found = [(match.span("name"), value) for match, value in _named_bounds(case)]
    return changed(case.text, [(*at, value) for at, value in found if value and value.isdecimal()])


def _as_float(kind: str, value: Any) -> Any:
    """Convert integers that are values of floating-point types to floats."""
    if re.split(r"[\[<]", kind, maxsplit=1)[0] not in ("float32", "float64", "long double"):
        return value
    if isinstance(value, list):
        return [_as_float(kind, each) for each in value]
    return float(value) if type(value) is int else value


RULES.add(
    "idl-whole-numbers",
    "rosidl_parser keeps an integer that is given for a floating-point number an integer.",
    theirs=mend_values(_as_float),
)


@RULES.facts(
    "idl-long-double-hash",
    "rosidl_generator_type_description raises KeyError for a long double; we have a hash.",
)
def _without_long_double_hash(facts: Facts, case: DefinitionCase) -> Facts:
    """Remove the error that rosidl raises in place of the hash of a long double."""
    if facts.get("hash") != "raises KeyError: 'long double'":
        return facts
    return without_hash(facts)


# Names that C++ would declare twice.


_NAMES = re.compile(
    r"(?P<constant>\bconst\s+[\w :<>,]*?\b(?P<a>\w+)\s*(?==))"
    r"|(?P<member>\b(?P<b>\w+)\s*(?:\[[^\]]*\]\s*)?(?=[;,]))"
)


@RULES.text(
    "idl-twice",
    "rosidl_parser takes constants and members that are declared twice, which C++ does not.",
    is_mistake=True,
)
def _declared_once(case: DefinitionCase) -> str:
    """Rename what is declared again inside the same braces."""
    # Blanks keep the length, so that places in `code` are places in the text.
    code = blanked(case.text)
    code = re.sub(r"<[^<>;{}]*>", lambda match: " " * len(match[0]), code)
    changes: list[tuple[int, int, str]] = []
    for begin, end in _scopes(code):
        seen: set[str] = set()
        is_struct = re.search(r"\bstruct\s+\w+\s*$", code[:begin]) is not None
        for match in _NAMES.finditer(code, begin, end):
            which = "b" if is_struct else "a"
            name = match[which]
            if name is None:
                continue
            if name in seen:
                changes.append((*match.span(which), f"{renamed(name)}{len(changes)}"))
            seen.add(name)
    return changed(case.text, changes)


# Mistakes that rosidl_parser does not check for.


@RULES.text("idl-lengths", "rosidl_parser takes arrays of negative lengths.", is_mistake=True)
def _positive_lengths(case: DefinitionCase) -> str:
    return in_code(case.text, r"(\[\s*)-\s*\d+(?=\s*\])", r"\g<1>1")


_TYPES = "octet|boolean|float|double|w?char|w?string|unsigned|short|long|u?int(?:8|16|32|64)"


_GLUED = (
    rf"((?:[{{;]|\btypedef\b)\s*)({_TYPES})(?=\w+\s*(?:\[[^\]]*\]\s*)?;)"
    r"|(\b)(unsigned)(?=(?:short|long)\b)"
)


@RULES.text("idl-words", "rosidl_parser takes words that run together.", is_mistake=True)
def _words_apart(case: DefinitionCase) -> str:
    """Write a blank after a type, or a word of it, that the next word follows without one."""
    return in_code(case.text, _GLUED, lambda m: f"{m[1] or m[3] or ''}{m[2] or m[4]} ")


_SCOPED = r"(?<![\w:])(?:\w+\s*::\s*)+\w+(?=\s+\w+\s*(?:[;,]|\[))"

_SCOPED_ELEMENT = r"(\bsequence\s*<\s*)((?:\w+\s*::\s*)+\w+)(?=\s*[,>])"


@RULES.text(
    "idl-type-scopes",
    "rosidl_parser takes types that are not written package::msg::Name.",
    is_mistake=True,
)
def _types_of_ros(case: DefinitionCase) -> str:
    """Write a builtin type in place of one whose scopes do not follow ROS's rules."""

    def kind(name: str) -> str:
        scopes = [each.strip() for each in name.split("::")]
        return name if scopes[1:-1] in (["msg"], ["srv"], ["action"]) else "long"

    def element(match: re.Match[str]) -> str:
        return match[1] + kind(match[2])

    text = in_code(case.text, _SCOPED, lambda match: kind(match[0]))
    return in_code(text, _SCOPED_ELEMENT, element)


# Constructs that firm-hdl refuses by name.

_UNSUPPORTED = r"@(?:optional|mutable)\b(?:\s*\([^()]*\))?|@extensibility\s*\(\s*MUTABLE\s*\)"


@RULES.text(
    "idl-unsupported",
    "Annotations that change the bytes on the wire are refused; rosidl_parser ignores them.",
    is_mistake=True,
)
def _without_unsupported(case: DefinitionCase) -> str:
    return in_code(case.text, _UNSUPPORTED, "")


@RULES.unavoidable(
    "idl-lists-of-lists",
    "Lists of lists by typedefs are refused; rosidl_parser takes some, and nothing after it.",
)
def _has_lists_of_lists(case: DefinitionCase) -> bool:
    """Whether the text declares a list of a type that is a list by a typedef."""
    code = blanked(case.text)
    lists = set(re.findall(r"\btypedef\s+sequence\s*<[^;]*>\s*(\w+)\s*;", code))
    arrays = set(re.findall(r"\btypedef\s+[^;]*?\b(\w+)\s*\[[^;\]]*\]\s*;", code))
    named = "|".join(map(re.escape, sorted(lists | arrays)))
    pattern = rf"sequence\s*<\s*(?:\w+::)*(?:{named})\b|\b(?:{named})\s+\w+\s*\["
    return bool(named) and re.search(pattern, code) is not None
