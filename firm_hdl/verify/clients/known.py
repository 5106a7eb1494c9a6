"""Which known divergences explain a difference.

A difference in values is explained if the values are equal without the parts that known divergences
are about. So a known divergence hides no other difference. If one library takes an unusual packet
and the other refuses it, the case and the library explain the difference. A difference that no
entry explains is new.
"""

from __future__ import annotations

from collections.abc import Sequence

from firm_hdl.cases.values import Plain, changed
from firm_hdl.model import Message
from firm_hdl.verify.clients.divergences import KNOWN
from firm_hdl.verify.clients.finding import Finding, KnownDivergence
from firm_hdl.verify.references.client import Codec, Refusal, UnsupportedError
from firm_hdl.verify.references.clients import client
from firm_hdl.wire import Wire

__all__ = ["known_keys", "known_writing"]

_ROSBAGS = "rosbags"


def known_keys(finding: Finding, library_codec: Codec, reference_codec: Codec) -> Sequence[str]:
    """Return the keys of the divergences that explain a difference; none if it is new."""
    entries = [entry for entry in KNOWN if entry.is_about(finding)]
    for entry in entries:
        if entry.explains_answer(finding):
            return [entry.key]
    if finding.what.startswith("encode"):
        return _explained_writing(
            finding.message, finding.value, entries, library_codec, reference_codec
        )
    if isinstance(finding.expected, Refusal) or isinstance(finding.got, Refusal):
        return ()
    found, expected, got = [], finding.expected, finding.got
    for entry in entries:
        if entry.same is not None:
            one, other = (changed(finding.message, each, entry.same) for each in (expected, got))
            if (one, other) != (expected, got):
                found.append(entry.key)
            expected, got = one, other
    return found if expected == got else ()


def _explained_writing(
    message: Message,
    value: Plain,
    entries: Sequence[KnownDivergence],
    library_codec: Codec,
    reference_codec: Codec,
) -> Sequence[str]:
    found = []
    for entry in entries:
        if entry.take_out is not None:
            left = changed(message, value, entry.take_out)
            if left != value:
                found.append(entry.key)
            value = left
    if not found:
        return ()
    one, other = reference_codec.encode_all([value])[0], library_codec.encode_all([value])[0]
    return found if one == other and not isinstance(one, Refusal) else ()


def known_writing(
    message: Message, wire: Wire, value: Plain, library: str, codec: Codec
) -> Sequence[str]:
    """Return the keys of divergences that explain why a library and rosbags write different bytes.

    The divergences explain it if both libraries write the same packet once the parts that the
    divergences are about are taken out of the value. There are no divergences of a type that
    rosbags does not have.

    Parameters
    ----------
    codec : Codec
        The codec of `library`. That of rosbags is opened here.
    """
    try:
        reference_codec = client(_ROSBAGS).open(message, wire)
    except UnsupportedError:
        # Without the type, rosbags writes nothing to compare.
        return ()
    entries = [
        entry for entry in KNOWN if entry.affected_library(wire, library, _ROSBAGS) is not None
    ]
    return _explained_writing(message, value, entries, codec, reference_codec)
