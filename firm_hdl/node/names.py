"""Names of nodes, topics and services: their rules, and how ROS completes them.

The rules of ROS 2 are those of rmw (``validate_node_name.h``, ``validate_namespace.h`` and
``validate_full_topic_name.h``), which each middleware applies; those of ROS 1 are of the page
"Names" of the ROS wiki. The design article of ROS 2 also forbids ``__`` in the name of a topic. rmw
does not check this, so such names are accepted here, too.
"""

from __future__ import annotations

import re

from firm_hdl.model import Dialect

__all__ = ["MOST_TOPIC_CHARACTERS", "expand", "namespace_problem", "node_problem", "topic_problem"]

MOST_NODE_CHARACTERS = 255
"""``RMW_NODE_NAME_MAX_NAME_LENGTH``."""

MOST_TOPIC_CHARACTERS = 247
"""``RMW_TOPIC_MAX_NAME_LENGTH``: 255, less 8 for the prefixes of DDS. Of a complete name."""

MOST_NAMESPACE_CHARACTERS = MOST_TOPIC_CHARACTERS - 2
"""``RMW_NAMESPACE_MAX_LENGTH``: the shortest topic, such as ``/x``, has two characters."""

_NOT_ALLOWED = re.compile(r"[^A-Za-z0-9_]")


def node_problem(name: str, dialect: Dialect) -> str:
    """Say why a name is none of a node; empty if it is one.

    * `name`: name without a namespace.
    """
    if not name:
        return "the name of a node must not be empty"
    if (wrong := _NOT_ALLOWED.search(name)) is not None:
        return f"the name of a node has letters, digits and '_' only, not {wrong[0]!r}"
    if problem := _first_letter(name, dialect):
        return f"the name of a node {problem}"
    if len(name) > MOST_NODE_CHARACTERS:
        return _too_long("the name of a node", MOST_NODE_CHARACTERS, len(name))
    return ""


def namespace_problem(name: str, dialect: Dialect) -> str:
    """Say why a name is no complete namespace, such as ``/`` or ``/robot``; empty if it is one."""
    if not name.startswith("/"):
        return "a namespace starts with '/'"
    if name != "/" and (problem := _tokens(name[1:], dialect)):
        return f"a namespace {problem}"
    if len(name) > MOST_NAMESPACE_CHARACTERS:
        return _too_long("a namespace", MOST_NAMESPACE_CHARACTERS, len(name))
    return ""


def topic_problem(name: str, dialect: Dialect) -> str:
    """Say why a name, as a description writes it, is none of a topic; empty if it is one.

    The name is absolute (``/odom``), relative to the namespace (``odom``) or private to the node
    (``~/odom``). Its complete name is checked by :func:`expand`'s callers for its length only.
    """
    if not name:
        return "the name of a topic must not be empty"
    rest = name
    if name.startswith("~"):
        if not name.startswith("~/"):
            return "'~' is followed by '/'"
        rest = name[2:]
    elif name.startswith("/"):
        rest = name[1:]
    problem = _tokens(rest, dialect)
    return f"the name of a topic {problem}" if problem else ""


def expand(name: str, namespace: str, node: str) -> str:
    """Complete a name of a topic, as ``rcl_expand_topic_name`` does.

    >>> expand("odom", "/robot", "wheels"), expand("~/odom", "/", "wheels")
    ('/robot/odom', '/wheels/odom')
    """
    if name.startswith("/"):
        return name
    base = namespace.rstrip("/")
    if name.startswith("~/"):
        return f"{base}/{node}/{name[2:]}"
    return f"{base}/{name}"


def _tokens(text: str, dialect: Dialect) -> str:
    """Say what is wrong with the words between slashes."""
    if text.endswith("/") or not text:
        return "does not end with '/'"
    for token in text.split("/"):
        if not token:
            return "has no '//'"
        if "{" in token or "}" in token:
            return "has no substitutions such as '{node}' here; write the name out"
        if (wrong := _NOT_ALLOWED.search(token)) is not None:
            return f"has letters, digits, '_' and '/' only, not {wrong[0]!r}"
        if problem := _first_letter(token, dialect):
            return f"{problem}; '{token}' does not fit" if token != text else problem
    return ""


def _first_letter(token: str, dialect: Dialect) -> str:
    if token[0].isdigit():
        return "does not start with a digit"
    # ROS 1 wants a letter; ROS 2 has hidden topics and nodes, whose names start with ``_``.
    if dialect == "ros1" and token[0] == "_":
        return "starts with a letter in ROS 1"
    return ""


def _too_long(what: str, most: int, found: int) -> str:
    return f"{what} has at most {most} characters, not {found}"
