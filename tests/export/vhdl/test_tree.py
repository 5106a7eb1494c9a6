# amaranth: UnusedElaboratable=no
"""The user's VHDL for types, fields and constants with equal names or unusual values."""

from __future__ import annotations

import re
import struct
import subprocess

from firm_hdl.export.constants import named_constants
from firm_hdl.export.tree import tree_of
from firm_hdl.export.vhdl.constants import comment, declarations
from firm_hdl.export.vhdl.package import types_package
from firm_hdl.gateware import record_layout
from firm_hdl.names.identifiers import scope_names
from firm_hdl.plan import build_plan
from firm_hdl.wire import lay_out
from tests.export.vhdl.test_layer import layer, vhdl_of, write
from tests.frontend.workspace import library

TWO = {
    "p/T": "int8 A=1\nPart a\nq/Part b\nq/Part[2] c\nint8 x",
    "p/Part": "int8 A=2\nint8 B=3\nint8 x\nint16 y",
    "q/Part": "int8 A=4\nint8 B=5\nint32 x\nint64 y",
}


def plan_of(message):
    return build_plan(lay_out(message), bus_bytes=8)


def test_constants_of_two_types_of_one_name_are_all_there(tmp_path):
    message = library(tmp_path, TWO).message("p/T")
    found = named_constants(message, ())
    assert [(n.owner.name, n.constant.name, n.constant.value) for n in found] == [
        ("p/msg/T", "A", 1),
        ("p/msg/Part", "A", 2),
        ("p/msg/Part", "B", 3),
        ("q/msg/Part", "A", 4),
        ("q/msg/Part", "B", 5),
    ]
    names = [n.name for n in found]
    assert names[0] == "A" and len({name.lower() for name in names}) == 5
    assert [name.startswith("PART_") for name in names] == [False, True, True, True, True]
    text = "".join(declarations(found, ()))
    for entry in found:
        value = f'x"{entry.constant.value:02x}"'
        assert re.search(rf"constant {entry.name} +: signed\(7 downto 0\) := {value};", text)


def test_types_of_one_name_have_records_of_their_own(tmp_path):
    message = library(tmp_path, TWO).message("p/T")
    root = tree_of(message, plan_of(message)).root
    a, b, c, x = root.children
    assert (a.package, b.package) == ("p_msg_part_cdr_8_pkg", "q_msg_part_cdr_8_pkg")
    assert a.type == b.type == c.children[0].type and b.package == c.package
    assert {x.type} == {"int8_stream_t"}
    assert [child.type for child in a.children] == ["int8_stream_t", "int16_stream_t"]
    assert [child.type for child in b.children] == ["int32_stream_t", "int64_stream_t"]
    made = layer(message)
    for node in (a, b):
        text = made.packages[f"{node.package}.vhd"]
        (body,) = re.findall(rf"  type {node.type} is record\n(.*?)  end record;", text, re.DOTALL)
        assert [line.split()[2].rstrip(";") for line in body.splitlines()] == [
            child.type for child in node.children
        ]
    own = made.packages[f"{made.package}.vhd"]
    assert f"a : work.{a.package}.part_t;" in own and f"b : work.{b.package}.part_t;" in own


NUMBERS = {
    "int8 I8_LOW=-128": "to_integer({}) = -128",
    "int8 I8_ONE=-1": "to_integer({}) = -1",
    "uint8 U8=255": "to_integer({}) = 255",
    "byte BYTE=200": "to_integer({}) = 200",
    "char CHAR=65": "to_integer({}) = 65",
    "int16 I16=-32768": "to_integer({}) = -32768",
    "uint16 U16=65535": "to_integer({}) = 65535",
    "int32 I32=-2147483647": "to_integer({}) = -2147483647",
    "uint32 U32=4294967295": '{} = x"ffffffff"',
    "int64 I64=-2": '{} = x"fffffffffffffffe"',
    "uint64 U64=18446744073709551614": '{} = x"fffffffffffffffe"',
    "bool YES=true": "{} = '1'",
    "bool NO=false": "{} = '0'",
    "float64 F64=-0.5": "{} = -0.5",
    "float64 F64_INT=3": "{} = 3.0",
    "float64 F64_BIG=1e300": "{} > 9.9e299",
    "float32 F32=0.25": "{} = 0.25",
    "string EMPTY=''": "{}'length = 0",
    "string TEXT='a\"b'": '{} = "a""b"',
    "string ONE='\"'": '{} = """" and {}\'length = 1',
    "string WIDE='é'": "{} = character'val(195) & character'val(169)",
    "string LONE='\x7f'": "{} = (1 => DEL)",
    "string TAB='a\\tb'": "{}'length >= 3",
}
BITS = {"F64": (-0.5, "d"), "F64_INT": (3.0, "d"), "F64_BIG": (1e300, "d"), "F32": (0.25, "f")}


