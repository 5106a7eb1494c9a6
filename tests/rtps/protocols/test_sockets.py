"""The sockets of a participant: which ports they take, and what they ask of the system."""

from __future__ import annotations

import errno
import fcntl
import socket
from types import SimpleNamespace

import pytest

from firm_hdl.rtps import transport
from firm_hdl.rtps.transport import Transport, TransportError, address_of

HOST = "192.168.1.7"
# Domain 3, after 9.6.1.1: 7400 and 250 for each domain.
DOMAIN, GROUP_PORT = 3, 8150


def ports(participant):
    """Return the ports of discovery and of user data: 10 and 11 behind, and 2 for each number."""
    return GROUP_PORT + 10 + 2 * participant, GROUP_PORT + 11 + 2 * participant


class System:
    """Sockets that are made, and errors by the call that they are the answer to."""

    def __init__(self):
        self.made = []
        self.used_ports = set()
        self.errors = {}
        self.own_address = HOST

    def socket(self, family, kind):
        assert (family, kind) == (socket.AF_INET, socket.SOCK_DGRAM)
        self.made.append(FakeSocket(self))
        return self.made[-1]

    @property
    def open(self):
        return [each for each in self.made if not each.is_closed]


class FakeSocket:
    def __init__(self, system):
        self.system = system
        self.options, self.bound, self.connected = {}, None, None
        self.blocks, self.is_closed = True, False

    def setblocking(self, blocks):
        self.blocks = blocks

    def setsockopt(self, level, option, value):
        self._answer(option)
        self.options[level, option] = value

    def bind(self, address):
        self._answer("bind")
        if address[1] in self.system.used_ports:
            raise OSError(errno.EADDRINUSE, "in use")
        self.bound = address

    def connect(self, address):
        self._answer("connect")
        self.connected = address

    def getsockname(self):
        return self.system.own_address, 50_000

    def close(self):
        self.is_closed = True

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def _answer(self, call):
        if call in self.system.errors:
            raise OSError(self.system.errors[call], "an error")


@pytest.fixture
def system(monkeypatch):
    made = System()
    monkeypatch.setattr(
        transport, "socket", SimpleNamespace(**{**vars(socket), "socket": made.socket})
    )
    return made


# The ports.


@pytest.mark.parametrize(
    ("used", "participant"),
    [
        (set(), 0),
        ({ports(0)[0]}, 1),
        ({ports(0)[1]}, 1),
        ({ports(0)[0], ports(1)[1], ports(2)[0]}, 3),
        ({port for n in range(119) for port in ports(n)}, 119),
        # The lowest free one, whatever is used above.
        ({ports(1)[0]}, 0),
    ],
)
def test_a_participant_has_the_lowest_free_number(system, used, participant):
    system.used_ports = used
    made = Transport(DOMAIN, HOST)
    discovery, user = ports(participant)
    assert made.participant == participant
    assert made.discovery == (HOST, discovery) and made.user == (HOST, user)
    multicast, *unicast = made.sockets
    assert [each.bound for each in unicast] == [(HOST, discovery), (HOST, user)]
    assert made.group == ("239.255.0.1", GROUP_PORT) and multicast.bound == ("", GROUP_PORT)
    # Those of the numbers that are used are not kept.
    assert sorted(map(id, system.open)) == sorted(map(id, made.sockets))
    made.close()
    assert len(system.made) >= 3 and not system.open


def test_a_host_has_no_more_than_120_participants(system):
    system.used_ports = {port for n in range(120) for port in ports(n)}
    with pytest.raises(TransportError, match=r"^all 120 participants of domain 3 are there$"):
        Transport(DOMAIN, HOST)
    assert system.made and not system.open


def test_an_address_of_another_host_is_an_error_at_once(system):
    system.errors["bind"] = errno.EADDRNOTAVAIL
    with pytest.raises(TransportError, match=rf"^no sockets on {HOST}: "):
        Transport(DOMAIN, HOST)
    assert len(system.made) == 2 and not system.open


@pytest.mark.parametrize("option", [socket.SO_REUSEADDR, socket.IP_ADD_MEMBERSHIP])
def test_without_multicast_no_socket_stays_open(system, option):
    system.errors[option] = errno.ENODEV
    with pytest.raises(TransportError, match=rf"^no multicast on {HOST}: "):
        Transport(DOMAIN, HOST)
    assert len(system.made) == 3 and not system.open


