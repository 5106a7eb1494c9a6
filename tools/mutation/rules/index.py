"""An index of a program's declarations, to replace a name by another one of the same type."""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

__all__ = ["Index", "index_of", "index_of_program"]

ENUMS = ("Enum", "IntEnum", "StrEnum", "Flag", "IntFlag")
PROPERTIES = ("property", "cached_property", "functools.cached_property")


@dataclass(frozen=True)
class Parameter:
    """A parameter of a function, or a field of a dataclass."""

    name: str
    annotation: str
    has_default: bool
    positional: bool


@dataclass
class Index:
    """Classes and functions by name.

    Attributes
    ----------
    fields : mapping
        By class: the names of its fields and properties, each with its annotation, in order.
    enums : mapping
        By enumeration: the names of its members.
    calls : mapping
        By function or dataclass: its parameters, without `self`; `None` if a name has several
        different declarations.
    """

    fields: dict[str, dict[str, str]] = field(default_factory=dict)
    enums: dict[str, list[str]] = field(default_factory=dict)
    calls: dict[str, list[Parameter] | None] = field(default_factory=dict)

    def neighbours(self, name: str, of: str | None = None) -> list[str]:
        """Return other attributes of the same type as an attribute, the nearest first.

        Parameters
        ----------
        of : str, optional
            The class, if it is known. Otherwise it may be any class that has the attribute.
        """
        if of in self.fields and name in self.fields[of]:
            classes = [self.fields[of]]
        else:
            classes = [fields for fields in self.fields.values() if name in fields]
        found = [_same(fields, name) for fields in classes]
        return [each for each in found[0] if all(each in rest for rest in found)] if found else []

    def parameters(self, name: str) -> Mapping[str, Parameter]:
        """Return the parameters of a function or dataclass by name; empty if not known."""
        return {each.name: each for each in self.calls.get(name) or ()}

    def positional(self, name: str) -> Sequence[Parameter]:
        """Return the positional parameters of a function or dataclass; empty if not known."""
        return [each for each in self.calls.get(name) or () if each.positional]


def _same(fields: Mapping[str, str], name: str) -> list[str]:
    """Return fields of the same type, the nearest first."""
    names = list(fields)
    here = names.index(name)
    same = [each for each in names if each != name and fields[each] == fields[name] != ""]
    return sorted(same, key=lambda each: abs(names.index(each) - here))


def index_of(texts: Iterable[str]) -> Index:
    """Return the index of some modules."""
    result = Index()
    seen: dict[str, list[list[Parameter]]] = defaultdict(list)
    for text in texts:
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.ClassDef):
                _class(node, result, seen)
            elif isinstance(node, ast.FunctionDef):
                seen[node.name].append(_parameters(node))
    for name, declared in seen.items():
        result.calls[name] = declared[0] if all(each == declared[0] for each in declared) else None
    return result


def index_of_program(root: Path) -> Index:
    """Return the index of the program at `root`."""
    return index_of(
        path.read_text(encoding="utf-8") for path in sorted(root.glob("firm_hdl/**/*.py"))
    )


def _class(node: ast.ClassDef, result: Index, seen: dict[str, list[list[Parameter]]]) -> None:
    if any(ast.unparse(base).rpartition(".")[2] in ENUMS for base in node.bases):
        members = [each.targets[0] for each in node.body if isinstance(each, ast.Assign)]
        result.enums[node.name] = [each.id for each in members if isinstance(each, ast.Name)]
        return
    fields: dict[str, str] = {}
    parameters: list[Parameter] = []
    named = any("kw_only=True" in ast.unparse(each) for each in node.decorator_list)
    for each in node.body:
        if isinstance(each, ast.AnnAssign) and isinstance(each.target, ast.Name):
            annotation = ast.unparse(each.annotation)
            fields[each.target.id] = annotation
            parameters.append(
                Parameter(each.target.id, annotation, each.value is not None, not named)
            )
        elif isinstance(each, ast.FunctionDef) and each.returns is not None:
            decorators = {ast.unparse(decorator) for decorator in each.decorator_list}
            if decorators & set(PROPERTIES):
                fields[each.name] = ast.unparse(each.returns)
    # Attributes of objects of the class, such as signals.
    for inner in ast.walk(node):
        if isinstance(inner, ast.Assign) and isinstance(inner.value, ast.Call):
            target = inner.targets[0]
            if isinstance(target, ast.Attribute) and ast.unparse(target.value) == "self":
                fields.setdefault(target.attr, f"= {ast.unparse(inner.value)}")
    result.fields[node.name] = fields
    if any("dataclass" in ast.unparse(each) for each in node.decorator_list):
        seen[node.name].append(parameters)


def _parameters(node: ast.FunctionDef) -> list[Parameter]:
    given = node.args
    plain = [*given.posonlyargs, *given.args]
    defaults = [None] * (len(plain) - len(given.defaults)) + list(given.defaults)
    pairs = [(each, default, True) for each, default in zip(plain, defaults, strict=True)]
    pairs += [
        (each, default, False)
        for each, default in zip(given.kwonlyargs, given.kw_defaults, strict=True)
    ]
    return [
        Parameter(
            name=each.arg,
            annotation=ast.unparse(each.annotation) if each.annotation else "",
            has_default=default is not None,
            positional=positional,
        )
        for each, default, positional in pairs
        if each.arg not in ("self", "cls")
    ]
