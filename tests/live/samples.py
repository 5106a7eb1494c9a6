"""The messages that peers send and expect, as CDR that rosbags has written."""

from __future__ import annotations

import struct

import numpy as np
from rosbags.typesys import Stores, get_typestore

__all__ = ["BLOCK_HEAD", "block", "imu", "number_of_imu", "set_bool", "string"]

BLOCK_HEAD = 16
"""Bytes of a UInt8MultiArray before its data."""

_STORE = get_typestore(Stores.ROS2_JAZZY)


def _imu(number: int) -> object:
    types = _STORE.types
    covariance = np.zeros(9)
    angular = covariance.copy()
    angular[8] = number
    vector = types["geometry_msgs/msg/Vector3"]
    return types["sensor_msgs/msg/Imu"](
        header=types["std_msgs/msg/Header"](
            stamp=types["builtin_interfaces/msg/Time"](sec=number, nanosec=0),
            frame_id=f"imu{number % 7}",
        ),
        orientation=types["geometry_msgs/msg/Quaternion"](x=number * 0.5, y=0.0, z=0.0, w=1.0),
        orientation_covariance=covariance,
        angular_velocity=vector(x=0.0, y=0.0, z=0.0),
        angular_velocity_covariance=angular,
        linear_acceleration=vector(x=0.0, y=0.0, z=-float(number)),
        linear_acceleration_covariance=covariance,
    )


def imu(number: int) -> bytes:
    """Return Imu number `number`."""
    return bytes(_STORE.serialize_cdr(_imu(number), "sensor_msgs/msg/Imu"))


def number_of_imu(payload: bytes) -> int:
    """Return the number of an Imu, or -1 if it has other values than that one.

    Values are compared: peers leave old bytes in the padding.
    """
    number = int.from_bytes(payload[4:8], "little")
    message = _STORE.deserialize_cdr(payload, "sensor_msgs/msg/Imu")
    same = bytes(_STORE.serialize_cdr(message, "sensor_msgs/msg/Imu")) == imu(number)
    return number if same else -1


def block(number: int, size: int) -> bytes:
    """Return a UInt8MultiArray of about `size` bytes, which depend on `number`."""
    data = bytes((number + i * 7) & 0xFF for i in range(251)) * (size // 251 & ~3)
    return b"\0\1\0\0" + struct.pack("<III", 0, 0, len(data)) + data


def string(text: str) -> bytes:
    """Return a String."""
    data = text.encode() + b"\0"
    return b"\0\1\0\0" + struct.pack("<I", len(data)) + data


def set_bool(value: bool) -> bytes:
    """Return a request of SetBool."""
    return b"\0\1\0\0" + bytes([value])
