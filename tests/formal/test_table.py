"""The table in lab/notes/formal.md."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from firm_hdl.formal.run import all_proofs
from firm_hdl.formal.solve import Answer
from firm_hdl.formal.table import replace_table, table

PAGE = Path(__file__).parents[2] / "lab/notes/formal.md"


def test_only_what_is_proved_has_a_row():
    proofs = all_proofs()
    keys = list(proofs)
    answers = {
        keys[0]: Answer(result="proved", seconds=1.25),
        keys[1]: Answer(result="undecided", seconds=2.0),
    }
    rows = table(proofs, answers).splitlines()
    assert len(rows) == 3
    assert "| PDR | unbounded | 1.2 |" in rows[2]


def test_page_has_a_row_for_each_proof():
    text = PAGE.read_text(encoding="utf-8")
    for proof in all_proofs().values():
        claim = proof.claim
        row = f"| {proof.study.block} | {claim.name} | {claim.method} | {claim.reach} |"
        assert row in text, f"{row}: python -m firm_hdl.formal --write lab/notes/formal.md"


def test_no_block_is_forgotten():
    """Other tests take the blocks from the program, and would not miss one."""
    blocks = [proof.study.block for proof in all_proofs().values()]
    assert {re.findall(r"\w+", block)[0] for block in blocks} == {
        *("StreamSlice", "PacketWidth", "PacketArbiter", "PacketRouter", "PacketFifo"),
        *("TailDrop", "PacketCrossing", "Claims", "RecordReader", "RecordWriter"),
        *("Deserializer", "Serializer", "Parser", "PacketGate"),
    }
    rows = re.findall(r"^\| `.* [\d.]+ \|$", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
    assert len(rows) == len(all_proofs()), "python -m firm_hdl.formal --write lab/notes/formal.md"


BEGIN = "<!-- proofs: written by `python -m firm_hdl.formal --write lab/notes/formal.md` -->"
END = "<!-- end of proofs -->"


def test_only_the_table_of_a_page_is_replaced(tmp_path):
    page = tmp_path / "page.md"
    page.write_text(f"# Head\n{BEGIN}\nold\n{END}\nTail {END}\n")
    for _ in range(2):
        replace_table(page, "| new |\n")
        assert page.read_text() == f"# Head\n{BEGIN}\n\n| new |\n\n{END}\nTail {END}\n"


@pytest.mark.parametrize("text", ["nothing", f"{BEGIN}\nrest", f"{END}\nrest", f"{END}{BEGIN}"])
def test_page_without_a_place_is_refused(tmp_path, text):
    page = tmp_path / "page.md"
    page.write_text(text)
    with pytest.raises(ValueError, match="has no lines"):
        replace_table(page, "")
    assert page.read_text() == text
