"""A header for C and C++: addresses, masks, the message as a struct, and how to exchange one."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import Any

from firm_hdl.model import Array, FieldType, Message, Primitive
from firm_hdl.names.identifiers import scope_names
from firm_hdl.registers.head import BODY_ADDRESS
from firm_hdl.registers.message import MessageMap, members_of, size_of
from firm_hdl.registers.table import RegisterMap

__all__ = ["c_header", "c_values", "table_c_header"]

_KEYWORDS = frozenset(
    "alignas alignof and and_eq asm auto bitand bitor bool break case catch char char8_t char16_t "
    "char32_t class co_await co_return co_yield compl concept const const_cast consteval constexpr "
    "constinit continue decltype default delete do double dynamic_cast else enum explicit export "
    "extern false float for friend goto if inline int long mutable namespace new noexcept not "
    "not_eq nullptr operator or or_eq private protected public register reinterpret_cast requires "
    "restrict return short signed sizeof static static_assert static_cast struct switch template "
    "this thread_local throw true try typedef typeid typename typeof typeof_unqual union unsigned "
    "using virtual void volatile wchar_t while xor xor_eq linux unix".split()
)
"""Keywords of C23 and C++23, and words that compilers define as 1 on Linux."""

_READ = """\
/* Read the newest message; return 0 if none came since the last call, and leave it as it is. */
static inline int {name}_receive(volatile uint32_t *registers, {type}_t *message)
{{
  uint32_t words[{words}];
  unsigned k;
  if (!(registers[{prefix}_STATUS / 4] & {prefix}_STATUS_NEW_MASK))
    return 0;
  registers[{prefix}_CONTROL / 4] = {prefix}_CONTROL_COMMIT_MASK;
  for (k = 0; k < {words}; k++)
    words[k] = registers[{prefix}_MESSAGE / 4 + k];
  memcpy(message, words, sizeof *message);
  return 1;
}}
"""

_WRITE = """\
/* Send a message; return 0, and send nothing, while the one before is still being taken. */
static inline int {name}_send(volatile uint32_t *registers, const {type}_t *message)
{{
  uint32_t words[{words}] = {{0}};
  unsigned k;
  if (registers[{prefix}_STATUS / 4] & {prefix}_STATUS_BUSY_MASK)
    return 0;
  memcpy(words, message, sizeof *message);
  for (k = 0; k < {words}; k++)
    registers[{prefix}_MESSAGE / 4 + k] = words[k];
  registers[{prefix}_CONTROL / 4] = {prefix}_CONTROL_COMMIT_MASK;
  return 1;
}}
"""

_CHECK = """\
/* Return whether these registers are those of this header. */
static inline int {name}_is(volatile const uint32_t *registers)
{{
  return registers[{prefix}_ID / 4] == {prefix}_ID_RESET
    && registers[{prefix}_VERSION / 4] >> 16 == {prefix}_VERSION_MAJOR_RESET
    && {same};
}}
"""

_FINGERPRINT = ("fingerprint_low", "fingerprint_high")


def c_header(layout: MessageMap, header: str = "") -> str:
    """Write the header of the registers of a message.

    * `header`: lines of the comment at the head.
    """
    name, prefix = layout.table.name, layout.table.name.upper()
    words = -(-layout.size // 4)
    exchange = _READ if layout.direction == "deserializer" else _WRITE
    message = [
        f"\n/* The message, from {prefix}_MESSAGE on. What has no fixed size is left out. */",
        f"#define {prefix}_MESSAGE {BODY_ADDRESS:#04x}",
        f"#define {prefix}_MESSAGE_WORDS {words}\n",
        f"#ifndef {layout.name.upper()}_T\n#define {layout.name.upper()}_T",
        "typedef struct {",
        *_members(layout.message, layout.shape, "  "),
        f"}} {layout.name}_t;\n",
        *_asserts(layout),
        "#endif\n",
    ]
    functions = exchange.format(name=name, type=layout.name, prefix=prefix, words=words)
    own = replace(
        layout.table,
        registers=tuple(each for each in layout.table.registers if each.address < BODY_ADDRESS),
    )
    return table_c_header(own, header, types=message, functions=functions)


def table_c_header(
    table: RegisterMap,
    header: str = "",
    *,
    types: Iterable[str] = (),
    same: Iterable[str] = _FINGERPRINT,
    functions: str = "",
) -> str:
    """Write a header of a table that begins with those of :mod:`firm_hdl.registers.head`.

    * `header`: lines of the comment at the head.
    * `types`: lines of C behind the addresses.
    * `same`: constants of 32 bits that tell whether the registers are those of the header.
    * `functions`: C behind the function ``NAME_is``.
    """
    name, prefix = table.name, table.name.upper()
    comment = "".join(f" * {_plain(line)}".rstrip() + "\n" for line in header.splitlines())
    compared = "\n    && ".join(
        f"registers[{prefix}_{each} / 4] == {prefix}_{each}_RESET" for each in map(str.upper, same)
    )
    return "\n".join(
        [
            f"/*\n{comment} *\n * {_plain(table.meaning)}\n */\n",
            f"#ifndef {prefix}_H\n#define {prefix}_H\n",
            "#include <stddef.h>\n#include <stdint.h>\n#include <string.h>\n",
            "/* Addresses in bytes; of a field its mask, its lowest bit, and its reset value. */",
            *_defines(table, prefix),
            *types,
            _CHECK.format(name=name, prefix=prefix, same=compared),
            functions,
            "#endif\n",
        ]
    )


def _defines(table: RegisterMap, prefix: str) -> Iterator[str]:
    for register in table.registers:
        base = f"{prefix}_{register.name.upper()}"
        yield f"#define {base} {register.address:#04x}  /* {_plain(register.meaning)} */"
        for field in register.fields:
            alone = field.name == register.name
            each = base if alone else f"{base}_{field.name.upper()}"
            if not alone:
                mask = ((1 << field.bits) - 1) << field.low
                yield f"#define {each}_MASK {mask:#x}u  /* {_plain(field.meaning)} */"
                yield f"#define {each}_SHIFT {field.low}"
            if field.kind == "constant" or field.reset:
                yield f"#define {each}_RESET {field.reset:#x}u"


def _members(message: Message, shape: Any, indent: str) -> Iterator[str]:
    found = list(members_of(message, shape))
    names = scope_names(name for name, _, _ in found)
    for name, kind, part in found:
        yield from _member(kind, part, _word(names[name]), indent)


def _member(kind: FieldType, shape: Any, declared: str, indent: str) -> Iterator[str]:
    if isinstance(kind, Array):
        yield from _member(kind.element, shape.elem_shape, f"{declared}[{kind.count}]", indent)
    elif isinstance(kind, Primitive):
        yield f"{indent}{_type(kind)} {declared};"
    else:
        assert isinstance(kind, Message)
        yield f"{indent}struct {{"
        yield from _members(kind, shape, f"{indent}  ")
        yield f"{indent}}} {declared};"


def c_values(layout: MessageMap) -> Iterator[tuple[str, Primitive]]:
    """Yield each value of the struct: what selects it in C, such as ``linear.x``, and its type."""
    return _values(layout.message, layout.shape, "")


def _values(kind: FieldType, shape: Any, name: str) -> Iterator[tuple[str, Primitive]]:
    if isinstance(kind, Array):
        for index in range(kind.count):
            yield from _values(kind.element, shape.elem_shape, f"{name}[{index}]")
    elif isinstance(kind, Primitive):
        yield name, kind
    else:
        assert isinstance(kind, Message)
        found = list(members_of(kind, shape))
        names = scope_names(each for each, _, _ in found)
        for each, inner, part in found:
            yield from _values(inner, part, f"{name}.{_word(names[each])}".lstrip("."))


def _type(kind: Primitive) -> str:
    if kind.kind == "float":
        return {4: "float", 8: "double"}[kind.bytes]
    # A bool is a byte that is 0 or 1; C's own type need not be.
    return f"{'' if kind.signed else 'u'}int{8 * kind.bytes}_t"


def _asserts(layout: MessageMap) -> Iterator[str]:
    """Yield what a compiler has to agree with: addresses of the first level, and the size."""
    name = layout.name
    yield "#if defined(__cplusplus) ? __cplusplus >= 201103L : __STDC_VERSION__ >= 201112L"
    yield "#ifdef __cplusplus"
    yield f"#define {name.upper()}_CHECK(condition) static_assert(condition, #condition)"
    yield "#else"
    yield f"#define {name.upper()}_CHECK(condition) _Static_assert(condition, #condition)"
    yield "#endif"
    check = f"{name.upper()}_CHECK"
    found = list(members_of(layout.message, layout.shape))
    names = scope_names(each for each, _, _ in found)
    first = {item.path[0]: item.address for item in reversed(layout.items)}
    for each, _, _ in found:
        yield f"{check}(offsetof({name}_t, {_word(names[each])}) == {first[each]});"
    size, _ = size_of(layout.message, layout.shape)
    yield f"{check}(sizeof({name}_t) == {size});"
    yield "#endif"


def _word(name: str) -> str:
    return f"{name}_" if name in _KEYWORDS else name


def _plain(text: str) -> str:
    """Return a text that ends no comment of C."""
    return text.replace("*/", "* /")
