"""Deliberate differences between oracles and firm-hdl: a table.

docs/reference/errata.md gives the reasons.

A row explains single facts, or that one of the two refuses a definition. Facts that no row explains
are compared. If the oracle refuses a text, there are no facts: the whole definition is known then.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from itertools import groupby
from typing import Any

from firm_hdl.errors import Diagnostic
from firm_hdl.frontend.sources import Language
from firm_hdl.model import Dialect
from firm_hdl.verify.ts1.facts import Difference
from firm_hdl.verify.ts1.universe import DefinitionCase

__all__ = ["KNOWN", "Known"]


@dataclass(frozen=True, slots=True)
class Known:
    """One deliberate difference: a row of the table."""

    key: str  # The name of the difference, here and in docs/reference/errata.md.
    oracles: str  # Names of the oracles that differ from us, separated by blanks.
    why: str  # What differs, in one sentence.
    dialect: Dialect | None = None
    language: Language | None = None  # Those of the definitions; `None`: any.
    # A pattern that the code of the definition, or of one that it needs, contains. Comments are no
    # code, and neither are string literals of IDL. It does not limit `ours`.
    where: str = ""
    # Patterns for a mistake that we refuse and the oracle accepts: the first finds something in our
    # message, the second matches all words that the message is about.
    ours: tuple[str, str] | None = None
    # A pattern that finds something in the message of the oracle, if it refuses a text that is none
    # of the mistakes of ROS.
    theirs: str = ""
    # A pattern that finds something in the path of a fact that may differ; empty: none may.
    facts: str = ""
    # Takes our fact and the oracle's. Returns whether they differ in this way; `None`: any way.
    like: Callable[[Any, Any], bool] | None = None

    def is_about(self, oracle: str, case: DefinitionCase) -> bool:
        """Whether this row can explain a difference from an oracle in a definition."""
        # The names of newer releases' oracles end in "-" and the version.
        is_oracle = oracle.partition("-")[0] in self.oracles.split()
        is_dialect = self.dialect in (None, case.dialect)
        return is_oracle and is_dialect and self.language in (None, case.language)

    def is_in(self, case: DefinitionCase) -> bool:
        """Whether the code of a definition has what makes the difference."""
        return re.search(self.where, _code(case), re.MULTILINE) is not None

    def has(self, difference: Difference, case: DefinitionCase) -> bool:
        """Whether a single difference comes from this one in a definition."""
        path, ours, theirs = difference.path, difference.ours, difference.theirs
        if not self.facts or not re.search(self.facts, path):
            return False
        if self.like is not None and not self.like(ours, theirs):
            return False
        if not self.where or path.startswith("hash"):
            return self.is_in(case)
        # What makes the difference must be in the declarations of all names that it is about.
        names = {path.split("/")[-2]}
        if re.search(_NAMES, path):
            names = {*ours} - {*theirs} or {*theirs} - {*ours}
        is_idl = case.language == "idl"
        parts = re.split(r"(?<=[;{}])" if is_idl else r"[\r\n]+", _code(case))
        found = "\n".join(each for each in parts if re.search(self.where, each, re.MULTILINE))
        declared = r"\b{}\s*[\[;,=]|\btypedef\b|#\s*include\b" if is_idl else r"(?m)^\s*\S+\s+{}\b"
        return all(re.search(declared.format(re.escape(name)), found) for name in names)

    def refuses(self, message: str) -> bool:
        """Whether an oracle says this if it refuses a definition for the difference."""
        return bool(self.theirs) and re.search(self.theirs, message, re.DOTALL) is not None

    def explains(self, problem: Diagnostic) -> bool:
        """Whether it is deliberate that we refuse a definition for a problem."""
        span = problem.span
        if self.ours is None or span is None:
            return False
        message, words = self.ours
        text = span.source.text[span.start : span.end]
        is_one = re.search(message, problem.message) and re.fullmatch(words, text, re.DOTALL)
        return bool(is_one) and _is_true(problem.message, text, span.source.text)


_QUIET = re.compile(r'"(?:[^"\\\n]|\\.)*"|//[^\n]*|/\*.*?\*/', re.DOTALL)


def _code(case: DefinitionCase) -> str:
    if case.language == "idl":
        return _QUIET.sub(lambda match: '"' if match[0].startswith('"') else " ", case.text)
    # The values of texts may have this sign.
    return re.sub(r"(?m)^([ \t]*(?!w?string\b)[^\s#][^\n#]*|[ \t]*)#.*", r"\1", case.text)


def _is_true(message: str, words: str, text: str) -> bool:
    """Whether a text has the mistake that we find in it, as far as this is plain."""
    if "already declared" in message:
        return len(re.findall(rf"\b{re.escape(words)}\b", text)) > 1
    if found := re.search(r"value of ([a-z]+)(\d*) must be in (-?\d+)\.\.(\d+)$", message):
        bits = int(found[2] or (16 if found[1] == "wchar" else 8))
        least, most = int(found[3]), int(found[4])
        is_type = most - least + 1 == 1 << bits and least in (0, -(1 << (bits - 1)))
        is_inside = re.fullmatch(r"-?\d+", words) and least <= int(words) <= most
        return is_type and not is_inside
    return True


# Our fact and the oracle's.


def _is_same_text(ours: Any, theirs: Any) -> bool:
    """Whether only quotes, escapes, comments and forms of numbers distinguish two texts.

    A list has names: rosbags may take a constant for a field.
    """

    def plain(value: Any) -> str:
        text = re.sub(r"[\"'\\\s]", "", str(value).partition("#")[0]).lower()
        return str(float(text)) if re.fullmatch(r"[-+]?\d+(\.\d*)?", text) else text

    return isinstance(ours, list) or (isinstance(ours, str) and plain(ours) == plain(theirs))


def _is_same_number(ours: Any, theirs: Any) -> bool:
    """Whether what is given for a floating-point number, or for several, is ours."""
    if isinstance(ours, list) and isinstance(theirs, list):
        return len(ours) == len(theirs) and all(map(_is_same_number, ours, theirs))
    text = theirs.partition("#")[0] if isinstance(theirs, str) else theirs
    try:
        return type(ours) is float and type(text) is not bool and repr(float(text)) == repr(ours)
    except (TypeError, ValueError):
        return False


def _is_whole_number(ours: Any, theirs: Any) -> bool:
    items = theirs if isinstance(theirs, list) else [theirs]
    return all(type(each) is int for each in items) and _is_same_number(ours, theirs)


def _is_truth_value(ours: Any, theirs: Any) -> bool:
    return type(ours) is bool and type(theirs) is int and bool(theirs) is ours


def _is_octal(ours: Any, theirs: Any) -> bool:
    return type(ours) is type(theirs) is int and f"{theirs:o}" == str(ours)


def _is_cut(ours: list[str], theirs: list[str]) -> bool:
    """Whether words of a type are missing in front of names."""
    return len(ours) == len(theirs) and all(
        one in (other, f"long{other}", f"double{other}")
        for one, other in zip(ours, theirs, strict=True)
    )


def _is_infinite(ours: Any, theirs: Any) -> bool:
    return isinstance(ours, float) and not math.isfinite(ours) and str(theirs) == str(abs(ours))


def _is_comment(ours: str, theirs: str) -> bool:
    """Whether blanks at the ends of lines, and empty lines, are all that differs."""
    lines = [line.rstrip() for line in theirs.split("\n")]
    kept: list[str] = []
    for is_empty, group in groupby(lines, key=lambda line: line == ""):
        kept += [""] if is_empty else group
    return "\n".join(kept).strip("\n") == ours


def _is_text_bound(ours: Any, theirs: Any) -> bool:
    """Whether a list has the bound of its texts, or hashes differ."""
    found = re.fullmatch(r"(wstring<=(\w+))\[<=\2\]", str(theirs))
    return str(ours).startswith("RIHS01_") or (found is not None and ours == f"{found[1]}[]")


def _is_bound_by_name(ours: str, theirs: str) -> bool:
    names = re.sub(r"\b(wstring<=)[A-Za-z_][\w:]*", r"\1N", theirs)
    return names == re.sub(r"\b(wstring<=)\d+", r"\1N", ours)


def _is_list_of_one(ours: Any, theirs: Any) -> bool:
    items = theirs.strip("() ").strip("'\"") if isinstance(theirs, str) else None
    return isinstance(ours, list) and list(map(str, ours)) == [items]


def _is_own_constants(ours: list[str], theirs: list[str]) -> bool:
    """Whether a list of constants lacks some, or has some twice, that another part has as well."""
    if len(theirs) > len(ours):
        return set(theirs) == set(ours)
    return len(theirs) < len(ours) and set(theirs) <= set(ours)


_VALUES, _TYPES, _NAMES, _HASHES = "/(value|default)$", "/type$", "/(fields|constants)$", "^hash/"
_CONSTANT = r"^[ \t]*\w+[ \t]+"
_ANNOTATED = r"@\s*(?:default|unit)\s*\("
# A value, a size or a bound that is no decimal number, no text and no boolean.
_EXPRESSION = (
    r"\bconst\s+[\w :]+=\s*(?!(?:-?\s*\d[\d.]*(?:[eE][-+]?\d+)?d?|L?\"|TRUE|FALSE)\s*;)"
    r"|=\s*-?0\d|\w\s*\[(?!\s*[1-9]\d*\s*\])|\bstring\s*<(?!\s*[1-9]\d*\s*>)"
    r"|\bwstring\s*<(?!\s*[\w:]+\s*>)"
    r"|\bsequence\s*<[^;{}]*,(?!\s*[1-9]\d*\s*>)"
    rf"|{_ANNOTATED}\s*value\s*=\s*(?!(?:-?\s*\d[\d.]*(?:[eE][-+]?\d+)?d?|L?\"|TRUE|FALSE)\s*\))"
)
_NO_LITERAL = (
    r"Unsupported tree|AssertionError|not supported between|only support Literal Sizes"
    r"|No terminal matches '[ux]'"
)
_VALUE = (
    r"must be in|is not an? (boolean|integer|number)|the default must have|does not fit"
    r"|expected (TRUE or FALSE|an? (string|number|integer|boolean|list)\b)|is too large"
)


def _of(oracles: str, **common: Any) -> Callable[..., Known]:
    return lambda key, why, **more: Known(key, oracles, why, **common, **more)


_rosbags, _genmsg = _of("rosbags"), _of("genmsg")
_rosidl, _idl = _of("rosidl_parser"), _of("rosidl_parser", language="idl")

KNOWN: tuple[Known, ...] = (
    # rosbags refuses it, or reads it otherwise.
    _rosbags("rosbags-crlf", "rosbags refuses lines that end in CR LF.", facts="^line ends$"),
    _rosbags(
        "rosbags-wstring",
        "rosbags does not know wstring.",
        dialect="ros2",
        where=r"^\s*wstring\b",
        theirs=r"wstring is not there|Could not parse",
    ),
    _rosbags(
        "rosbags-special-types",
        "rosbags takes time, duration and Header for builtin types where ROS does not.",
        where=r"^\s*(time|duration|Header)\b",
        ours=(r"\b(time|duration|Header)\b", r"(time|duration|Header)(\[.*)?"),
        facts=f"{_TYPES}|{_HASHES}",
    ),
    _rosbags(
        "rosbags-constant-names",
        "rosbags takes constants with lower-case letters for fields, or refuses them.",
        dialect="ros1",
        where=rf"{_CONSTANT}(?![A-Z](?:_?[A-Z0-9]+)*\s*=)\w+\s*=",
        theirs=r"Could not parse",
        facts=_NAMES,
    ),
    _rosbags(
        "rosbags-placeholders",
        "rosbags takes a field of this name for the one that messages without fields get.",
        where=r"^\s*uint8\s+structure_needs_at_least_one_member\b",
        theirs=r"TypeError|Could not parse",
        facts=_HASHES,
    ),
    _rosbags(
        "rosbags-texts",
        "rosbags takes texts without quotes for numbers, and knows no escapes and comments.",
        where=r"^\s*w?string(<=\d+)?\s+\w+(\s*=|[ \t]+[^\s#])",
        theirs=r"Could not parse|AssertionError|ValueError|TypesysError",
        facts=f"{_VALUES}|{_NAMES}",
        like=_is_same_text,
    ),
    _rosbags(
        "rosbags-constant-bool",
        "rosbags keeps a bool constant that is written as a number as a number.",
        facts=_VALUES,
        like=_is_truth_value,
    ),
    _rosbags(
        "rosbags-integers",
        "rosbags reads 010 as 8, and does not know 1_000 and 0o17.",
        where=rf"{_CONSTANT}\w+\s*=\s*[-+]?(0\d|0[oObB]|[\w.]+_)|int\d+ \w+ +[-+]?(0\d|\d+_)",
        theirs=r"Could not parse|ValueError",
        facts=_VALUES,
        like=_is_octal,
    ),
    _rosbags(
        "rosbags-floats",
        "rosbags takes floating-point numbers for such only if they have digits and a point.",
        facts=_VALUES,
        like=_is_same_number,
    ),
    _rosbags(
        "rosbags-char-hash",
        "rosbags hashes char of a .msg as a character, and rosidl as a uint8.",
        dialect="ros2",
        where=r"^\s*char\b",
        facts=_HASHES,
    ),
    # rosbags accepts mistakes.
    _rosbags(
        "rosbags-names",
        "rosbags takes names of fields and constants that ROS 2 refuses.",
        dialect="ros2",
        ours=(r"is not a legal (field|constant) name", r"\w+"),
    ),
    _rosbags(
        "rosbags-type-names",
        "rosbags takes names of messages that ROS 2 refuses.",
        dialect="ros2",
        # A file's own name is in no text.
        ours=(r"not a legal (message|package) name", r"([\w/]*/)?([a-z]\w*|\w*_\w*)|"),
    ),
    _rosbags(
        "rosbags-twice",
        "rosbags takes what is declared twice.",
        ours=(r"^(field|constant) .* is already declared", r"\w+"),
    ),
    _rosbags(
        "rosbags-values", "rosbags takes values that do not fit their types.", ours=(_VALUE, r".+")
    ),
    _rosbags(
        "rosbags-sizes",
        "rosbags takes arrays and bounds of 0, and in ROS 1 sizes with a sign.",
        ours=(r"must be at least 1|is not a (length|size|number)", r"[-+]?0*|[-+]\d+"),
    ),
    _rosbags(
        "rosbags-ros2-forms",
        "rosbags takes bounds and defaults in ROS 1.",
        dialect="ros1",
        ours=(r"ROS 1 has no (bounds|defaults)|a field of ROS 1 has no default", r".+"),
    ),
    _rosbags(
        "rosbags-blanks",
        "rosbags takes blanks in front of a line in ROS 2, and tabs between words in ROS 1.",
        ours=(r"tabs alone do not|must start in the first column", r"\t+|\w.*"),
    ),
    _rosbags(
        "rosbags-annotations",
        "rosbags takes lines like @key.",
        ours=(r"^annotation .* is not supported", r"@\w+.*"),
    ),
    # ROS's own readers accept mistakes.
    _genmsg(
        "ros1-indented-texts",
        "genmsg takes an indented string constant for one called 'string X'.",
        ours=(r"a string constant must start in the first column", r"string"),
    ),
    _genmsg(
        "ros1-constant-names",
        "genmsg takes anything for the name of a constant.",
        ours=(
            r"is not a legal name: |^expected '=' or the end of the line",
            r".*\W.*|\d.*|",
        ),
    ),
    _genmsg(
        "ros1-bool-literals",
        "genmsg takes any literal of Python for a truth value.",
        ours=(r"is not a boolean", r"(?!True$|False$|[01]$).*"),
    ),
    _genmsg(
        "ros1-empty-arrays",
        "genmsg takes arrays of no elements.",
        ours=(r"must be at least 1, not 0", r"0+"),
    ),
    _genmsg(
        "ros1-64-bit-limits",
        "genmsg compares with rounded limits, and takes one more than 64 bits hold.",
        ours=(r"the value of u?int64 must be in", r"\+?(9223372036854775808|18446744073709551616)"),
    ),
    Known(
        "ascii-only",
        "genmsg rosidl_adapter rosidl_parser",
        "Names and numbers are written in ASCII.",
        ours=(r"", r".*[^\x00-\x7f].*"),
    ),
    Known(
        "sizes-of-32-bits",
        "genmsg rosidl_adapter rosidl_parser rosbags",
        "Every wire format counts elements in 32 bits, and so do we.",
        ours=(r"must be at most 4294967295", r"[\d_]{10,}"),
    ),
    # rosidl reads a .msg otherwise.
    Known(
        "ros2-escaped-quotes",
        "rosidl_adapter rosidl_parser",
        "rosidl_adapter loses count of escaped quotes in a list of strings.",
        where=r"^\s*w?string.*\[.*\\[\"']",
        theirs=r"incorrectly quoted",
        facts="/default$",
    ),
    _rosidl(
        "ros2-backslashes",
        "rosidl_adapter copies backslashes into IDL, where they begin escapes.",
        where=r"^\s*w?string.*\\(?![\"'])",
        theirs=r"SystemExit|Unexpected|unicodeescape",
        facts=_VALUES,
        like=lambda ours, _: "\\" in repr(ours),
    ),
    _rosidl(
        "ros2-infinite-numbers",
        "rosidl_adapter writes inf and nan into IDL, where they are names.",
        where=r"^\s*float\S*\s+\w+[ \t]*[= ].*(?i:(?<![a-z])(inf|nan)|\de\+?\d{3})",
        theirs=r"malformed node or string",
        facts=_VALUES,
        like=_is_infinite,
    ),
    Known(
        "ros2-comment-blanks",
        "rosidl_adapter",
        "Blanks at the end of a comment's lines, and empty lines, do not count for us.",
        facts="/comment$",
        like=_is_comment,
    ),
    _rosidl(
        "ros2-wstring-sequences",
        "rosidl_parser takes the bound of the texts in a sequence of wstring for its own.",
        where=r"\bwstring<=\d+\[\]|\bsequence\s*<\s*wstring\s*<[^<>]*>\s*>",
        facts=f"{_TYPES}|{_HASHES}",
        like=_is_text_bound,
    ),
    # rosidl_parser reads IDL otherwise.
    _idl(
        "idl-names",
        "A type in IDL is called by its package and its file, whatever its modules say.",
        facts="^scope$",
    ),
    _idl(
        "idl-bounds-by-name",
        "rosidl_parser keeps the name of a constant that bounds a wstring; we have its value.",
        where=r"\bwstring\s*<\s*[A-Za-z_:]",
        facts=_TYPES,
        like=_is_bound_by_name,
    ),
    _idl(
        "idl-whole-numbers",
        "rosidl_parser keeps an integer that is given for a floating-point number an integer.",
        facts=_VALUES,
        like=_is_whole_number,
    ),
    _idl(
        "idl-booleans",
        "rosidl_parser keeps a boolean constant that is written as a number a number.",
        facts=_VALUES,
        like=_is_truth_value,
    ),
    _rosidl(
        "idl-long-double-hash",
        "rosidl_generator_type_description raises KeyError for a long double; we have a hash.",
        where=r"\blong\s+double\b",
        facts="^hash$",
        like=lambda _, theirs: theirs == "raises KeyError: 'long double'",
    ),
    _idl(
        "idl-lists-of-one",
        "Generators fail at a list that is written (1); rosidl_adapter writes (1, ).",
        facts="/default$",
        like=_is_list_of_one,
    ),
    _idl(
        "idl-short-annotations",
        "rosidl_parser does not understand an annotation whose only argument has no name.",
        where=rf"{_ANNOTATED}(?!\s*\w+\s*=)",
        theirs=r"TypeError: .* is not subscriptable",
        facts="/(default|unit)$",
    ),
    _idl(
        "idl-includes",
        "rosidl_parser does not look at included files.",
        where=r"#\s*include\b",
        theirs=rf"{_NO_LITERAL}|is not there|no name in ROS",
        facts=f"{_TYPES}|{_VALUES}|{_HASHES}",
    ),
    _idl(
        "idl-typedefs",
        "rosidl_parser does not know typedefs of typedefs, and typedefs with their scopes.",
        where=r"\btypedef\b",
        theirs=r"NamedType has no name in ROS|is not there",
        facts=f"{_TYPES}|{_HASHES}",
    ),
    _idl(
        "idl-expressions",
        "rosidl_parser knows decimal numbers only: no expressions, names or characters.",
        where=_EXPRESSION,
        theirs=_NO_LITERAL,
        facts=f"{_TYPES}|{_VALUES}|{_HASHES}",
    ),
    _idl(
        "idl-long-names",
        "rosidl_parser reads 'long longitude' as a long long called itude.",
        where=r"\blong\s+(long|double)\w+\s*[;,\[]",
        facts=_NAMES,
        like=_is_cut,
    ),
    _idl(
        "idl-service-constants",
        "rosidl_parser gives the request what request and response both declare, twice.",
        where=r"\bconst\b",
        facts="/constants$",
        like=_is_own_constants,
    ),
    # rosidl_parser accepts mistakes in IDL, and what we refuse by name.
    _idl(
        "idl-file-names",
        "A file in IDL must declare what it is called; rosidl_parser does not see file names.",
        ours=(r"^this file must declare", r""),
    ),
    _idl(
        "idl-unseen-bounds",
        "rosidl_parser takes a wstring whose bound is no constant that its struct sees.",
        ours=(r"is not declared above", r"[\w:]+"),
    ),
    _idl(
        "idl-twice",
        "rosidl_parser takes what is declared twice, which C++ does not.",
        ours=(r"^(field|constant) .* is already declared", r"\w+"),
    ),
    _idl(
        "idl-lengths",
        "rosidl_parser takes arrays of negative lengths, and a wstring of no characters.",
        ours=(r"must be at least 1", r"-\s*\d+|0+"),
    ),
    _idl(
        "idl-words",
        "rosidl_parser takes words that run together, and numbers that blanks part.",
        ours=(
            r"^expected (a name|an operator or .*), not|is not a type; those of ROS|did you mean",
            r";|(unsigned|short|long|u?int|octet|boolean|float|double|w?char|w?string)\w+|\d+",
        ),
    ),
    _idl(
        "idl-names-after-arrays",
        "rosidl_parser gives a name that follows an array its size.",
        ours=(r"^'\w+' follows array '\w+'", r"\w+"),
    ),
    _idl(
        "idl-type-scopes",
        "rosidl_parser takes types that are not written package::msg::Name.",
        ours=(
            r"is not a type; those of ROS",
            r"(\w+|\w+::(?!(msg|srv|action)::)\w+.*|::.*|(\w+::){3,}\w+|(?:msg|srv|action)::\w+|\w+::\w+)",
        ),
    ),
    _idl(
        "idl-unsupported",
        "rosidl_parser ignores annotations that change the bytes on the wire.",
        ours=(r"^annotation .* is not supported", r"@\s*(optional|mutable|extensibility)\b.*"),
    ),
    _idl(
        "idl-lists-of-lists",
        "rosidl_parser takes some lists of lists by typedefs.",
        ours=(r"(sequences|arrays|several dimensions) (is|are) not supported", r".*"),
    ),
    _idl(
        "idl-defaults",
        "rosidl_parser takes several defaults of a member, and defaults of structs.",
        ours=(
            r"can have only one default|a default needs a value|builtin type can have a default",
            r"@\s*default.*",
        ),
    ),
    _idl(
        "idl-values",
        "rosidl_parser takes values that are none of their types.",
        ours=(_VALUE, r".+"),
    ),
)
"""All rows, in the order in which they are tried."""
