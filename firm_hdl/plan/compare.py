"""The differences between two plans, by meaning and not by line.

Plans are compared in their printed form, which is what people review. A step is identified by the
first leaf of its map, not by its number. So an additional step does not change the names of the
others. A jump is compared by the step to which it leads.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from difflib import SequenceMatcher
from typing import Any

import yaml

from firm_hdl.plan.yaml_reader import compose

__all__ = ["Change", "compare"]

MOST_MOVED = 1000
"""Most names whose new places are looked for. The time is that of their square."""

_STEP = re.compile(r"step \d+")
_STEP_PATH = re.compile(r"steps\[([^]]*)\]")
_AGAIN = re.compile(r"loop \d+ again")
# A slice of a step: ``0..3``, ``4``, ``at 8``.
_PLACE = re.compile(r"(?:at )?\d+(?:\.\.\d+)?")


@dataclass(frozen=True, slots=True, kw_only=True)
class Change:
    """One difference.

    Attributes
    ----------
    path : str
        Place in the plan: ``steps[header.stamp.sec].starts.limit``. A step is named by the first
        leaf of its map.
    old, new : str or None
        The text at this place; `None` if the plan does not have it.
    """

    path: str
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
        where = re.sub(r"^(leaves|runs)\..*", r"\1.*", where)
        if self.old is None or self.new is None:
            return f"{where}: {'new' if self.old is None else 'gone'}"
        return where


def compare(old: str, new: str) -> list[Change]:
    """Compare two plans in YAML.

    Returns
    -------
    list of Change
        Empty if the plans mean the same. In the order of the new plan; removed parts come last.

    Raises
    ------
    ValueError
        If a text is not a plan.
    """
    before, after = _facts(old), _facts(new)
    # A step that only one plan has is one change, not one for each of its entries.
    before, after = _fold(before, after), _fold(after, before)
    changes = [
        Change(path=path, old=before.get(path), new=text)
        for path, text in after.items()
        if before.get(path) != text
    ]
    changes += [
        Change(path=path, old=text, new=None) for path, text in before.items() if path not in after
    ]
    for what in ("leaves", "steps"):
        changes += _moved(what, _entries(before, what), _entries(after, what))
    return changes


def _fold(facts: Mapping[str, str], others: Mapping[str, str]) -> dict[str, str]:
    known = set(_entries(others, "steps"))
    folded: dict[str, list[str]] = {}
    for path, text in facts.items():
        found = _STEP_PATH.match(path)
        if found is None or found[1] in known:
            folded[path] = [text]
        else:
            entry = f"{path[found.end() :].lstrip('.')}: {text}"
            folded.setdefault(found[0], []).append(entry)
    return {path: "; ".join(entries) for path, entries in folded.items()}


def _plain(node: yaml.Node | None) -> Any:
    """Return dictionaries, lists and texts. YAML would take the last of two equal keys only."""
    if isinstance(node, yaml.SequenceNode):
        return list(map(_plain, node.value))
    if not isinstance(node, yaml.MappingNode):
        return None if node is None else str(node.value)
    found: dict[str, Any] = {}
    for key, value in node.value:
        line = node.start_mark.line + 1
        if not isinstance(key, yaml.ScalarNode):
            raise ValueError(f"Not a plan: the mapping in line {line} has a key that is no text")
        if key.value in found:
            raise ValueError(f"Not a plan: the mapping in line {line} has {key.value!r} twice")
        found[str(key.value)] = _plain(value)
    return found


def _facts(text: str) -> dict[str, str]:
    """Give every value of a plan, by path."""
    document = _plain(compose(text))
    if not isinstance(document, dict) or not isinstance(document.get("steps"), dict):
        raise ValueError("Not a plan: it has no steps")
    if not all(isinstance(content, dict) for content in document["steps"].values()):
        raise ValueError("Not a plan: a step must be a mapping")
    names = _step_names(document["steps"])
    facts: dict[str, str] = {}
    for key, value in document.items():
        if key == "steps":
            for step, content in value.items():
                facts.update(_flatten(f"steps[{names[step]}]", content, names))
        else:
            facts.update(_flatten(str(key), value, names))
    return facts


def _step_names(steps: Mapping[str, Any]) -> dict[str, str]:
    """Name each step by the first leaf of its map; equal names are numbered."""
    seen: Counter[str] = Counter()
    names = {}
    for step, content in steps.items():
        name = _step_name(content)
        seen[name] += 1
        names[step] = name if seen[name] == 1 else f"{name}, {seen[name]}"
    return names


def _step_name(content: Mapping[Any, Any]) -> str:
    if "words of" in content:
        return f"words of {content['words of']}"
    slices = [value for key, value in content.items() if _PLACE.fullmatch(str(key))]
    flat = [text for s in slices for text in (s if isinstance(s, list) else [s])]
    for text in flat:
        if not str(text).startswith("("):
            return str(text)
    if flat:
        return "header" if "checked" in str(flat[0]) else "padding"
    return f"rest of {content['rest of']}" if "rest of" in content else "nothing"


def _flatten(path: str, value: Any, names: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    if isinstance(value, Mapping):
        # The first loop that has elements left is repeated.
        loops = [key for key in value if _AGAIN.fullmatch(str(key))]
        if len(loops) > 1:
            yield f"{path}.order", ", ".join(loops)
        for key, inner in value.items():
            yield from _flatten(f"{path}.{key}", inner, names)
    elif isinstance(value, list):
        yield path, ", ".join(map(str, value))
    else:
        # A jump: "step 3", perhaps with counters.
        yield path, _STEP.sub(lambda found: f"step [{names.get(found[0], '?')}]", str(value))


def _entries(facts: Mapping[str, str], what: str) -> list[str]:
    """List leaves, or names of steps, in their order."""
    if what == "leaves":
        return [path.removeprefix("leaves.") for path in facts if path.startswith("leaves.")]
    found = map(_STEP_PATH.match, facts)
    return list(dict.fromkeys(match[1] for match in found if match))


def _moved(what: str, old: list[str], new: list[str]) -> Iterator[Change]:
    """Yield the entries of both lists whose order differs."""
    common = set(old) & set(new)
    first = [name for name in old if name in common]
    second = [name for name in new if name in common]
    if first == second:
        return
    if len(first) > MOST_MOVED:
        yield Change(path=f"order of {what}", old="(another one)", new="(another one)")
        return
    matcher = SequenceMatcher(a=first, b=second, autojunk=False)
    for tag, start, end, new_start, new_end in matcher.get_opcodes():
        if tag != "equal":
            yield Change(
                path=f"order of {what}",
                old=", ".join(first[start:end]) or "(nothing here)",
                new=", ".join(second[new_start:new_end]) or "(nothing here)",
            )
