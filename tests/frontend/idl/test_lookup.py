"""Look-up of names that occur more than once.

If every constant had its own name, a look-up in the wrong scope would find the right constant. Here
each scope has the same names with other values.
"""

from __future__ import annotations

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import Library
from firm_hdl.model import String

from ..workspace import errors_of, make_files
from .reading import read


def library(tmp_path, files):
    return Library("lyrical", [make_files(tmp_path, files)])


def sizes_of(text):
    """Return the sizes of all members of all structs of a text, by struct and member."""
    messages, wrong = read(text)
    assert [d.message for d in wrong] == []
    return {
        f"{name}.{member.name.text}": member.type.size.value
        for name, syntax in messages.items()
        for member in syntax.members
        if member.type.array != "one"
    }


def types(message):
    return {item.name: str(item.type) for item in message.fields}


SERVICE = """module p {{ {outer} module srv {{ {inner}
  module S_Request_Constants {{ const long N = 3; const long A = 13; }};
  struct S_Request {{ long n[N]; sequence<long, N> m; string<N> s; {request} }};
  module S_Response_Constants {{ const long N = 4; const long B = 14; }};
  struct S_Response {{ long n[N]; sequence<long, N> m; string<N> s; {response} }};
}}; }};"""


def texts_of(text):
    messages, wrong = read(text)
    assert wrong == []
    return {name: s.members[-1].type.bound.value for name, s in messages.items()}


def test_a_struct_sees_its_own_constants_and_not_those_of_another():
    text = SERVICE.format(outer="", inner="", request="", response="")
    want = {f"S_Request.{m}": 3 for m in "nm"} | {f"S_Response.{m}": 4 for m in "nm"}
    assert sizes_of(text) == want
    assert texts_of(text) == {"S_Request": 3, "S_Response": 4}


def test_a_module_around_a_struct_comes_before_the_structs_own_constants():
    # By the standard: the struct's own constants are in a module beside it.
    text = SERVICE.format(outer="", inner="const long N = 7;", request="", response="")
    assert set(sizes_of(text).values()) == {7}
    assert set(texts_of(text).values()) == {7}


def test_constant_of_one_struct_is_seen_by_all():
    text = SERVICE.format(outer="", inner="", request="long b[B];", response="long a[A];")
    sizes = sizes_of(text)
    assert (sizes["S_Request.b"], sizes["S_Response.a"]) == (14, 13)


def test_constant_of_two_other_structs_is_not_found():
    text = """module p { module action {
      module D_Goal_Constants { const long N = 1; };
      struct D_Goal { long a[N]; };
      module D_Result_Constants { const long N = 2; };
      struct D_Result { long a[N]; };
      struct D_Feedback { long a[N]; };
    }; };"""
    (wrong,) = read(text)[1]
    assert wrong.message == "constant 'N' is not declared above; there are 2 of that name elsewhere"
    assert wrong.span.line == 6


def test_defaults_see_the_constants_of_their_own_struct():
    member = "@default(value=N) long d;"
    messages, wrong = read(SERVICE.format(outer="", inner="", request=member, response=member))
    assert wrong == []
    found = {name: syntax.members[-1].default.value for name, syntax in messages.items()}
    assert found == {"S_Request": 3, "S_Response": 4}


@pytest.mark.parametrize(
    ("kind", "value"), [("float", "2"), ("double", "2"), ("boolean", "1"), ("long double", "2")]
)
def test_constants_have_the_kind_of_their_type_and_not_of_their_value(kind, value):
    text = f"""module p {{ module msg {{ const {kind} N = {value};
      struct T {{ long a[N]; }}; }}; }};"""
    (wrong,) = read(text)[1]
    assert wrong.message == "the length of an array must be an integer"


def test_a_scope_is_followed_from_the_inside_to_the_outside():
    text = """module a { const long N = 1; module a { const long N = 2; }; };
      module p { const long N = 3; module a { const long M = 4; };
        module msg { const long N = 5; module a { const long N = 6; };
          struct T { long x[N]; long y[p::N]; long z[a::N]; long w[::a::N]; long v[a::a::N];
                     long u[::a::a::N]; long t[a::M]; long s[msg::N]; long r[p::msg::a::N]; };
    }; };"""
    found = {name[2:]: size for name, size in sizes_of(text).items()}
    assert found == {
        "x": 5, "y": 3, "z": 6, "w": 1, "v": 2, "u": 2, "t": 4, "s": 5, "r": 6
    }  # fmt: skip


