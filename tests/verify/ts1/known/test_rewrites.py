"""Lines that entries of the table of known differences rewrite, and lines that they leave.

The entries are called directly. Tests with ROS's readers check that the readers then agree.
"""

from __future__ import annotations

import pytest

from tests.verify.ts1.known.rewriting import hidden, numbered, rewritten

# After each line, there is another line that must change, or one that must not.
MSG = [
    # key, dialect, before, after
    ("rosbags-crlf", "ros2", "int8 a\r\nint8 b\rint8 c\n\r\n", "int8 a\nint8 b\nint8 c\n\n"),
    (
        "rosbags-wstring",
        "ros2",
        "wstring a\nstring b\nwstring<=3[<=2] c\nwstring[4] d # wstring e\np/wstringy f",
        "string a\nstring b\nstring<=3[<=2] c\nstring[4] d # wstring e\np/wstringy f",
    ),
    (
        "rosbags-special-types",
        "ros2",
        "time a\nduration[] b\nHeader c\nHeader[2] d\nint8 e\nstd_msgs/Header f",
        "p/time a\np/duration[] b\np/Header c\np/Header[2] d\nint8 e\nstd_msgs/Header f",
    ),
    (
        "rosbags-special-types",
        "ros1",
        "time a\nduration[] b\nHeader c\nHeader[2] d\nHeader[] e\nTime f",
        "time a\nduration[] b\nHeader c\np/Header[2] d\np/Header[] e\nTime f",
    ),
    (
        "rosbags-constant-names",
        "ros1",
        "int8 b=1\nint8 b\nint8 B=1\nint8 B_2C=1\nint8 B__C=1\nint8 a-b=1\nint8 low = 2",
        "int8 RENAMED62=1\nint8 b\nint8 B=1\nint8 B_2C=1\nint8 RENAMED425F5F43=1\nint8 a-b=1\n"
        "int8 RENAMED6C6F77 = 2",
    ),
    (
        "rosbags-constant-names",
        "ros1",
        "int8 B_=1\nint8 _B=1\nint8 B2=1\nint8 2B=1\nint8 aB=1\nint8 Ba=1",
        "int8 RENAMED425F=1\nint8 RENAMED5F42=1\nint8 B2=1\nint8 2B=1\nint8 RENAMED6142=1\n"
        "int8 RENAMED4261=1",
    ),
    (
        "rosbags-placeholders",
        "ros2",
        "uint8 structure_needs_at_least_one_member\nuint8 b",
        "uint8 structure_has_one_more_member\nuint8 b",
    ),
    (
        "rosbags-placeholders",
        "ros2",
        "uint8 structure_needs_at_least_one_member=1",
        "uint8 structure_needs_at_least_one_member=1",
    ),
    # In ROS 1, a string is the rest of the line; in ROS 2, it has quotes, and a comment may follow.
    (
        "rosbags-texts",
        "ros1",
        'string A=  7 # "x"  \nint8 B=7\nstring c\nstring D=a\\b\nstring e 7',
        f'string A=  "7 # {hidden(chr(34))}x{hidden(chr(34))}"\nint8 B=7\nstring c\n'
        f'string D="a{hidden(chr(92))}b"\nstring e 7',
    ),
    (
        "rosbags-texts",
        "ros2",
        "string A='7' # x\nstring B=7\nstring C=\"it's\"\nstring D='a\\'b'\nstring E='a'b'\n"
        "string F='7\nwstring G=7\nint8 H=7",
        f'string A="7"\nstring B="7"\nstring C="it{hidden(chr(39))}s"\n'
        f'string D="a{hidden(chr(39))}b"\nstring E=\'a\'b\'\nstring F="{hidden(chr(39))}7"\n'
        'wstring G="7"\nint8 H=7',
    ),
    (
        "rosbags-texts",
        "ros2",
        "string a 7\nstring b\nstring c # 7\nstring[] d ['7']\nstring<=3 e '7'\nint8 f 7",
        'string a "7"\nstring b\nstring c # 7\nstring[] d [\'7\']\nstring<=3 e "7"\nint8 f 7',
    ),
    (
        "rosbags-integers",
        "ros2",
        "int8 A=010 # x\nint64 b 1_000\nuint8 C=0o17\nint8[] d [010]\nfloat32 e 010\nuint8 F=0x10\n"
        "uint8 G=0X1_0\nint8 H=-007\nbyte I=010\nchar J=+5\nint8 K=x7\nint8 L=a",
        "int8 A=10 # x\nint64 b 1000\nuint8 C=15\nint8[] d [010]\nfloat32 e 010\nuint8 F=0x10\n"
        "uint8 G=0X1_0\nint8 H=-7\nbyte I=10\nchar J=5\nint8 K=x7\nint8 L=a",
    ),
    (
        "rosbags-integers",
        "ros1",
        "int8 A=010 # x\nint64 B=1_000\nuint8 C=0o17\nuint8 D=0b1",
        "int8 A=10 # x\nint64 B=1000\nuint8 C=0o17\nuint8 D=0b1",
    ),
    (
        "rosbags-floats",
        "ros2",
        "float32 A=1 # x\nfloat64 b 1_0\nfloat32 C=1.\nfloat32 D=.5\nfloat32 E=1e3\n"
        "float32 F=-1.5E-3\nfloat32 G=inf\nint8 H=1\nfloat32[] i [1]\nfloat64 J=1.5x\n"
        "float32 K=-.5\nfloat32 L=+.5e1",
        "float32 A=1.0 # x\nfloat64 b 10.0\nfloat32 C=1.\nfloat32 D=.5\nfloat32 E=1e3\n"
        "float32 F=-1.5E-3\nfloat32 G=inf\nint8 H=1\nfloat32[] i [1]\nfloat64 J=1.5x\n"
        "float32 K=-0.5\nfloat32 L=5.0",
    ),
    (
        "rosbags-char-hash",
        "ros2",
        "char a\nchar[] b\nchar[<=3] c\nbyte d\nchar E=1\np/char f",
        "uint8 a\nuint8[] b\nuint8[<=3] c\nbyte d\nuint8 E=1\np/char f",
    ),
    # Lines that rosbags accepts and ROS refuses.
    (
        "rosbags-names",
        "ros2",
        "int8 aB\nint8 b=1\nint8 a__b\nint8 a_\nint8 _a\nint8 a2_b\nint8 a-b\nint8 2a\nint8 A_B=1\n"
        "int8 A__B=1\nint8 A_=1\nint8 ok",
        "int8 renamed6142\nint8 RENAMED62=1\nint8 renamed615f5f62\nint8 renamed615f\nint8 _a\n"
        "int8 a2_b\nint8 a-b\nint8 2a\nint8 A_B=1\nint8 RENAMED415F5F42=1\nint8 RENAMED415F=1\n"
        "int8 ok",
    ),
    (
        "rosbags-twice",
        "ros2",
        "int8 a\nint8 A=1\nint8 a\nint8 a\nint8 A=2\nint8 b\nint8 b # a",
        "int8 a\nint8 A=1\nint8 atwice2\nint8 atwice3\nint8 ATWICE2=2\nint8 b\nint8 btwice2 # a",
    ),
    (
        "rosbags-twice",
        "ros1",
        "int8 a\nint8 A=1\nint8 a\nint8 A=2\nint8 A=3",
        "int8 a\nint8 A=1\nint8 atwice2\nint8 A=2\nint8 A=3",
    ),
    (
        "rosbags-sizes",
        "ros2",
        "int8[0] a\nint8[<=0] b\nstring<=0 c\nint8[3] d\nint8[+2] e\nint8[-2] f\nstring<=0[0] g\n"
        "int8[] h\nint8[00] i\nint8[1] j",
        "int8[1] a\nint8[<=1] b\nstring<=1 c\nint8[3] d\nint8[+2] e\nint8[1] f\nstring<=1[1] g\n"
        "int8[] h\nint8[1] i\nint8[1] j",
    ),
    (
        "rosbags-sizes",
        "ros1",
        "int8[0] a\nint8[3] b\nint8[+2] c\nint8[-2] d",
        "int8[1] a\nint8[3] b\nint8[1] c\nint8[1] d",
    ),
    (
        "rosbags-ros2-forms",
        "ros1",
        "string<=3 a\nint8[<=2] b\nint8 c 7 # x\nint8 d 7\nint8 E=7 # x\nint8 f # x\nint8 g",
        "string a\nint8[] b\nint8 c# x\nint8 d\nint8 E=7 # x\nint8 f # x\nint8 g",
    ),
    ("rosbags-blanks", "ros2", "  int8 a\n\tint8\tb\nint8 c", "int8 a\nint8\tb\nint8 c"),
    ("rosbags-blanks", "ros1", "  int8 a\n\tint8\t\tb\nint8 c", "  int8 a\n\tint8  b\nint8 c"),
    (
        "rosbags-annotations",
        "ros2",
        "@key\nint8 a\n @final \nint8 b\n@\n@K\nint8 c @key\n@end",
        "int8 a\nint8 b\n@\n@K\nint8 c @key\n",
    ),
    # genmsg and rosidl.
    (
        "ros1-indented-texts",
        "ros1",
        "  string A=1\n  int8 B=1\n  string c\nstring D=2\n\tstring E=3",
        "string A=1\n  int8 B=1\n  string c\nstring D=2\nstring E=3",
    ),
    (
        "ascii-only",
        "ros1",
        "int8 \u0661\nstring A=\u0661\nstring\u2003B =\u0661\nint8 caf\xe9 # caf\xe9\nint8 \u20ac\n"
        "int8 D=\u0664\u0665",
        "int8 1\nstring A=\u0661\nstring B =\u0661\nint8 cafxe9 # caf\xe9\nint8 \u20ac\nint8 D=45",
    ),
    (
        "ros1-constant-names",
        "ros1",
        "int8 a b=1\nint8 a1=1\nint8  a-b =2 # c=3\nint8 a # b c=1\nint8 a-b\nint8 1=2\n"
        "int8 \xe9=1",
        "int8 RENAMED612062=1\nint8 a1=1\nint8  RENAMED612D62 =2 # c=3\nint8 a # b c=1\nint8 a-b\n"
        "int8 RENAMED31=2\nint8 RENAMEDC3A9=1",
    ),
    (
        "ros1-bool-literals",
        "ros1",
        "bool A=[]\nbool B='x' # y\nbool C=True\nbool D=False\nbool E=x\nint8 F=[]\nbool g []\n"
        "bool H=0\nbool I=2",
        "bool A=False\nbool B=True # y\nbool C=True\nbool D=False\nbool E=x\nint8 F=[]\nbool g []\n"
        "bool H=False\nbool I=True",
    ),
    (
        "ros1-64-bit-limits",
        "ros1",
        "int64 A=9223372036854775808 # x\nuint64 B=18446744073709551616\n"
        "int64 C=9223372036854775807\n"
        "int64 D=9223372036854775809\nuint64 E=9223372036854775808\nint64 F=x\nint64 G=-1\n"
        "int32 H=9223372036854775808\nint64 i 9223372036854775808\nuint64 J=18446744073709551617",
        "int64 A=9223372036854775807 # x\nuint64 B=18446744073709551615\n"
        "int64 C=9223372036854775807\n"
        "int64 D=9223372036854775809\nuint64 E=9223372036854775808\nint64 F=x\nint64 G=-1\n"
        "int32 H=9223372036854775808\nint64 i 9223372036854775808\nuint64 J=18446744073709551617",
    ),
    (
        "ros1-empty-arrays",
        "ros1",
        "int8[0] a\nint8[00] b\nint8[10] c\nint8[] d\nint8 e[0]",
        "int8[1] a\nint8[1] b\nint8[10] c\nint8[] d\nint8 e[0]",
    ),
    (
        "sizes-of-32-bits",
        "ros2",
        "int8[4294967295] a\nint8[4294967296] b\nint8[<=99999999999] c\nstring<=4294967296[<=5] d\n"
        "int8 E=4294967296\nstring<=4294967296[4294967297] f",
        "int8[4294967295] a\nint8[4294967295] b\nint8[<=4294967295] c\nstring<=4294967295[<=5] d\n"
        "int8 E=4294967296\nstring<=4294967295[4294967295] f",
    ),
    (
        "ros2-escaped-quotes",
        "ros2",
        "string[] a ['x\\'y', \"z\\\"w\"] # '\\''\nstring b 'x\\'y'\nstring[] C=['\\'']\n"
        "int8[] d ['\\'']\nwstring[] e ['\\'']\nstring[] f [\\'a]",
        f"string[] a ['x{hidden(chr(39))}y', \"z{hidden(chr(34))}w\"] # '\\''\nstring b 'x\\'y'\n"
        f"string[] C=['\\'']\nint8[] d ['\\'']\nwstring[] e ['{hidden(chr(39))}']\n"
        "string[] f [\\'a]",
    ),
    (
        "ros2-backslashes",
        "ros2",
        "string a 'x\\y\\'z' # \\n\nint8 B=\\n\nwstring C=\"\\n\\\"\"\nstring[] d ['\\t']",
        f"string a 'x{hidden(chr(92))}y\\'z' # \\n\nint8 B=\\n\n"
        f'wstring C="{hidden(chr(92))}n\\""\n'
        f"string[] d ['{hidden(chr(92))}t']",
    ),
    (
        "ros2-infinite-numbers",
        "ros2",
        "float32 A=inf # inf\nfloat64 B=-inf\nfloat32 C=nan\nfloat32[] d [inf, -nan,1.5]\n"
        "string E=inf\n"
        "float32 F=1e999\nfloat32 G=1.5\nfloat32 H=x\nfloat32 I=-1e999",
        "float32 A=1.25e300 # inf\nfloat64 B=-1.25e300\nfloat32 C=1.75e300\n"
        "float32[] d [1.25e300, -1.75e300,1.5]\nstring E=inf\nfloat32 F=1.25e300\nfloat32 G=1.5\n"
        "float32 H=x\nfloat32 I=-1.25e300",
    ),
]


