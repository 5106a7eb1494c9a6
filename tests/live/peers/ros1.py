"""A peer in rospy, run by the Python of the system; arguments and output are those of `ros.py`."""

import io
import json
import sys
import threading
import time

import rospy
from numbered import cloud, imu, say, stamped
from sensor_msgs.msg import Imu, PointCloud2
from std_msgs.msg import String
from std_srvs.srv import SetBool


def make(kind, number, size):
    if kind == "cloud":
        return cloud(number, size)
    return imu(number) if kind == "imu" else String(data=f"m{number}")


TYPES = {"imu": Imu, "cloud": PointCloud2, "string": String}


def content(message):
    """Return what has to be equal: rospy sets the number in the header when it sends."""
    if hasattr(message, "header"):
        message.header.seq = 0
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


def trip(options):
    """Publish on several topics at once, and take what comes back on others."""
    numbers = [[] for _ in options["topics"]]
    publishers, subscribers, messages = [], [], []
    for got, each in zip(numbers, options["topics"], strict=True):
        kind, size = each["type"], each.get("bytes", 0)
        messages.append([make(kind, n, size) for n in range(each["count"])])
        publishers.append(
            rospy.Publisher(each["to"], TYPES[kind], queue_size=10_000, tcp_nodelay=True)
        )

        def take(message, got=got, kind=kind, size=size):
            number = int(message.data[1:]) if kind == "string" else stamped(message)
            wanted = make(kind, number, size)
            got.append(number if content(message) == content(wanted) else -1)

        subscribers.append(rospy.Subscriber(each["back"], TYPES[kind], take, tcp_nodelay=True))
    say(ready=True)
    end = time.monotonic() + options.get("patience", 60)
    while not all(each.get_num_connections() for each in (*publishers, *subscribers)):
        if time.monotonic() > end:
            return say(failed="no bridge")
        time.sleep(0.02)
    time.sleep(options.get("settle", 0.5))
    say(begins=True)
    begin = time.monotonic()

    def publish(index):
        for n, message in enumerate(messages[index]):
            time.sleep(max(0, begin + n * options["topics"][index]["period"] - time.monotonic()))
            publishers[index].publish(message)

    threads = [threading.Thread(target=publish, args=[n]) for n in range(len(messages))]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    seconds = time.monotonic() - begin
    # Seconds since a message came: a slow simulation ends its work late.
    linger = options.get("linger", 20)
    end, came = time.monotonic() + linger, 0
    while time.monotonic() < end and any(
        got[-1:] != [each["count"] - 1]
        for got, each in zip(numbers, options["topics"], strict=True)
    ):
        time.sleep(0.05)
        if came < (came := sum(map(len, numbers))):
            end = time.monotonic() + linger
    return say(numbers=numbers, seconds=seconds)


def call(options):
    say(ready=True)
    rospy.wait_for_service(options["name"], timeout=options.get("patience", 20))
    ask = rospy.ServiceProxy(options["name"], SetBool, persistent=options.get("persistent", False))
    answers = []
    for number in range(options["count"]):
        answer = ask(bool(number & 1))
        answers.append([answer.success, answer.message])
    say(answers=answers)


if __name__ == "__main__":
    what, options = sys.argv[1], json.loads(sys.argv[2])
    rospy.init_node(options.get("own", "peer"), disable_signals=True)
    {"trip": trip, "call": call}[what](options)
