"""From trees of IDL to messages, and from messages to the model."""

from __future__ import annotations

from pathlib import Path

import pytest

from firm_hdl.errors import DefinitionError, Source
from firm_hdl.frontend import Library
from firm_hdl.frontend.idl import read_idl
from firm_hdl.frontend.syntax import ConstantSyntax
from firm_hdl.model import Array, Sequence, String
from tests.depth import by_depth
from tests.frontend.workspace import make_files
from tests.steps import calls_at_most

from .reading import read


def library(tmp_path, files, distro="lyrical"):
    return Library(distro, [make_files(tmp_path, files)])


def message(tmp_path, members, before="", distro="lyrical"):
    text = f"module p {{ module msg {{ {before} struct T {{ {members} }}; }}; }};"
    return library(tmp_path, {"p/msg/T.idl": text}, distro).message("p/msg/T")


def types(found):
    return {item.name: str(item.type) for item in found.fields}


def test_primitives_have_the_names_that_ros_gives_them(tmp_path):
    words = (
        "short|unsigned short|long|unsigned long|long long|unsigned long long|float|double|char|"
        "wchar|boolean|octet|int8|uint8|int16|uint16|int32|uint32|int64|uint64"
    ).split("|")
    members = "".join(f"{word} a{i}; " for i, word in enumerate(words))
    assert [*types(message(tmp_path, members)).values()] == (
        "int16 uint16 int32 uint32 int64 uint64 float32 float64 char wchar bool byte "
        "int8 uint8 int16 uint16 int32 uint32 int64 uint64"
    ).split()


@pytest.mark.parametrize(
    ("distro", "size"),
    [("foxy", 4), ("humble", 4), ("iron", 4), ("jazzy", 2), ("kilted", 2), ("lyrical", 2)],
)
def test_wchar_has_the_size_of_the_distribution(tmp_path, distro, size):
    (a,) = message(tmp_path, "wchar a;", distro=distro).fields
    assert str(a.type) == "wchar" and a.type.bytes == size


def test_types_with_sizes(tmp_path):
    found = message(
        tmp_path,
        "string a; wstring<2> b; sequence<long> c; sequence<string<3>, N> d; double e[N * 2];"
        "std_msgs::msg::Header g; sequence<std_msgs::msg::Header, 2> h;",
        "const long N = 4;",
    )
    assert types(found) == {
        "a": "string",
        "b": "wstring<=2",
        "c": "int32[]",
        "d": "string<=3[<=4]",
        "e": "float64[8]",
        "g": "std_msgs/msg/Header",
        "h": "std_msgs/msg/Header[<=2]",
    }
    assert isinstance(found.fields[3].type, Sequence) and isinstance(found.fields[4].type, Array)
    assert found.fields[1].type == String(bound=2, wide=True)


@pytest.mark.parametrize("module", ["b", "bits", "B_constants"])
def test_constants_of_other_modules_need_their_scope(module):
    text = f"""module a {{ module {module} {{ const long N = 3; }}; }};
      module p {{ module msg {{ struct T {{ long x[N]; long y[a::{module}::N]; }}; }}; }};"""
    (wrong,) = read(text)[1]
    assert wrong.message == "constant 'N' is not declared above"


def test_constants_belong_to_the_struct_that_their_module_is_called_after(tmp_path):
    text = """module p { module srv {
      module S_Request_Constants {
        @verbatim(language="comment", text="why") @unit(value="m")
        const double A = 1 / 2.;
        const char B = 'b';
      };
      struct S_Request { long a; };
      module S_Response_Constants { const string A = "x" "\\n"; const boolean C = TRUE; };
      struct S_Response { long a; };
    }; };"""
    service = library(tmp_path, {"p/srv/S.idl": text}).interface("p/srv/S")
    a, b = service.request.constants
    assert (a.name, a.value, str(a.type), a.comment, a.unit) == ("A", 0.5, "float64", "why", "m")
    assert (a.text, b.value) == ("1 / 2.", 98)
    assert [(c.name, c.value) for c in service.response.constants] == [("A", "x\n"), ("C", True)]


def test_comments_units_and_defaults_are_in_the_model(tmp_path):
    text = """module p { module msg {
      @verbatim (language="comment", text="about T" "\\n" "and more")
      struct T {
        @verbatim (language="comment", text="about a") @unit (value="m/s") @default (value=-3)
        long a, b;
        @default (value="(1, 0x10, -3)") sequence<int8> c;
        @default (value="('a, b', \\"c'\\", 'd\\\\\\\\n')") string d[3];
        @default (value="[True, False]") boolean e[2];
        @default (value=TRUE) boolean f;
        @default (value="('x', 'y')") string g, h[2];
      };
    }; };"""
    found = library(tmp_path, {"p/msg/T.idl": text}).message("p/msg/T")
    assert found.comment == "about T\nand more"
    a, b, c, d, e, f, g, h = found.fields
    for item in (a, b):
        assert (item.comment, item.unit, item.default) == ("about a", "m/s", -3)
    assert c.default == (1, 16, -3)
    assert d.default == ("a, b", "c'", "d\n")
    assert e.default == (True, False)
    assert f.default is True
    # The same default is read as a text and as a list of texts.
    assert (g.default, h.default) == ("('x', 'y')", ("x", "y"))


