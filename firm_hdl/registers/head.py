"""The registers that every block begins with: what it is, its control, and its interrupt."""

from __future__ import annotations

from firm_hdl.registers.table import Field, Kind, Register

__all__ = [
    "BODY_ADDRESS",
    "LATCHED",
    "bits",
    "control_register",
    "identity_registers",
    "interrupt_registers",
    "word",
]

ID = int.from_bytes(b"FIRM", "little")

VERSION = (1, 0)
"""Of the registers before the body: a new minor one adds some."""

BODY_ADDRESS = 0x40
"""Where that begins which the fingerprint tells of: a message, or the counters of a node."""

LATCHED = " As at the last latch; stops at its largest value."
"""What a counter is."""


def bits(kind: Kind, name: str, low: int, bits: int, meaning: str, reset: int = 0) -> Field:
    """Return a field."""
    return Field(name=name, low=low, bits=bits, kind=kind, meaning=meaning, reset=reset)


def word(address: int, name: str, kind: Kind, meaning: str, reset: int = 0) -> Register:
    """Return a register with one field."""
    only = bits(kind, name, 0, 32, meaning, reset)
    return Register(name=name, address=address, fields=(only,), meaning=meaning)


def identity_registers(fingerprint: int, meaning: str) -> tuple[Register, ...]:
    """Return what tells software whether it knows these registers.

    * `fingerprint`: 64 bits.
    * `meaning`: what these depend on.
    """
    return (
        word(0x00, "id", "constant", "The text FIRM.", ID),
        Register(
            name="version",
            address=0x04,
            meaning=f"Of the registers before {BODY_ADDRESS:#x}.",
            fields=(
                bits("constant", "minor", 0, 16, "Raised by what only adds.", VERSION[1]),
                bits("constant", "major", 16, 16, "Raised by all other changes.", VERSION[0]),
            ),
        ),
        word(0x08, "fingerprint_low", "constant", meaning, fingerprint & 0xFFFF_FFFF),
        word(0x0C, "fingerprint_high", "constant", meaning, fingerprint >> 32),
    )


def control_register(*own: Field, reset: str, latch: str = "Latch all counters.") -> Register:
    """Return the register of pulses; `own` are those besides ``latch`` and ``reset``."""
    common = (
        bits("pulse", "latch", 1, 1, latch),
        bits("pulse", "reset", 2, 1, reset),
    )
    fields = tuple(sorted((*own, *common), key=lambda field: field.low))
    return Register(name="control", address=0x10, meaning="A written 1 acts once.", fields=fields)


def interrupt_registers(message: str, error: str) -> tuple[Register, ...]:
    """Return the registers of the interrupt; `message` and `error` say what the events are."""
    events = (("message", 0, message), ("error", 1, error))

    def fields(kind: Kind) -> tuple[Field, ...]:
        return tuple(bits(kind, name, low, 1, meaning) for name, low, meaning in events)

    enable = "Events that raise the interrupt."
    return (
        Register(name="interrupt_enable", address=0x18, meaning=enable, fields=fields("setting")),
        Register(
            name="interrupt",
            address=0x1C,
            meaning="Events; a written 1 clears one.",
            fields=fields("event"),
        ),
    )
