"""Fuzzing of hardware: packets by the million through exported Verilog, in Verilator.

For each type and bus width, a program is compiled: Verilator's models of the circuits, and a
harness in C++ that makes packets, damages them, stalls all streams, and checks every cycle. What
must come is predicted by a decoder in `harness/judge.cpp`, which shares no code with plans and
circuits. It is driven by a table of the type's fields, which :mod:`lab.fuzz.table`
makes from the message model alone.
"""

from __future__ import annotations

from lab.fuzz.run import Failure, FuzzTask, Outcome, run_task

__all__ = ["Failure", "FuzzTask", "Outcome", "run_task"]
