"""Every operator with every width, sign and value of small operands, in Icarus Verilog."""

from __future__ import annotations

from pathlib import Path

import pytest

from firm_hdl.verilog import convert
from tests.verilog.icarus import replay
from tests.vhdl.test_operator_table import TABLES, Table, design_of


def wrong_rows(table: Table, folder: Path, change: tuple[str, str] = ("", "")) -> set[int]:
    """Return the numbers of the operators that do not give what Python gives."""
    text = convert(design_of(table), name="top").replace(*change)
    widths = {f"o{number}": row.width for number, row in enumerate(table.rows)}
    inputs = dict.fromkeys("ab", table.bits)
    seen = replay(text, "top", inputs, widths, table.steps, "-g2005", folder)
    return {
        number
        for step, now in zip(table.steps, seen, strict=True)
        for number, row in enumerate(table.rows)
        if (value := row.value(step)) is not None and now[f"o{number}"] != f"{value:0{row.width}b}"
    }


@pytest.mark.usefixtures("iverilog")
@pytest.mark.parametrize("table", TABLES)
def test_each_operator_gives_what_python_gives(table: str, tmp_path: Path) -> None:
    assert wrong_rows(TABLES[table], tmp_path) == set()


@pytest.mark.usefixtures("iverilog")
def test_a_changed_operator_is_noticed(tmp_path: Path) -> None:
    assert wrong_rows(TABLES["inputs"], tmp_path, (" > ", " >= "))
