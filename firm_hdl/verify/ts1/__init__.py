"""TS1: does firm-hdl read a definition as ROS does?

Oracles read each definition with their own code. Their readings are compared with our model as
plain data. Each deliberate difference has a key.
"""

__all__ = []