def test_constants_have_their_values_in_ghdl(ghdl, tmp_path):
    text = "\n".join(NUMBERS) + "\nint8 x\n"
    message = library(tmp_path / "src", {"p/T": text}).message("p/T")
    found = {n.constant.name: n for n in named_constants(message, ())}
    tests = []
    for line, test in NUMBERS.items():
        name = line.split()[1].partition("=")[0]
        tests.append(test.replace("{}", found[name].name))
    for name, (value, code) in BITS.items():
        bits = struct.pack(">" + code, value).hex()
        tests.append(f'{found[name].name}_BITS = x"{bits}"')
    checks = "".join(
        f'    assert {t} report "{n}" severity failure;\n' for n, t in enumerate(tests)
    )
    (tmp_path / "t.vhd").write_text(
        "library ieee;\nuse ieee.std_logic_1164.all;\nuse ieee.numeric_std.all;\n"
        f"package t_pkg is\n{''.join(declarations(found.values(), ()))}end package;\n"
        "library ieee;\nuse ieee.std_logic_1164.all;\nuse ieee.numeric_std.all;\n"
        "use work.t_pkg.all;\nentity t is end entity;\narchitecture a of t is\nbegin\n"
        f'  process begin\n{checks}    report "ALL {len(tests)}";\n    wait;\n  end process;\n'
        "end architecture;\n"
    )
    done = subprocess.run(
        f"{ghdl} -a --std=08 t.vhd && {ghdl} --elab-run --std=08 t",
        shell=True, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=60,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    assert f"ALL {len(tests)}" in done.stdout + done.stderr


def test_constants_that_start_with_an_underscore_have_legal_names(ghdl, tmp_path):
    values = {"_": 1, "_A": 2, "A": 3, "_1": 4, "_signal": 5, "_NOTE": 6, "__a__b": 7, "A_b": 8}
    text = "".join(f"int8 {name}={value}\n" for name, value in values.items())
    texts = {"p/T": "int8 _A=9\nstring _s=x\nPart a\nint8 x\n", "p/Part": f"{text}int8 x\n"}
    message = library(tmp_path / "src", texts, "ros1").message("p/T")
    (part,) = message.children
    assert {each.name: each.value for each in part.constants} == values
    made, _ = vhdl_of(message, hollow=True)
    listed = {(e["type"], e["constant"]): e["name"] for e in made.manifest["constants"]}
    names = [name for (owner, _), name in listed.items() if owner == "p/Part"]
    assert len({name.lower() for name in names}) == len(values)
    assert listed["p/Part", "A"] == "A" and listed["p/T", "_A"] == "A"
    assert all(re.fullmatch(r"[A-Za-z](_?[A-Za-z0-9])*", name) for name in listed.values())
    write(tmp_path / "vhdl", made.files)
    done = subprocess.run(
        [ghdl, "-a", "--std=08", "--warn-error", *made.manifest["files"]],
        cwd=tmp_path / "vhdl", capture_output=True, text=True, check=False, timeout=60,
    )  # fmt: skip
    assert (done.returncode, done.stdout + done.stderr) == (0, "")


ODD = [
    "plain",
    "-- already; end package; \"quotes\" 'ticks'",
    "tab\there\x0bvertical\x1b escape\x7f",
    "line\rseparator\u2028more\x85next",
    "ümläut 漢字 \U0001f600 \ud800",
    "x" * 300,
    "word " * 60,
    "",
    "   ",
]


def test_comments_stay_comments_for_any_text():
    for indent in ("", "  ", "    "):
        for text in ODD:
            lines = list(comment(text, indent))
            for line in lines:
                assert line.endswith("\n") and line.count("\n") == 1
                assert line.startswith(f"{indent}--")
                assert line.isascii() and line.rstrip("\n").isprintable()
                assert len(line) <= 101 or " " not in line[len(indent) + 3 :].strip()
            words = "".join(lines).replace("--", " ").split()
            if text in ("plain", "word " * 60):
                assert words == text.split()
    assert list(comment("ü \N{DEGREE SIGN}C", "")) == ["-- \\xfc degC\n"]
    assert list(comment("a\n\nb", "")) == ["-- a\n", "--\n", "-- b\n"]


def test_unusual_comments_and_units_are_analysed(ghdl, tmp_path):
    # Characters that a line of a definition may have.
    unusual = [text for text in ODD if "\ud800" not in text]
    unusual = [re.sub(r"[\r\v\x85\u2028\x1b]", " ", text) for text in unusual]
    lines = [f'# {text}\nint8 f{n}  # {text} [{n} °"]' for n, text in enumerate(unusual)]
    lines += [f"# {text}\nint8 C{n}={n}  # [--]" for n, text in enumerate(unusual)]
    message = library(tmp_path / "src", {"p/T": '# "head" --\n\n' + "\n".join(lines)}).message(
        "p/T"
    )
    made, _ = vhdl_of(message, hollow=True)
    write(tmp_path / "vhdl", made.files)
    done = subprocess.run(
        [ghdl, "-a", "--std=08", "--warn-error", *made.manifest["files"]],
        cwd=tmp_path / "vhdl", capture_output=True, text=True, check=False, timeout=60,
    )  # fmt: skip
    assert (done.returncode, done.stdout + done.stderr) == (0, "")


def test_values_of_a_record_stand_where_the_layout_has_them(tmp_path):
    texts = {**TWO, "p/T": "bool f\nPart a\nq/Part b\nq/Part[2] c\nint8 x\nfloat32[3] y"}
    message = library(tmp_path, texts).message("p/T")
    made, _ = vhdl_of(message, hollow=True)
    text = made.files[f"{made.manifest['package']}.vhd"]
    layout = record_layout(message, wire="cdr")
    for name, place in layout:
        bits = place.width
        first, last = place.offset, place.offset + bits - 1
        part = f"({first})" if bits == 1 else f"({last} downto {first})"
        member = scope_names([name])[name]
        read = rf"value\.{member} := [a-z_0-9.]*\(?all_bits{re.escape(part)}\)?;"
        assert re.search(read, text), name
        assert re.search(rf"bits{re.escape(part)} := [a-z_0-9.]*\(?value\.{member}\)?;", text), name
    assert made.manifest["record_view"]["bits"] == layout.size == 1 + 24 + 96 + 192 + 8 + 96
    # Two types with one name are two records, each with its own size.
    (body,) = re.findall(r"  type t_value_t is record\n(.*?)  end record;", text, re.DOTALL)
    types = {line.split()[0]: line.split()[2].rstrip(";") for line in body.splitlines()}
    assert types["a"] != types["b"] and types["c"].startswith(types["b"].removesuffix("_t"))
    # Arrays have as many elements as the field.
    assert types["c"].endswith("_t(0") and "float32_items_t(0 to 2);" in body
    for member, bits in (("a", 24), ("b", 96)):
        _, package, kind = types[member].split(".")
        constant = f"{kind.removesuffix('_t').upper()}_BITS"
        assert f"constant {constant} : positive := {bits};" in made.files[f"{package}.vhd"]


CONVERSIONS = """\
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use work.firm_hdl_types_pkg.all;
entity t is end entity;
architecture a of t is
begin
  process
    -- Bounds that start elsewhere, and run the other way.
    variable bits : std_logic_vector(32 to 95) := x"0123456789abcdef";
    variable up   : uint16_items_t(5 to 8) := (x"cdef", x"89ab", x"4567", x"0123");
    variable down : uint16_items_t(3 downto 0) := (x"cdef", x"89ab", x"4567", x"0123");
    variable some : bool_items_t(1 to 3) := ('1', '0', '0');
  begin
    assert to_slv(up) = bits and to_slv(down) = bits report "to_slv" severity failure;
    assert to_uint16_items(bits) = up report "to_uint16_items" severity failure;
    assert to_uint16_items(bits)(0) = x"cdef" report "the first is lowest" severity failure;
    assert to_int8_items(bits)(7) = x"01" and to_int8_items(bits)(0) = -17
      report "to_int8_items" severity failure;
    assert to_float64_items(bits)(0) = bits report "to_float64_items" severity failure;
    assert to_slv(some) = "001" report "to_slv of bits" severity failure;
    assert to_bool_items("001") = some report "to_bool_items" severity failure;
STATUSES    report "ALL";
    wait;
  end process;
end architecture;
"""


def test_items_and_vectors_are_the_same_in_any_range(ghdl, tmp_path):
    names = ["OK", "TRUNCATED", "TRAILING", "LENGTH", "ENCAPSULATION", "STRING", "ITEMS"]
    checks = "".join(
        f'    assert STATUS_{name} = x"{n:02x}" and status_name(x"{n:02x}") = "{name}"\n'
        f'      report "{name}" severity failure;\n'
        for n, name in enumerate(names)
    )
    checks += '    assert status_name(x"07") = "UNKNOWN" report "unknown" severity failure;\n'
    (tmp_path / "types.vhd").write_text(types_package())
    (tmp_path / "t.vhd").write_text(CONVERSIONS.replace("STATUSES", checks))
    done = subprocess.run(
        f"{ghdl} -a --std=08 types.vhd t.vhd && {ghdl} --elab-run --std=08 t",
        shell=True, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=60,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    assert "ALL" in done.stdout + done.stderr
