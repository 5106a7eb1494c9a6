"""A network of its own for this process and all that it starts: only a loopback interface.

Peers find each other by multicast. So tests neither disturb a graph that runs on this machine, nor
are disturbed by one.
"""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess

__all__ = ["leave_network", "why_not"]

_NEW_USER, _NEW_NETWORK = 0x1000_0000, 0x4000_0000
_COMMANDS = (
    "ip link set lo up",
    "ip link set lo multicast on",
    "ip route add 224.0.0.0/4 dev lo",
)


def why_not() -> str | None:
    """Return why this system has no such networks, or `None`."""
    if not shutil.which("ip") or not shutil.which("unshare"):
        return "ip or unshare"
    rights = [] if os.geteuid() == 0 else ["--map-root-user"]
    tried = subprocess.run(
        ["unshare", *rights, "--net", "true"], capture_output=True, timeout=20, check=False
    )
    return None if tried.returncode == 0 else "the right to create a network namespace"


def leave_network() -> None:
    """Move this thread, and what it starts from now on, into a new network, for good."""
    libc = ctypes.CDLL(None, use_errno=True)
    flags = _NEW_NETWORK if os.geteuid() == 0 else _NEW_USER | _NEW_NETWORK
    if libc.unshare(flags):
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()))
    for command in _COMMANDS:
        subprocess.run(command.split(), check=True, timeout=20)