BASE = "module {q} {{ const long K = {k}; module msg {{ const long N = {n}; {more} }}; }};"


def test_constants_of_a_file_come_before_those_of_included_files(tmp_path):
    # The same full names with other values: those of the file are declared last.
    files = {
        "p/msg/Base.idl": BASE.format(q="p", k=1, n=2, more=""),
        "p/msg/T.idl": """#include "p/msg/Base.idl"
            module p { const long K = 11; module msg { const long N = 12;
            struct T { long k[K]; long n[N]; long m[p::msg::N]; }; }; };""",
    }
    found = types(library(tmp_path, files).message("p/msg/T"))
    assert found == {"k": "int32[11]", "n": "int32[12]", "m": "int32[12]"}


def test_each_included_file_has_constants_of_its_own(tmp_path):
    files = {
        "q/msg/Base.idl": BASE.format(q="q", k=1, n=2, more="const long M = N + K;"),
        "r/msg/Base.idl": BASE.format(q="r", k=3, n=4, more="const long M = N + K;"),
        "p/msg/T.idl": """#include "q/msg/Base.idl"
            #include "r/msg/Base.idl"
            module p { module msg { struct T {
            long a[q::K]; long b[q::msg::N]; long c[q::msg::M];
            long d[r::K]; long e[r::msg::N]; long f[r::msg::M]; }; }; };""",
    }
    found = types(library(tmp_path, files).message("p/msg/T"))
    assert [*found.values()] == [f"int32[{n}]" for n in (1, 2, 3, 3, 4, 7)]


def test_an_included_file_is_looked_for_as_it_is_written_before_its_own_folder(tmp_path):
    sizes = "module p {{ module msg {{ const long N = {}; }}; }};"
    files = {
        "q/msg/Base.idl": '#include "p/sizes.idl"\nmodule q { module msg { }; };'.replace(
            "module msg { };", "module msg { struct Base { long x; }; };"
        ),
        "p/sizes.idl": sizes.format(2),
        "q/msg/p/sizes.idl": sizes.format(3),
        "p/msg/T.idl": """#include "q/msg/Base.idl"
            module p { module msg { struct T { long a[N]; }; }; };""",
    }
    assert types(library(tmp_path, files).message("p/msg/T")) == {"a": "int32[2]"}


def test_a_file_that_was_included_before_is_not_looked_for_elsewhere(tmp_path):
    sizes = "module p {{ module msg {{ const long N = {}; }}; }};"
    files = {
        "q/msg/Base.idl": '#include "p/sizes.idl"\nmodule q { struct Base { long x; }; };',
        "p/sizes.idl": sizes.format(2),
        "q/msg/p/sizes.idl": sizes.format(3),
        "p/msg/T.idl": """#include "p/sizes.idl"
            #include "q/msg/Base.idl"
            module p { module msg { struct T { long a[N]; }; }; };""",
    }
    assert types(library(tmp_path, files).message("p/msg/T")) == {"a": "int32[2]"}


def test_a_file_of_the_same_name_in_two_folders_is_that_beside_the_one_that_includes_it(tmp_path):
    def base(package, n):
        return {
            f"{package}/msg/Base.idl": f'#include "sizes.idl"\nmodule {package} {{ module msg {{ '
            f"const long M = {package}::msg::N; struct Base {{ long x; }}; }}; }};",
            f"{package}/msg/sizes.idl": f"module {package} {{ module msg {{ const long N = {n}; "
            "}; };",
        }

    files = {
        **base("q", 2),
        **base("r", 3),
        "p/msg/T.idl": """#include "q/msg/Base.idl"
            #include "r/msg/Base.idl"
            module p { module msg { struct T { long a[q::msg::M]; long b[r::msg::M]; }; }; };""",
    }
    found = types(library(tmp_path, files).message("p/msg/T"))
    assert found == {"a": "int32[2]", "b": "int32[3]"}
    # A file beside the one that includes them all is another one.
    files["p/msg/sizes.idl"] = "module q { module msg { const long N = 7; }; };"
    found = types(library(tmp_path, files).message("p/msg/T"))
    assert found == {"a": "int32[2]", "b": "int32[3]"}


