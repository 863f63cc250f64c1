"""PIPython's ReplyServer as a controller for our driver: python3 pipython_replies.py FOLDER. Says its port in a line, and
answers only what it knows until its input ends; ends with 0 where it was told what it must be."""
import collections
import sys

import pipython_parts

pipython_parts.import_from(sys.argv[1])
from pipython.pitools import replyserver

axes = "XYZUVW"


def each(value):
    return " \n".join(f"{axis}={value}" for axis in axes) + "\n"


told = collections.Counter()


class Handler(replyserver.ReplyHandler):
    def _ReplyHandler__verify_answer(self, received):
        told[received] += 1
        return super()._ReplyHandler__verify_answer(received)


replyserver.ReplyHandler = Handler
server = replyserver.ReplyServer(host="127.0.0.1", port=0)
port = server._ReplyServer__server.server_address[1]
server.append("*IDN?\n", "(c)2017 Physik Instrumente (PI) GmbH & Co. KG, C-887.53, 117012345, 2.3.0.1\n")
server.append("CSV?\n", "2.0\n")
server.append("ERR?\n", "0\n")
server.append("CST?\n", each("H-840.D2"))
server.append("PUN?\n", "X=MM \nY=MM \nZ=MM \nU=DEG \nV=DEG \nW=DEG\n")
server.append("KEN?\n", "ZERO=KSD\n")
server.append("SPA? X 0x19001900\n", "X 0x19001900=1\n")
server.append("SPA X 0x19001900 1\n")
server.append("SPA X 0x19001900 0\n")
server.append("SCT T 10\n")
server.append("\x0b", "64\n")
server.append("\x05", "0\n")
server.append("FRF?\n", each(1))
server.append("SVO?\n", each(1))
server.append("SPI?\n", "R=0 \nS=0 \nT=0\n")
server.append("TMN?\n", each(-90))
server.append("TMX?\n", each(90))
server.append("VLS?\n", "50.0\n")
server.append("POS?\n", "X=1.5 \nY=0 \nZ=0 \nU=0 \nV=0 \nW=0\n")
server.append("MOV X 1.5 Y 0 Z 0 U 0 V 0 W 0\n")
server.append("\x18")
print(port, flush=True)
sys.stdin.read()
server.check
expected = {"*IDN?\n": 1, "FRF?\n": 1, "MOV X 1.5 Y 0 Z 0 U 0 V 0 W 0\n": 2, "\x18": 1, "POS?\n": 5, "ERR?\n": 5}
for command, least in expected.items():
    if told[command] < least:
        sys.exit(f"PIPython's server was told {command!r} {told[command]} times: {dict(told)}")
