"""Definitions printed in the format of ROS."""

from __future__ import annotations

import sys

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import Library, show

from .workspace import library, make_files


def test_rosmsg_show():
    # The output of rosmsg 1.15.15, less its last empty line.
    assert show(Library("noetic"), "sensor_msgs/NavSatFix") == (
        "uint8 COVARIANCE_TYPE_UNKNOWN=0\n"
        "uint8 COVARIANCE_TYPE_APPROXIMATED=1\n"
        "uint8 COVARIANCE_TYPE_DIAGONAL_KNOWN=2\n"
        "uint8 COVARIANCE_TYPE_KNOWN=3\n"
        "std_msgs/Header header\n"
        "  uint32 seq\n"
        "  time stamp\n"
        "  string frame_id\n"
        "sensor_msgs/NavSatStatus status\n"
        "  int8 STATUS_NO_FIX=-1\n"
        "  int8 STATUS_FIX=0\n"
        "  int8 STATUS_SBAS_FIX=1\n"
        "  int8 STATUS_GBAS_FIX=2\n"
        "  uint16 SERVICE_GPS=1\n"
        "  uint16 SERVICE_GLONASS=2\n"
        "  uint16 SERVICE_COMPASS=4\n"
        "  uint16 SERVICE_GALILEO=8\n"
        "  int8 status\n"
        "  uint16 service\n"
        "float64 latitude\n"
        "float64 longitude\n"
        "float64 altitude\n"
        "float64[9] position_covariance\n"
        "uint8 position_covariance_type\n"
    )


def test_rosmsg_show_keeps_the_text_of_constants_and_names_types_in_full(tmp_path):
    text = 'U[] a\nHeader h\nint8 X= +07 # c\nstring S = "#"\ntime[2] t\nint8[007] z'
    files = {"p/T": text, "p/U": "V v", "p/V": ""}
    assert show(library(tmp_path, files, "ros1"), "p/T") == (
        'int8 X=+07\nstring S="#"\np/U[] a\n  p/V v\nstd_msgs/Header h\n  uint32 seq\n'
        "  time stamp\n  string frame_id\ntime[2] t\nint8[007] z\n"
    )


NESTED = {
    # From ros2cli's own tests.
    "q/ShortVaried": "# A constant\nbool BOOL_CONST=true # Comment - Nesting Level 1: 1 of 2\n\n"
    "# Bool and array of bools\nbool bool_value\n"
    "bool[<=3] bool_values # Comment - Nesting Level 1: 2 of 2\n\n# Trailing comment\n",
    "q/ShortVariedNested": "# A short, varied type\n"
    "ShortVaried short_varied # Comment - Nesting Level 2: 1 of 1\n# Trailing comment\n",
    "q/ShortVariedMultiNested": "# A short, varied, and nested type\n"
    "ShortVariedNested short_varied_nested # Comment - Nesting Level 3: 1 of 1\n"
    "# Trailing comment\n",
}


def test_ros2_interface_show(tmp_path):
    assert show(library(tmp_path, NESTED), "q/ShortVariedMultiNested") == (
        "# A short, varied, and nested type\n"
        "ShortVariedNested short_varied_nested # Comment - Nesting Level 3: 1 of 1\n"
        "\tShortVaried short_varied\n"
        "\t\tbool BOOL_CONST=true\n"
        "\t\tbool bool_value\n"
        "\t\tbool[<=3] bool_values\n"
        "# Trailing comment\n"
    )


def test_ros2_interface_show_keeps_blanks_and_empty_lines_of_the_type_itself(tmp_path):
    files = {
        "p/T": "\n#\n\nint32   x  # c  \r\nU[<=2]\tu\n  # more\n\nU again\nU_Request r\n\n\n",
        "p/U": "#\n# c\n\nint8   a    # one [m]\n         # two\nint8 b 5 # x\n",
        "p/U_Request": "",
    }
    assert show(library(tmp_path, files), "p/T") == (
        "\n#\n\nint32   x  # c\nU[<=2]\tu\n\tint8   a\n\tint8 b 5\n  # more\n\n"
        "U again\n\tint8   a\n\tint8 b 5\nU_Request r\n\n\n"
    )