@pytest.mark.parametrize("kind", ["msg", "srv", "action"])
@pytest.mark.parametrize("path", ["sizes.idl", "more/sizes.idl", "p/{}/sizes.idl"])
def test_a_path_is_also_looked_for_in_the_folder_of_the_file(tmp_path, kind, path):
    path = path.format(kind)
    parts = {"msg": ["T"], "srv": ["T_Request", "T_Response"]}
    structs = "".join(
        f"struct {name} {{ long a[N]; }}; "
        for name in parts.get(kind, ["T_Goal", "T_Result", "T_Feedback"])
    )
    files = {
        f"p/{kind}/T.idl": f'#include "{path}"\nmodule p {{ module {kind} {{ {structs} }}; }};',
        path if path.startswith("p/") else f"p/{kind}/{path}": (
            f"module p {{ module {kind} {{ const long N = 5; }}; }};"
        ),
    }
    first = library(tmp_path, files).interface(f"p/{kind}/T").messages[0]
    assert types(first) == {"a": "int32[5]"}


def test_files_of_one_library_do_not_remember_those_of_another(tmp_path, monkeypatch):
    # Paths are relative, as the user wrote them: the same path may be another file.
    for folder, n in (("one", 2), ("two", 3)):
        files = {
            "ws/p/msg/sizes.idl": f"module p {{ module msg {{ const long N = {n}; }}; }};",
            "ws/p/msg/T.idl": '#include "p/msg/sizes.idl"\n'
            "module p { module msg { struct T { long a[N]; }; }; };",
        }
        make_files(tmp_path / folder, files)
        monkeypatch.chdir(tmp_path / folder)
        assert types(Library("lyrical", ["ws"]).message("p/msg/T")) == {"a": f"int32[{n}]"}


# Typedefs.


def test_a_file_has_its_own_typedefs_before_those_that_it_includes(tmp_path):
    files = {
        "q/msg/Base.idl": "module q { module msg { typedef double Value[2]; typedef long Other;"
        " struct Base { Value v; Other o; }; }; };",
        "p/msg/T.idl": """#include "q/msg/Base.idl"
            module p { module msg { typedef string<5> Value;
            struct T { Value v; sequence<Value, 2> w; Other o; }; }; };""",
    }
    lib = library(tmp_path, files)
    assert types(lib.message("q/msg/Base")) == {"v": "float64[2]", "o": "int32"}
    found = lib.message("p/msg/T")
    assert types(found) == {"v": "string<=5", "w": "string<=5[<=2]", "o": "int32"}
    assert found.fields[0].type == String(bound=5)


def test_typedefs_of_the_same_last_name_in_two_modules_need_one_meaning():
    two = "module a {{ typedef long V[2]; }}; module b {{ typedef {} V[{}]; }}; "
    struct = "module p { module msg { struct T { V v; b::V w; }; }; };"
    (wrong,) = read(two.format("double", 2) + struct)[1]
    assert wrong.message == "typedef 'V' is already declared as another type"
    (wrong,) = read(two.format("long", 3) + struct)[1]
    assert wrong.message == "typedef 'V' is already declared as another type"
    assert sizes_of(two.format("long", 2) + struct) == {"T.v": 2, "T.w": 2}


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("string V", "wstring V"),
        ("string<2> V", "string V"),
        ("string<2> V", "string<3> V"),
        ("sequence<long> V", "sequence<long, 2> V"),
        ("sequence<long, 2> V", "sequence<long, 3> V"),
        ("long V", "long V[1]"),
        ("q::msg::A V", "q::msg::B V"),
        ("q::msg::A V", "r::msg::A V"),
    ],
)
def test_any_difference_between_two_typedefs_of_a_name_is_another_meaning(one, other):
    text = f"module a {{ typedef {one}; }}; module b {{ typedef {other}; }}; "
    text += "module p { module msg { struct T { long x; }; }; };"
    (wrong,) = read(text)[1]
    assert wrong.message == "typedef 'V' is already declared as another type"


