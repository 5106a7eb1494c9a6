"""What a recording says of its topics and of their types."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Schema", "Topic"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Schema:
    """A definition as it was recorded.

    Attributes
    ----------
    type : str
        The name of the type.
    encoding : str
        The language, such as ``ros2msg``; ``ros1msg`` in a ``.bag``.
    data : bytes or None
        The text; `None` if it is longer than :data:`firm_hdl.recordings.limits.MAX_TEXT_BYTES`.
    """

    type: str
    encoding: str
    data: bytes | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Topic:
    """A topic of a recording. A topic with several types or digests counts several times.

    Attributes
    ----------
    name, type : str
        As they were recorded. The type of a channel of MCAP without a schema is empty.
    encoding : str
        The wire format of the messages: ``ros1``, ``cdr`` or any other word.
    digest : str
        The recorded md5 sum or type hash; empty if there is none.
    """

    name: str
    type: str
    encoding: str
    digest: str
