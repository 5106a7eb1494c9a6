"""What the process with rosidl makes of rosidl's objects, and which definitions it refuses.

Objects of this test take the place of rosidl's, so the tests are fast and rosidl is not needed.
"""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from firm_hdl.verify.ts1.oracles import worker_rosidl as worker
from tests.frontend.workspace import make_files


def kind(form, **parts):
    """An object of rosidl_parser, whose class has a name that counts."""
    return type(form, (), parts)()


def basic(name):
    return kind("BasicType", typename=name)


INT8, WIDE = basic("int8"), kind("BoundedWString", maximum_size=3)


@pytest.mark.parametrize(
    ("given", "name"),
    [
        (basic("boolean"), "bool"),
        (basic("octet"), "byte"),
        (basic("float"), "float32"),
        (basic("double"), "float64"),
        (basic("uint64"), "uint64"),
        (basic("wchar"), "wchar"),
        (kind("NamespacedType", namespaces=["p", "msg"], name="A"), "p/msg/A"),
        (kind("UnboundedString"), "string"),
        (kind("UnboundedWString"), "wstring"),
        (kind("BoundedString", maximum_size=8), "string<=8"),
        (WIDE, "wstring<=3"),
        (kind("Array", value_type=INT8, size=4), "int8[4]"),
        (kind("BoundedSequence", value_type=WIDE, maximum_size=5), "wstring<=3[<=5]"),
        (kind("UnboundedSequence", value_type=basic("octet")), "byte[]"),
    ],
)
def test_types_of_idl_have_names_of_ros(given, name):
    assert worker._type(given) == name


def test_a_type_without_a_name_in_ros_is_refused():
    with pytest.raises(worker._RefusedError, match=r"^AbstractType has no name in ROS$"):
        worker._type(kind("AbstractType"))


@pytest.mark.parametrize(
    ("primitive", "bound", "array", "name"),
    [
        (True, None, None, "string"),
        (True, 8, None, "string<=8"),
        (True, None, (3, False), "string[3]"),
        (True, 8, (3, True), "string<=8[<=3]"),
        (False, None, (None, False), "q/msg/string[]"),
        (False, None, None, "q/msg/string"),
    ],
)
def test_types_of_rosidl_adapter_have_names_of_ros(primitive, bound, array, name):
    size, is_upper_bound = array or (None, False)
    given = SimpleNamespace(
        type="string",
        pkg_name="q",
        is_primitive_type=lambda: primitive,
        string_upper_bound=bound,
        is_array=array is not None,
        array_size=size,
        is_upper_bound=is_upper_bound,
    )
    assert worker._adapter_type(given) == name


LISTS = ("Array", "BoundedSequence", "UnboundedSequence")


@pytest.mark.parametrize(
    ("forms", "written", "value"),
    [
        (LISTS, "(1, 2)", [1, 2]),
        (LISTS, "('a',)", ["a"]),
        (LISTS, 3, 3),
        (("BasicType", "UnboundedString"), "(1, 2)", "(1, 2)"),
        (("BasicType",), 0, 0),
    ],
)
def test_defaults_of_lists_are_texts_in_idl(forms, written, value):
    for form in forms:
        member = SimpleNamespace(
            type=kind(form),
            has_annotation=lambda name: name == "default",
            get_annotation_value=lambda name: {"value": written},
        )
        found = worker._default(member)
        assert (found, type(found)) == (value, type(value))
    assert worker._default(SimpleNamespace(has_annotation=lambda name: False)) is None


def member(name, type_):
    return SimpleNamespace(name=name, type=type_, has_annotation=lambda name: False)


def message(name, *types, constants=()):
    """A message of rosidl_parser by its full name."""
    *namespaces, base = name.split("/")
    structure = SimpleNamespace(
        namespaced_type=kind("NamespacedType", namespaces=namespaces, name=base),
        members=[member(f"f{n}", each) for n, each in enumerate(types)],
    )
    return SimpleNamespace(structure=structure, constants=list(constants))


def test_constants_of_texts_have_no_bound():
    forms = {"BoundedString": "string", "BoundedWString": "wstring"}
    constants = [
        SimpleNamespace(name="C", type=kind(form, maximum_size=2), value="ab") for form in forms
    ]
    constants.append(SimpleNamespace(name="C", type=basic("octet"), value=7))
    found = worker._parsed_message(message("p/msg/A", constants=constants))["constants"]
    assert [(each["type"], each["value"]) for each in found] == [
        ("string", "ab"),
        ("wstring", "ab"),
        ("byte", 7),
    ]


def service(name, *, has_event=True):
    parts = {f"{end}_message": message(f"{name}_{end.title()}") for end in ("request", "response")}
    if has_event:
        parts["event_message"] = message(f"{name}_Event")
    return SimpleNamespace(**parts)


def file_of(element):
    """The content of a file: includes stand before and after what is declared."""
    include = SimpleNamespace(locator="q/msg/B.idl")
    return SimpleNamespace(elements=[include, element, include])


