"""The words that a syntax error in a line marks, and its message."""

from __future__ import annotations

import pytest

from firm_hdl.errors import DefinitionError

from .reading import parse

ONE_PART = "a message has one part; '---' is for services and actions"
NO_CONSTANT = "a constant must have a builtin type and cannot be an array"
NUMBER = "is not a number of elements or characters"
BLANK = "expected a number; blanks are not allowed inside a type"
LEGAL = "not a legal message name: letters and digits, a capital first"
TYPE_FORM = f"is {LEGAL}; a type is written 'Name' or 'package/Name'"
NAME = "is not a legal name: letters, digits and underscores"
FIELD = (
    "is not a legal field name: lower-case letters, digits and single underscores, a letter first "
    "and no underscore last"
)
CONSTANT = FIELD.replace("field", "constant").replace("lower", "upper")
PACKAGE = FIELD.replace("field", "package")
AFTER_LIST = "only a comment may follow the ']' of a list"
BRACKETS = "brackets belong to the type"

ROS1 = [
    ("int32« » ", "a name must follow the type"),
    ("int32«#» c", "a name must follow the type"),
    ("int32«\t»# c", "a name must follow the type"),
    ("int32  «#» c", "expected a constant name or a name, but the definition ends here"),
    ("int32«\t»a", "a space must separate type and name; tabs alone do not"),
    ("int32«\xa0»a", "a space must separate type and name; tabs alone do not"),
    ("«--- x»", ONE_PART),
    ("«---»", ONE_PART),
    ("int32 «1a»", f"'1a' {NAME}, a letter first"),
    ("int32 «1a» = 3", f"'1a' {NAME}, no digit first"),
    ("  int32 «a-b» # c", f"'a-b' {NAME}, a letter first"),
    ("time «1a»=3", NO_CONSTANT),
    ("int32[] A«=1»", NO_CONSTANT),
    ("p/Foo A« = 1»", NO_CONSTANT),
    ("p/Foo A« = 1»  ", NO_CONSTANT),
    ("«\x07» a", r"'\x07' is not a type"),
    ("int32 «a[3]»", f"'a[3]' is not a legal name: {BRACKETS}"),
    (
        "int32 a «b»",
        "expected '=' or the end of the line, not 'b'; a field of ROS 1 has no default",
    ),
    (
        "p/Foo[] a «[]»  # c",
        "expected the end of the line, not '[]'; a field of ROS 1 has no default",
    ),
    (
        "int32 a «b»  # = c",
        "expected '=' or the end of the line, not 'b'; a field of ROS 1 has no default",
    ),
    ("int32 a «b=1»", "expected '=' or the end of the line, not 'b=1'"),
    ("int32 A=«»", "expected an integer, but the definition ends here"),
    ("int32 A=1 «2»", "expected the end of the line, not '2'"),
    ("int32 A=«0x1»", "'0x1' is not a decimal integer"),
    ("bool A=«true»", "'true' is not a boolean: True, False, 1 or 0"),
    ("float32 A=«x»  # c", "'x' is not a number"),
    ("string«<=5» a", "ROS 1 has no bounds"),
    ("int32[«<=5]» a", f"'<=5]' {NUMBER}"),
    ("int32[3]«[4]» a", "an array has one dimension"),
    ("int32[« »3] a", BLANK),
    ("int32[«x]» a", f"'x]' {NUMBER}"),
    ("int32[3 «a»", "expected ']', not 'a'"),
    ("a«-b/C» x", "expected '[' or a space, not '-b/C'"),
    ("p/«1» x", f"'1' {TYPE_FORM}"),
    ("  «9a» b", "'9a' is not a type"),
    ("«9/a/B» b", f"'9' {NAME.replace('name', 'package name')}, a letter first"),
    ("«9/A» b", f"'9' {NAME.replace('name', 'package name')}, a letter first"),
    ("«@key»", "annotation '@key' is not supported"),
    ("«\ufeff»int8 a", "a byte order mark is not allowed"),
]
ROS2 = [
    ("int32« » ", "a name must follow the type"),
    ("int32[3]«#» c", "a name must follow the type"),
    ("int32  «#» c", "expected a constant name or a field name, but the definition ends here"),
    ("  «int32 a»  ", "a definition must start in the first column"),
    ("  «9»", "a definition must start in the first column"),
    ("«--- »", "a line that separates two parts must be '---' and nothing else"),
    ("«---x»", "a line that separates two parts must be '---' and nothing else"),
    ("«---»", ONE_PART),
    ("int32 «aB»", f"'aB' {FIELD}"),
    ("int32 «aB» 3", f"'aB' {FIELD}"),
    ("int32 «aB» = 3", f"'aB' {CONSTANT}"),
    ("int32 «A__B»=3", f"'A__B' {CONSTANT}"),
    ("Foo «A» = 1", NO_CONSTANT),
    ("Foo«=1»", NO_CONSTANT),
    ("bool a\xa0«true»", "expected a space or the end of the line, not 'true'"),
    ("int32[] «A» = [1]", NO_CONSTANT),
    ("int32 «a[3]»", f"'a[3]' is not a legal field name: {BRACKETS}"),
    ("int32 «A[3]»=1", f"'A[3]' is not a legal constant name: {BRACKETS}"),
    ("int32 «a[3» ]", f"'a[3' is not a legal field name: {BRACKETS}"),
    ("int32 a 1 «2»", "expected the end of the line, not '2'"),
    ("int32 a «x y»  # c", "'x y' is not an integer"),
    ("int32 a «0o8»", "'0o8' is not an integer"),
    ("int32 a «0xG»", "'0xG' is not an integer"),
    ("int32 A=«0b2»", "'0b2' is not an integer"),
    ("int32[] a «x»", "expected a list in brackets, not 'x'"),
    ("int32[] a [«x», 2]", "'x' is not an integer"),
    ("int32[] a [1, «x», 2]", "'x' is not an integer"),
    ("int32[] a [1 «2]»", "expected ',' or ']', not '2]'"),
    ("int32[] a [1«] x» # c", AFTER_LIST),
    ("float32[] a [1, 2.5«]]»  ", AFTER_LIST),
    ("bool[2] a [true« ] = [1]»", AFTER_LIST),
    ("int32[] a [«] = []»", AFTER_LIST),
    ("bool[<=3] a [ «]x»", "expected a boolean, not ']x'"),
    ("int32[] a [1«»", "expected ',' or ']', but the definition ends here"),
    ("float32[] a [1, «x»]", "'x' is not a number"),
    ("bool a «yes»", "'yes' is not a boolean: true, false, 1 or 0"),
    ("bool[] a [true, «maybe»]", "'maybe' is not a boolean: true, false, 1 or 0"),
    ('string a «"a"b"»', '"a"b" is not a string: a quote inside it needs a backslash'),
    ('string A=«"a"=b"»', '"a"=b" is not a string: a quote inside it needs a backslash'),
    ("string[] a [«\"'b''\"»]", "'b'' is not a string: a quote inside it needs a backslash"),
    ("string a b«=c»", "a default cannot contain '='"),
    ('string a «"b=c"»', "a default cannot contain '='"),
    ("string<=«x» a", f"'x' {NUMBER}"),
    ("string<=« »5 a", BLANK),
    ("string<=5«<=6» a", "expected '[' or a space, not '<=6'"),
    ("int32[<=«]» a", f"']' {NUMBER}"),
    ("int32[« »3] a", BLANK),
    ("int32[3 «a»", "expected ']', not 'a'"),
    ("int32[3]«[4]» a", "an array has one dimension"),
    ("Foo«<=5» a", "expected '[' or a space, not '<=5'"),
    ("«@key(a)» x", "annotation '@key(a)' is not supported"),
    ("«\ufeff»int8 a", "a byte order mark is not allowed"),
    ("«P/Foo» a", f"'P' {PACKAGE}"),
    # A builtin type is no likely package.
    ("«Bool/Foo» a", f"'Bool' {PACKAGE}"),
    ("«Uint16/A» a", f"'Uint16' {PACKAGE}"),
    ("«Strings/Foo»[3] a", f"'Strings' {PACKAGE}"),
    ("p/«foo» a", f"'foo' {TYPE_FORM}"),
    ("p/«msg/Foo» a", f"'msg/Foo' {TYPE_FORM}"),
    ("«foo» a", f"'foo' is not a type, and {LEGAL}"),
    ("«time»[2] a", "'time' is not a type of ROS 2; use 'builtin_interfaces/Time'"),
    ("«duration» a", "'duration' is not a type of ROS 2; use 'builtin_interfaces/Duration'"),
    ("Foo a «1»", "expected the end of the line, not '1'"),
    ("p/ «a»", "expected the name of a message type, not 'a'"),
]