def test_a_scope_before_a_typedef_has_to_be_its_own():
    text = """module a { typedef long V[2]; };
      module p { module msg { struct T { a::V x; }; }; };"""
    assert sizes_of(text) == {"T.x": 2}
    for scope in ("b", "a::a", "p"):
        (wrong,) = read(text.replace("a::V x", f"{scope}::V x"))[1]
        assert wrong.message.startswith(f"'{scope}::V' is not a type"), scope
    # From the outermost scope, the whole scope is needed.
    assert sizes_of(text.replace("a::V x", "::a::V x")) == {"T.x": 2}
    (wrong,) = read(text.replace("a::V x", "::V x"))[1]
    assert wrong.message.startswith("'::V' is not a type")
    inner = "module p { module msg { typedef long V[2]; struct T { msg::V x; }; }; };"
    assert sizes_of(inner) == {"T.x": 2}
    (wrong,) = read(inner.replace("msg::V x", "::msg::V x"))[1]
    assert wrong.message.startswith("'::msg::V' is not a type")
    # A name in the scope of structs is taken for a struct.
    messages, wrong = read(text.replace("a::V x", "p::msg::V x"))
    type_ = messages["T"].members[0].type
    assert wrong == [] and (type_.package, type_.kind, type_.name) == ("p", "msg", "V")


def test_a_constant_keeps_its_first_value_and_place():
    text = """module p { module T_Constants {
        const long N = 2;
        const long N = 3;
        const long N = 4; const long M = N;
      }; struct T { long a[T_Constants::N]; }; };"""
    messages, wrong = read(text)
    assert [(d.span.line, d.message) for d in wrong] == [
        (line, "constant 'N' is already declared in line 2") for line in (3, 4)
    ]
    n, m, a = messages["T"].members
    assert (n.name.text, n.value.value, m.value.value, a.type.size.value) == ("N", 2, 2, 2)


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


FAR = "module q {{ module msg {{ const long N = 2; typedef long V[2]; {typedef} }}; }}; "
NEAR = "module p {{ module msg {{ const long N = 5; {near} struct T {{ {use} x; }}; }}; }};"


def of_member(text):
    """Return the array size and the bound of the only member, or what is wrong."""
    messages, wrong = read(text)
    if wrong:
        return wrong[0].message
    type_ = messages["T"].members[-1].type
    return type_.size and type_.size.value, type_.bound and type_.bound.value


@pytest.mark.parametrize("use", ["W", "q::msg::W", "q::msg::X"])
@pytest.mark.parametrize(
    ("typedef", "found"),
    [
        ("typedef msg::V W;", (2, None)),
        ("typedef q::msg::V W;", (2, None)),
        ("typedef ::q::msg::V W;", (2, None)),
        ("typedef long W[N];", (2, None)),
        ("typedef long W[msg::N];", (2, None)),
        ("typedef sequence<long, N> W;", (2, None)),
        ("typedef string<N> W;", (None, 2)),
        ("typedef string<msg::N> W;", (None, 2)),
    ],
)
def test_names_in_a_typedef_are_those_of_its_own_module(typedef, found, use):
    far = FAR.format(typedef=f"{typedef} typedef W X;")
    assert of_member(far + NEAR.format(near="", use=use)) == found


def test_a_typedef_has_no_struct_whose_constants_it_sees_first():
    text = """module p {{ module msg {{ module S_Constants {{ const long N = 6; }};
      module T_Constants {{ const long N = 7; }};
      typedef long W{}; struct T {{ W x{}; }}; }}; }};"""
    assert of_member(text.format("", "[N]")) == (7, None)
    wrong = "constant 'N' is not declared above; there are 2 of that name elsewhere"
    assert of_member(text.format("[N]", "")) == wrong


@pytest.mark.parametrize(("outer", "found"), [("msg::V", (3, None)), ("p::V", (4, None))])
def test_each_typedef_of_a_chain_has_its_own_module(outer, found):
    """The first one stands in p, the second in p::msg, the member in r."""
    text = f"""module p {{ typedef {outer} A; typedef long V[4]; }};
      module p {{ module msg {{ typedef p::A B; }}; }};
      module r {{ typedef msg::B C; struct T {{ p::msg::B x; }}; }};"""
    if outer == "msg::V":
        text = text.replace("typedef long V[4];", "module msg { typedef long V[3]; };")
    assert of_member(text) == found
