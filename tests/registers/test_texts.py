"""The SystemRDL and the C header of a table, by PeakRDL and by a C compiler; and refusals."""

from __future__ import annotations

import shutil
import subprocess
from importlib.util import find_spec

import pytest

from firm_hdl import load_message
from firm_hdl.cli import main
from firm_hdl.plan import build_plan
from firm_hdl.registers import Field, Register, RegisterMap, c_header, message_map, system_rdl
from firm_hdl.wire import lay_out
from tests.tools import need

TX = """\
#include "ours.h"
#include "peakrdl.h"
#define SAME(member, address) \\
  _Static_assert(offsetof(test_msgs_msg_Mixed_tx_t, member) == address, #member)
#define AT(field) (test_msgs_msg_Mixed_MESSAGE + offsetof(test_msgs_msg_Mixed_t, field))
#define test_msgs_msg_Mixed_MESSAGE TEST_MSGS_MSG_MIXED_TX_MESSAGE
SAME(id, TEST_MSGS_MSG_MIXED_TX_ID);
SAME(fingerprint_high, TEST_MSGS_MSG_MIXED_TX_FINGERPRINT_HIGH);
SAME(interrupt, TEST_MSGS_MSG_MIXED_TX_INTERRUPT);
SAME(skipped, TEST_MSGS_MSG_MIXED_TX_SKIPPED);
SAME(message_double, AT(double_));
SAME(message_b_low, AT(b));
SAME(message_b_high, AT(b) + 4);
SAME(message_word_4_2, AT(c));
SAME(message_word_4_2, AT(d) - 2);
SAME(message_word_5, AT(inner[0].e));
SAME(message_word_5, AT(inner[1].e) - 2);
SAME(message_g_low, AT(g));
SAME(message_g_low_2, AT(g_low));
SAME(message_word_4, AT(word_4));
_Static_assert(TEST_MSGS_MSG_MIXED_TX_STATUS_CODE_MASK
  == TEST_MSGS_MSG_MIXED_TX__STATUS__CODE_bm, "mask");
int main(void)
{
  uint32_t registers[64] = {0};
  test_msgs_msg_Mixed_t message = {0};
  message.b = 1.5;
  message.inner[1].e[1] = 7;
  if (test_msgs_msg_Mixed_tx_is(registers))
    return 1;
  if (!test_msgs_msg_Mixed_tx_send(registers, &message) || registers[4] != 1
      || memcmp((char *)registers + 64, &message, sizeof message))
    return 2;
  registers[5] = 1;
  registers[4] = 0;
  return test_msgs_msg_Mixed_tx_send(registers, &message) || registers[4] ? 3 : 0;
}
"""


def test_peakrdl_and_a_compiler_agree_with_the_header(tmp_path):
    found = find_spec("systemrdl") and find_spec("peakrdl_cheader")
    need("peakrdl-cheader", "here" if found else None)
    from peakrdl_cheader.exporter import CHeaderExporter
    from systemrdl import RDLCompiler

    folder = tmp_path / "test_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder.parent / "package.xml").write_text("<package><name>test_msgs</name></package>")
    (folder / "Inner.msg").write_text("uint8[2] e\nstring left_out\n")
    text = "uint8 double\nfloat64 b\nbool c\nint16 d\nFixed[2] inner\nint64 g\n"
    # Names that are those of halves and words of others.
    text += "int32 g_low\nint32 word_4\n"
    (folder / "Fixed.msg").write_text("uint8[2] e\n")
    (folder / "Mixed.msg").write_text(text + "Inner unused\nstring name\n")
    message = load_message("test_msgs/msg/Mixed", paths=[tmp_path])
    layout = message_map(message, build_plan(lay_out(message), bus_bytes=8), "serializer")
    (tmp_path / "ours.h").write_text(c_header(layout, "A test */"))
    (tmp_path / "ours.rdl").write_text(system_rdl(layout.table, "A test"))
    compiler = RDLCompiler()
    compiler.compile_file(str(tmp_path / "ours.rdl"))
    CHeaderExporter().export(compiler.elaborate(), str(tmp_path / "peakrdl.h"))
    (tmp_path / "main.c").write_text(TX)
    cc = need("a C compiler", shutil.which("cc"))
    strict = ["-std=c11", "-Wall", "-Wextra", "-Werror"]
    subprocess.run([cc, *strict, "-o", "main", "main.c"], cwd=tmp_path, check=True)
    subprocess.run([tmp_path / "main"], check=True)
    cxx = [need("a C++ compiler", shutil.which("c++")), "-std=c++17", *strict[1:]]
    subprocess.run([*cxx, "-fsyntax-only", "-x", "c++", "ours.h"], cwd=tmp_path, check=True)


def test_registers_need_values_of_fixed_size(tmp_path, capsys):
    for name, reason in {
        "std_msgs/msg/String": "no field of fixed size",
        "std_msgs/msg/Empty": "no values",
    }.items():
        assert main(["build", name, "--registers", "--out", str(tmp_path / "out")]) == 1
        assert reason in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def field(low, bits, name="a"):
    return Field(name=name, low=low, bits=bits, kind="status", meaning="")


def register(address, *fields, name="r"):
    return Register(name=name, address=address, fields=fields, meaning="")


@pytest.mark.parametrize(
    "registers",
    [
        (register(2),),
        (register(4), register(4, name="s")),
        (register(0, field(30, 3)),),
        (register(0, field(0, 8), field(7, 1, "b")),),
        (register(0, field(0, 0)),),
        (register(0, field(0, 1)), register(4, field(0, 1, "A"))),
    ],
)
def test_table_that_overlaps_is_refused(registers):
    with pytest.raises(ValueError, match=r"of its own|one name"):
        RegisterMap(name="t", registers=registers, meaning="")
