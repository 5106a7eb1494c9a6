"""Different types, fields and constants with the same names."""

from __future__ import annotations

import pytest

from firm_hdl.frontend import Library
from firm_hdl.frontend.sources import FolderOrigin, Sources
from firm_hdl.model import Action, Message, Service
from tests.frontend.workspace import library, make_files


def names_of(message):
    return [item.name for item in message.fields]


@pytest.mark.parametrize("dialect", ["ros1", "ros2"])
def test_a_name_without_a_package_is_the_packages_own(tmp_path, dialect):
    files = {
        "p/T": "Part a\nq/Part b\nr/Part[] c\nPart[2] d\nq/Whole e",
        "p/Part": "int8 p",
        "q/Part": "int8 q",
        "q/Whole": "Part part\np/Part other",
        "r/Part": "int8 r",
        "std_msgs/Part": "int8 std",
    }
    message = library(tmp_path, files, dialect).message("p/T")
    kinds = [getattr(f.type, "element", f.type) for f in message.fields]
    assert [names_of(kind) for kind in kinds[:4]] == [["p"], ["q"], ["r"], ["p"]]
    assert [names_of(item.type) for item in kinds[4].fields] == [["q"], ["p"]]


def test_header_of_ros1_is_that_of_std_msgs_in_every_package(tmp_path):
    # Two packages have their own Header, besides std_msgs.
    files = {
        "p/T": "Header a\np/Header b\nq/Header c\nq/U d",
        "p/Header": "int8 p",
        "q/Header": "int8 q",
        "q/U": "Header a\nHeader[] b\np/Header c",
        "std_msgs/Header": "int8 std",
        "std_msgs/V": "Header a\nHeader[] b\nq/Header c",
    }
    lib = library(tmp_path, files, "ros1")
    a, b, c, d = (item.type for item in lib.message("p/T").fields)
    assert [names_of(kind) for kind in (a, b, c)] == [["std"], ["p"], ["q"]]
    inner = [getattr(item.type, "element", item.type) for item in d.fields]
    assert [names_of(kind) for kind in inner] == [["std"], ["q"], ["p"]]
    inner = [getattr(i.type, "element", i.type) for i in lib.message("std_msgs/V").fields]
    assert [names_of(kind) for kind in inner] == [["std"], ["std"], ["q"]]
    # A package with its own Header, and no folder that has std_msgs.
    alone = library(tmp_path / "alone", {"p/T": "Header a", "p/Header": "int8 p"}, "ros1")
    assert names_of(alone.message("p/T").fields[0].type) == ["seq", "stamp", "frame_id"]


@pytest.mark.parametrize("distro", ["noetic", "lyrical"])
def test_services_and_actions_of_one_name_in_two_packages(tmp_path, distro):
    for package, n in (("p", 1), ("q", 2)):
        text = f"int8 goal{n}\n---\nint8 result{n}\n---\nint8 feedback{n}"
        service = f"int8 request{n}\n---\nint8 response{n}"
        make_files(tmp_path, {f"{package}/action/Do.action": text})
        make_files(tmp_path, {f"{package}/srv/Ask.srv": service})
    lib = Library(distro, [tmp_path])
    for package, n in (("p", 1), ("q", 2), ("p", 1)):
        action, service = lib.interface(f"{package}/Do"), lib.interface(f"{package}/Ask")
        assert isinstance(action, Action) and isinstance(service, Service)
        assert action.name.startswith(f"{package}/") and service.name.startswith(f"{package}/")
        parts = (action.goal, action.result, action.feedback)
        found = [names_of(part) for part in (*parts, service.request, service.response)]
        words = ("goal", "result", "feedback", "request", "response")
        assert found == [[f"{word}{n}"] for word in words]
        # The derived messages of an action have its own parts.
        inside = {
            item.type.name
            for message in action.messages
            for item in message.fields
            if isinstance(item.type, Message) and "Do" in item.type.name
        }
        assert inside and all(name.startswith(f"{package}/") for name in inside)


def test_a_service_and_an_action_of_one_name_have_their_own_parts(tmp_path):
    make_files(tmp_path, {"p/srv/Do.srv": "int8 request\n---\nint8 response"})
    make_files(tmp_path, {"p/action/Do.action": "int8 goal\n---\nint8 result\n---\n"})
    make_files(tmp_path, {"p/msg/Do.msg": "int8 message"})
    for distro, middle in (("noetic", "/"), ("lyrical", "/msg/")):
        lib = Library(distro, [tmp_path])
        assert names_of(lib.interface("p/msg/Do")) == ["message"]
        assert names_of(lib.interface("p/srv/Do").response) == ["response"]
        assert names_of(lib.interface("p/action/Do").result) == ["result"]
        assert lib.interface("p/msg/Do").name == f"p{middle}Do"


def test_includes_are_those_of_the_first_folder_that_has_the_package(tmp_path):
    for folder, n in (("one", 1), ("two", 2)):
        make_files(
            tmp_path / folder,
            {
                "p/package.xml": "<package><name>p</name></package>",
                "p/sizes.idl": f"module p {{ const long N = {n}; }};",
                "p/msg/A.msg": "int8 a",
                f"p/only_{folder}.idl": f"module p {{ const long {folder.upper()} = {n}; }};",
            },
        )
    have = Sources([FolderOrigin(tmp_path / "one"), FolderOrigin(tmp_path / "two")])
    assert "N = 1" in have.include("p/sizes.idl").text
    assert have.include("p/only_two.idl") is None


# Coverage of definition hashes.