def test_sizes_have_32_bits(tmp_path):
    members = "octet a[~4294967290]; octet b[4294967295]; sequence<octet, 4294967295> c; char d[1];"
    assert types(message(tmp_path, members)) == {
        "a": "byte[5]",
        "b": "byte[4294967295]",
        "c": "byte[<=4294967295]",
        "d": "char[1]",
    }
    for member in ("octet a[4294967296]", "octet a[0]", "sequence<octet, 4294967296> a"):
        with pytest.raises(DefinitionError, match="must be at "):
            message(tmp_path, member + ";")


def test_padding_member_alone_is_an_empty_message(tmp_path):
    member = "uint8 structure_needs_at_least_one_member;"
    assert message(tmp_path, member).fields == ()
    assert len(message(tmp_path, member + " long a;").fields) == 2
    # Only the exact member of rosidl_adapter counts: a `long` has four bytes on the wire.
    for other in (member.replace("uint8", "long"), member.replace(";", "[1];"), "uint8 struct_;"):
        assert len(message(tmp_path, other).fields) == 1
    files = {"q/msg/T.msg": member.rstrip(";")}
    assert len(library(tmp_path, files).message("q/msg/T").fields) == 1


def test_what_is_included_can_be_named(tmp_path):
    files = {
        "q/msg/Base.idl": """#include "Other.idl"
            module q { module msg { const long N = M * 2; typedef double Pair[2];
            struct Base { long a; }; }; };""",
        "q/msg/Other.idl": """#include "Base.idl"
            module q { module msg { const long M = 3; struct Other { long a; }; }; };""",
        "p/msg/T.idl": """#include <q/msg/Base.idl>
            #include "nowhere/msg/Nothing.idl"
            module p { module msg {
            struct T { long a[q::msg::N]; Pair b; q::msg::Base c; }; }; };""",
    }
    found = library(tmp_path, files).message("p/msg/T")
    # `Base` and `Other` include each other; if `Base` is read first, `M` is declared before `N`.
    assert types(found) == {"a": "int32[6]", "b": "float64[2]", "c": "q/msg/Base"}


def test_errors_of_unused_parts_of_included_files_are_ignored(tmp_path):
    files = {
        "q/msg/Base.idl": """module q { module msg { const long N = 1 / 0;
            struct Base { any a; }; }; };""",
        "p/msg/T.idl": """#include "q/msg/Base.idl"
            module p { module msg { struct T { long a; }; }; };""",
        "p/msg/U.idl": """#include "q/msg/Base.idl"
            module p { module msg { struct U { long a[q::msg::N]; }; }; };""",
    }
    lib = library(tmp_path, files)
    assert types(lib.message("p/msg/T")) == {"a": "int32"}
    with pytest.raises(DefinitionError, match=r"constant 'q::msg::N' is not declared above"):
        lib.message("p/msg/U")


def test_constants_are_declared_in_modules():
    text = "const long N = 3;\nmodule p { struct T { long a[N]; }; };"
    (wrong,) = read(text)[1]
    assert (wrong.message, wrong.span.start) == ("a constant must be declared in a module", 11)


def test_errors_of_included_files_come_first(tmp_path):
    files = {
        "q/msg/Base.idl": "module q { typedef fixed<3, 1> Bad; struct Base { long a; }; };",
        "p/msg/T.idl": '#include "q/msg/Base.idl"\nmodule p { typedef Bad A; };',
    }
    with pytest.raises(DefinitionError) as caught:
        library(tmp_path, files).message("p/msg/T")
    places = [(Path(d.span.source.name).name, d.message) for d in caught.value.diagnostics]
    assert places == [
        ("Base.idl", "type 'fixed' is not supported"),
        ("T.idl", "this file declares no struct"),
    ]


def test_included_files_that_cannot_be_read_are_not_there(tmp_path):
    (tmp_path / "q" / "msg").mkdir(parents=True)
    (tmp_path / "q" / "msg" / "Latin.idl").write_bytes(b"// caf\xe9")
    outside = tmp_path / "outside.idl"
    outside.write_text("module q { const long N = 2; };")
    text = f"""#include "q/msg/Latin.idl"
        #include "q/{outside}"
        #include "q/msg/../../outside.idl"
        module p {{ module msg {{ struct T {{ long a[q::N]; }}; }}; }};"""
    lib = library(tmp_path, {"p/msg/T.idl": text})
    with pytest.raises(DefinitionError, match=r"constant 'q::N' is not declared above"):
        lib.message("p/msg/T")


