"""The MCAP reader of those who made the format reads an export: python3 mcap_reader.py FOLDER FILE. Checks all that a file
says of itself, and says in a line each: "TOPIC MESSAGES SCHEMA", "attached NAME SIZE", "KEY = TEXT" of its metadata. Ends with
0 where all is as it must be."""
import collections
import io
import json
import sys
import tomllib
import zlib

sys.path.insert(0, sys.argv[1])
from mcap.opcode import Opcode
from mcap.reader import NonSeekingReader, make_reader
from mcap.stream_reader import StreamReader

import jsonschema

# What viewers look for in a message of theirs, by its published schema.
THEIRS = {
    "foxglove.PoseInFrame": ["timestamp", "frame_id", "pose"],
    "foxglove.FrameTransforms": ["transforms"],
}
TYPES = {"object": dict, "array": list, "string": str, "boolean": bool, "integer": int, "number": (int, float)}


def expect(good, what):
    if not good:
        sys.exit(f"mcap: {what}")


def validate(value, schema, at):
    """What our schemas ask: types, fields that must be there, and no field that is not named."""
    kind = schema["type"]
    good = isinstance(value, TYPES[kind]) and (kind == "boolean" or not isinstance(value, bool))
    expect(good, f"{at} is {value!r} and no {kind}")
    if kind == "array":
        for item in value:
            validate(item, schema["items"], f"{at}[]")
    if kind == "object":
        for name in schema.get("required", []):
            expect(name in value, f"{at} has no {name}")
        for name, inner in value.items():
            expect(name in schema["properties"], f"{at}.{name} is not in its schema")
            validate(inner, schema["properties"][name], f"{at}.{name}")


def no_constant(text):
    sys.exit(f"mcap: {text} is no JSON")


def keys(messages):
    return [(channel.topic, message.sequence, message.log_time, message.data) for _, channel, message in messages]


data = open(sys.argv[2], "rb").read()
reader = make_reader(io.BytesIO(data), validate_crcs=True)
header, summary = reader.get_header(), reader.get_summary()
expect(header.profile == "" and header.library.startswith("Encounter "), f"header {header}")
messages = list(reader.iter_messages())
times = [message.log_time for _, _, message in messages]
counts = collections.Counter(message.channel_id for _, _, message in messages)
sequences = collections.Counter()
schemas = {id: json.loads(schema.data) for id, schema in summary.schemas.items()}
for schema in summary.schemas.values():
    jsonschema.Draft7Validator.check_schema(schemas[schema.id])  # throws
    missing = set(THEIRS.get(schema.name, [])) - set(schemas[schema.id].get("required", []))
    expect(not missing, f"{schema.name} does not ask for {missing}")
expect({schema.name for schema in summary.schemas.values()} & THEIRS.keys(), "no message is one of theirs")
judges = {id: jsonschema.Draft7Validator(schema) for id, schema in schemas.items()}
for schema, channel, message in messages:
    expect(channel.message_encoding == "json" and schema.encoding == "jsonschema", f"encodings of {channel.topic}")
    expect(message.sequence == sequences[channel.id], f"{channel.topic}: number {message.sequence}")
    sequences[channel.id] += 1
    value = json.loads(message.data, parse_constant=no_constant)
    validate(value, schemas[schema.id], channel.topic)
    if message.sequence % 20 == 0:  # it takes its time
        judges[schema.id].validate(value)  # throws

said = summary.statistics
expect(said.message_count == len(messages), f"{said.message_count} messages are said, {len(messages)} there")
expect({id: n for id, n in said.channel_message_counts.items() if n} == counts, f"{said.channel_message_counts}, {counts}")
expect((said.message_start_time, said.message_end_time) == (min(times), max(times)), f"times of {said}")
expect(said.schema_count == len(summary.schemas) and said.channel_count == len(summary.channels), f"{said}")
expect(said.chunk_count == len(summary.chunk_indexes), f"chunks of {said}")
expect(said.attachment_count == len(summary.attachment_indexes), f"attachments of {said}")
expect(said.metadata_count == len(summary.metadata_indexes), f"metadata of {said}")
expect(sum(index.chunk_length for index in summary.chunk_indexes) < len(data), "chunks are longer than the file")

# From front to back, as through a pipe, with the CRC of the whole data section: the same in the same order, which is that of time.
streamed = list(NonSeekingReader(io.BytesIO(data), validate_crcs=True).iter_messages(log_time_order=False))
expect(keys(streamed) == keys(messages), "messages in the order of the file are others")
expect(times == sorted(times), "times go back")
# By its indexes: a part of the time, and one channel.
middle = times[len(times) // 2]
part = list(reader.iter_messages(starting_at=middle))
expect(keys(part) == [key for key in keys(messages) if key[2] >= middle], "the later part is another")
one = list(reader.iter_messages(topics=["/core"]))
expect(keys(one) == [key for key in keys(messages) if key[0] == "/core"], "one channel alone is another")

records = list(StreamReader(io.BytesIO(data), emit_chunks=True, validate_crcs=True).records)
footer = records[-1]
expect(zlib.crc32(data[footer.summary_start : -12]) == footer.summary_crc != 0, "CRC of the summary")
for index in summary.chunk_indexes:
    for channel, offset in index.message_index_offsets.items():
        expect(data[offset] == Opcode.MESSAGE_INDEX and data[offset + 9] == channel, f"no message index at {offset}")
at = footer.summary_offset_start
offsets = list(StreamReader(io.BytesIO(data[at:]), skip_magic=True).records)[:-1]
expect(len(offsets) == 6, f"{len(offsets)} kinds in the summary")
for offset in offsets:
    expect(data[offset.group_start] == offset.group_opcode, f"{offset} leads to something else")

for id, channel in summary.channels.items():
    print(channel.topic, counts[id], summary.schemas[channel.schema_id].name)
for attachment in reader.iter_attachments():
    if attachment.name == "resolved.toml":
        tomllib.loads(attachment.data.decode())
    print("attached", attachment.name, len(attachment.data))
for metadata in reader.iter_metadata():
    expect(metadata.name == "encounter", f"metadata {metadata.name}")
    for key, text in metadata.metadata.items():
        print(key, "=", text)