def test_signs_in_comments_make_no_constants_of_fields(tmp_path):
    files = {"p/T": "U a # a = b\nU b # c\nint8 X=1 # d = e\nU c", "p/U": "int8 x"}
    assert show(library(tmp_path, files), "p/T") == (
        "U a # a = b\n\tint8 x\nU b # c\n\tint8 x\nint8 X=1 # d = e\nU c\n\tint8 x\n"
    )


@pytest.mark.parametrize("distro", ["noetic", "lyrical"])
def test_empty_message_shows_nothing(distro):
    assert show(Library(distro), "std_msgs/Empty") == ""


def test_wrong_types_are_not_shown(tmp_path):
    with pytest.raises(DefinitionError):
        show(library(tmp_path, {"p/T": "T t"}), "p/T")
    with pytest.raises(DefinitionError):
        show(Library(), "p/T")


SERVICE = {
    "p/srv/S.srv": "# Asks.\nint8 X=1 # one\nq/U a  # [m]\n---\n# Answers.\n\nq/U[<=2] b\nint8 c\n",
    "q/msg/U.msg": "# u\nint8 x # comment\n",
}


def test_rossrv_show(tmp_path):
    texts = {name: text.replace("<=2", "2") for name, text in SERVICE.items()}
    library = Library("noetic", [make_files(tmp_path, texts)])
    # The output of rosmsg 1.15.15's `get_srv_text`.
    assert show(library, "p/S") == ("int8 X=1\nq/U a\n  int8 x\n---\nq/U[2] b\n  int8 x\nint8 c\n")
    assert show(library, "p/SResponse") == "q/U[2] b\n  int8 x\nint8 c\n"


def test_ros2_interface_show_of_a_service(tmp_path):
    library = Library("lyrical", [make_files(tmp_path, SERVICE)])
    assert show(library, "p/srv/S") == (
        "# Asks.\nint8 X=1 # one\nq/U a  # [m]\n\tint8 x\n---\n# Answers.\n\n"
        "q/U[<=2] b\n\tint8 x\nint8 c\n"
    )
    assert show(library, "p/srv/S_Response") == ("# Answers.\n\nq/U[<=2] b\n\tint8 x\nint8 c\n")
    assert show(library, "p/srv/S_Event").endswith(
        "S_Request[<=1] request\n\tint8 X=1\n\tq/U a\n\t\tint8 x\n"
        "S_Response[<=1] response\n\tq/U[<=2] b\n\t\tint8 x\n\tint8 c\n"
    )


@pytest.mark.parametrize("distro", ["noetic", "lyrical"])
def test_actions_are_shown(tmp_path, distro):
    text = "int8 a\n---\nstd_msgs/String b\n---\n# c\n"
    library = Library(distro, [make_files(tmp_path, {"p/action/A.action": text})])
    tail = "# c\n" if distro == "lyrical" else ""
    indent = "\t" if distro == "lyrical" else "  "
    assert show(library, "p/action/A") == (
        f"int8 a\n---\nstd_msgs/String b\n{indent}string data\n---\n{tail}"
    )


def test_idl_is_shown_as_msg(tmp_path):
    idl = """
        #include "q/msg/U.idl"
        module p { module msg {
          module T_Constants { @unit("s") const short LIMIT = 3; };
          @verbatim(language="comment", text="A type." "\\n\\n  More. ")
          struct T {
            @verbatim(language="comment", text="Of x.") @unit(value="m") @default(value=2.5)
            double x;
            sequence<q::msg::U, 4> us;
            string<5> s;
          };
        }; };
    """
    files = {"p/msg/T.idl": idl, "q/msg/U.msg": SERVICE["q/msg/U.msg"], "p/msg/V.msg": "T[2] t # v"}
    library = Library("lyrical", [make_files(tmp_path, files)])
    assert show(library, "p/msg/T") == (
        "# A type.\n#\n# More.\nint16 LIMIT=3  # [s]\n# Of x.\nfloat64 x 2.5  # [m]\n"
        "q/U[<=4] us\n\tint8 x\nstring<=5 s\n"
    )
    assert show(library, "p/msg/V") == (
        "T[2] t # v\n\tint16 LIMIT=3\n\tfloat64 x 2.5\n\tq/U[<=4] us\n\t\tint8 x\n\tstring<=5 s\n"
    )


