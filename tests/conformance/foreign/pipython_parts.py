"""What both ends of PIPython need here: its import, and a bridge between a TCP connection and our own input and output, at
whose other ends the test is."""
import os
import socket
import sys
import threading
import types


def import_from(folder):
    """PIPython imports its wires for USB and RS-232, which nothing here uses, whether they are there or not."""
    for name in ("usb", "usb.core", "usb.util", "usb.backend", "usb.backend.libusb0", "usb.backend.libusb1", "serial"):
        sys.modules[name] = types.ModuleType(name)
    sys.path.insert(0, folder)


class Bridge:
    """Between the test and the connection that there is now."""

    def __init__(self, connection=None):
        self.connection = connection
        threading.Thread(target=self._from_test, daemon=True).start()

    def _from_test(self):
        while data := os.read(0, 4096):
            self.connection.sendall(data)
        self.connection.shutdown(socket.SHUT_WR)

    def serve(self, connection):
        """Until the other end closes it."""
        self.connection = connection
        try:
            while data := connection.recv(4096):
                os.write(1, data)
        except OSError:
            pass
