"""Attacks by definitions, and by folders of packages."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from tests.attacks.table import Attack, files

__all__ = ["definition_attacks"]

STRUCT = "module p { module msg { struct A { long a; }; }; };"
NAMED = b"<package><name>p</name></package>"
ONCE = ("build", "plan", "info", "cover", "verify", "prove")
MSG, IDL = "src/p/msg/A.msg", "src/p/msg/A.idl"
PATH = ("--path", "src")
# Each text is wrong, expensive to read, or both.
TEXTS: dict[str, str | bytes] = {
    "empty": "",
    "blank": "\n\n \t\n",
    "nul": "int8 a\x00b\n",
    "not_utf8": b"int8 a # \xff\n",
    "utf16": "int8 a\n".encode("utf-16"),
    "byte_order_mark": b"\xef\xbb\xbfint8 a\n",
    "half_a_character": b"int8 a # \xe2\x82",
    "control": "int8 \x1b[2J\n",
    "carriage_returns": "int8 a\rint8 b\r",
    "no_name": "int8\n",
    "no_type": "= 3\n",
    "huge_bound": f"string<={10**40} a\n",
    "huge_array": f"int8[{10**40}] a\n",
    "digits_bound": f"int8[{'9' * 5000}] a\n",
    "digits_constant": f"int64 A={'9' * 5000}\n",
    "digits_default": f"int64 a {'9' * 5000}\n",
    "digits_float": f"float64 A={'9' * 5000}\n",
    "exponent": "float64 A=1e999999999\n",
    "integer_exponent": "int64 A=1e999999999\n",
    "hex": f"int64 A=0x{'f' * 5000}\n",
    "nan": "float64 A=nan\nfloat64 B=inf\n",
    "surrogate": 'string A="\\ud800"\n',
    "bad_escape": 'string A="\\x"\n',
    "open_quote": 'string A="abc\n',
    "open_list": "int8[] a [1, 2\n",
    "deep_list": f"int8[] a {'[' * 5000}\n",
    "many_brackets": f"int8{'[]' * 3000} a\n",
    "long_name": f"int8 {'a' * 100_000}\n",
    "long_type": f"{'A' * 100_000} a\n",
    "long_line": f"int8 a # {'x' * 1_000_000}\n",
    "thousand_mistakes": "int8\n" * 1000,
    "thousand_unknown": "".join(f"Typ{n} f{n}\n" for n in range(1000)),
    "same_name": "int8 a\n" * 500,
    "itself": "A a\n",
    "path": "../../etc/passwd a\n",
    "slashes": "a/b/c/d e\n",
    "percent": "int8 %s%n{0}\n",
    "separator": "int8 a\n---\nint8 b\n",
    "bad_field": "int8 __class__\n",
    "keyword": "int8 final\nint8 self\nint8 signal\n",
    "every_byte": bytes(range(256)),
    "long_string": f'string A="{"x" * 200_000}"\n',
    "largest_array": "uint8[4294967295] a\n",
    "largest_float_array": "float64[4294967295] a\n",
    "largest_strings": "string[4294967295] a\n",
    "kilobytes": "uint8[20000] a\n",
}
IDLS: dict[str, str | bytes] = {
    "empty": "",
    "no_end": "module p { module msg { struct A {",
    "deep_modules": "module a { " * 3000,
    "deep_parentheses": "module p { const long A = " + "(" * 3000 + "1" + ")" * 3000 + "; };",
    "deep_sequences": "module p { module msg { struct A { " + "sequence<" * 2000,
    "shift": "module p { const long long A = 1 << 99999999999; };",
    "power": "module p { const long long A = " + " * ".join(["99999999999"] * 3000) + "; };",
    "by_zero": "module p { const long A = 1 / 0; const long B = 1 % 0; };",
    "digits": f"module p {{ const long A = {'9' * 5000}; }};",
    "float_digits": f"module p {{ const double A = {'9' * 5000}.0; }};",
    "includes_itself": f'#include "p/msg/A.idl"\n{STRUCT}',
    "includes_device": f'#include "/dev/zero"\n{STRUCT}',
    "includes_above": f'#include "p/../../x"\n{STRUCT}',
    "typedef_of_itself": "module p { typedef B B; };",
    "typedef_ring": "module p { typedef B C; typedef C B; };",
    "constant_ring": "module p { const long A = B; const long B = A; };",
    "open_comment": "module p { /* ",
    "open_string": 'module p { const string A = "abc',
    "characters": "module p { const char A = ''; const wchar B = L'\\uD800'; };",
    "octal": "module p { const long A = 09; };",
    "annotations": "@a(" * 1000,
    "not_utf8": b"module p { \xff };",
    "nul": "module p { \x00 };",
    "two_structs": "module p { module msg { struct A { long a; }; struct B { long b; }; }; };",
    "array_of_zero": "module p { module msg { struct A { long a[0]; }; }; };",
    "array_of_much": f"module p {{ module msg {{ struct A {{ long a[{10**30}]; }}; }}; }};",
}
COMMANDS = ("show", "info", "hash", "proto", "metrics", "cover")


def definition_attacks() -> Iterator[Attack]:
    """Yield the attacks of this kind."""
    order = sorted(TEXTS)
    for number, name in enumerate(order):
        # Not every text with every command: all commands read texts with the same code.
        for command in ("plan", COMMANDS[number % len(COMMANDS)]):
            yield Attack(
                name=f"msg_{name}_{command}",
                argv=(command, "p/A", *PATH),
                make=files({MSG: TEXTS[name]}),
            )
        yield Attack(
            name=f"msg_{name}_noetic",
            argv=("proto" if number % 2 else "md5", "p/A", "--distro", "noetic", *PATH),
            make=files({MSG: TEXTS[name]}),
        )
    for name, text in IDLS.items():
        yield Attack(name=f"idl_{name}", argv=("plan", "p/A", *PATH), make=files({IDL: text}))
    yield from _trees()
    yield from _folders()
    yield from _packages()
    yield from _paths()


def _trees() -> Iterator[Attack]:
    boom = {
        f"src/p/msg/T{level}.msg": "".join(f"T{level + 1} f{n}\n" for n in range(100))
        for level in range(7)
    }
    boom["src/p/msg/T7.msg"] = "float64 x\n"
    deep = {f"src/p/msg/T{level}.msg": f"T{level + 1} f\n" for level in range(480)}
    deep["src/p/msg/T480.msg"] = "float64 x\n"
    lists = {f"src/p/msg/T{level}.msg": f"T{level + 1}[] f\n" for level in range(480)}
    lists["src/p/msg/T480.msg"] = "float64 x\n"
    arrays = {f"src/p/msg/T{level}.msg": f"T{level + 1}[65535] f\n" for level in range(8)}
    arrays["src/p/msg/T8.msg"] = "float64 x\n"
    trees = {"boom": boom, "deep": deep, "lists": lists, "arrays": arrays}
    for name, tree in trees.items():
        others = (
            ("build", "plan", "info", "cover", "verify", "prove") if name == "boom" else ("plan",)
        )
        for command in ("show", "hash", "proto", "metrics", *others):
            yield Attack(
                name=f"tree_{name}_{command}", argv=(command, "p/T0", *PATH), make=files(tree)
            )
        yield Attack(
            name=f"tree_{name}_noetic",
            argv=("proto", "p/T0", "--distro", "noetic", *PATH),
            make=files(tree),
        )
        yield Attack(
            name=f"tree_{name}_golden",
            argv=("golden", "add", "golden", "p/T0", *PATH),
            make=files(tree),
            fails=True,
        )


def _folders() -> Iterator[Attack]:
    def fifo(name: str) -> Attack:
        def make(root: Path) -> None:
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            os.mkfifo(root / name)
            for other in (MSG, "src/p/package.xml"):
                if other != name:
                    (root / other).parent.mkdir(parents=True, exist_ok=True)
                    (root / other).write_text("int8 a\n" if other == MSG else "<a/>")

        return Attack(name=f"fifo_{Path(name).suffix[1:]}", argv=("plan", "p/A", *PATH), make=make)

    def sparse(name: str) -> Attack:
        def make(root: Path) -> None:
            files({MSG: "int8 a\n", name: b""})(root)
            os.truncate(root / name, 1 << 30)

        return Attack(
            name=f"sparse_{Path(name).suffix[1:]}",
            argv=("plan", "p/A", *PATH),
            make=make,
            fails=True,
        )

    def linked(name: str, target: str) -> Attack:
        def make(root: Path) -> None:
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).symlink_to(target)

        what = target.strip("/.").replace("/", "_")
        return Attack(name=f"link_to_{what}", argv=("plan", "p/A", *PATH), make=make, fails=True)

    yield fifo(MSG)
    yield fifo(IDL)
    yield fifo("src/p/package.xml")
    yield sparse(MSG)
    yield sparse("src/p/package.xml")
    for target in ("/dev/zero", "/dev/null", "/proc/self/mem", ".", "A.msg", "nowhere"):
        yield linked(MSG, target)


def _packages() -> Iterator[Attack]:
    for name, text in {
        "unknown_encoding": b'<?xml version="1.0" encoding="klingon"?>' + NAMED,
        "wide_encoding": b'<?xml version="1.0" encoding="utf-32"?>' + NAMED,
        "laughs": b'<!DOCTYPE a [<!ENTITY b "'
        + b"x" * 1000
        + b'"><!ENTITY c "'
        + b"&b;" * 1000
        + b'"><!ENTITY d "'
        + b"&c;" * 1000
        + b'">]><package><name>&d;</name></package>',
        "external": b'<!DOCTYPE a [<!ENTITY b SYSTEM "/etc/passwd">]>'
        + NAMED.replace(b"p<", b"&b;<"),
        "deep": b"<a>" * 100_000,
        "name_with_slash": b"<package><name>../p</name></package>",
        "binary": bytes(range(256)),
    }.items():
        yield Attack(
            name=f"package_{name}",
            argv=("plan", "p/A", *PATH),
            make=files({MSG: "int8 a\n", "src/p/package.xml": text}),
        )
    yield Attack(
        name="package_of_another_lives",
        argv=("plan", "q/B", *PATH),
        make=files(
            {
                MSG: "int8 a\n",
                "src/p/package.xml": '<?xml version="1.0" encoding="klingon"?><package/>',
                "src/q/msg/B.msg": "int8 b\n",
            }
        ),
        fails=False,
    )


def _paths() -> Iterator[Attack]:
    yield Attack(
        name="path_is_file", argv=("list", "--path", "x"), make=files({"x": ""}), fails=True
    )
    yield Attack(name="path_is_device", argv=("list", "--path", "/dev/null"), fails=True)
    yield Attack(name="path_is_empty", argv=("list", "--path", ""), fails=True)
    yield Attack(name="path_has_nul", argv=("list", "--path", "a\0b"), fails=True)
    yield Attack(name="path_is_long", argv=("list", "--path", "a" * 5000), fails=True)

    def loop(root: Path) -> None:
        files({MSG: "int8 a\n"})(root)
        (root / "src/loop").symlink_to("..")
        (root / "src/p/msg/loop").symlink_to("..")

    yield Attack(name="path_loops", argv=("plan", "p/A", *PATH), make=loop, fails=False)
