"""The parser of hand-tracking-sdk reads lines: python3 hand_sdk_parser.py FOLDER FILE. Prints for each line "no", or side, kind,
frame, stamp and values."""
import sys

sys.path.insert(0, sys.argv[1])
from hand_tracking_sdk.exceptions import ParseError
from hand_tracking_sdk.parser import parse_line

for line in open(sys.argv[2], encoding="latin-1", newline="\n").read().split("\n")[:-1]:
    try:
        packet = parse_line(line)
    except (ParseError, ValueError):
        print("no")
        continue
    data = packet.data
    if packet.kind.value == "landmarks":
        values = [number for point in data.points for number in point]
    else:
        values = [data.x, data.y, data.z, data.qx, data.qy, data.qz, data.qw]
    debug = packet.debug
    frame, stamp = (None, None) if debug is None else (debug.source_frame_seq, debug.source_ts_ns)
    print(packet.side.value.lower(), packet.kind.value, frame, stamp, *[repr(float(value)) for value in values])
