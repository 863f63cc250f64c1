"""rosbags, a reader of ROS 2 bags without ROS: python3 rosbags_reader.py ROSBAGS FILE. ROSBAGS is the folder with the package.
Reads each message of an MCAP file by the schemas that stand in it; says "TOPIC MESSAGES TYPE" of each topic. Ends with 0 where
each stamped message has the time at which the file has it."""
import collections
import pathlib
import sys
import unittest.mock

import zstandard

# What the reader of MCAP does not need: bags of other kinds, LZ4, metadata in a second file.
for name in ("apsw", "backports", "lz4", "lz4.frame", "ruamel", "ruamel.yaml", "ruamel.yaml.error", "typing_extensions"):
    sys.modules[name] = unittest.mock.MagicMock()
sys.modules["backports"].zstd = zstandard
sys.modules["typing_extensions"].override = lambda method: method
sys.path.insert(0, sys.argv[1])
from rosbags.highlevel import AnyReader

counts = collections.Counter()
with AnyReader([pathlib.Path(sys.argv[2])]) as reader:
    for connection, time, raw in reader.messages():
        message = reader.deserialize(raw, connection.msgtype)
        header = message.transforms[0].header if connection.topic == "/tf_static" else message.header
        if header.stamp.sec * 10**9 + header.stamp.nanosec > time:
            sys.exit(f"rosbags: a message on {connection.topic} has a time after {time} ns")
        counts[connection.topic, connection.msgtype] += 1
for (topic, name), count in sorted(counts.items()):
    print(topic, count, name)