LEVELS = {
    "p/msg/T.idl": '#include "q/msg/Mid.idl"\nmodule p {{ module msg {{ '
    "module T_Constants {{ const long C = q::msg::M; const string S = q::msg::S; }}; "
    "struct T {{ sequence<long, q::msg::M> x; @default(value=q::msg::M) long y; }}; }}; }};",
    "q/msg/Mid.idl": '#include "r/msg/Low.idl"\nmodule q {{ module msg {{ '
    "const long M = r::msg::N + 1; const string S = r::msg::S; struct Mid {{ long x; }}; }}; }};",
    "r/msg/Low.idl": 'module r {{ module msg {{ const long N = {n}; const string S = "{s}"; '
    "typedef {typedef} Kind; struct Low {{ long x; }}; }}; }};",
}


def digest(folder, name="p/msg/T", files=LEVELS, **values):
    values = {"n": 3, "s": "a", "typedef": "long", "tail": ""} | values
    tail = values.pop("tail")
    filled = {path: text.format(**values) + tail for path, text in files.items()}
    return Library("lyrical", [make_files(folder, filled)]).definition_hash(name)


def test_hash_covers_what_included_files_include(tmp_path):
    first = digest(tmp_path / "0")
    assert digest(tmp_path / "1", n=4) != first
    assert digest(tmp_path / "2", s="b") != first
    assert digest(tmp_path / "3") == first


@pytest.mark.parametrize(
    ("struct", "what"),
    [
        ("struct T {{ long x[r::msg::N]; }};", "n"),
        ("struct T {{ string<r::msg::N> x; }};", "n"),
        ("struct T {{ sequence<string<r::msg::N> > x; }};", "n"),
        ("struct T {{ @default(value=r::msg::N) long x; }};", "n"),
        ("struct T {{ @default(value=r::msg::S) string x; }};", "s"),
        ("module T_Constants {{ const long A = r::msg::N; }}; struct T {{ long x; }};", "n"),
        ("module T_Constants {{ const string A = r::msg::S; }}; struct T {{ long x; }};", "s"),
        ("struct T {{ Kind x; }};", "typedef"),
        ("struct T {{ sequence<Kind> x; }};", "typedef"),
    ],
)
def test_hash_covers_whatever_an_included_file_decides(tmp_path, struct, what):
    files = {
        **LEVELS,
        "p/msg/T.idl": '#include "q/msg/Mid.idl"\nmodule p {{ module msg {{ ' + struct + " }}; }};",
    }
    others = {"n": {"n": 5}, "s": {"s": "other"}, "typedef": {"typedef": "short"}}
    first = digest(tmp_path / "0", files=files)
    found = {
        key: digest(tmp_path / key, files=files, **value) != first for key, value in others.items()
    }
    assert found == {key: key == what for key in others}


def test_hash_covers_what_parts_include_at_any_depth(tmp_path):
    top = {"u/msg/Top.msg": "v/Middle[] m\n", "v/msg/Middle.msg": "p/T t\n"}
    for name in ("u/msg/Top", "v/msg/Middle", "p/msg/T"):
        files = {**LEVELS, **top}
        first = digest(tmp_path / f"{name}0", name, files)
        assert digest(tmp_path / f"{name}1", name, files, n=4) != first, name
        assert digest(tmp_path / f"{name}2", name, files, s="b") != first, name
        assert digest(tmp_path / f"{name}3", name, files) == first, name


def test_hash_does_not_depend_on_the_order_in_which_types_are_found(tmp_path):
    texts = {"p/A": "int8 a", "q/A": "int8 b", "p/T": "A x\nq/A y", "p/U": "T t\nq/A y\nA x"}
    want = library(tmp_path / "0", texts).definition_hash("p/U")
    lib = library(tmp_path / "1", dict(reversed(texts.items())))
    for name in ("q/A", "p/T", "p/A"):
        lib.message(name)
    assert lib.definition_hash("p/U") == want
    # The hash depends on which type of the two has which text.
    swapped = {**texts, "p/A": "int8 b", "q/A": "int8 a"}
    assert library(tmp_path / "2", swapped).definition_hash("p/U") != want


# Models with the same name.


def test_messages_with_other_fields_or_constants_are_different(tmp_path):
    texts = {
        "int8 a": True,
        "int8 a 0": False,
        "int8 a 1": False,
        "int8 b": False,
        "uint8 a": False,
        "int8[1] a": False,
        "int8[] a": False,
        "int8[<=1] a": False,
        "int8 A=1\nint8 a": False,
        "# other\nint8 a  # [m]": True,
    }
    first = library(tmp_path / "first", {"p/T": "int8 a"}).message("p/T")
    for number, (text, is_same) in enumerate(texts.items()):
        other = library(tmp_path / str(number), {"p/T": text}).message("p/T")
        assert (other == first) is is_same, text


@pytest.mark.parametrize(
    ("text", "is_fixed"),
    [
        ("int8 a", True),
        ("", True),
        ("int8[3] a", True),
        ("int8[<=3] a", False),
        ("string a", False),
        ("string<=3 a", False),
        ("string[2] a", False),
        ("Fixed a\nFixed[2] b", True),
        ("Fixed[] a", False),
        ("Text a", False),
        ("Text[2] a", False),
        ("Deep[2] a", False),
        ("Deep a\nint8 b", False),
    ],
)
def test_size_is_fixed_where_all_parts_are(tmp_path, text, is_fixed):
    files = {"p/T": text, "p/Fixed": "int8 a", "p/Text": "string a", "p/Deep": "Fixed b\nText[1] a"}
    assert library(tmp_path, files).message("p/T").is_fixed_size is is_fixed