@pytest.mark.parametrize(
    ("kind", "parts"),
    [("srv", ["Request", "Response"]), ("action", ["Goal", "Result", "Feedback"])],
)
def test_parts_of_an_idl_are_separated(tmp_path, kind, parts):
    structs = " ".join(f"struct T_{part} {{ long {part.lower()}; }};" for part in parts)
    files = {f"p/{kind}/T.idl": f"module p {{ module {kind} {{ {structs} }}; }};"}
    ours = Library("lyrical", [make_files(tmp_path, files)])
    assert show(ours, "p/T") == "---\n".join(f"int32 {part.lower()}\n" for part in parts)


def test_a_nested_idl_without_fields_is_shown_by_its_constants(tmp_path):
    idl = """module q { module msg { module U_Constants { const short LIMIT = 3; };
      struct U { uint8 structure_needs_at_least_one_member; }; }; };"""
    files = {"q/msg/U.idl": idl, "p/msg/T.msg": "q/U u\nint8 x\n"}
    ours = Library("lyrical", [make_files(tmp_path, files)])
    assert show(ours, "p/T") == "q/U u\n\tint16 LIMIT=3\nint8 x\n"
    assert show(ours, "q/U") == "int16 LIMIT=3\n"


def test_a_text_in_an_idl_stays_in_its_line_and_is_shown_to_its_end(tmp_path):
    idl = r"""module p { module msg {
      module T_Constants { @unit("a\nb") const string S = "one\ntwo\r# three"; };
      @verbatim(language="comment", text="of T") struct T {
        @verbatim(language="comment", text="of s") @unit(value="m") @default(value="#1\x1c\"#\"")
        string s; @default(value="('# a', 'b')") string t[2]; }; }; };"""
    files = {"p/msg/T.idl": idl, "p/msg/V.msg": "T t # one\nint8 x\n"}
    ours = Library("lyrical", [make_files(tmp_path, files)])
    members = [
        ('string S="one\\ntwo\\r# three"', r"  # [a\nb]"),
        (r'string s "#1\x1c\"#\""', "  # [m]"),
        ('string[2] t ["# a", "b"]', ""),
    ]
    first, second, third = (text + unit for text, unit in members)
    assert show(ours, "p/T") == f"# of T\n{first}\n# of s\n{second}\n{third}\n"
    nested = "".join(f"\t{text}\n" for text, _ in members)
    assert show(ours, "p/V") == f"T t # one\n{nested}int8 x\n"


def test_values_of_an_idl_read_back_as_those_of_a_msg(tmp_path):
    idl = """module p { module msg {
      module T_Constants { const string Q = "say \\"a\\" 'b'"; const boolean B = TRUE; };
      struct T { @default(value="it's \\"it\\"") string s;
                 @default(value="('a\\"', \\"b'\\")") string t[2];
                 @default(value=TRUE) boolean b; @default(value=-1.5) double d; long x; };
    }; };"""
    make_files(tmp_path / "idl", {"p/msg/T.idl": idl})
    ours = Library("lyrical", [tmp_path / "idl"])
    text = show(ours, "p/T")
    again = library(tmp_path / "msg", {"p/T": text}).message("p/T")
    assert again == ours.message("p/T")
    assert again.constants[0].value == "say \"a\" 'b'"


@pytest.mark.parametrize("distro", ["noetic", "lyrical"])
def test_the_limit_counts_each_character_that_is_shown(distro, tmp_path, monkeypatch):
    texts = {"p/msg/A.msg": "B b\nB c\n", "p/msg/B.msg": "C[] c\nint8 x\n"}
    texts["p/msg/C.msg"] = "float64 long_name\nint8 y\n"
    library = Library(distro, [make_files(tmp_path, texts)])
    shown = show(library, "p/A")
    assert max(len(line) - len(line.lstrip()) for line in shown.splitlines()) > 1
    module = sys.modules["firm_hdl.frontend.show"]
    monkeypatch.setattr(module, "MOST_CHARACTERS", len(shown))
    assert show(library, "p/A") == shown
    monkeypatch.setattr(module, "MOST_CHARACTERS", len(shown) - 1)
    with pytest.raises(
        DefinitionError, match=f"is shown in {len(shown)} characters, which is more"
    ):
        show(library, "p/A")