# What they ask of the system.


def test_no_socket_blocks_and_each_has_room_for_a_burst(system):
    made = Transport(DOMAIN, HOST)
    assert len(made.sockets) == 3
    for each in made.sockets:
        assert not each.blocks
        assert each.options[socket.SOL_SOCKET, socket.SO_RCVBUF] == 4 << 20


def test_a_system_with_less_room_is_no_error(system):
    system.errors[socket.SO_RCVBUF] = errno.EPERM
    assert Transport(DOMAIN, HOST).participant == 0


def test_announcements_leave_by_the_interface_and_reach_this_host_too(system):
    discovery, _ = Transport(DOMAIN, HOST).sockets[1:]
    own = socket.inet_aton(HOST)
    assert discovery.options[socket.IPPROTO_IP, socket.IP_MULTICAST_IF] == own
    assert discovery.options[socket.IPPROTO_IP, socket.IP_MULTICAST_LOOP] == 1


def test_the_group_is_joined_on_the_interface_beside_other_participants(system):
    multicast, *_ = Transport(DOMAIN, HOST).sockets
    membership = bytes([239, 255, 0, 1, 192, 168, 1, 7])
    assert multicast.options[socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP] == membership
    assert multicast.options[socket.SOL_SOCKET, socket.SO_REUSEADDR] == 1
    if hasattr(socket, "SO_REUSEPORT"):
        assert multicast.options[socket.SOL_SOCKET, socket.SO_REUSEPORT] == 1


@pytest.mark.parametrize(("platform", "value"), [("linux", 0), ("darwin", None)])
def test_only_what_comes_to_the_interface_is_received(system, monkeypatch, platform, value):
    """Linux gives a socket what others have joined, unless it is told not to."""
    monkeypatch.setattr(transport, "sys", SimpleNamespace(platform=platform))
    multicast, *_ = Transport(DOMAIN, HOST).sockets
    # IP_MULTICAST_ALL of <linux/in.h>.
    assert multicast.options.get((socket.IPPROTO_IP, 49)) == value


# The interface.


def test_without_a_name_it_is_the_one_that_multicast_goes_to(system):
    system.own_address = "10.0.0.5"
    assert address_of(None) == "10.0.0.5"
    assert system.made[0].connected[0] == "239.255.0.1" and not system.open
    # There is no network.
    system.errors["connect"] = errno.ENETUNREACH
    assert address_of(None) == "127.0.0.1" and not system.open


@pytest.mark.parametrize("name", ["lo", "eth0", "enx001122334455"])
def test_an_interface_has_its_own_address(system, monkeypatch, name):
    asked = []

    def ioctl(file, request, argument):
        asked.append((file, request, argument))
        # A struct ifreq: 16 bytes of the name; family and port, 4; the address; the rest.
        return argument[:16] + bytes([2, 0, 0, 0, 10, 1, 2, 3]) + bytes([9] * 232)

    monkeypatch.setattr(fcntl, "ioctl", ioctl)
    assert address_of(name) == "10.1.2.3"
    ((file, request, argument),) = asked
    # SIOCGIFADDR of <linux/sockios.h>.
    assert file is system.made[0] and request == 0x8915
    assert argument.rstrip(b"\0") == name.encode() and len(argument) >= 40


# The system would read the first 15 bytes of a longer name, and a name as far as its NUL.
@pytest.mark.parametrize("name", ["eth0.0123456789a", "\u0101" * 8, "lo\0", "eth0"])
def test_an_interface_without_an_address_is_an_error(system, monkeypatch, name):
    def ioctl(file, request, argument):
        if argument.startswith(b"eth0\0"):
            raise OSError(errno.EADDRNOTAVAIL, "none")
        return bytes(256)

    monkeypatch.setattr(fcntl, "ioctl", ioctl)
    with pytest.raises(TransportError, match=rf"^interface '{name}' has no IPv4 address$"):
        address_of(name)


@pytest.mark.parametrize("address", ["127.0.0.1", "192.168.1.50"])
def test_an_address_names_itself(system, address):
    assert address_of(address) == address
    assert not system.made
