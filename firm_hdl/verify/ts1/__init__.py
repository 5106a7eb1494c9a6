"""TS1: does firm-hdl read a definition as ROS does?

Oracles read each definition with code of their own. What they say of a definition is compared with
our model in plain data. Differences that are meant to be have names.
"""

__all__ = []
