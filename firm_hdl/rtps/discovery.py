"""Discovery data: what participants and endpoints announce about themselves (8.5, 9.6.2)."""

from __future__ import annotations

import struct
from dataclasses import dataclass

from firm_hdl.rtps.qos import Qos, duration, seconds
from firm_hdl.rtps.wire import locators
from firm_hdl.rtps.wire.guid import PARTICIPANT, VENDOR, Guid
from firm_hdl.rtps.wire.locators import Address
from firm_hdl.rtps.wire.octets import Cursor, MalformedError
from firm_hdl.rtps.wire.parameters import ParameterList, Pid, string

__all__ = [
    "MOST_USER_DATA",
    "EndpointData",
    "ParticipantData",
    "check_owner",
    "key_of",
    "key_payload",
]

MOST_USER_DATA = 4096
"""Most bytes of what a participant or an endpoint announces in addition."""

# 9.3.2, BuiltinEndpointSet_t: writer and reader of SPDP, and of SEDP's publications and
# subscriptions. Those of publications and of subscriptions are bits 2 to 5.
_BUILTIN_ENDPOINTS = 0x3F
# 9.6.2.2.2: the lease of a participant that announces none.
_DEFAULT_LEASE = 100.0


@dataclass(frozen=True, slots=True, kw_only=True)
class ParticipantData:
    """What a participant announces with SPDP (8.5.3.2)."""

    prefix: bytes
    vendor: bytes = VENDOR  # Two bytes.
    # Unicast addresses of discovery, and of user data for endpoints without addresses.
    discovery: tuple[Address, ...]
    user: tuple[Address, ...]
    lease: float  # Seconds after which a silent participant is gone.
    endpoints: int = _BUILTIN_ENDPOINTS  # Bits of the built-in endpoints that it has.
    user_data: bytes = b""  # ROS 2 has its enclave here.
    name: str = ""
    domain: int | None = None  # The domain, where the participant says it.

    def has(self, bit: int) -> bool:
        """Whether it has the built-in endpoint of a bit of BuiltinEndpointSet_t."""
        return bool(self.endpoints >> bit & 1)

    def encode(self) -> bytes:
        """Return the payload of its SPDP announcement, little-endian."""
        domain = [] if self.domain is None else [(Pid.DOMAIN_ID, struct.pack("<I", self.domain))]
        items = (
            (Pid.PROTOCOL_VERSION, b"\x02\x03"),
            (Pid.VENDOR_ID, self.vendor),
            (Pid.PARTICIPANT_GUID, bytes(Guid(self.prefix, PARTICIPANT))),
            *domain,
            *((Pid.METATRAFFIC_UNICAST_LOCATOR, locators.encode(each)) for each in self.discovery),
            *((Pid.DEFAULT_UNICAST_LOCATOR, locators.encode(each)) for each in self.user),
            (Pid.PARTICIPANT_LEASE_DURATION, duration(self.lease)),
            (Pid.BUILTIN_ENDPOINT_SET, struct.pack("<I", self.endpoints)),
            *_user_data(self.user_data),
            (Pid.ENTITY_NAME, string(self.name)),
        )
        return ParameterList(items).encode_payload()

    @classmethod
    def decode(cls, payload: bytes) -> ParticipantData:
        """Read the payload of an SPDP announcement.

        Raises
        ------
        MalformedError
            It is no parameter list, or has no GUID.
        """
        parameters = ParameterList.decode_payload(payload)
        guid = _required(parameters, Pid.PARTICIPANT_GUID, "a participant without GUID")
        vendor = parameters.first(Pid.VENDOR_ID)
        lease = parameters.first(Pid.PARTICIPANT_LEASE_DURATION)
        endpoints = parameters.first(Pid.BUILTIN_ENDPOINT_SET)
        name = parameters.first(Pid.ENTITY_NAME)
        domain = parameters.first(Pid.DOMAIN_ID)
        every = parameters.every
        return cls(
            prefix=guid.take(12),
            vendor=vendor.take(2) if vendor else bytes(2),
            discovery=locators.decode(every(Pid.METATRAFFIC_UNICAST_LOCATOR)),
            user=locators.decode(every(Pid.DEFAULT_UNICAST_LOCATOR)),
            lease=seconds(lease) if lease else _DEFAULT_LEASE,
            endpoints=endpoints.u32() if endpoints else _BUILTIN_ENDPOINTS,
            user_data=_read_user_data(parameters),
            name=name.string() if name else "",
            domain=domain.u32() if domain else None,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class EndpointData:
    """What a participant announces about a writer or a reader with SEDP (8.5.4.2)."""

    guid: Guid
    # Names, of which both have to be equal for two endpoints to match.
    topic: str
    type_name: str
    qos: Qos  # Policies that it offers or asks for.
    # Where to send its samples or acknowledgements. None means where the participant says.
    addresses: tuple[Address, ...] = ()
    user_data: bytes = b""  # ROS 2 has its type hash here.

    def encode(self) -> bytes:
        """Return the payload of its announcement, little-endian."""
        items = (
            (Pid.ENDPOINT_GUID, bytes(self.guid)),
            # Peers of ROS 2 find the node of an endpoint by this one.
            (Pid.PARTICIPANT_GUID, bytes(Guid(self.guid.prefix, PARTICIPANT))),
            (Pid.KEY_HASH, bytes(self.guid)),
            (Pid.TOPIC_NAME, string(self.topic)),
            (Pid.TYPE_NAME, string(self.type_name)),
            *((Pid.UNICAST_LOCATOR, locators.encode(each)) for each in self.addresses),
            *self.qos.parameters(),
            *_user_data(self.user_data),
        )
        return ParameterList(items).encode_payload()

    @classmethod
    def decode(cls, payload: bytes, writer: bool) -> EndpointData:
        """Read the payload of an announcement of a writer, or of a reader.

        Raises
        ------
        MalformedError
            It is no parameter list, or has no GUID, topic or type.
        """
        parameters = ParameterList.decode_payload(payload)
        guid = _required(parameters, Pid.ENDPOINT_GUID, "an endpoint without GUID")
        topic = _required(parameters, Pid.TOPIC_NAME, "an endpoint without topic")
        type_name = _required(parameters, Pid.TYPE_NAME, "an endpoint without type")
        return cls(
            guid=Guid.parse(guid.take(16)),
            topic=topic.string(),
            type_name=type_name.string(),
            qos=Qos.decode(parameters, writer),
            addresses=locators.decode(parameters.every(Pid.UNICAST_LOCATOR)),
            user_data=_read_user_data(parameters),
        )


def check_owner(prefix: bytes, source: bytes) -> None:
    """Check that a participant announces, or ends, only what is its own.

    Raises `MalformedError`: the GUID prefix of what it speaks of is not that of `source`.
    """
    if prefix != source:
        raise MalformedError(f"an announcement of {prefix.hex()} by {source.hex()}")


def key_of(payload: bytes | None, inline: ParameterList, pid: int) -> Guid | None:
    """Return the GUID that a DATA without sample is about, such as the end of an endpoint.

    The key is in the payload, as parameter `pid`, or is the key hash of the inline QoS (9.6.4.8).
    """
    value = inline.first(Pid.KEY_HASH)
    if payload:
        value = ParameterList.decode_payload(payload).first(pid) or value
    return None if value is None else Guid.parse(value.take(16))


def key_payload(guid: Guid, pid: int) -> bytes:
    """Return the payload of a DATA that ends `guid`."""
    return ParameterList(((pid, bytes(guid)),)).encode_payload()


def _required(parameters: ParameterList, pid: int, problem: str) -> Cursor:
    value = parameters.first(pid)
    if value is None:
        raise MalformedError(problem)
    return value


def _user_data(data: bytes) -> tuple[tuple[int, bytes], ...]:
    return ((Pid.USER_DATA, struct.pack("<I", len(data)) + data),) if data else ()


def _read_user_data(parameters: ParameterList) -> bytes:
    value = parameters.first(Pid.USER_DATA)
    if value is None:
        return b""
    size = value.u32()
    if size > MOST_USER_DATA:
        raise MalformedError(f"user data of {size} bytes")
    return value.take(size)
