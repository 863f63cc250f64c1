"""hand-tracking-sdk receives the fake's hands: python3 hand_sdk_client.py FOLDER udp|tcp_client PORT. Says its port in a line
over UDP. Ends with 0 where all is as it must be."""
import socket
import sys

sys.path.insert(0, sys.argv[1])
from hand_tracking_sdk import HTSClient, HTSClientConfig, JointName, StreamOutput
from hand_tracking_sdk.client import TransportMode
from hand_tracking_sdk.convert import convert_hand_frame_unity_left_to_right


def expect(good, what):
    if not good:
        sys.exit(f"hand-tracking-sdk: {what}")


def near(one, other):
    return all(abs(a - b) < 1e-9 for a, b in zip(one, other, strict=True))


mode, port = TransportMode(sys.argv[2]), int(sys.argv[3])
config = HTSClientConfig(transport_mode=mode, host="127.0.0.1", port=port, timeout_s=10.0, output=StreamOutput.FRAMES)
seen = []
for frame in HTSClient(config).iter_events():
    hand = convert_hand_frame_unity_left_to_right(frame)
    # As in hand_test.cpp: a quarter turn about z, right-handed.
    wrist = hand.wrist
    expect(hand.side.value == "Left", f"side {hand.side}")
    expect(near((wrist.x, wrist.y, wrist.z), (0.1, -0.2, 0.3)), f"wrist at {wrist}")
    expect(near((wrist.qx, wrist.qy, wrist.qz, wrist.qw), (0, 0, 0.5**0.5, 0.5**0.5)), f"wrist turned {wrist}")
    expect(near(hand.get_joint(JointName.WRIST), (0, 0, 0)), "the wrist's own joint")
    expect(near(hand.get_joint(JointName.INDEX_TIP), (0.08, 0.008, -0.016)), f"{hand.get_joint(JointName.INDEX_TIP)}")
    seen.append((frame.source_frame_seq, frame.source_ts_ns))
    if len(seen) > 40:
        break
expect(seen[-1][0] > seen[0][0] + 10 and seen[-1][1] > seen[0][1], f"numbers and stamps {seen}")
