"""ROS's own Python modules, which answer requests in lines of JSON.

This file is run by the Python that ROS's modules are installed for. firm-hdl often runs on another
one, so this file imports nothing of firm-hdl. Its arguments are the name of a family (``genmsg``,
``rosidl`` or ``genpy``), a folder of definitions, ``PACKAGE/msg|srv|action/FILE``, and the folder
of the module ``worker_FAMILY``. A request may name another folder of definitions. The first output
line names the readers and their versions. Then each input line is a request, and each output line
is an answer:

    {"oracle": "genmsg", "package": "p", "kind": "msg", "name": "A", "file": "A.msg", "text": null,
     "has_events": false, "folder": "/tmp/definitions"}
    {"facts": {...}} or {"refused": "why"} or {"failed": "why"}

Facts are described in `firm_hdl.verify.ts1.facts`. A ``text`` that is not null replaces the text of
the file. ``has_events`` says whether services have event messages and types have hashes. The
process ends at the end of its input.
"""

import functools
import importlib
import json
import os
import resource
import signal
import sys
from importlib import metadata

__all__ = ["main"]

MOST_SECONDS = 60  # Processor time, because the machine may be busy with other work.
MOST_BYTES = 3 << 30


def main():
    """Answer requests until there are no more."""
    # ROS's modules print, and templates replace sys.stdout. So answers go to a copy of stdout.
    answers = os.fdopen(os.dup(1), "w", encoding="ascii")
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    os.dup2(1, 2)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # The parent process ends this one.
    signal.signal(signal.SIGPROF, _too_slow)
    resource.setrlimit(resource.RLIMIT_AS, (MOST_BYTES, MOST_BYTES))
    sys.path[0] = sys.argv[3]
    try:
        family = importlib.import_module(f"worker_{sys.argv[1]}")
        del sys.path[0]  # ROS may have modules with the names of our other modules.
        readers = functools.lru_cache(maxsize=None)(family.readers)
        judges, modules = readers(sys.argv[2])
    except Exception as error:
        _send(answers, {"missing": f"{type(error).__name__}: {error}"})
        return
    _send(
        answers, {"ready": sorted(judges), "versions": {name: _version(name) for name in modules}}
    )
    for line in sys.stdin:
        request = json.loads(line)
        judges, _ = readers(request.get("folder", sys.argv[2]))
        _send(answers, _judge(judges[request["oracle"]], request))


def _judge(judge, request):
    signal.setitimer(signal.ITIMER_PROF, MOST_SECONDS)
    try:
        return {"facts": judge(request)}
    except _TooSlowError:
        return {"failed": f"it took over {MOST_SECONDS} s"}
    except MemoryError:
        return {"failed": f"it took over {MOST_BYTES >> 30} GiB"}
    except RecursionError:
        return {"refused": "RecursionError: it never ends"}
    # Templates that fail call sys.exit.
    except (Exception, SystemExit) as error:
        return {"refused": f"{type(error).__name__}: {error}"[:1000]}
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)


class _TooSlowError(BaseException):
    pass


def _too_slow(signum, frame):
    raise _TooSlowError


def _send(answers, value):
    # `json` writes NaN and infinities in the form that the `json` of the parent reads.
    print(json.dumps(value), file=answers, flush=True)


def _version(name):
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return "?"


if __name__ == "__main__":
    main()
