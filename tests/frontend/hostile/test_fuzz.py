"""Damaged IDL ends in messages or diagnostics (``make -C lab fuzz`` damages all languages)."""

from __future__ import annotations

import random

from hypothesis import given, settings
from hypothesis import strategies as st

from firm_hdl.errors import Diagnostic, Source
from firm_hdl.frontend.idl import read_idl
from tests.damage import TOKEN, WORDS, mutate
from tests.depth import by_depth
from tests.steps import calls_at_most

IDL = (
    '#include "a.idl"\nmodule p { module msg { module T_Constants { const long N = 1 << 2; };\n'
    "typedef sequence<string<N>, 3> S; enum E { A }; @final struct T {\n"
    '@default(value=-1) @verbatim(language="comment", text="x" "\\n") long a, b; // c\n'
    '@unit(value="m") S d; q::msg::X e[N + 1]; @default(value="(1, 2)") sequence<octet> f;\n'
    "char g; wchar h; unsigned long long i; /* j */ wstring<2> k; }; }; };\n"
)


@settings(max_examples=by_depth(40, 200), deadline=None)
@given(st.integers(0, 2**32))
def test_damaged_idl_gives_messages_and_diagnostics(number):
    rng = random.Random(number)
    text = mutate(rng, IDL, IDL)
    # A long text has many calls: about 100 for each character were counted.
    with calls_at_most(1_000_000 + 150 * len(text)):
        messages, wrong = read_idl(Source(name="test.idl", text=text), lambda path: None)
        assert isinstance(messages, dict)
        assert all(isinstance(d, Diagnostic) and str(d) for d in wrong)


@settings(max_examples=by_depth(80, 200), deadline=None)
@given(st.lists(st.sampled_from([*WORDS, *TOKEN.findall(IDL)]), max_size=40))
def test_any_words_give_messages_and_diagnostics(words):
    source = Source(name="test.idl", text="module p { struct T { " + " ".join(words))
    messages, wrong = read_idl(source, lambda path: source)
    assert wrong or messages
