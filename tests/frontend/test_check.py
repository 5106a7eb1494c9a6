"""Limits of definitions, from both sides; ``test_errors.py`` has the messages."""

from __future__ import annotations

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import Library
from tests.frontend.workspace import make_files


def load(tmp_path, line):
    return Library("lyrical", [make_files(tmp_path, {"p/msg/T.msg": line})]).message("p/msg/T")


@pytest.mark.parametrize("line", ["int8[{}] a", "int8[<={}] a", "string<={} a"])
@pytest.mark.parametrize(
    ("size", "is_legal"), [(0, False), (1, True), (2**32 - 1, True), (2**32, False)]
)
def test_sizes_have_32_bits(tmp_path, line, size, is_legal):
    if is_legal:
        assert str(size) in str(load(tmp_path, line.format(size)).fields[0].type)
    else:
        with pytest.raises(DefinitionError, match=r"must be at (least|most)"):
            load(tmp_path, line.format(size))


@pytest.mark.parametrize("distro", ["noetic", "lyrical"])
@pytest.mark.parametrize(
    ("text", "where"),
    {
        # Lines around the two do not hide them; a third field is compared with the first.
        "int8 K = 1\nint8 a\nint8 a": (3, 2),
        "int8 a\nint8 K = 1\nint8 a": (3, 1),
        "int8 a\nint8 a\nint8 K = 1": (2, 1),
        "int8 b\nint8 a\nint8 c\nint8 a\nint8 d": (4, 2),
        "int8 a\nint8 b\nint8 a\nint8 a": (3, 1),
    }.items(),
)
def test_field_declared_twice_is_refused_between_any_other_lines(tmp_path, distro, text, where):
    root = make_files(tmp_path, {"p/msg/T.msg": text})
    with pytest.raises(DefinitionError) as error:
        Library(distro, [root]).message("p/msg/T" if distro == "lyrical" else "p/T")
    second, first = where
    lines = [line for line in str(error.value).splitlines() if "error:" in line]
    assert f"T.msg:{second}:6: error: field 'a' is already declared in line {first}" in lines[0]
    assert len(lines) == text.count("int8 a") - 1
    assert all(line.endswith(f"in line {first}") for line in lines)


CAPITAL = "letters and digits, a capital first"
WORD = "letters, digits and underscores, a letter first"
PARTS = {"msg": "", "srv": "---\n", "action": "---\n---\n"}


@pytest.mark.parametrize(("distro", "rule"), [("noetic", WORD), ("lyrical", CAPITAL)])
@pytest.mark.parametrize(
    ("kind", "what"), [("msg", "message"), ("srv", "service"), ("action", "action")]
)
def test_the_name_of_a_file_is_called_that_of_its_kind(tmp_path, distro, rule, kind, what):
    root = make_files(tmp_path, {f"p/{kind}/do-it.{kind}": PARTS[kind]})
    with pytest.raises(DefinitionError) as error:
        Library(distro, [root]).interface("p/do-it")
    (wrong,) = error.value.diagnostics
    assert wrong.message == f"'do-it' is not a legal {what} name: {rule}"
    assert (wrong.span.line, wrong.span.column) == (1, 1)