@pytest.mark.parametrize("has_event", [True, False])
def test_events_are_those_that_were_asked_for_and_that_rosidl_has(has_event):
    content = file_of(service("p/srv/S", has_event=has_event))
    names = ["p/srv/S_Request", "p/srv/S_Response"]
    assert list(worker._parsed(content)) == names
    events = ["p/srv/S_Event"] if has_event else []
    assert list(worker._parsed(content, has_events=True)) == names + events
    goal = {part: message(f"p/action/D_{part.title()}") for part in ("goal", "result", "feedback")}
    action = SimpleNamespace(
        **goal,
        send_goal_service=service("p/action/D_SendGoal", has_event=has_event),
        get_result_service=service("p/action/D_GetResult", has_event=has_event),
        feedback_message=message("p/action/D_FeedbackMessage"),
    )
    found = [each.removeprefix("p/action/D_") for each in worker._parsed(file_of(action), True)]
    ends = ["_Request", "_Response", *["_Event"] * has_event]
    assert found == [
        *("Goal", "Result", "Feedback"),
        *(f"SendGoal{end}" for end in ends),
        *(f"GetResult{end}" for end in ends),
        "FeedbackMessage",
    ]


def described(*types):
    return {"p/msg/A": {"fields": [{"type": each} for each in types]}}


def test_bounds_that_are_names_and_types_that_are_needed():
    for name in ("wstring<=N", "wstring<=N[]", "wstring<=p::N[<=3]", "int8[<=N]"):
        assert worker._has_named_bounds(described("int8", name))
    assert not worker._has_named_bounds(described("int8", "wstring<=3", "wstring<=3[<=5]", "p/N[]"))
    types = ("int8", "q/msg/B", "q/msg/C[3]", "q/srv/S_Request", "q/msg/D[<=2]", "string<=3[]")
    assert worker._idl_needs(described(*types)) == ["q/msg/B", "q/msg/C", "q/msg/D"]


# Definitions in a folder.


def spec_of(text):
    """A message of rosidl_adapter: a type in each line; one without ``/`` is a primitive."""
    if "wrong" in text:
        raise ValueError("it is wrong")
    fields = []
    for line in text.split("\n"):
        package, _, base = line.rpartition("/")
        if base:
            type_ = SimpleNamespace(
                pkg_name=package, type=base, is_primitive_type=lambda package=package: not package,
                string_upper_bound=None, is_array=False,
            )  # fmt: skip
            fields.append(SimpleNamespace(name="x", type=type_, annotations={}, default_value=None))
    return SimpleNamespace(fields=fields, constants=[], annotations={})


def parse_idl(text):
    """A message of rosidl_parser; each word of the text is a type that it needs."""
    if "wrong" in text:
        raise ValueError("it is wrong")
    kinds = [
        kind("NamespacedType", namespaces=each.split("/")[:-1], name=each.rpartition("/")[2])
        for each in text.split()
    ]
    return file_of(message("p/msg/I", *kinds))


@pytest.fixture
def rosidl(tmp_path):
    """Return a function that makes the reader for the files of a folder."""
    spec = SimpleNamespace(
        parse_message_string=lambda package, name, text: spec_of(text),
        parse_service_string=lambda package, name, text: SimpleNamespace(
            request=spec_of(text), response=spec_of("")
        ),
    )
    template = SimpleNamespace(evaluate_template=lambda name, data: "Ã©")

    def make(files):
        texts.clear()
        adapter = SimpleNamespace(parser=spec, resource=template)
        parser = SimpleNamespace(
            parser=SimpleNamespace(
                parse_idl_string=lambda text: texts.append(text) or parse_idl("")
            )
        )
        reader = worker._Rosidl(adapter, parser, str(make_files(tmp_path, files)))
        reader.texts = texts
        return reader

    texts = []
    return make


def asked(name="A", kind="msg", text=None, end=None):
    return {
        "package": "p", "kind": kind, "name": name, "file": f"{name}.{end or kind}", "text": text,
        "has_events": False,
    }  # fmt: skip


def refusal(reader, request):
    with pytest.raises(worker._RefusedError) as caught:
        reader.adapter(request)
    return str(caught.value)


def test_a_needed_type_is_that_of_the_msg_file_if_there_are_two(rosidl):
    files = {"p/msg/A.msg": "q/B", "q/msg/B.msg": "int8", "q/msg/B.idl": "wrong"}
    reader = rosidl(files)
    reader.parse_idl = parse_idl
    assert list(reader.adapter(asked())["structure"]) == ["p/msg/A"]
    reader = rosidl({**files, "q/msg/B.msg": "wrong", "q/msg/B.idl": ""})
    reader.parse_idl = parse_idl
    assert refusal(reader, asked()) == "q/msg/B: ValueError: it is wrong"


