"""Names of an IDL file: what includes itself, and what is no name."""

from __future__ import annotations

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import Library

from ..workspace import errors_of, make_files
from .rosidl import read

# A constant sees only those above it.
LATE = "\nmodule p { module msg { const long A = B; const long B = 3; struct T { long a; }; }; };"


@pytest.mark.parametrize("path", ["p/msg/T.idl", "T.idl"])
def test_a_file_that_includes_itself_declares_nothing_earlier(tmp_path, path):
    files = {"p/msg/T.idl": f'#include "{path}"{LATE}'}
    library = Library("lyrical", [make_files(tmp_path, files)])
    with pytest.raises(DefinitionError) as error:
        library.message("p/T")
    assert "T.idl:2:" in errors_of(error.value, tmp_path)
    assert "error: constant 'B' is not declared above" in str(error.value)


def test_two_files_that_include_each_other_declare_nothing_earlier(tmp_path):
    files = {
        "p/msg/T.idl": f'#include "U.idl"{LATE}',
        "p/msg/U.idl": '#include "T.idl"\nmodule p { module msg { struct U { long a; }; }; };',
    }
    library = Library("lyrical", [make_files(tmp_path, files)])
    with pytest.raises(DefinitionError, match="constant 'B' is not declared above"):
        library.message("p/T")
    assert library.message("p/U").fields[0].name == "a"


@pytest.mark.parametrize(
    ("word", "message"),
    [
        ("true", "'true' is not a boolean: TRUE or FALSE"),
        ("false", "'false' is not a boolean: TRUE or FALSE"),
        ("False", "constant 'False' is not declared above"),
        ("p::true", "constant 'p::true' is not declared above"),
    ],
)
def test_booleans_of_other_languages_are_told_from_names(word, message):
    _, wrong = read(f"module p {{ struct T {{ @default(value={word}) boolean a; }}; }};")
    assert [each.message for each in wrong] == [message]
