"""The architecture: the imports that each part may have."""

from __future__ import annotations

import ast
import re
from collections.abc import Container, Iterator
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

import firm_hdl

PACKAGE = Path(firm_hdl.__file__).parent

# The parts in the order of the pipeline, each with the parts that it may import.
MAY_IMPORT = {
    # Know nothing of messages; could be published alone.
    "terminal": set[str](),
    "errors": {"terminal"},
    # Figures, and pages with figures.
    "drawing": set[str](),
    "files": set[str](),
    "garbage": set[str](),
    "jobs": {"errors"},
    "names": set[str](),
    "recordings": {"errors", "files"},
    "rtlil": {"names"},
    "vhdl": {"names", "rtlil"},
    # The netlist, the names and the statements are those of the VHDL.
    "verilog": {"names", "rtlil", "vhdl"},
    "rtps": set[str](),
    # Know messages.
    "model": {"errors"},
    # `wire`: a type that no wire can carry is refused when it is loaded.
    "frontend": {"errors", "files", "recordings", "model", "wire"},
    "identity": {"errors", "model", "frontend"},
    "wire": {"errors", "model"},
    "metrics": {"errors", "model", "frontend", "identity", "wire"},
    "plan": {"model", "wire"},
    "estimates": {"plan"},
    # Knows the circuits' pipeline.
    "timing": {"plan"},
    "program": {"names", "plan", "timing", "wire"},
    # `names`: the attribute of a signal's comment.
    "gateware": {"names", "model", "wire", "plan", "timing", "program"},
    # Its block RAMs.
    "ethernet": {"gateware"},
    # `jobs`: compilers.
    "sim": {
        *("errors", "garbage", "jobs", "rtlil", "verilog", "model", "wire", "plan", "gateware"),
    },
}
# What a user's accelerator is made of. `sim`: values of messages become transfers.
MAY_IMPORT["accelerator"] = {"gateware", "model", "plan", "sim", "wire"}
# `accelerator`: whole messages in place of leaves. `names`: words of C.
MAY_IMPORT["registers"] = {"accelerator", "gateware", "model", "names", "plan"}
MAY_IMPORT["export"] = {
    # `drawing`, `identity`, `metrics`, `sim`: datasheets show what a type is, and waveforms.
    *("firm_hdl", "errors", "files", "garbage", "jobs", "names", "rtlil", "vhdl", "verilog"),
    *("drawing", "identity", "metrics", "model", "frontend", "wire", "plan", "timing", "program"),
    *("estimates", "gateware", "registers", "sim"),
}
MAY_IMPORT["node"] = {
    # `terminal`: names of peers are printed. `equivalence`, `jobs`: accelerators in VHDL and
    # Verilog are read by GHDL and Verilator.
    *("firm_hdl", "errors", "files", "garbage", "names", "rtlil", "rtps", "terminal", "vhdl"),
    *("model", "frontend", "identity", "wire", "metrics", "plan", "timing", "estimates"),
    *("drawing", "ethernet", "gateware", "registers", "sim", "export", "equivalence", "jobs"),
}
MAY_IMPORT["arguments"] = {"frontend", "model", "plan"}
MAY_IMPORT["covering"] = {
    *("arguments", "errors", "files", "model", "frontend", "wire", "plan", "export", "terminal"),
}
# Messages and packets to try, and the oracle that writes them.
MAY_IMPORT["cases"] = {"metrics", "model", "plan", "sim", "wire"}
MAY_IMPORT["verify"] = {
    "cases",
    *(
        MAY_IMPORT["export"]
        - {"estimates", "garbage", "metrics", "program", "registers", "rtlil", "timing"}
    ),
    *("arguments", "export", "node", "recordings", "terminal"),
}
MAY_IMPORT["equivalence"] = {
    *("arguments", "errors", "jobs", "names", "terminal", "vhdl"),
    *("model", "frontend", "wire", "plan", "export"),
}
MAY_IMPORT["bench"] = {
    *("arguments", "errors", "files", "jobs", "rtlil", "terminal"),
    *("model", "frontend", "wire", "plan", "gateware", "sim", "export"),
}
MAY_IMPORT["cli"] = {
    *("firm_hdl", "arguments", "errors", "garbage", "jobs", "terminal"),
    *("names", "model", "frontend", "plan", "timing", "program", "estimates", "export"),
    *("identity", "metrics", "node", "cases", "verify", "bench"),
}
MAY_IMPORT["__main__"] = {"cli"}
# The public interface of the package.
MAY_IMPORT["firm_hdl"] = {"errors", "frontend", "gateware"}

# Allowed imports of the parts of `firm_hdl.verify`.
VERIFY_MAY_IMPORT = {
    "results": set[str](),
    "ros2_wheels": set[str](),
    "ros_python": set[str](),
    "references": {"ros2_wheels", "ros_python"},
    "simulators": set[str](),
    "systems": {"results"},
    "clients": {"references", "results", "systems"},
    "ts1": {"results", "ros2_wheels", "ros_python", "systems"},
    "ts2": {"results", "systems"},
    "ts3": {"clients", "references", "results", "simulators", "systems"},
    "generated_benches": {"references", "results", "systems", "ts3"},
    "board": {"references", "results", "systems", "ts3"},
    "report": {"results"},
}
VERIFY_MAY_IMPORT["run"] = {
    *("board", "clients", "command", "generated_benches", "report", "results"),
    *("systems", "ts1", "ts2", "ts3"),
}
VERIFY_MAY_IMPORT["command"] = {"board", "report", "results", "run", "systems", "ts3"}
VERIFY_MAY_IMPORT["verify"] = set()


