"""Ways to damage a text, for tests that feed damaged texts to something."""

from __future__ import annotations

import random
import re
from collections.abc import Callable

__all__ = ["MOST_CHARACTERS", "TOKEN", "WORDS", "mutate"]

# Close to the size of the largest real files.
MOST_CHARACTERS = 40_000

# Words with a meaning in some language, and values at limits.
# fmt: off
WORDS = [
    "int32", "uint64", "float64", "bool", "string", "wstring", "time", "duration", "byte", "char",
    "Header", "std_msgs/Header", "string<=", "[]", "[3]", "[<=3]", "[0]", "[4294967296]", "---",
    "#", "=", "\"", "'", "\\", "\t", "\r\n", "\x00", "\ufeff", "\u2028", "é", "0x10", "010", "-1",
    "1e999", "nan", "18446744073709551616", "9" * 5000, "[1, 2, 3]", "{", "}", "(", ")", "<", ">",
    ">>", "<<", "::", ";", ",", "@", "@default(value=", "@verbatim(language=\"comment\", text=\"",
    "module", "struct", "typedef", "const", "sequence<", "enum", "union", "long double", "#include",
    "TRUE", "L\"", "L'", "/*", "*/", "//", "~", "/ 0", "<< 63", "[2][3]", "\\u12", "\\xff",
    "structure_needs_at_least_one_member", "\"(1, 2)\"",
]
# fmt: on
TOKEN = re.compile(r"\w+|\s+|[^\w\s]")


# Each kind of damage takes the random numbers, the text, and another text of the same language.


def _flip(rng: random.Random, text: str, other: str) -> str:
    data = bytearray(text.encode("utf-8", "replace"))
    for _ in range(rng.choice((1, 1, 2, 8))):
        data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
    return data.decode("utf-8", "replace")


def _replace_bytes(rng: random.Random, text: str, other: str) -> str:
    data = bytearray(text.encode("utf-8", "replace"))
    start = rng.randrange(len(data))
    data[start : start + rng.choice((0, 1, 4))] = rng.randbytes(rng.choice((1, 2, 8)))
    return data.decode("utf-8", "replace")


def _swap_lines(rng: random.Random, text: str, other: str) -> str:
    lines = text.splitlines(keepends=True)
    a, b = rng.randrange(len(lines)), rng.randrange(len(lines))
    lines[a], lines[b] = lines[b], lines[a]
    return "".join(lines)


def _delete(rng: random.Random, text: str, other: str) -> str:
    start, end = _range(rng, text)
    return text[:start] + text[end:]


def _duplicate(rng: random.Random, text: str, other: str) -> str:
    start, end = _range(rng, text)
    return text[:end] + text[start:end] * rng.choice((1, 1, 2, 50, 5000)) + text[end:]


def _splice(rng: random.Random, text: str, other: str) -> str:
    start, end = _range(rng, text)
    from_, to = _range(rng, other or " ")
    return text[:start] + other[from_:to] + text[end:]


def _splice_token(rng: random.Random, text: str, other: str) -> str:
    tokens, others = TOKEN.findall(text), TOKEN.findall(other) or [" "]
    for _ in range(rng.choice((1, 1, 3))):
        tokens[rng.randrange(len(tokens))] = rng.choice(others)
    return "".join(tokens)


def _swap_tokens(rng: random.Random, text: str, other: str) -> str:
    tokens = TOKEN.findall(text)
    a, b = rng.randrange(len(tokens)), rng.randrange(len(tokens))
    tokens[a], tokens[b] = tokens[b], tokens[a]
    return "".join(tokens)


def _insert_word(rng: random.Random, text: str, other: str) -> str:
    tokens = TOKEN.findall(text)
    at = rng.randrange(len(tokens))
    word = rng.choice(WORDS) * rng.choice((1, 1, 1, 1, 2, 1000))
    tokens[at : at + rng.choice((0, 1))] = [word]
    return "".join(tokens)


def _range(rng: random.Random, text: str) -> tuple[int, int]:
    start = rng.randrange(len(text))
    return start, min(len(text), start + rng.choice((1, 2, 5, 20, 100, len(text))))


DAMAGES: tuple[Callable[[random.Random, str, str], str], ...] = (
    _flip,
    _replace_bytes,
    _swap_lines,
    _delete,
    _duplicate,
    _splice,
    _splice_token,
    _swap_tokens,
    _insert_word,
)


def mutate(rng: random.Random, text: str, other: str) -> str:
    """Damage a text a few times; `other` is a text to take pieces from."""
    for _ in range(rng.choice((1, 1, 1, 2, 3, 5))):
        if text.strip():
            text = rng.choice(DAMAGES)(rng, text, other)[:MOST_CHARACTERS]
    # A file is read as UTF-8, which has no surrogates.
    return text.encode("utf-8", "replace").decode("utf-8")
