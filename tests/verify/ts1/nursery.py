"""Oracles' processes that are forked from one that has loaded ROS's modules.

Loading takes a quarter of a second, rosidl_parser's first file takes another one, and a hundred
tests have a folder, and so a process, of their own. Each process still runs `worker_script` from
its start, with its own arguments. How it is started and ended by itself,
`tests.verify.ts1.oracles.test_oracles` tests.
"""

from __future__ import annotations

import json
import os
import socket
import subprocess
import time
from functools import cache
from types import SimpleNamespace

__all__ = ["nursed"]

# It forks a process for each line of arguments, which come with the ends of two pipes.
_NURSE = """
import contextlib, gc, importlib, json, os, runpy, signal, socket, sys

sys.path.insert(0, sys.argv[3])
with contextlib.suppress(OSError):  # The modules are loaded before a folder is read.
    judges, _ = importlib.import_module("worker_" + sys.argv[2]).readers("/nowhere")
    if "rosidl_parser" in judges:  # It makes its tables when it reads its first file.
        first = {"package": "p", "kind": "msg", "name": "A", "file": "A.msg", "text": "int8 x\\n"}
        judges["rosidl_parser"]({**first, "has_events": False})
del sys.path[0]
gc.freeze()
asked = socket.socket(fileno=0)
signal.signal(signal.SIGCHLD, signal.SIG_IGN)
while True:
    line, ends, _, _ = socket.recv_fds(asked, 1 << 16, 2)
    if not line:
        break
    child = os.fork()
    if not child:
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        os.dup2(ends[0], 0)
        os.dup2(ends[1], 1)
        for end in ends:
            os.close(end)
        sys.argv = json.loads(line)
        runpy.run_path(sys.argv[0], run_name="worker_script")["main"]()
        os._exit(0)  # All is written. To clear Python's memory takes as long as a short answer.
    for end in ends:
        os.close(end)
    asked.send(str(child).encode())
"""


class _Child:
    """What `Worker` needs of a process that is not a child of this one."""

    def __init__(self, pid, stdin, stdout):
        self.pid, self.stdin, self.stdout = pid, stdin, stdout

    def wait(self, timeout=None):
        """Wait until the process is gone; its nurse reaps it."""
        end = time.monotonic() + (60 if timeout is None else timeout)
        while self._is_there():
            if time.monotonic() > end:
                raise subprocess.TimeoutExpired("worker", timeout)
            time.sleep(0.001)

    def kill(self):
        if self._is_there():
            os.kill(self.pid, 9)

    def _is_there(self):
        try:
            os.kill(self.pid, 0)
        except ProcessLookupError:
            return False
        return True


@cache
def _nurse(python, family, modules, environment):
    """Start the process that others are forked from; it ends with this one."""
    ours, theirs = socket.socketpair()
    with theirs:
        try:
            process = subprocess.Popen(
                [python, "-c", _NURSE, "nurse", family, modules],
                stdin=theirs.fileno(),
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                env=dict(environment),
            )
        except OSError:
            ours.close()
            raise
    return ours, process


def _popen(command, *, env, **_):
    """Fork what `Worker` starts."""
    python, script, family, folder, modules = command
    # pytest writes the name of each test into the environment.
    variables = (each for each in env.items() if each[0] != "PYTEST_CURRENT_TEST")
    nurse, _process = _nurse(python, family, modules, tuple(sorted(variables)))
    request, answers = os.pipe(), os.pipe()
    line = json.dumps([script, family, folder, modules]).encode()
    socket.send_fds(nurse, [line], [request[0], answers[1]])
    os.close(request[0])
    os.close(answers[1])
    pid = int(nurse.recv(64) or b"-1")
    assert pid > 0, "the nurse is dead"
    return _Child(pid, os.fdopen(request[1], "w"), os.fdopen(answers[0]))


def nursed(monkeypatch, module):
    """Let the workers of a module be forked."""
    names = {name: getattr(subprocess, name) for name in ("PIPE", "DEVNULL")}
    monkeypatch.setattr(module, "subprocess", SimpleNamespace(Popen=_popen, **names))
