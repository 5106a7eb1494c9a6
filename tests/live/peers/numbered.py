"""What the peers in rclpy and in rospy share: their output, and messages that have a number.

The Python of ROS finds this module because it is in the folder of the script that it runs.
"""

import json

from sensor_msgs.msg import Imu, LaserScan, PointCloud2, PointField


def say(**what):
    print(json.dumps(what), flush=True)


def imu(number):
    message = Imu()
    _stamp(message, number)
    message.header.frame_id = f"imu{number % 7}"
    message.orientation.x = number * 0.5
    message.angular_velocity_covariance[8] = number
    message.linear_acceleration.z = -float(number)
    return message


def cloud(number, size):
    message = PointCloud2(height=1, width=size // 16, point_step=16, row_step=size // 16 * 16)
    _stamp(message, number)
    message.header.frame_id = "lidar"
    message.fields = [
        PointField(name=name, offset=4 * at, datatype=PointField.FLOAT32, count=1)
        for at, name in enumerate(["x", "y", "z", "intensity"])
    ]
    message.data = (number.to_bytes(4, "little") * 4) * (size // 16)
    message.is_dense = True
    return message


def scan(number):
    """As long as those of a usual lidar; a float holds each number that is here."""
    message = LaserScan(range_max=30.0, ranges=[number + 0.5] * 180)
    _stamp(message, number)
    message.header.frame_id = "laser"
    return message


def stamped(message):
    """Return the number of a message with a header."""
    stamp = message.header.stamp
    return stamp.secs if hasattr(stamp, "secs") else stamp.sec


def _stamp(message, number):
    # ROS 1 has `secs`, ROS 2 has `sec`.
    stamp = message.header.stamp
    setattr(stamp, "secs" if hasattr(stamp, "secs") else "sec", number)
