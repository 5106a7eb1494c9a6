"""A peer in rclpy, run by the Python of an environment with a release of ROS 2.

The first argument says what to do, the second is a JSON object of options. Output is a JSON object
per line: ``{"ready": true}`` when endpoints exist, and one with the results at the end.
"""

import json
import sys
import time

import rclpy
from geometry_msgs.msg import Twist
from numbered import cloud, imu, say, scan, stamped
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import Imu, LaserScan, PointCloud2
from std_msgs.msg import Int32, String, UInt8MultiArray
from std_srvs.srv import SetBool


def qos_of(options):
    depth = options.get("depth", 10)
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST if depth else HistoryPolicy.KEEP_ALL,
        depth=depth or 1,
        reliability=ReliabilityPolicy.BEST_EFFORT
        if options.get("best_effort")
        else ReliabilityPolicy.RELIABLE,
        durability=DurabilityPolicy.TRANSIENT_LOCAL
        if options.get("transient_local")
        else DurabilityPolicy.VOLATILE,
    )


def block(number, size):
    return UInt8MultiArray(
        data=bytes((number + i * 7) & 0xFF for i in range(251)) * (size // 251 & ~3)
    )


def twist(number):
    message = Twist()
    message.linear.x, message.angular.z = float(number), -float(number)
    return message


def message_of(options, number):
    return {
        "imu": lambda: imu(number),
        "cloud": lambda: cloud(number, options.get("bytes", 0)),
        "block": lambda: block(number, options.get("bytes", 0)),
        "scan": lambda: scan(number),
        "twist": lambda: twist(number),
        "string": lambda: String(data=f"m{number}"),
    }[options["type"]]()


def number_of(options, message):
    """Return the number of a message, or -1 if its content is not what that number's has to be."""
    if options["type"] in ("imu", "cloud", "scan"):
        number = stamped(message)
    elif options["type"] == "block":
        number = message.data[0] if message.data else -1
    elif options["type"] == "twist":
        number = int(message.linear.x)
    else:
        number = int(message.data[1:])
    return number if message == message_of(options, number) else -1


TYPES = {
    "imu": Imu,
    "cloud": PointCloud2,
    "block": UInt8MultiArray,
    "scan": LaserScan,
    "string": String,
    "twist": Twist,
}


def publish(node, options):
    publisher = node.create_publisher(TYPES[options["type"]], options["topic"], qos_of(options))
    messages = [message_of(options, n) for n in range(options["count"])]
    say(ready=True)
    end = time.monotonic() + options.get("patience", 20)
    while publisher.get_subscription_count() < options.get("wait", 1):
        if time.monotonic() > end:
            return say(sent=0)
        rclpy.spin_once(node, timeout_sec=0.02)
    time.sleep(options.get("settle", 0.3))
    at = time.monotonic()
    for message in messages:
        publisher.publish(message)
        at += options.get("period", 0)
        time.sleep(max(0, at - time.monotonic()))
    end = time.monotonic() + options.get("linger", 2)
    while time.monotonic() < end:
        rclpy.spin_once(node, timeout_sec=0.1)
    return say(sent=len(messages))


def trip(node, options):
    """Publish on several topics at once, and take what comes back on others.

    Numbers of messages are those of this process: each has to come back with equal values.
    """
    numbers = [[] for _ in options["topics"]]
    publishers, messages, due = [], [], []
    for got, each in zip(numbers, options["topics"], strict=True):
        kind, qos = TYPES[each["type"]], qos_of(each)
        publishers.append(node.create_publisher(kind, each["to"], qos))
        messages.append([message_of(each, n) for n in range(each["count"])])

        def take(message, got=got, each=each):
            got.append(number_of(each, message))

        node.create_subscription(kind, each["back"], take, qos)
    say(ready=True)
    end = time.monotonic() + options.get("patience", 60)
    while not all(
        publisher.get_subscription_count() and node.count_publishers(each["back"])
        for publisher, each in zip(publishers, options["topics"], strict=True)
    ):
        if time.monotonic() > end:
            return say(failed="no bridge")
        rclpy.spin_once(node, timeout_sec=0.02)
    time.sleep(options.get("settle", 1))
    say(begins=True)
    begin = time.monotonic()
    for index, each in enumerate(options["topics"]):
        due += [(begin + n * each["period"], index, n) for n in range(each["count"])]
    for at, index, number in sorted(due):
        while (left := at - time.monotonic()) > 0:
            rclpy.spin_once(node, timeout_sec=left)
        publishers[index].publish(messages[index][number])
    seconds = time.monotonic() - begin
    # Seconds since a message came: a slow simulation ends its work late.
    linger = options.get("linger", 10)
    end, came = time.monotonic() + linger, 0
    while time.monotonic() < end and any(
        got[-1:] != [each["count"] - 1]
        for got, each in zip(numbers, options["topics"], strict=True)
    ):
        rclpy.spin_once(node, timeout_sec=0.1)
        if came < (came := sum(map(len, numbers))):
            end = time.monotonic() + linger
    return say(numbers=numbers, seconds=seconds)


def echo(node, options):
    """Send back what comes, until this process is killed."""
    publisher = node.create_publisher(String, options["back"], 10)
    node.create_subscription(String, options["to"], publisher.publish, 10)
    say(ready=True)
    rclpy.spin(node)


def delays(node, options):
    """Let one message of 64 bytes at a time go and come back; tell the seconds of each."""
    got, seconds = [], []
    publisher = node.create_publisher(String, options["to"], 10)
    node.create_subscription(String, options["back"], got.append, 10)
    say(ready=True)
    end = time.monotonic() + options.get("patience", 60)
    while not (publisher.get_subscription_count() and node.count_publishers(options["back"])):
        if time.monotonic() > end:
            return say(failed="no echo")
        rclpy.spin_once(node, timeout_sec=0.02)
    time.sleep(1)
    for number in range(options["count"]):
        before, begin = len(got), time.monotonic()
        publisher.publish(String(data=f"{number:055}"))
        while len(got) == before and time.monotonic() < begin + 5:
            rclpy.spin_once(node, timeout_sec=1)
        seconds.append(time.monotonic() - begin)
        time.sleep(0.01)
    return say(seconds=seconds)


def come_and_go(node, options):
    """Be another participant each time, which sends a message and waits until it comes back."""
    say(ready=True)
    back = 0
    for number in range(options["count"]):
        context = rclpy.Context()
        rclpy.init(context=context)
        peer = rclpy.create_node(f"peer{number}", context=context)
        executor = SingleThreadedExecutor(context=context)
        executor.add_node(peer)
        got = []
        peer.create_subscription(String, options["back"], got.append, 10)
        publisher = peer.create_publisher(String, options["to"], 10)
        end = time.monotonic() + options.get("patience", 20)
        sent = False
        while not got and time.monotonic() < end:
            executor.spin_once(timeout_sec=0.02)
            if publisher.get_subscription_count() and peer.count_publishers(options["back"]):
                if not sent:
                    # Both sides have to know each other, and only one of them is asked here.
                    executor.spin_once(timeout_sec=0.3)
                    publisher.publish(String(data=f"m{number}"))
                sent = True
        back += [each.data for each in got] == [f"m{number}"]
        executor.shutdown()
        peer.destroy_node()
        rclpy.shutdown(context=context)
    say(back=back)


def subscribe(node, options):
    numbers = []
    node.create_subscription(
        TYPES[options["type"]],
        options["topic"],
        lambda message: numbers.append(number_of(options, message)),
        qos_of(options),
    )
    say(ready=True)
    end = time.monotonic() + options.get("patience", 20)
    while len(numbers) < options["count"] and time.monotonic() < end:
        rclpy.spin_once(node, timeout_sec=0.1)
    time.sleep(options.get("settle", 0))
    rclpy.spin_once(node, timeout_sec=0.1)
    say(numbers=numbers)


def graph(node, options):
    say(ready=True)
    begin = time.monotonic()
    end = begin + options.get("patience", 20)
    name, namespace = options["node"], options["namespace"]
    while time.monotonic() < end:
        rclpy.spin_once(node, timeout_sec=0.05)
        if (name, namespace) not in node.get_node_names_and_namespaces():
            continue
        publishers = node.get_publisher_names_and_types_by_node(name, namespace)
        if len(publishers) >= options["publishers"]:
            break
    seconds = time.monotonic() - begin
    infos = []
    for topic in options.get("topics", []):
        # Names without a slash are those of DDS.
        raw = not topic.startswith("/")
        infos += node.get_publishers_info_by_topic(topic, no_mangle=raw)
        infos += node.get_subscriptions_info_by_topic(topic, no_mangle=raw)
    infos = [info for info in infos if info.node_name != node.get_name()]
    say(
        seconds=seconds,
        owners=[[info.node_name, info.node_namespace] for info in infos],
        nodes=node.get_node_names_and_namespaces(),
        publishers=node.get_publisher_names_and_types_by_node(name, namespace),
        subscriptions=node.get_subscriber_names_and_types_by_node(name, namespace),
        services=node.get_service_names_and_types_by_node(name, namespace),
        clients=node.get_client_names_and_types_by_node(name, namespace),
        hashes=[str(info.topic_type_hash) for info in infos],
        depths=[info.qos_profile.reliability.name for info in infos],
    )


def gone(node, options):
    """Say when a node appears, and when it is gone."""
    say(ready=True)
    wanted = (options["node"], options["namespace"])
    for there in (True, False):
        end = time.monotonic() + options.get("patience", 20)
        while (wanted in node.get_node_names_and_namespaces()) != there:
            if time.monotonic() > end:
                return say(failed=f"there: {not there}")
            rclpy.spin_once(node, timeout_sec=0.05)
        say(there=there)
    return None


def double(node, options):
    """Publish numbers, take their doubles, and say who publishes them."""
    doubles = []
    publisher = node.create_publisher(Int32, "/number", 10)
    node.create_subscription(Int32, "/double", lambda message: doubles.append(message.data), 10)
    say(ready=True)
    end = time.monotonic() + options.get("patience", 20)
    while not (publisher.get_subscription_count() and node.count_publishers("/double")):
        if time.monotonic() > end:
            return say(failed="no bridge")
        rclpy.spin_once(node, timeout_sec=0.02)
    time.sleep(options.get("settle", 0.3))
    for number in options["numbers"]:
        publisher.publish(Int32(data=number))
        waits = time.monotonic() + 5
        before = len(doubles)
        while len(doubles) == before and time.monotonic() < waits:
            rclpy.spin_once(node, timeout_sec=0.1)
    return say(
        doubles=doubles,
        nodes=node.get_node_names_and_namespaces(),
        topics=node.get_topic_names_and_types(),
    )


def call(node, options):
    client = node.create_client(SetBool, options["name"])
    say(ready=True)
    there = client.wait_for_service(timeout_sec=options.get("patience", 20))
    answers = []
    for number in range(options["count"] if there else 0):
        future = client.call_async(SetBool.Request(data=bool(number & 1)))
        rclpy.spin_until_future_complete(node, future, timeout_sec=options.get("timeout", 5))
        answer = future.result()
        answers.append(None if answer is None else [answer.success, answer.message])
    say(answers=answers)


def serve(node, options):
    served = []

    def handle(request, response):
        served.append(request.data)
        response.success = request.data
        response.message = f"{request.data} {len(served)}"
        return response

    node.create_service(SetBool, options["name"], handle)
    say(ready=True)
    end = time.monotonic() + options.get("patience", 20)
    while len(served) < options["count"] and time.monotonic() < end:
        rclpy.spin_once(node, timeout_sec=0.1)
    rclpy.spin_once(node, timeout_sec=0.5)
    say(served=len(served))


if __name__ == "__main__":
    what, options = sys.argv[1], json.loads(sys.argv[2])
    rclpy.init()
    node = rclpy.create_node(options.get("own", "peer"))
    {
        "publish": publish,
        "trip": trip,
        "come_and_go": come_and_go,
        "echo": echo,
        "delays": delays,
        "subscribe": subscribe,
        "graph": graph,
        "gone": gone,
        "call": call,
        "double": double,
        "serve": serve,
    }[what](node, options)
    node.destroy_node()
    rclpy.shutdown()
