"""pyigtl as the tracker's server, for our driver: python3 pyigtl_server.py FOLDER VERSION. Says its port in a line, and then
sends a pose each 10 ms until its input is closed, with a header of that version; of 2 with metadata, as PLUS has them."""
import socket
import sys
import threading
import time

import igtl_parts

igtl_parts.import_from(sys.argv[1])
import numpy
import pyigtl


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


port = free_port()
server = pyigtl.OpenIGTLinkServer(port=port, local_server=True)
print(port, flush=True)
over = threading.Event()
threading.Thread(target=lambda: (sys.stdin.read(), over.set()), daemon=True).start()
matrix = numpy.array([[0, -1, 0, 10], [1, 0, 0, 20], [0, 0, 1, 30], [0, 0, 0, 1]], dtype=float)
version = int(sys.argv[2])
while not over.is_set():
    message = pyigtl.TransformMessage(matrix, device_name="stylusToTracker")
    message.header_version = version
    if version == 2:
        message.metadata = {"TransformStatus": "OK", "TransformValid": "1"}
    if server.is_connected():
        server.send_message(message, wait=False)
    time.sleep(0.01)
server.stop()
