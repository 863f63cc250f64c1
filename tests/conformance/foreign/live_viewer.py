"""A viewer of `run --live`: python3 live_viewer.py WEBSOCKETS WAY PROGRAM run SCENE --live 0 ...
WEBSOCKETS is the folder of the package. WAY: "all" takes each message of each channel and says "TOPIC MESSAGES FIRST_NS LAST_NS",
then "GAPS n", the ticks that /core lacks in between; "stall" subscribes and reads nothing; "mistakes" sends requests that are none
and says the answers. The last line is the program's exit code and what it said."""
import asyncio
import json
import socket
import struct
import subprocess
import sys

sys.path.insert(0, sys.argv[1])
import websockets

SPOILT = ["", "{", "[]", "null", '{"op": 1}', '{"op": "advertise"}', '{"op": "subscribe", "subscriptions": [{"id": -1}]}',
          '{"op": "subscribe", "subscriptions": [{"id": -1, "channelId": 0}]}', '{"op": "unsubscribe", "subscriptionIds": [4294967296]}',
          '{"op": "subscribe", "subscriptions": [{"id": 0, "channelId": 1.5}]}',
          '{"op": "subscribe", "subscriptions": [{"id": 0, "channelId": 99}]}', b"\1\2\3", "\u00e4" * 100]


def page(port):
    """What a browser gets."""
    with socket.create_connection(("127.0.0.1", port), 10) as browser:
        browser.sendall(b"GET / HTTP/1.1\r\nHost: a\r\n\r\n")
        return browser.recv(100).decode().splitlines()[0]


async def watch(way, port, program):
    uri = f"ws://127.0.0.1:{port}"
    async with websockets.connect(uri, subprotocols=["foxglove.websocket.v1"], max_queue=None if way == "all" else 1) as link:
        assert link.subprotocol == "foxglove.websocket.v1"
        assert json.loads(await link.recv())["op"] == "serverInfo"
        channels = json.loads(await link.recv())["channels"]
        for channel in channels:
            assert json.loads(channel["schema"])["type"] == "object" and channel["encoding"] == "json", channel
        if way == "mistakes":
            print(await asyncio.to_thread(page, port))
        for spoilt in SPOILT if way == "mistakes" else []:
            await link.send(spoilt)
            if isinstance(spoilt, str):
                print(json.loads(await link.recv())["message"])
        ask = [{"id": 100 + channel["id"], "channelId": channel["id"]} for channel in channels]
        await link.send(json.dumps({"op": "subscribe", "subscriptions": ask}))
        if way == "stall":
            while program.poll() is None:
                await asyncio.sleep(0.05)
            link.transport.abort()
            return
        times = {channel["id"]: [] for channel in channels}
        try:
            while True:
                kind, subscription, time = struct.unpack_from("<BIQ", data := await link.recv())
                assert kind == 1 and isinstance(json.loads(data[13:]), dict)
                times[subscription - 100].append(time)
        except websockets.ConnectionClosed:
            pass
        for channel in channels:
            of = times[channel["id"]]
            assert of == sorted(of)
            print(channel["topic"], len(of), of[0] if of else "-", of[-1] if of else "-")
            if channel["topic"] == "/core":
                print("GAPS", round((of[-1] - of[0]) / 1e6) + 1 - len(of))


run = subprocess.Popen(sys.argv[3:], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
where = run.stderr.readline()
try:
    asyncio.run(watch(sys.argv[2], int(where.split(":")[-1].split(",")[0]), run))
except websockets.ConnectionClosed:
    pass
said = run.stderr.read().strip()
print("ended", run.wait(), said)
