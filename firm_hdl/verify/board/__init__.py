"""The test system ``board``: TS3's cases through a node on a board that sends them back.

:mod:`description` says which node the board has to have, :mod:`talk` sends and receives,
:mod:`judge` compares, and :mod:`system` is the test system of the command.
"""

__all__ = []