@pytest.mark.parametrize(
    ("dialect", "marked", "message"),
    [("ros1", *case) for case in ROS1] + [("ros2", *case) for case in ROS2],
)
def test_wrong_words_are_marked_and_explained(dialect, marked, message):
    line = marked.replace("«", "").replace("»", "")
    # An offset in the line is not one in the text.
    text = f"# é\r\n{line}\n"
    with pytest.raises(DefinitionError) as error:
        parse(text, dialect)
    (wrong,) = error.value.diagnostics
    start, end = (place - text.index(line, 5) for place in (wrong.span.start, wrong.span.end))
    # The place after the last word is the line end, if nothing else follows.
    shown = f"{line[:start]}«{line[start:end]}»{line[end:]}"
    assert (shown, wrong.message, wrong.span.line) == (marked, message, 2)


@pytest.mark.parametrize(
    ("word", "meant"),
    {
        "boolean": "bool",
        "double": "float64",
        "float": "float32",
        "int": "int32",
        "long": "int64",
        "short": "int16",
        "str": "string",
        "uint": "uint32",
        "unsigned": "uint32",
        "strnig": "string",
        "flaot32": "float32",
        "uint46": "uint64",
        "bole": "bool",
        "uint2": "uint32",
    }.items(),
)
def test_builtin_types_are_suggested_for_words_that_are_like_them(word, meant):
    with pytest.raises(DefinitionError) as error:
        parse(f"{word}[3] a", "ros2")
    assert error.value.diagnostics[0].message == f"'{word}' is not a type; did you mean '{meant}'?"


@pytest.mark.parametrize("word", ["bolean", "flota", "real"])
def test_builtin_types_are_not_suggested_for_words_that_are_less_like_them(word):
    with pytest.raises(DefinitionError) as error:
        parse(f"{word} a", "ros2")
    assert error.value.diagnostics[0].message == f"'{word}' is not a type, and {LEGAL}"


@pytest.mark.parametrize(("length", "shown"), [(60, "x" * 60), (61, "x" * 57 + "...")])
def test_long_words_are_shortened(length, shown):
    with pytest.raises(DefinitionError) as error:
        parse(f"int8 a {'x' * length}", "ros2")
    assert error.value.diagnostics[0].message == f"'{shown}' is not an integer"
