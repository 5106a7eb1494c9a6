"""IDL files of real ROS packages, if ``FIRM_HDL_CORPUS`` names a corpus of them."""

from __future__ import annotations

from dataclasses import replace

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import Library
from firm_hdl.model import IDL_PRIMITIVES, PRIMITIVES, Array, FieldType, Message, Sequence
from firm_hdl.wire import lay_out
from tests.steps import calls_at_most


def texts(message: Message) -> list[object]:
    """Return comments and units, which do not count when models are compared."""
    parts = [*message.constants, *message.fields]
    return [message.comment, *((part.name, part.comment, part.unit) for part in parts)]


def adapted(kind: FieldType) -> FieldType:
    """Replace ``char`` by ``uint8``, as rosidl_adapter does with the types of ``.msg`` files."""
    match kind:
        case Message():
            fields = (replace(item, type=adapted(item.type)) for item in kind.fields)
            return replace(kind, fields=tuple(fields))
        case Array() | Sequence():
            return replace(kind, element=adapted(kind.element))
    return PRIMITIVES["ros2"]["uint8"] if kind == PRIMITIVES["ros2"]["char"] else kind


@pytest.mark.parametrize("kind", ["msg", "srv", "action"])
def test_idl_of_rosidl_adapter_means_the_same_as_its_input(corpus, kind, tmp_path):
    folder = corpus / "rosidl_adapter_pairs" / kind
    models = []
    for file, ending in ((f"Test.{kind}", kind), ("Test.expected.idl", "idl")):
        target = tmp_path / ending / "test_msgs" / kind / f"Test.{ending}"
        target.parent.mkdir(parents=True)
        target.write_bytes((folder / file).read_bytes())
        library = Library("lyrical", [tmp_path / ending])
        assert library.is_idl(f"test_msgs/{kind}/Test") == (ending == "idl")
        models.append(library.interface(f"test_msgs/{kind}/Test").messages)
    for message, other in zip(*models, strict=True):
        # Types of the distribution are the same on both sides, and some have a `char`.
        assert adapted(message) == adapted(other)
        assert texts(message) == texts(other)


def leaves(message: Message, known: dict[str, int]) -> int:
    """Count the leaves of a message, with each element of an array of messages."""
    if message.name not in known:
        count = 0
        for item in message.fields:
            kind, times = item.type, 1
            if isinstance(kind, Array | Sequence):
                times = kind.count if isinstance(kind, Array) else 1
                kind = kind.element
            count += times * leaves(kind, known) if isinstance(kind, Message) else 1
        known[message.name] = count
    return known[message.name]


def test_large_types_take_no_time(corpus):
    with calls_at_most(2_000_000):
        library = Library("lyrical", [corpus / "ros2"])
        struct = library.message("performance_test/msg/Struct32k")
        (array, *_) = library.message("performance_test/msg/Array8m").fields
        assert leaves(struct, {}) == 37_138
        assert str(array.type) == "byte[8388608]"


def test_every_file_resolves(corpus):
    library = Library("lyrical", [corpus / "ros2"])
    found = sorted((corpus / "ros2").glob("*/*/*.idl"))
    for path in found:
        name = f"{path.parts[-3]}/{path.parts[-2]}/{path.stem}"
        library.interface(name)
    assert len(found) >= 49


def test_the_file_with_long_double_is_read_and_not_laid_out(corpus):
    message = Library("lyrical", [corpus / "ros2"]).message("rosidl_parser/msg/MyMessage")
    (field,) = [item for item in message.fields if item.name == "long_double_value"]
    assert field.type == IDL_PRIMITIVES["long double"]
    with pytest.raises(DefinitionError) as error:
        lay_out(message)
    (diagnostic,) = error.value.diagnostics
    assert "'long double'" in diagnostic.message
    assert diagnostic.span.line_text.strip() == "long double long_double_value;"