@pytest.mark.parametrize("unused", ["Nothing", "q::Nothing", "sequence<Nothing, 2>", "A"])
def test_an_unused_typedef_may_have_an_unknown_name_as_in_rosidl(unused):
    before = "typedef Nothing A; " if unused == "A" else ""
    messages, wrong = read(f"module p {{ {before}typedef {unused} B; struct T {{ long a; }}; }};")
    assert wrong == [] and [*messages] == ["T"]
    # Any other mistake counts.
    (only,) = read("module p { typedef fixed<3, 1> B; struct T { long a; }; };")[1]
    assert only.message == "type 'fixed' is not supported"


def test_good_members_stay_when_others_are_wrong():
    messages, wrong = read("module p { struct T { long a; any b; fixed<5, 2> c; long d; }; };")
    assert [m.name.text for m in messages["T"].members] == ["a", "d"]
    assert len(wrong) == 2


def test_a_thousand_mistakes_are_enough():
    members = "".join(f"any a{i}; " for i in range(3000))
    wrong = read(f"module p {{ struct T {{ {members} }}; }};")[1]
    assert len(wrong) == 1001
    assert wrong[-1].message == "too many errors; the others are not listed"
    members = "".join(f"any a{i}; " for i in range(1000))
    wrong = read(f"module p {{ struct T {{ {members} }}; }};")[1]
    assert [each.message for each in wrong] == ["type 'any' is not supported"] * 1000


@pytest.mark.sampled(3)
@pytest.mark.parametrize("kind", ["typedefs", "constants", "includes"])
def test_long_chains_need_neither_stack_nor_time(kind):
    count, sources = by_depth(1200, 3000), {}
    if kind == "typedefs":
        chain = "".join(f"typedef A{i} A{i + 1}; " for i in reversed(range(count)))
        text = f"module p {{ typedef long A0; {chain} struct T {{ A{count} a; A5 b; }}; }};"
    elif kind == "constants":
        chain = "".join(f"const long A{i + 1} = A{i} + 1; " for i in range(count))
        text = f"module p {{ const long A0 = 0; {chain} struct T {{ long a[A{count}]; }}; }};"
    else:
        for i in range(count):
            sources[f"F{i}"] = f'#include "F{i + 1}"\nmodule p {{ const long A{i} = {i}; }};'
        text = '#include "F0"\nmodule p { struct T { long a[A%s]; }; };' % (count - 1)
        text = text.replace("A", "p::A")

    def include(path):
        return Source(name=path, text=sources[path]) if path in sources else None

    # What grows with the square of the count makes too many calls with either count.
    with calls_at_most(by_depth(3_500_000, 15_000_000)):
        messages, wrong = read_idl(Source(name="test.idl", text=text), include)
        assert wrong == []
        assert messages["T"].members


def test_members_are_in_the_order_of_the_text():
    text = """module p { module T_Constants { const long A = 1; }; struct T { long b; };
      module T_Constants { const long C = 1; }; };"""
    members = read(text)[0]["T"].members
    assert [m.name.text for m in members] == ["A", "b", "C"]
    assert [isinstance(m, ConstantSyntax) for m in members] == [True, False, True]


def test_a_long_default_before_many_names_takes_no_time():
    items, names = ",".join("1" * 5000), ",".join(f"a{i}" for i in range(2500))
    text = f'module p {{ struct T {{ @default(value="({items})") sequence<long> {names}; }}; }};'
    with calls_at_most(2_000_000):
        messages, wrong = read(text)
        assert wrong == [] and len(messages["T"].members) == 2500


def test_long_types_before_many_names_take_no_time():
    count = by_depth(1500, 5000)
    chain = "+".join("1" * count)
    text = f"module p {{ struct T {{ sequence<long, {chain}> {','.join('a' * count)}; }}; }};"
    with calls_at_most(by_depth(1_100_000, 7_000_000)):
        read(text)


@pytest.mark.parametrize(
    "text",
    [
        "(1,2,3)",
        "[1,2,3]",
        " (1, 2, 3) ",
        "( 1,2,3 )",
        "(1 ,2 ,3 )",
        "(1,2,3,)",
        "(1,2,3, )",
        "(+1,2,3\t)",
    ],
)
def test_blanks_in_a_list_mean_nothing(text):
    source = f'module p {{ struct T {{ @default(value="{text}") sequence<long> a; }}; }};'
    messages, wrong = read(source)
    assert wrong == []
    (member,) = messages["T"].members
    assert [item.value for item in member.default.items] == [1, 2, 3]