@cache
def _tree(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


def unused(package: Path, whole: str, may_import: dict[str, set[str]]) -> Iterator[str]:
    """Yield the permissions that no module uses."""
    used: dict[str, set[str]] = {}
    for path in package.rglob("*.py"):
        where = path.relative_to(package)
        tree = _tree(path)
        used.setdefault(_part(where, whole), set()).update(_imports(tree, whole, may_import))
    for part, allowed in may_import.items():
        for name in sorted(allowed - used.get(part, set())):
            yield f"{part} does not import {name}"


def _part(where: Path, whole: str) -> str:
    """Name the part of a module, by its path in the folder of `whole`."""
    return whole if where.parts == ("__init__.py",) else where.parts[0].removesuffix(".py")


def problems(package: Path) -> Iterator[str]:
    for path in sorted(package.rglob("*.py")):
        where = path.relative_to(package)
        tree = _tree(path)
        if ast.get_docstring(tree) is None:
            yield f"{where}: no docstring"
        if path.name != "__main__.py" and not _has_all(tree):
            yield f"{where}: no literal __all__"
        if "lab" in _packages(tree):
            yield f"{where}: imports the laboratory"
        yield from _wrong_imports(where, tree, "firm_hdl", MAY_IMPORT)
        if where.parts[0] == "verify":
            yield from _wrong_imports(where, tree, "verify", VERIFY_MAY_IMPORT)


def _wrong_imports(
    where: Path, tree: ast.Module, whole: str, may_import: dict[str, set[str]]
) -> Iterator[str]:
    """Yield what a module imports from parts of `whole` that are not below its own.

    `whole` is the package, or one of its parts that has parts itself.
    """
    part = _part(Path(*where.parts[1:]) if whole == "verify" else where, whole)
    if part not in may_import:
        yield f"{where}: a part of the package that the architecture does not know"
        return
    for imported in sorted(set(_imports(tree, whole, may_import))):
        if imported != part and imported not in may_import[part]:
            yield f"{where}: {part} imports {imported}"


def _statements(node: ast.AST) -> Iterator[ast.AST]:
    """Yield all statements in a node. `ast.walk` takes longer, because of the expressions."""
    for part in ("body", "orelse", "finalbody", "handlers", "cases"):
        for child in getattr(node, part, ()):
            yield child
            yield from _statements(child)


def _packages(tree: ast.Module) -> set[str]:
    """Return the first parts of the names of all modules that a module imports."""
    names: list[str] = []
    for node in _statements(tree):
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names.append(node.module or "")
    return {name.partition(".")[0] for name in names}


def _has_all(tree: ast.Module) -> bool:
    for node in tree.body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
            return isinstance(node.value, ast.List) and all(
                isinstance(entry, ast.Constant) for entry in node.value.elts
            )
    return False


def _imports(tree: ast.Module, whole: str, parts: Container[str]) -> Iterator[str]:
    """Yield the parts of `whole` that a module imports, wherever in it."""
    prefix = "firm_hdl" if whole == "firm_hdl" else f"firm_hdl.{whole}"
    for node in _statements(tree):
        names: list[str] = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "imports are absolute"
            if node.module == prefix:
                # A public name of the package, or one of its parts.
                names = [f"{prefix}.{a.name}" if a.name in parts else prefix for a in node.names]
            else:
                names = [node.module or ""]
        for name in names:
            if name == prefix:
                yield whole
            elif name.startswith(f"{prefix}."):
                yield name.removeprefix(f"{prefix}.").partition(".")[0]


def _needs(module: str, modules: dict[str, Path]) -> Iterator[str]:
    """Yield the modules, and the packages around them, that a module imports when it is loaded."""
    for node in _tree(modules[module]).body:
        if isinstance(node, ast.ImportFrom):
            for imported in (node.module or "", *(f"{node.module}.{a.name}" for a in node.names)):
                parts = imported.split(".")
                names = {".".join(parts[: end + 1]) for end in range(len(parts))}
                yield from (n for n in names & set(modules) if not f"{module}.".startswith(f"{n}."))


def test_each_module_can_be_imported_first() -> None:
    paths = {
        path: path.relative_to(PACKAGE.parent).with_suffix("") for path in PACKAGE.rglob("*.py")
    }
    modules = {".".join(p.parts).removesuffix(".__init__"): path for path, p in paths.items()}
    TopologicalSorter({each: set(_needs(each, modules)) for each in modules}).prepare()


def test_package_keeps_to_its_architecture() -> None:
    assert list(problems(PACKAGE)) == []


@pytest.mark.parametrize("folder", ["examples", "tests"])
def test_the_laboratory_is_imported_by_nobody(folder: str) -> None:
    for path in (PACKAGE.parent / folder).rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        assert not re.search(r"^\s*(from|import) lab\b", text, re.MULTILINE), path


def test_every_permission_is_used() -> None:
    assert list(unused(PACKAGE, "firm_hdl", MAY_IMPORT)) == []
    assert list(unused(PACKAGE / "verify", "verify", VERIFY_MAY_IMPORT)) == []
