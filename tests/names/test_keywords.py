"""The lists of reserved words of VHDL and Verilog, compared with GHDL and Pygments."""

from __future__ import annotations

import subprocess

import pytest
from pygments.lexers.hdl import SystemVerilogLexer
from pygments.token import Keyword, Operator

from firm_hdl.names.identifiers import identifier, scope_names
from firm_hdl.names.keywords import KEYWORDS, VERILOG, VHDL

# Words of VHDL-2019 and PSL that GHDL 2.0 does not reserve.
TAKEN = {"private", "view", "vpkg", "assume_guarantee", "fairness", "strong"}
# Pygments takes these for keywords before a name only.
IN_CONTEXT = {"class", "extends"}


def accepts(ghdl: str, folder, word: str) -> bool:
    """Return whether GHDL accepts a word as an identifier."""
    (folder / "e.vhd").write_text(f"entity e is port (\n  {word} : in bit\n); end entity;\n")
    done = subprocess.run(
        [ghdl, "-a", "--std=08", "e.vhd"], cwd=folder, capture_output=True, check=False
    )
    return done.returncode == 0


def test_every_word_of_vhdl_is_reserved_by_ghdl(ghdl, tmp_path):
    assert {word for word in VHDL if accepts(ghdl, tmp_path, word)} == TAKEN
    # Must-pass twins: words that are no keywords, some of which look like one.
    for word in ("ranges", "buffe", "signal_field", "integer"):
        assert accepts(ghdl, tmp_path, word)


def is_keyword(word: str) -> bool:
    kind = next(
        kind for kind, text in SystemVerilogLexer().get_tokens(f" {word} ;") if text == word
    )
    return kind in Keyword or kind in Operator.Word


def test_every_word_of_systemverilog_is_reserved_by_pygments():
    assert {word for word in VERILOG if not is_keyword(word)} == IN_CONTEXT
    assert not is_keyword("wires") and not is_keyword("ranges") and not is_keyword("label")


def test_every_word_that_pygments_reserves_is_in_the_list():
    # Pygments also has types and directives that are no keywords of the standard.
    words = {
        word
        for name in ("keyword", "keyword_types")
        for word in getattr(SystemVerilogLexer, name, ())
    }
    for rules in SystemVerilogLexer.tokens.values():
        for rule in rules:
            if isinstance(rule, tuple) and hasattr(rule[0], "words") and rule[1] in Keyword:
                words |= {w for w in rule[0].words if w.isidentifier() and w.islower()}
    assert len(words) > 200
    assert words - VERILOG == set()


@pytest.mark.parametrize("form", [str, str.upper, str.title])
def test_no_name_is_a_keyword_in_any_case(form):
    assert {*VHDL, *VERILOG} <= {*KEYWORDS}
    for word in KEYWORDS:
        name = identifier(form(word))
        assert name.lower() == f"{word}_field" and name.startswith(form(word))
    names = scope_names(form(word) for word in KEYWORDS)
    assert not {name.lower() for name in names.values()} & KEYWORDS
    assert len({name.lower() for name in names.values()}) == len(KEYWORDS)
