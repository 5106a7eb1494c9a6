"""Peers as processes: start one, wait until it is ready, get its results, or kill it."""

from __future__ import annotations

import json
import os
import queue
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

from tests.tools import need

__all__ = ["Peer", "python_of", "ros1_variables"]

_HERE = Path(__file__).parent / "peers"
_FOLDER = "FIRM_HDL_LIVE_PEERS"
_SYSTEM_PYTHON = "/usr/bin/python3"


def python_of(environment: str) -> str:
    """Return the Python of an environment, such as ``kilted``; see `make live`.

    That of ``ros1`` is the system's, with Debian's packages of ROS 1.
    """
    if environment == "ros1":
        return need("ROS 1 (rospy, rosmaster, messages)", _ros1())
    folder = Path(os.environ.get(_FOLDER) or Path(sys.prefix) / "live")
    path = folder / environment / "bin" / "python"
    found = str(path) if path.is_file() else None
    return need(f"the peer '{environment}' (make live, or {_FOLDER}=DIR)", found)


def _ros1() -> str | None:
    """Return the Python of the system if it has ROS 1, perhaps from ``FIRM_HDL_ROS1``."""
    modules = "import rospy, rosmaster, sensor_msgs.msg, std_srvs.srv"
    tried = subprocess.run(
        [_SYSTEM_PYTHON, "-c", modules], env=ros1_variables(), capture_output=True, check=False
    )
    return _SYSTEM_PYTHON if tried.returncode == 0 else None


def ros1_variables() -> dict[str, str]:
    """Return the variables of the environment of a process of ROS 1."""
    return {
        "PATH": os.environ.get("PATH", ""),
        "HOME": os.environ.get("HOME", "/tmp"),
        "PYTHONPATH": os.environ.get("FIRM_HDL_ROS1", ""),
        "ROS_MASTER_URI": "http://127.0.0.1:11311",
        "ROS_IP": "127.0.0.1",
    }


class Peer:
    """A script of `peers` in a process; a context manager, which kills it.

    Parameters
    ----------
    environment : str
        The environment: ``kilted``, ``jazzy``, ``cyclone`` or ``ros1``.
    what : str
        The first argument of the script.
    options
        Options of the script. `domain` is that of the process, too.
    variables : dict
        Further variables of the environment.
    """

    def __init__(
        self,
        environment: str,
        what: str,
        domain: int = 0,
        variables: dict[str, str] | None = None,
        **options: Any,
    ):
        script = {"cyclone": "cyclone.py", "ros1": "ros1.py"}.get(environment, "ros.py")
        if environment == "cyclone":
            options["domain"] = domain
        # Neither this repository nor a ROS workspace is the peer's business.
        inherited = {k: v for k, v in os.environ.items() if k in ("PATH", "HOME", "LANG")}
        self._process = subprocess.Popen(
            [python_of(environment), str(_HERE / script), what, json.dumps(options)],
            stdout=subprocess.PIPE,
            text=True,
            env={
                **inherited,
                "ROS_DOMAIN_ID": str(domain),
                "CYCLONEDDS_URI": _CYCLONE,
                **(ros1_variables() if environment == "ros1" else {}),
                **(variables or {}),
            },
        )
        self._lines: queue.Queue[str] = queue.Queue()
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()
        try:
            assert self.next() == {"ready": True}
        except BaseException:
            self.kill()
            raise

    def __enter__(self) -> Peer:
        return self

    def __exit__(self, *_: object) -> None:
        self.kill()

    def next(self, timeout: float = 60) -> dict[str, Any]:
        """Return the next line of output."""
        line = self._lines.get(timeout=timeout)
        assert line, "the peer has ended"
        answer: dict[str, Any] = json.loads(line)
        return answer

    def result(self, timeout: float = 60) -> dict[str, Any]:
        """Return the next line of output, after which the peer ends by itself."""
        answer = self.next(timeout)
        self._process.wait(timeout)
        return answer

    def kill(self) -> None:
        """Kill the process (SIGKILL): its participant says no farewell."""
        self._process.kill()
        self._process.wait()
        self._reader.join()
        if self._process.stdout:
            self._process.stdout.close()

    def _read(self) -> None:
        assert self._process.stdout is not None
        for line in self._process.stdout:
            self._lines.put(line)
        self._lines.put("")


# By default, Cyclone takes another interface than loopback where there is one.
_CYCLONE = (
    "<CycloneDDS><Domain><General><Interfaces>"
    '<NetworkInterface name="lo" multicast="true"/>'
    "</Interfaces></General></Domain></CycloneDDS>"
)
