"""Definitions of ROS 1, and what ``rosmsg-proto msg`` of rosmsg 1.15.15 prints for them.

`test_example_is_that_of_rosmsg_proto` compares the outputs with the tool, where it is installed.
"""

from __future__ import annotations

__all__ = ["EXAMPLES"]

# Each row changes the YAML style of another part.
EXAMPLES: dict[str, tuple[str, str]] = {
    "p/Plain": (
        "int32 a\nfloat32 b\nstring c\nbool d\n",
        """\
a: 0
b: 0.0
c: ''
d: false""",
    ),
    "p/Five": (
        "int32 a\nfloat32 b\nstring c\nbool d\nuint8 e\n",
        "{a: 0, b: 0.0, c: '', d: false, e: 0}",
    ),
    "p/Times": (
        "time t\nduration d\ntime[] ts\nduration[2] ds\nHeader header\nHeader[] own\n",
        """\
t: {secs: 0, nsecs: 0}
d: {secs: 0, nsecs: 0}
ts:
- data: {secs: 0, nsecs: 0}
ds:
- {secs: 0, nsecs: 0}
- {secs: 0, nsecs: 0}
header:
  seq: 0
  stamp: {secs: 0, nsecs: 0}
  frame_id: ''
own:
- {mine: ''}""",
    ),
    "p/Durations": (
        "duration[] a\ntime[2] b\n",
        """\
a:
- data:
    secs: 0
    nsecs: 0
b:
- secs: 0
  nsecs: 0
- secs: 0
  nsecs: 0""",
    ),
    "p/Header": (
        "string mine\n",
        "mine: ''",
    ),
    "p/Bytes": (
        "uint8[] a\nchar[] b\nuint8[3] c\nchar[70] d\nbyte[] e\nint8[2] f\n",
        """\
a: !!binary ""
b: !!binary ""
c: !!binary |
  AAAA
d: !!binary |
  AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA
  AAAAAAAAAAAAAAAAAA==
e: [0]
f: [0, 0]""",
    ),
    "p/Packed": (
        "uint8[9] a\nchar[] b\nPlain c\n",
        """\
a: !!binary |
  AAAAAAAAAAAA
b: !!binary ""
c:
  a: 0
  b: 0.0
  c: ''
  d: false""",
    ),
    "p/FiveWithBytes": (
        "uint8[3] a\nint8 b\nint8 c\nint8 d\nint8 e\n",
        """\
a: !!binary |
  AAAA
b: 0
c: 0
d: 0
e: 0""",
    ),
    "p/Lists": (
        "float64[] a\nstring[] b\nbool[] c\nstring[2] d\nfloat32[4] e\n",
        """\
a: [0]
b: ['']
c: [false]
d: ['', '']
e: [0.0, 0.0, 0.0, 0.0]""",
    ),
    "p/Long": (
        "int8 a\nfloat32[5] b\nPlain c\n",
        """\
a: 0
b: [0.0, 0.0, 0.0, 0.0, 0.0]
c: {a: 0, b: 0.0, c: '', d: false}""",
    ),
    "p/Short": (
        "int8 a\nfloat32[4] b\nPlain c\n",
        """\
a: 0
b:
- 0.0
- 0.0
- 0.0
- 0.0
c:
  a: 0
  b: 0.0
  c: ''
  d: false""",
    ),
    "p/LongLast": (
        "Plain a\nPlain b\nLong c\n",
        """\
a:
  a: 0
  b: 0.0
  c: ''
  d: false
b:
  a: 0
  b: 0.0
  c: ''
  d: false
c:
  a: 0
  b: [0.0, 0.0, 0.0, 0.0, 0.0]
  c: {a: 0, b: 0.0, c: '', d: false}""",
    ),
    "p/Messages": (
        "Plain[] a\nPlain[2] b\nFive[] c\nPlain[] d\n",
        """\
a:
- a: 0
  b: 0.0
  c: ''
  d: false
b:
- a: 0
  b: 0.0
  c: ''
  d: false
- a: 0
  b: 0.0
  c: ''
  d: false
c:
- {a: 0, b: 0.0, c: '', d: false, e: 0}
d:
- {a: 0, b: 0.0, c: '', d: false}""",
    ),
    "p/None": (
        "",
        "{}",
    ),
    "p/Nones": (
        "None a\nNone[] b\nNone[2] c\n",
        """\
a: {}
b:
- {}
c:
- {}
- {}""",
    ),
    "p/Nested": (
        "Messages[] a\nNones[] b\nTimes c\nint8 x\nint8 y\n",
        """\
a:
- a:
  - {a: 0, b: 0.0, c: '', d: false}
  b:
  - {a: 0, b: 0.0, c: '', d: false}
  - {a: 0, b: 0.0, c: '', d: false}
  c:
  - {a: 0, b: 0.0, c: '', d: false, e: 0}
  d:
  - {a: 0, b: 0.0, c: '', d: false}
b:
- a: {}
  b:
  - {}
  c:
  - {}
  - {}
c:
  t: {secs: 0, nsecs: 0}
  d: {secs: 0, nsecs: 0}
  ts:
  - data: {secs: 0, nsecs: 0}
  ds:
  - {secs: 0, nsecs: 0}
  - {secs: 0, nsecs: 0}
  header:
    seq: 0
    stamp: {secs: 0, nsecs: 0}
    frame_id: ''
  own:
  - {mine: ''}
x: 0
y: 0""",
    ),
    "p/Constants": (
        "int8 A=1\nstring B=x\nint8 a\n",
        "a: 0",
    ),
    "p/Names": (
        "float64 y\nint8 on\nint8 null\nint8 x\n",
        """\
y: 0.0
'on': 0
'null': 0
x: 0""",
    ),
    "p/Python": (
        "int8 self\nint8 lambda\nint8 None\nint8 print\nint8 match\n",
        "{self_: 0, lambda_: 0, None_: 0, print: 0, match: 0}",
    ),
    "p/Folded": (
        "int8[60] numbers\nstring[40] texts\n",
        """\
numbers: [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
  0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
  0, 0, 0, 0, 0, 0, 0, 0, 0]
texts: ['', '', '', '', '', '', '', '', '', '', '', '', '', '', '', '', '', '', '',
  '', '', '', '', '', '', '', '', '', '', '', '', '', '', '', '', '', '', '', '',
  '']""",
    ),
}
