"""Python's search for reference cycles, put off while a circuit is made.

Elaborating and writing a circuit makes up to millions of objects, and nearly all of them live until
the text is written. Python searches the new objects for cycles whenever there are a few hundred
more, and all objects when a quarter of them is new. That took almost half of the time of a build.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager

__all__ = ["search_put_off"]


@contextmanager
def search_put_off() -> Iterator[None]:
    """Search for cycles once, when the block ends, and only among the objects that are new.

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
        gc.enable()
    # All objects since `disable` are in the youngest generation. After an exception, Python
    # searches later: Amaranth would warn of unfinished circuits before the exception is reported.
    gc.collect(0)
