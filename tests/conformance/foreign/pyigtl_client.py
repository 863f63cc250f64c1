"""pyigtl as a client of our tracker's server: python3 pyigtl_client.py FOLDER PORT. Ends with 0 where all is as it must be."""
import sys

import igtl_parts
from igtl_parts import expect

igtl_parts.import_from(sys.argv[1])
import numpy
import pyigtl

client = pyigtl.OpenIGTLinkClient("127.0.0.1", int(sys.argv[2]))
stamps = []
for _ in range(20):
    message = client.wait_for_message("stylusToTracker", timeout=10)
    expect(message is not None, "no pose within 10 s")
    expect(message.message_type == "TRANSFORM", f"a {message.message_type}")
    # As in igtl_foreign_test.cpp: a quarter turn about z, then 10, 20, 30 mm.
    expected = [[0, -1, 0, 10], [1, 0, 0, 20], [0, 0, 1, 30], [0, 0, 0, 1]]
    expect(numpy.abs(message.matrix - expected).max() < 1e-5, f"the matrix is {message.matrix}")
    stamps.append(message.timestamp)
expect(all(a < b for a, b in zip(stamps, stamps[1:])), f"stamps {stamps}")
client.stop()
