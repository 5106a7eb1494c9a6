"""TS1: does firm-hdl read a definition as ROS does?

Oracles read each definition with code of their own; what they say of it is compared with our model
in plain data, and differences that are meant to be are known by name.
"""

from __future__ import annotations

from firm_hdl.verify.ts1.command import Ts1
from firm_hdl.verify.ts1.oracles import ORACLES
from firm_hdl.verify.ts1.run import Ts1Run, each_distro

__all__ = ["ORACLES", "Ts1", "Ts1Run", "each_distro"]
