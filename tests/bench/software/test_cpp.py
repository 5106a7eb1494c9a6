"""The C++ that Fast CDR is timed with, for each kind of field."""

from __future__ import annotations

import pytest

from firm_hdl.bench.software.cpp import cpp_types
from firm_hdl.model import PRIMITIVES, Array, Field, FieldType, Message, Sequence, String
from tests.bench.software.test_software import PADDED

UINT8 = PRIMITIVES["ros2"]["uint8"]
WIDE = String(wide=True)


@pytest.mark.parametrize(
    ("kind", "type_name", "write", "read"),
    [
        (UINT8, "uint8_t", "cdr << X;", "cdr >> X;"),
        (PRIMITIVES["ros2"]["int64"], "int64_t", "cdr << X;", "cdr >> X;"),
        (PRIMITIVES["ros2"]["float32"], "float", "cdr << X;", "cdr >> X;"),
        (PRIMITIVES["ros2"]["float64"], "double", "cdr << X;", "cdr >> X;"),
        (String(), "std::string", "cdr << X;", "cdr >> X;"),
        (WIDE, "std::u16string", "write_wide(cdr, X);", "read_wide(cdr, X);"),
        (Array(element=UINT8, count=3), "std::array<uint8_t, 3>", "cdr << X;", "cdr >> X;"),
        (Sequence(element=String()), "std::vector<std::string>", "cdr << X;", "cdr >> X;"),
        (
            Sequence(element=UINT8, bound=2),
            "std::vector<uint8_t>",
            "check_bound(X.size(), 2); cdr << X;",
            "cdr >> X; check_bound(X.size(), 2);",
        ),
        (
            Array(element=WIDE, count=3),
            "std::array<std::u16string, 3>",
            "for (const auto & each : X) {write_wide(cdr, each);}",
            "{for (auto & each : X) {read_wide(cdr, each);}}",
        ),
        (
            Sequence(element=WIDE),
            "std::vector<std::u16string>",
            "cdr << static_cast<uint32_t>(X.size()); "
            "for (const auto & each : X) {write_wide(cdr, each);}",
            "{uint32_t size; cdr >> size; X.resize(size); "
            "for (auto & each : X) {read_wide(cdr, each);}}",
        ),
        (
            Sequence(element=PADDED, bound=5),
            "std::vector<M0>",
            "check_bound(X.size(), 5); cdr << static_cast<uint32_t>(X.size()); "
            "for (const auto & each : X) {write(cdr, each);}",
            "{uint32_t size; cdr >> size; check_bound(size, 5); X.resize(size); "
            "for (auto & each : X) {read(cdr, each);}}",
        ),
    ],
)
def test_cpp_of_each_kind_of_field(kind: FieldType, type_name: str, write: str, read: str) -> None:
    message = Message(name="p/msg/One", dialect="ros2", fields=(Field(name="a", type=kind),))
    text = cpp_types(message).partition("// p/msg/One\n")[2]
    own = "M1" if "M0" in type_name else "M0"
    assert text == (
        f"struct {own} {{\n"
        f"  {type_name} f0{{}};  // a\n"
        "};\n"
        f"inline void write(Cdr & cdr, const {own} & message) {{\n"
        f"  {write.replace('X', 'message.f0')}\n"
        "}\n"
        f"inline void read(Cdr & cdr, {own} & message) {{\n"
        f"  {read.replace('X', 'message.f0')}\n"
        "}\n"
        f"using Root = {own};\n"
    )
