"""Python's search for reference cycles, put off while a circuit is made.

Elaborating and writing a circuit makes up to millions of objects, and nearly all of them live until
the text is written. Python searches the new objects for cycles whenever there are a few hundred
more, and all objects when a quarter of them is new. That took almost half of the time of a build.
"""

from __future__ import annotations

import atexit
import gc
from collections.abc import Iterator
from contextlib import contextmanager

__all__ = ["search_put_off", "search_rarely"]

MANY_OBJECTS = 500_000
"""Objects that Python makes before it searches, in a process that ends soon: some 100 MB."""


def search_rarely() -> None:
    """Search seldom from now on, and not at the end: this process ends after its command."""
    gc.set_threshold(MANY_OBJECTS)
    atexit.register(gc.freeze)


@contextmanager
def search_put_off() -> Iterator[None]:
    """Search for cycles when the block has ended, and at first only among the objects that are new.

    Also usable as a decorator. A block inside another one, or in a program that has disabled the
    search, changes nothing. The memory of cycles is free after the block only, so a block should
    make one circuit, not many.
    """
    if not gc.isenabled():
        yield
        return
    gc.disable()
    try:
        yield
    finally:
        # All objects since `disable` are in the youngest generation, which is searched next.
        gc.enable()
