"""The reader of ROS 2 messages of those who made MCAP beside our JSON: python3 mcap_ros2_reader.py MCAP ROS2 JSON_FILE ROS2_FILE.
MCAP and ROS2 are folders with the packages. Each message of the ROS 2 file has the numbers and texts of the JSON file's message;
says "TOPIC MESSAGES SCHEMA" of each channel. Ends with 0 where all is equal."""
import collections
import json
import math
import sys

sys.path[:0] = sys.argv[1:3]
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

# Fields of Foxglove's messages that have other names in ROS 2.
THEIRS = {"parent_frame_id": "header.frame_id", "frame_id": "header.frame_id", "translation": "transform.translation",
          "rotation": "transform.rotation", "timestamp": "header.stamp", "nsec": "nanosec"}
WRENCH = {"force_N": "wrench.force", "torque_Nm": "wrench.torque"}


def expect(good, what):
    if not good:
        sys.exit(f"ros2: {what}")


def of(message, path):
    for name in path.split("."):
        message = getattr(message, name)
    return message


def compare(ours, ros, at, names):
    """ours: a value of the JSON message. What is unknown is left out there."""
    if isinstance(ours, dict):
        for name, value in ours.items():
            compare(value, of(ros, names.get(name, name.lower())), f"{at}.{name}", names)
    elif isinstance(ours, list):
        expect(len(ours) == len(ros), f"{at} has {len(ros)}")
        for one, other in zip(ours, ros):
            compare(one, other, at, names)
    else:
        expect(ours == ros, f"{at} is {ros!r} and not {ours!r}")


def unknown(ours, ros, at):
    """The numbers that the JSON message leaves out are NaN."""
    for name, value in vars(ros).items():
        there = {key.lower() for key in ours}
        if isinstance(value, float) and name not in there:
            expect(math.isnan(value), f"{at}.{name} is {value}")


plain = make_reader(open(sys.argv[3], "rb"), validate_crcs=True)
reader = make_reader(open(sys.argv[4], "rb"), validate_crcs=True, decoder_factories=[DecoderFactory()])
expect(reader.get_header().profile == "ros2", "profile")
counts = collections.Counter()
for (_, channel, message), (schema, ros_channel, ros_message, ros) in zip(
    plain.iter_messages(), reader.iter_decoded_messages(), strict=True
):
    topic = ros_channel.topic
    expect(topic == {"/frames": "/tf_static"}.get(channel.topic, channel.topic), topic)
    expect(message.log_time == ros_message.log_time and message.publish_time == ros_message.publish_time, f"times on {topic}")
    expect(schema.encoding == "ros2msg" and ros_channel.message_encoding == "cdr", f"encoding of {topic}")
    ours = json.loads(message.data)
    if topic == "/wrench":
        ours = {name: ours[name] for name in WRENCH if name in ours}
    compare(ours, ros, topic, WRENCH if topic == "/wrench" else THEIRS if topic in ("/tf_static", "/tool", "/tip", "/command") else {})
    if topic in ("/core", "/arm", "/gripper", "/surface"):
        unknown(ours, ros, topic)
    counts[topic, schema.name] += 1
for (topic, name), count in sorted(counts.items()):
    print(topic, count, name)