def values(dialect, lines):
    return [("rosbags-values", dialect, before, after) for before, after in lines]


MSG += values(
    "ros2",
    [
        ("int8 A=127", "int8 A=127"),
        ("int8 A=128 # x", "int8 A=0 # x"),
        ("int8 A=-128", "int8 A=-128"),
        ("int8 A=-129", "int8 A=0"),
        ("uint8 A=255", "uint8 A=255"),
        ("uint8 A=256", "uint8 A=0"),
        ("uint8 A=-1", "uint8 A=0"),
        ("byte A=255", "byte A=255"),
        ("byte A=-1", "byte A=0"),
        ("char A=255", "char A=255"),
        ("char A=256", "char A=0"),
        ("int64 A=x", "int64 A=0"),
        ("uint16 A=65536", "uint16 A=0"),
        ("uint32 A=4294967295", "uint32 A=4294967295"),
        ("float32 A=x", "float32 A=0.0"),
        ("float64 A=x", "float64 A=0.0"),
        ("float32 A=1e3", "float32 A=1e3"),
        ("bool A=x", "bool A=false"),
        ("bool A=2", "bool A=false"),
        ("bool A=1", "bool A=1"),
        ("bool A=0", "bool A=0"),
        ("bool A=TRUE", "bool A=TRUE"),
        ("bool A=False", "bool A=False"),
        ("string A=x", "string A=x"),
        ("Other A=x", "Other A=x"),
        # Invalid defaults are removed; a comment stays.
        ("int8 a 128 # x", "int8 a# x"),
        ("int8 a 128", "int8 a"),
        ("int8 a 127 # x", "int8 a 127 # x"),
        ("int8 a # 128", "int8 a # 128"),
        ("Other a 1", "Other a"),
        ("p/Other[] a [1]", "p/Other[] a"),
        ("string<=3 a 'abc'", "string<=3 a 'abc'"),
        ("string<=3 a 'abcd'", "string<=3 a"),
        ("string<=3 a abcd", "string<=3 a"),
        ("string a 'abcd'", "string a 'abcd'"),
        ("int8[2] a [1, 2]", "int8[2] a [1, 2]"),
        ("int8[2] a [1]", "int8[2] a"),
        ("int8[2] a [1, 2, 3]", "int8[2] a"),
        ("int8[<=2] a [1]", "int8[<=2] a [1]"),
        ("int8[<=2] a [1, 2]", "int8[<=2] a [1, 2]"),
        ("int8[<=2] a [1, 2, 3]", "int8[<=2] a"),
        ("int8[] a [1, 2, 3]", "int8[] a [1, 2, 3]"),
        ("int8[] a []", "int8[] a []"),
        ("int8[1] a []", "int8[1] a"),
        ("int8[] a [1, 128]", "int8[] a"),
        ("int8[] a [128, 1]", "int8[] a"),
        ("int8[] a 1", "int8[] a"),
        ("int8[] a [1", "int8[] a"),
        ("int8[] a 1]", "int8[] a"),
        ("bool[] a [true, 2]", "bool[] a"),
        ("string[2] a ['x']", "string[2] a ['x']"),
    ],
)
MSG += values(
    "ros1",
    [
        ("int8 A=128", "int8 A=0"),
        ("byte A=-128", "byte A=-128"),
        ("byte A=128", "byte A=0"),
        ("char A=255", "char A=255"),
        ("char A=-1", "char A=0"),
        ("int8 A=0x1", "int8 A=0"),
        ("bool A=x", "bool A=False"),
        ("bool A=true", "bool A=False"),
        ("bool A=True", "bool A=True"),
        ("bool A=False", "bool A=False"),
        ("bool A=7", "bool A=7"),
        ("bool A=0x7", "bool A=0x7"),
        ("int8 a 128", "int8 a 128"),
    ],
)


@pytest.mark.parametrize(("key", "dialect", "before", "after"), numbered(MSG))
def test_rewriting_lines(key, dialect, before, after):
    assert rewritten(key, before, dialect=dialect) == after
