"""The far end of ``ts1/worker_script.py`` for genpy: packets instead of definitions.

A request to ``open`` has the name of a type, the ``text`` of its definition, and its ``table`` of
fields. Then those to ``encode`` have ``items`` that are plain values, and those to ``decode`` ones
that are packets, bytes always as text in Latin-1. An answer has as many, ``{"item": ...}`` or
``{"refused": "why"}``.
"""

import sys

from genpy_objects import Objects, to_json

__all__ = ["readers"]


def readers(folder):
    """Load genpy; return what answers requests, and which modules these are."""
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
        # It makes a module for each, and a place in the search path.
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
