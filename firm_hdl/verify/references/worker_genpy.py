"""The module of genpy for ``ros_python/worker_script.py``, which handles packets, not definitions.

A request to ``open`` has the name of a type, the ``text`` of its definition, and its ``table`` of
fields. Later requests have ``items``: plain values to ``encode``, or packets to ``decode``. Bytes
are always text in Latin-1. An answer has one entry for each item: ``{"item": ...}`` or
``{"refused": "why"}``.
"""

import sys

from genpy_objects import Objects, to_json

__all__ = ["readers"]


def readers(folder):
    """Load genpy; return the functions that answer requests, and the names of its modules."""
    import genpy
    import genpy.dynamic

    worker = _Genpy(genpy)
    return {"open": worker.open, "encode": worker.encode, "decode": worker.decode}, ("genpy",)


class _Genpy:
    def __init__(self, genpy):
        self.genpy = genpy
        self.objects = None
        self.name = ""

    def open(self, request):
        before = list(sys.path)
        classes = self.genpy.dynamic.generate_dynamic(request["name"], request["text"])
        # genpy generates a module for each type, and adds its folder to the search path.
        sys.path[:] = before
        self.objects = Objects(self.genpy, classes, request["table"])
        self.name = request["name"]

    def encode(self, request):
        return [self._each(self._encode, value) for value in request["items"]]

    def decode(self, request):
        return [self._each(self._decode, value) for value in request["items"]]

    def _encode(self, value):
        return self.objects.encode(self.name, value).decode("latin-1")

    def _decode(self, packet):
        return to_json(self.objects.decode(self.name, packet.encode("latin-1")))

    def _each(self, work, item):
        try:
            return {"item": work(item)}
        except Exception as error:
            return {"refused": f"{type(error).__name__}: {error}"[:300]}
