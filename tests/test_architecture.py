"""The shape of the package: who may import whom, and what every module has."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import firm_hdl

PACKAGE = Path(firm_hdl.__file__).parent
MOST_LINES = 450
# Of a function, with its docstring.
MOST_SIZE = 60

# Text to syntax to model to layout to plan to circuit to Verilog and VHDL: what each part may use.
MAY_IMPORT = {
    # Of no message: these could be packages of their own.
    "terminal": set[str](),
    "errors": {"terminal"},
    "files": set[str](),
    "jobs": set[str](),
    "names": set[str](),
    "rtlil": set[str](),
    "vhdl": {"names", "rtlil"},
    # Of messages.
    "model": {"errors"},
    "frontend": {"errors", "files", "model"},
    "identity": {"errors", "model", "frontend"},
    "wire": {"errors", "model"},
    "metrics": {"errors", "model", "frontend", "identity", "wire"},
    "plan": {"errors", "model", "wire"},
    "gateware": {"errors", "model", "wire", "plan"},
    "sim": {"errors", "model", "frontend", "wire", "plan", "gateware"},
    "export": {"firm_hdl", "errors", "files", "names", "vhdl", "model", "frontend", "wire", "plan"},
}
MAY_IMPORT["export"] |= {"gateware"}
MAY_IMPORT["verify"] = {
    *MAY_IMPORT["export"],
    *("export", "identity", "jobs", "metrics", "sim", "terminal"),
}
MAY_IMPORT["equivalence"] = {
    *("firm_hdl", "errors", "jobs", "names", "rtlil", "terminal", "vhdl"),
    *("model", "frontend", "wire", "plan", "gateware", "export"),
    # Which types have all constructs, and where tools are.
    "verify",
}
MAY_IMPORT["commands"] = {*MAY_IMPORT["verify"], "verify", "identity", "metrics", "equivalence"}
MAY_IMPORT["cli"] = {"firm_hdl", "errors", "terminal", "commands"}
# The package's own face.
MAY_IMPORT["firm_hdl"] = {"errors", "frontend", "gateware"}


def problems(package: Path) -> Iterator[str]:
    for path in sorted(package.rglob("*.py")):
        where = path.relative_to(package)
        text = path.read_text(encoding="utf-8")
        tree = ast.parse(text)
        if ast.get_docstring(tree) is None:
            yield f"{where}: no docstring"
        if path.name != "__main__.py" and not _has_all(tree):
            yield f"{where}: no literal __all__"
        if len(text.splitlines()) > MOST_LINES:
            yield f"{where}: more than {MOST_LINES} lines"
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and _size(node) > MOST_SIZE:
                yield f"{where}: {node.name} has more than {MOST_SIZE} lines"
        part = "firm_hdl" if where.name == "__init__.py" and len(where.parts) == 1 else (
            where.parts[0].removesuffix(".py")
        )
        if part not in MAY_IMPORT:
            yield f"{where}: a part of the package that the architecture does not know"
            continue
        for imported in sorted(set(_imports(tree))):
            if imported != part and imported not in MAY_IMPORT[part]:
                yield f"{where}: {part} imports {imported}"


def _size(node: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    return (node.end_lineno or 0) - node.lineno + 1


def _has_all(tree: ast.Module) -> bool:
    for node in tree.body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
            return isinstance(node.value, ast.List) and all(
                isinstance(entry, ast.Constant) for entry in node.value.elts
            )
    return False


def _imports(tree: ast.Module) -> Iterator[str]:
    """Yield the parts of firm_hdl that a module imports, wherever in it."""
    for node in ast.walk(tree):
        names: list[str] = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "imports are absolute"
            if node.module == "firm_hdl":
                # A name of the package's face, or one of its parts.
                names = [
                    f"firm_hdl.{a.name}" if a.name in MAY_IMPORT else "firm_hdl" for a in node.names
                ]
            else:
                names = [node.module or ""]
        for name in names:
            parts = name.split(".")
            if parts[0] == "firm_hdl":
                yield parts[1] if len(parts) > 1 else "firm_hdl"


def test_package_keeps_to_its_architecture() -> None:
    assert list(problems(PACKAGE)) == []


def test_violations_are_found(tmp_path: Path) -> None:
    files = {
        "__init__.py": '"""Face."""\nfrom firm_hdl.export import build\n__all__ = []\n',
        "model.py": '"""Doc."""\nimport firm_hdl.wire.cdr\n__all__ = ["x"]\n',
        "wire/__init__.py": '"""Doc."""\n__all__ = []\n',
        "wire/cdr.py": '"""Doc."""\nfrom firm_hdl import frontend\n__all__ = []\n',
        "sim/a.py": '"""Doc."""\ndef f():\n    from firm_hdl.export.build import build\n',
        "sim/b.py": '__all__ = ["a", *b]\n',
        "cli.py": '"""Doc."""\nfrom firm_hdl.verify import accept\n__all__ = []\n' + "\n" * 450,
        "utils.py": '"""Doc."""\n__all__ = []\n',
        "plan/a.py": '"""Doc."""\n__all__ = []\ndef long():\n' + "    pass\n" * 60,
        "plan/b.py": '"""Doc."""\n__all__ = []\ndef long():\n' + "    pass\n" * 59,
        "gateware/__main__.py": '"""Doc."""\nimport firm_hdl\nimport os\n',
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    assert list(problems(tmp_path)) == [
        "__init__.py: firm_hdl imports export",
        "cli.py: more than 450 lines",
        "cli.py: cli imports verify",
        "gateware/__main__.py: gateware imports firm_hdl",
        "model.py: model imports wire",
        "plan/a.py: long has more than 60 lines",
        "sim/a.py: no literal __all__",
        "sim/a.py: sim imports export",
        "sim/b.py: no docstring",
        "sim/b.py: no literal __all__",
        "utils.py: a part of the package that the architecture does not know",
        "wire/cdr.py: wire imports frontend",
    ]
