"""Corrections of facts by entries of the table of known differences."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from firm_hdl.model import Action, Array, Field, Message, Sequence, Service, String
from tests.verify.ts1.known.rewriting import BY_KEY, case_of, hidden, numbered


def field_of(name, kind):
    return Field(name=name, type=kind)


def message_of(name, *fields):
    return Message(name=name, dialect="ros2", fields=fields, constants=())


def member(**parts):
    return {"name": "a", **parts}


def facts_of(fields=(), constants=(), **more):
    return {
        "structure": {"p/msg/A": {"fields": list(fields), "constants": list(constants)}},
        **more,
    }


def corrected(key, facts, text="", **more):
    theirs = BY_KEY[key].theirs
    assert theirs is not None
    return theirs(facts, case_of(text, **more))


BACK = [
    # key, type, the value of a constant or default for the oracle, the value for firm-hdl
    ("rosbags-texts", "string", f"a{hidden('=')}", "a="),
    ("rosbags-constant-bool", "bool", 0, False),
    ("rosbags-constant-bool", "bool", 2, True),
    ("rosbags-constant-bool", "bool", True, True),
    ("rosbags-constant-bool", "bool", "2", "2"),
    ("rosbags-constant-bool", "int8", 2, 2),
    ("rosbags-floats", "float32", "inf", math.inf),
    ("rosbags-floats", "float64", "-1e3", -1000.0),
    ("rosbags-floats", "float32", "inf # a # b", math.inf),
    ("rosbags-floats", "float64", "1e3#", 1000.0),
    ("rosbags-floats", "float64", "x", "x"),
    ("rosbags-floats", "float64", 1.5, 1.5),
    ("rosbags-floats", "string", "inf", "inf"),
    ("ros2-backslashes", "string", hidden("\\"), "\\"),
    ("ros2-infinite-numbers", "float32", 1.25e300, math.inf),
    ("ros2-infinite-numbers", "float32", -1.25e300, -math.inf),
    ("ros2-infinite-numbers", "float64", -1.5, -1.5),
    ("ros2-infinite-numbers", "float64", "1.25e300", "1.25e300"),
    ("ros2-infinite-numbers", "int64", 3, 3),
    ("idl-booleans", "bool", 0, False),
    ("idl-booleans", "bool", 1, True),
    ("idl-booleans", "bool", "1", "1"),
    ("idl-booleans", "int8", 1, 1),
    ("idl-whole-numbers", "float32", 3, 3.0),
    ("idl-whole-numbers", "float64", 3, 3.0),
    ("idl-whole-numbers", "long double", 3, 3.0),
    ("idl-whole-numbers", "int32", 3, 3),
    ("idl-whole-numbers", "float32", True, True),
    ("idl-whole-numbers", "float32", "3", "3"),
]


def same(found, expected):
    return repr(found) == repr(expected)


@pytest.mark.parametrize(("key", "kind", "theirs", "ours"), numbered(BACK))
def test_values_are_put_back(key, kind, theirs, ours):
    other = {"name": "b", "type": kind, "value": "other"}
    given = facts_of(constants=[member(type=kind, value=theirs), other])
    given["structure"]["p/msg/B"] = {"fields": [], "constants": [member(type=kind, value=theirs)]}
    found = corrected(key, given)
    expected = facts_of(constants=[member(type=kind, value=ours), other])
    expected["structure"]["p/msg/B"] = {"fields": [], "constants": [member(type=kind, value=ours)]}
    assert same(found, expected)


DEFAULTS = [
    ("ros2-backslashes", "string", hidden("\\"), "\\"),
    ("ros2-backslashes", "string[]", ["x", hidden("\\")], ["x", "\\"]),
    ("ros2-infinite-numbers", "float32", -1.25e300, -math.inf),
    ("ros2-infinite-numbers", "float32[]", [1.0, 1.25e300], [1.0, math.inf]),
    ("ros2-infinite-numbers", "float32", None, None),
    ("idl-whole-numbers", "float32[]", [3, 1.5], [3.0, 1.5]),
    ("idl-whole-numbers", "float64[<=2]", [3], [3.0]),
    ("idl-whole-numbers", "int32[2]", [3], [3]),
    # Only two equal quotes around a hidden text are removed; other quotes are part of the text.
    ("ros2-escaped-quotes", "string[]", [f"'x{hidden(chr(39))}y'"], ["x'y"]),
    ("ros2-escaped-quotes", "string[]", ["'x'", f"{hidden(chr(34))}"], ["'x'", ""]),
    ("ros2-escaped-quotes", "string[]", [f"a{hidden(chr(34))}"], ['a"']),
    ("ros2-escaped-quotes", "string[]", [f"'a{hidden(chr(34))}"], ["'a\""]),
    ("ros2-escaped-quotes", "string[]", [f"x{hidden(chr(34))}x"], ['x"x']),
    ("ros2-escaped-quotes", "int8[]", [1], [1]),
    ("ros2-escaped-quotes", "string", hidden(chr(34)), hidden(chr(34))),
]


@pytest.mark.parametrize(("key", "kind", "theirs", "ours"), numbered(DEFAULTS))
def test_defaults_are_put_back(key, kind, theirs, ours):
    first = {"name": "b", "type": "int8", "default": None}
    found = corrected(key, facts_of([first, member(type=kind, default=theirs)]))
    assert same(found, facts_of([first, member(type=kind, default=ours)]))


@pytest.mark.parametrize("key", ["rosbags-constant-names", "idl-service-constants"])
def test_names_of_constants_are_put_back(key):
    constants = [{"name": "RENAMED6C6F77"}, {"name": "RENAMED"}, {"name": "B"}]
    found = corrected(key, facts_of(constants=constants))
    assert [each["name"] for each in found["structure"]["p/msg/A"]["constants"]] == [
        "low",
        "RENAMED",
        "B",
    ]


def test_placeholders_are_put_back_and_hashed_by_their_other_name():
    other, own = "structure_has_one_more_member", "structure_needs_at_least_one_member"
    given = facts_of([{"name": other}, {"name": "b"}], hash="x", md5="y")
    found = corrected("rosbags-placeholders", given, f"uint8 {own}")
    assert found == facts_of([{"name": own}, {"name": "b"}], hash="x", md5="y")
    inner = message_of("p/msg/I", field_of(own, String()), field_of("b", String()))
    hashed = BY_KEY["rosbags-placeholders"].hashed(message_of("p/msg/A", field_of("i", inner)))
    assert [each.name for each in hashed.fields[0].type.fields] == [other, "b"]
    assert [each.name for each in hashed.fields] == ["i"]


@pytest.mark.parametrize(
    ("comment", "left"),
    [
        ("a  \nb\t", "a\nb"),
        ("\n\na\n\n\nb\n\n", "a\n\nb"),
        ("  a", "  a"),
        ("a\nb\n \n\nc", "a\nb\n\nc"),
        ("", ""),
    ],
)
def test_blanks_of_comments_do_not_count(comment, left):
    given = {"structure": {"p/msg/A": {"comment": comment, "fields": []}, "p/msg/B": {}}, "x": 1}
    assert corrected("ros2-comment-blanks", given) == {
        "structure": {"p/msg/A": {"comment": left, "fields": []}, "p/msg/B": {"comment": ""}},
        "x": 1,
    }


def test_a_long_double_has_no_hash_to_compare():
    key = "idl-long-double-hash"
    given = {"hash": "raises KeyError: 'long double'", "names": ["a"]}
    assert corrected(key, given) == {"names": ["a"]}
    for other in ({"hash": "RIHS01_0"}, {"hash": "raises KeyError: 'long'"}, {"names": []}):
        assert corrected(key, other) == other


def with_file_name(facts, text, kind="msg"):
    return corrected("idl-names", facts, text, language="idl", kind=kind)


def test_a_message_is_called_by_its_file():
    text = "module q { module x { struct A {}; }; };"
    assert with_file_name({"names": ["q/x/A"], "y": 1}, text) == {"names": ["p/msg/A"], "y": 1}
    assert with_file_name({"names": ["q/x/B"]}, text) == {"names": ["p/msg/B"]}
    assert with_file_name({"names": ["q/x/A"]}, text, "srv") == {"names": ["p/srv/A"]}
    # Only names in the text are excused, except in comments.
    assert with_file_name({"names": ["q/z/A"]}, text) == {"names": ["q/z/A"]}
    commented = "// module x\nmodule q {"
    assert with_file_name({"names": ["q/x/A"]}, commented) == {"names": ["q/x/A"]}


def test_parts_of_a_service_are_called_by_its_file():
    text = "module q { module x { struct A_Request {}; struct A_Response {}; }; };"

    def parts(scope, type_scope=None):
        kinds = [f"{type_scope or scope}/A_Request[<=3]", "q/x/Other", "int8"]
        fields = [{"name": f"f{number}", "type": kind} for number, kind in enumerate(kinds)]
        return {
            "structure": {
                f"{scope}/A_Request": {"fields": [], "comment": "c"},
                f"{scope}/A_Response": {"fields": fields, "comment": ""},
            },
            "y": 1,
        }

    assert with_file_name(parts("q/x"), text, "srv") == parts("p/srv")
    assert with_file_name(parts("p/srv"), "module p { module srv {", "srv") == parts("p/srv")
    # Scopes that the text does not have, or different scopes, are other differences.
    assert with_file_name(parts("q/z"), text, "srv") == parts("q/z")
    mixed = {"structure": {"q/x/A_Request": {}, "q/A_Response": {}}}
    assert with_file_name(mixed, text, "srv") == mixed
    alone = {"structure": {"q/x/A": {}}}
    assert with_file_name(alone, text) == alone


def test_wide_texts_are_narrow_to_rosbags_wherever_they_are():
    inner = message_of("p/msg/I", field_of("x", String(wide=True)))
    kinds = {
        "plain": String(wide=True, bound=3),
        "narrow": String(),
        "array": Array(element=String(wide=True), count=2),
        "list": Sequence(element=String(wide=True), bound=4),
        "inner": inner,
        "again": Array(element=inner, count=3),
    }
    fields = [field_of(name, kind) for name, kind in kinds.items()]
    hashed = BY_KEY["rosbags-wstring"].hashed
    found = hashed(message_of("p/msg/A", *fields))
    types = {each.name: each.type for each in found.fields}
    assert types["plain"] == String(bound=3)
    assert types["narrow"] == String()
    assert types["array"] == Array(element=String(), count=2)
    assert types["list"] == Sequence(element=String(), bound=4)
    assert types["inner"].fields[0].type == String()
    # A message that is used twice stays a single message.
    assert types["again"] == Array(element=types["inner"], count=3)
    assert types["again"].element is types["inner"]


@pytest.mark.parametrize(
    ("text", "is_spoilt"),
    [
        ("int8 a\nOther b\nq/Other c\nq/msg/Other d\nOther[3] e\nwstring<=3 f", False),
        ("int8 a\nother b\nint8 c", True),
        ("Other_2 a", True),
        ("Q/Other a", True),
        ("q/srv/Other a", True),
        ("q2_x/Other2 a", False),
        ("bool a\nbyte b\nchar c\nfloat64 d", False),
    ],
)
def test_names_of_types_that_ros2_refuses(text, is_spoilt):
    spoils = BY_KEY["rosbags-type-names"].unavoidable
    assert spoils(case_of(text)) == is_spoilt
    assert not spoils(case_of(text, dialect="ros1"))


def test_name_of_the_message_itself_may_be_refused():
    spoils = BY_KEY["rosbags-type-names"].unavoidable
    assert spoils(case_of("int8 a", name="a"))
    assert spoils(case_of("int8 a", name="A_b"))
    assert not spoils(case_of("int8 a", name="AbC2"))


@pytest.mark.parametrize(
    ("text", "is_spoilt"),
    [
        ("typedef sequence<long> L; sequence<L> a;", True),
        ("typedef sequence<long, 3> L; sequence< p::msg::L , 3> a;", True),
        ("typedef sequence<long> L; L a[3];", True),
        ("typedef long R[3]; sequence<R> a;", True),
        ("typedef long R[3]; R a [2];", True),
        ("typedef sequence<long> L; L a;", False),
        ("typedef long R[3]; R a; sequence<Ra> b;", False),
        ("typedef long N; sequence<N> a; N b[3];", False),
        ("// typedef sequence<long> L;\nsequence<L> a;", False),
        ("typedef sequence<long> L; // sequence<L> a;", False),
        ("sequence<sequence<long>> a;", False),
    ],
)
def test_lists_of_lists_by_typedef(text, is_spoilt):
    assert BY_KEY["idl-lists-of-lists"].unavoidable(case_of(text, language="idl")) == is_spoilt


SHARED = {"name": "a", "type": "wstring<=3[<=3]"}


@pytest.mark.parametrize(
    ("text", "language"),
    [
        ("sequence<wstring<3>> a; sequence<wstring<3>> z;", "idl"),
        ("sequence< wstring<N> >  a;", "idl"),
        ("wstring<=3[] a\nwstring<=4[] z", "msg"),
    ],
)
def test_the_bound_of_texts_is_not_the_list_s(text, language):
    others = [
        {"name": "b", "type": "wstring<=3[<=3]"},
        {"name": "a", "type": "wstring<=3[<=4]"},
        {"name": "a", "type": "string<=3[<=3]"},
    ]
    found = corrected(
        "ros2-wstring-sequences",
        facts_of([SHARED, *others], hash="x", names=["y"]),
        text,
        language=language,
    )
    own = {"name": "a", "type": "wstring<=3[]"}
    assert found == facts_of([own, *others], hash="x", names=["y"])


def test_a_list_of_texts_is_hashed_with_their_bound():
    kinds = {
        "texts": Sequence(element=String(wide=True, bound=3)),
        "own": Sequence(element=String(wide=True, bound=3), bound=4),
        "narrow": Sequence(element=String(bound=3)),
        "none": Sequence(element=String(wide=True)),
    }
    message = message_of("p/srv/S_Request", *(field_of(*each) for each in kinds.items()))
    after = replace(message.fields[0], type=replace(kinds["texts"], bound=3))
    other = replace(message, fields=(after, *message.fields[1:]))
    hashed = BY_KEY["ros2-wstring-sequences"].hashed
    assert hashed(message) == other
    # Wherever a message is in a service or an action.
    plain = message_of("p/srv/S_Response")
    service = Service(name="p/srv/S", dialect="ros2", request=message, response=plain)
    with_event = replace(service, response=message, event=message_of("E", field_of("r", message)))
    assert hashed(service) == replace(service, request=other)
    assert hashed(with_event) == replace(
        with_event, request=other, response=other, event=message_of("E", field_of("r", other))
    )
    parts = {"name": "p/action/A", "dialect": "ros2"}
    given, wanted = (
        Action(**parts, goal=m, result=plain, feedback=m, services=(s,), wrappers=(m, plain))
        for m, s in ((message, service), (other, hashed(service)))
    )
    assert hashed(given) == wanted
    assert hashed(replace(given, result=message)).result == other


@pytest.mark.parametrize(
    ("text", "language"),
    [
        ("sequence<wstring<3>, 3> a;", "idl"),
        ("// sequence<wstring<3>> a;", "idl"),
        ("sequence<string<3>> a;", "idl"),
        ("wstring<=3[<=3] a", "msg"),
        ("wstring<=3[] b", "msg"),
    ],
)
def test_a_list_of_texts_has_its_own_bound_where_it_has_one(text, language):
    given = facts_of([SHARED], hash="x")
    assert corrected("ros2-wstring-sequences", given, text, language=language) == given
