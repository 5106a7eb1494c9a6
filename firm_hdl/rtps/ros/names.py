"""Names of ROS 2 and what they are on the wire, as all middlewares of ROS 2 write them.

The rules are those of the design articles "Topic and Service name mapping to DDS" and "Mapping
between ROS interface types and DDS IDL types".
"""

from __future__ import annotations

import re

__all__ = [
    "demangled_topic",
    "demangled_type",
    "enclave",
    "expanded",
    "reply_topic",
    "request_topic",
    "topic",
    "type_hash_of",
    "type_name",
    "user_data",
]

_TOKEN = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_TYPE = re.compile(r"([a-z][a-z0-9_]*)/(msg|srv|action)/([A-Za-z][A-Za-z0-9_]*)")
_MANGLED = re.compile(r"([a-z][a-z0-9_]*)::(msg|srv|action)::dds_::([A-Za-z][A-Za-z0-9_]*)_")
_HASH = re.compile(r"RIHS[0-9]{2}_[0-9a-f]+")
_HASH_IN_DATA = re.compile(rb"(?:^|;)typehash=([^;]*)")


def expanded(name: str, node: str, namespace: str) -> str:
    """Return the full name of a topic or service, such as ``/ns/chatter`` of ``chatter``.

    * `name`: relative (``chatter``), private (``~/chatter``) or full (``/chatter``).
    * `node`, `namespace`: name and namespace of the node.

    Raises `ValueError`: the name breaks the rules of ROS 2.
    """
    base = namespace.rstrip("/")
    if name.startswith("/"):
        full = name
    elif name == "~" or name.startswith("~/"):
        full = f"{base}/{node}{name[1:]}"
    else:
        full = f"{base}/{name}"
    tokens = full.split("/")[1:]
    if not tokens or not all(_TOKEN.fullmatch(each) and "__" not in each for each in tokens):
        raise ValueError(f"'{name}' is no name of a topic or service")
    return full


def topic(full: str) -> str:
    """Return the topic on the wire of a ROS topic with its full name."""
    return f"rt{full}"


def request_topic(full: str) -> str:
    """Return the topic of a service's requests."""
    return f"rq{full}Request"


def reply_topic(full: str) -> str:
    """Return the topic of a service's replies."""
    return f"rr{full}Reply"


def type_name(name: str, suffix: str = "") -> str:
    """Return a type's name on the wire, such as ``std_msgs::msg::dds_::String_``.

    * `name`: full name of a message or of a service, such as ``std_msgs/msg/String``.
    * `suffix`: ``"_Request"`` or ``"_Response"`` for the messages of a service.

    Raises `ValueError`: `name` is not ``package/msg/Name``, or ``srv`` or ``action`` instead of
    ``msg``.
    """
    match = _TYPE.fullmatch(name)
    if match is None:
        raise ValueError(f"'{name}' is no type of ROS 2, such as 'std_msgs/msg/String'")
    package, kind, base = match.groups()
    return f"{package}::{kind}::dds_::{base}{suffix}_"


def demangled_type(name: str) -> str | None:
    """Return the ROS name of a type on the wire, or `None` if it is none of ROS."""
    match = _MANGLED.fullmatch(name)
    return "/".join(match.groups()) if match else None


def demangled_topic(name: str) -> str | None:
    """Return the full name of a ROS topic, or `None` if it is none, such as one of a service."""
    return name[2:] if name.startswith("rt/") else None


def user_data(type_hash: str | None) -> bytes:
    """Return what an endpoint announces about its type.

    * `type_hash`: such as ``RIHS01_df668c...``. Peers warn about a wrong one, and not about none.

    Raises `ValueError`: it does not begin with ``RIHS`` and a version.
    """
    if type_hash is None:
        return b""
    if not _HASH.fullmatch(type_hash):
        raise ValueError(f"'{type_hash}' is no type hash of ROS 2")
    return f"typehash={type_hash};".encode()


def type_hash_of(data: bytes) -> str | None:
    """Return the type hash in the user data of an endpoint, or `None`."""
    match = _HASH_IN_DATA.search(data)
    return match[1].decode("ascii", "replace") if match else None


def enclave(name: str) -> bytes:
    """Return what a participant announces about its enclave, such as ``"/"``."""
    return f"enclave={name};".encode()
