"""The differences between two plans, by meaning and not by line.

Plans are compared in their printed form, which is what people review. A step is identified by the
first leaf of its map, a run by its items, and a loop by its count, within the items around. So an
additional step does not change the names of the others.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from typing import Any

import yaml

from firm_hdl.model import Wire
from firm_hdl.wire import RULES

__all__ = ["Change", "Head", "compare", "head_of"]

MOST_MOVED = 1000
"""Most names whose new places are looked for. The time is that of their square."""

MOST_LEVELS = 200
"""Most levels of YAML. A loop has four of them, and a plan at most 32 loops inside each other."""

# A slice of a step: ``0..3``, ``4``, ``at 8``.
_PLACE = re.compile(r"(?:at )?\d+(?:\.\.\d+)?")


@dataclass(frozen=True, slots=True, kw_only=True)
class Head:
    """What a plan is of: the parameters of :func:`firm_hdl.plan.build_plan`."""

    message: str
    wire: Wire
    bus_bytes: int
    max_message_bytes: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Change:
    """One difference."""

    # Place in the plan: `plan[run of name.items].limit`. A step is named by the first leaf of its
    # map.
    path: str
    # The text at this place; `None` if the plan does not have it.
    old: str | None
    new: str | None

    def __str__(self) -> str:
        if self.old is None:
            return f"{self.path}: new: {self.new}"
        if self.new is None:
            return f"{self.path}: gone: {self.old}"
        return f"{self.path}: {self.old} -> {self.new}"

    @property
    def kind(self) -> str:
        """The change without the names of a type, for counting over many types."""
        where = re.sub(r"\[[^]]*\]", "[*]", self.path)
        where = re.sub(r"^leaves\..*", "leaves.*", where)
        if self.old is None or self.new is None:
            return f"{where}: {'new' if self.old is None else 'gone'}"
        return where


def compare(old: str, new: str) -> list[Change]:
    """Compare two plans in YAML.

    Returns nothing if the plans mean the same. Changes are in the order of the new plan; removed
    parts come last.

    Raises `ValueError` if a text is not a plan.
    """
    before, after = _Facts(_read(old)), _Facts(_read(new))
    # An item that only one plan has is one change, not one for each of its entries.
    olds, news = before.without(after), after.without(before)
    changes = [
        Change(path=path, old=olds.get(path), new=text)
        for path, text in news.items()
        if olds.get(path) != text
    ]
    changes += [
        Change(path=path, old=text, new=None) for path, text in olds.items() if path not in news
    ]
    for path, names in before.orders.items():
        changes += _moved(path, names, after.orders.get(path, []))
    return changes


def head_of(text: str) -> Head:
    """Return what a plan in YAML is of.

    Raises `ValueError` if the text is not a plan.
    """
    document = _read(text)
    message, wire = document.get("message"), document.get("wire")
    if not (isinstance(message, str) and isinstance(wire, str) and wire in RULES):
        raise ValueError("Not a plan: it has no message, or no wire that firm-hdl knows")
    numbers = [document.get(key) for key in ("bus_bytes", "max_message_bytes")]
    if not all(isinstance(each, str) and re.fullmatch("[0-9]{1,10}", each) for each in numbers):
        raise ValueError("Not a plan: it has no bus_bytes, or no max_message_bytes")
    bus_bytes, max_message_bytes = (int(str(each)) for each in numbers)
    return Head(
        message=message, wire=wire, bus_bytes=bus_bytes, max_message_bytes=max_message_bytes
    )


def _read(text: str) -> dict[str, Any]:
    """Read a plan in YAML: dictionaries, lists and texts.

    Only its form is read, not whether it is sound.

    Raises `ValueError` if the text is not YAML, or not that of a plan.
    """
    document = _plain(_compose(text), set(), 0)
    if not isinstance(document, dict) or not isinstance(document.get("plan"), list):
        raise ValueError("Not a plan: it has no list of steps, 'plan'")
    return document


def _compose(text: str) -> yaml.Node | None:
    """Parse a text into a tree; `None` if it is empty."""
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    try:
        root: yaml.Node | None = yaml.compose(text, Loader=loader)
    except yaml.reader.ReaderError as error:
        line = text.count("\n", 0, max(0, text.find(chr(error.character))))
        raise ValueError(f"Line {line + 1}: not YAML: {error.reason}") from None
    except yaml.MarkedYAMLError as error:
        line = 0 if error.problem_mark is None else error.problem_mark.line
        raise ValueError(f"Line {line + 1}: not YAML: {error.problem}") from None
    except (RecursionError, ValueError, OverflowError) as error:
        # Half of a surrogate pair; the others are of the loader in Python.
        line = text.count("\n", 0, getattr(error, "start", 0))
        raise ValueError(f"Line {line + 1}: not YAML that a plan can have") from None
    return root


def _plain(node: yaml.Node | None, seen: set[int], level: int) -> Any:
    """Return dictionaries, lists and texts.

    YAML would take the last of two equal keys only. Aliases are refused: a text with few of them
    can stand for a tree without an end.
    """
    if node is None:
        return None
    line = node.start_mark.line + 1
    if id(node) in seen:
        raise ValueError(f"Line {line}: a plan has no aliases")
    seen.add(id(node))
    if level > MOST_LEVELS:
        raise ValueError(f"Line {line}: a plan is not nested so deep")
    if isinstance(node, yaml.SequenceNode):
        return [_plain(each, seen, level + 1) for each in node.value]
    if not isinstance(node, yaml.MappingNode):
        return str(node.value)
    found: dict[str, Any] = {}
    for key, value in node.value:
        if not isinstance(key, yaml.ScalarNode):
            raise ValueError(f"Line {line}: the mapping has a key that is no text")
        if key.value in found:
            raise ValueError(f"Line {line}: the mapping has {key.value!r} twice")
        found[str(key.value)] = _plain(value, seen, level + 1)
    return found


class _Facts:
    """What a plan says."""

    def __init__(self, document: Mapping[str, Any]):
        self.texts: dict[str, str] = {}  # Every value, by its path.
        # For each path of a value: the paths of the items that it is in, outermost first.
        self.around: dict[str, tuple[str, ...]] = {}
        # The names of leaves, and of the items of each body, in their order.
        self.orders: dict[str, list[str]] = {}
        head = {key: value for key, value in document.items() if key != "plan"}
        for key, value in head.items():
            if isinstance(value, dict):
                self.orders[key] = list(value)
            self.entries(key, value, ())
        self.block("plan", document["plan"], ())

    def block(self, path: str, items: Sequence[Any], around: tuple[str, ...]) -> None:
        seen: Counter[str] = Counter()
        names = self.orders[path] = []
        for item in items:
            name = _name(item)
            seen[name] += 1
            name = name if seen[name] == 1 else f"{name}, {seen[name]}"
            names.append(name)
            where = f"{path}[{name}]"
            # The only entry of a step or loop; a run has others beside its name.
            content = item.get("step", item.get("loop", item))
            self.texts[where] = ""
            self.around[where] = around
            self.entries(where, content, (*around, where))

    def entries(self, path: str, value: Any, around: tuple[str, ...]) -> None:
        if isinstance(value, dict):
            for key, inner in value.items():
                if key == "body" and isinstance(inner, list):
                    self.block(f"{path}.body", inner, around)
                else:
                    self.entries(f"{path}.{key}", inner, around)
        else:
            self.texts[path] = ", ".join(map(str, value)) if isinstance(value, list) else str(value)
            self.around[path] = around

    def without(self, other: _Facts) -> dict[str, str]:
        """Return all values; those of an item that the other plan does not have are one text."""
        folded: dict[str, list[str]] = {}
        for path, text in self.texts.items():
            missing = next((item for item in self.around[path] if item not in other.texts), path)
            entry = f"{path[len(missing) :].lstrip('.')}: {text}" if missing != path else text
            folded.setdefault(missing, []).append(entry)
        return {path: "; ".join(filter(None, texts)) for path, texts in folded.items()}


def _name(item: Any) -> str:
    """Name a step, run or loop."""
    match item:
        case {"step": dict(content), **others} if not others:
            slices = [value for key, value in content.items() if _PLACE.fullmatch(str(key))]
            flat = [text for s in slices for text in (s if isinstance(s, list) else [s])]
            for text in flat:
                if not str(text).startswith("("):
                    return str(text)
            if flat:
                return "header" if "checked" in str(flat[0]) else "padding"
            return f"rest of {content.get('rest of', 'nothing')}"
        case {"run": str(items)}:
            return f"run of {items}"
        case {"loop": {"count": str(count), "body": list()}, **others} if not others:
            return f"loop of {count}"
    raise ValueError("Not a plan: each of its items must be a step, a run or a loop")


def _moved(path: str, old: Sequence[str], new: Sequence[str]) -> Iterator[Change]:
    """Yield the entries of both lists whose order differs."""
    common = set(old) & set(new)
    first = [name for name in old if name in common]
    second = [name for name in new if name in common]
    if first == second:
        return
    if len(first) > MOST_MOVED:
        yield Change(path=f"order of {path}", old="(another one)", new="(another one)")
        return
    matcher = SequenceMatcher(a=first, b=second, autojunk=False)
    for tag, start, end, new_start, new_end in matcher.get_opcodes():
        if tag != "equal":
            yield Change(
                path=f"order of {path}",
                old=", ".join(first[start:end]) or "(nothing here)",
                new=", ".join(second[new_start:new_end]) or "(nothing here)",
            )