def test_a_needed_type_that_no_reader_takes_is_refused_by_name(rosidl, tmp_path):
    reader = rosidl({"p/msg/A.msg": "q/B", "q/msg/I.idl": "wrong"})
    reader.parse_idl = parse_idl
    assert refusal(reader, asked()) == "q/msg/B is not there"
    assert refusal(reader, asked(text="int8\nq/I")) == "q/msg/I: ValueError: it is wrong"
    (tmp_path / "q" / "msg" / "C.msg").write_bytes(b"int8 \xff")
    assert refusal(reader, asked(text="q/C")).startswith("q/msg/C: 'utf-8' codec can't decode")
    # What a needed type needs is looked up, too, in both languages.
    make_files(tmp_path, {"q/msg/D.msg": "r/E", "q/msg/F.idl": "r/msg/E"})
    for name in "DF":
        assert refusal(reader, asked(text=f"q/{name}")) == "r/msg/E is not there"
    # All types that it needs are looked up, not only the first one.
    files = {
        "q/msg/G.msg": "r/H\nr/H\nr/E",
        "q/msg/J.idl": "r/msg/H r/msg/E",
        "r/msg/H.msg": "int8",
    }
    make_files(tmp_path, files)
    for text in ("q/G", "q/J", "r/H\nq/G", "r/H\nr/E"):
        assert refusal(reader, asked(text=text)) == "r/msg/E is not there"
    assert reader.adapter(asked(text="r/H\nint8\nr/H"))


def test_a_type_must_not_contain_itself_even_after_a_change(rosidl):
    reader = rosidl({"p/msg/A.msg": "int8", "q/msg/B.msg": "p/A"})
    assert reader.adapter(asked(text="int16"))
    for text in ("p/A", "int8\nq/B"):
        assert refusal(reader, asked(text=text)) == "p/msg/A contains itself"
    # A service may need the message of its name.
    assert reader.adapter(asked(kind="srv", text="p/A"))


def test_a_changed_type_says_nothing_of_its_file_nor_the_file_of_the_change(rosidl):
    files = {"p/msg/A.msg": "int8", "q/msg/B.msg": "p/A", "p/msg/C.msg": "q/B\np/A"}
    for asks in ("change file", "file change file change"):
        reader = rosidl(files)
        for each in asks.split():
            if each == "file":
                assert reader.adapter(asked("C"))
            else:
                assert refusal(reader, asked(text="q/B")) == "p/msg/A contains itself"
    # What is found in files is looked up once.
    reader.text = None
    reader._check_needs(asked("C"), ["q/msg/B"])


def test_line_ends_of_files_and_of_changed_texts_are_the_same(rosidl):
    reader = rosidl({"p/msg/A.msg": "int8\r\nint16\rint32\n"})
    assert reader.text(asked()) == "int8\nint16\nint32\n"
    assert reader.text(asked(text="a\r\nb\rc\n\r")) == "a\nb\nc\n\n"
    assert reader.text(asked(text="")) == ""


def test_idl_that_rosidl_adapter_wrote_is_read_as_utf_8(rosidl):
    reader = rosidl({"p/msg/A.msg": "int8"})
    reader.content(asked())
    assert reader.texts == ["é"]
    # Equal texts are converted and read once.
    reader.content(asked())
    assert reader.texts == ["é"]


def test_an_error_of_the_generator_of_hashes_stands_for_the_hash():
    hashes = worker._Hashes(None, None)
    for error, text in ((KeyError("long double"), "KeyError: 'long double'"),
                        (ValueError("no"), "ValueError: no")):  # fmt: skip

        def fails(element, request, error=error):
            raise error

        hashes._of = fails
        assert hashes.of(file_of("it"), {}) == f"raises {text}"
    hashes._of = lambda element, request: (element, request)
    assert hashes.of(file_of("it"), {"a": 1}) == ("it", {"a": 1})


@pytest.mark.parametrize(
    ("files", "found"),
    [
        ({}, "raises ValueError: q/msg/B is not there"),
        ({"B.msg": ["q/msg/C"]}, "raises ValueError: q/msg/C is not there"),
        ({"B.msg": ["q/msg/C", "q/msg/D"], "C.msg": []}, "raises ValueError: q/msg/D is not there"),
        ({"B.idl": []}, ["p/msg/A", "q/msg/B"]),
        # A definition in a .msg file is the one that counts.
        ({"B.msg": [], "B.idl": ["q/msg/C"]}, ["p/msg/A", "q/msg/B"]),
        ({"B.idl": ["q/msg/C"], "C.msg": ["q/msg/B"]}, ["p/msg/A", "q/msg/B", "q/msg/C"]),
    ],
)
def test_types_that_a_hash_needs_are_those_of_files(files, found):
    def content(request):
        if request["file"] not in files:
            raise FileNotFoundError(request["file"])
        return file_of(files[request["file"]])

    def described(element, request):
        fields = [{"type": {"nested_type_name": need}} for need in ["", *element]]
        return {f"{request['package']}/msg/{request['name']}": {"fields": fields}}

    describing = SimpleNamespace(
        extract_full_type_description=lambda name, described: sorted(described),
        calculate_type_hash=lambda names: names,
    )
    hashes = worker._Hashes(SimpleNamespace(content=content), describing)
    hashes._individual = described
    answer = hashes.of(file_of(["q/msg/B"]), asked())
    assert answer == (found if isinstance(found, str) else {"p/msg/A": found})
