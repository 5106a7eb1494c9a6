"""The program: a plan as the circuit of one direction needs it, one state per step.

The plan says what a converter does with the bytes of a packet, and serves both directions. A
program is what remains to be transcribed into registers and logic: constants that a circuit
registers together with the number of the state, transitions, and decoded lengths.
"""

from firm_hdl.program.control import Load, Transition
from firm_hdl.program.deserializer import (
    DeserializerProgram,
    DeserializerState,
    NextPosition,
    align_addend,
    deserializer_program,
    distance_to,
)
from firm_hdl.program.lanes import StartLanes, WordLanes, start_lanes
from firm_hdl.program.lengths import Length, NextMap
from firm_hdl.program.names import leaf_names, state_names, unique
from firm_hdl.program.serializer import (
    LENGTH_BITS,
    SerializerProgram,
    SerializerState,
    WireByte,
    serializer_program,
)
from firm_hdl.program.state import AnyState, Part, Program, State, Transfer
from firm_hdl.program.table import LEGEND, MANY_STATES, lane_remark, program_lines, state_remark

__all__ = [
    "LEGEND",
    "LENGTH_BITS",
    "MANY_STATES",
    "AnyState",
    "DeserializerProgram",
    "DeserializerState",
    "Length",
    "Load",
    "NextMap",
    "NextPosition",
    "Part",
    "Program",
    "SerializerProgram",
    "SerializerState",
    "StartLanes",
    "State",
    "Transfer",
    "Transition",
    "WireByte",
    "WordLanes",
    "align_addend",
    "deserializer_program",
    "distance_to",
    "lane_remark",
    "leaf_names",
    "program_lines",
    "serializer_program",
    "start_lanes",
    "state_names",
    "state_remark",
    "unique",
]
