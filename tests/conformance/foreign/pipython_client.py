"""PIPython drives the fake controller: python3 pipython_client.py FOLDER PORT. Ends with 0 where all is as it must be."""
import socket
import sys
import time

import pipython_parts

pipython_parts.import_from(sys.argv[1])
from pipython import GCSDevice, GCSError, pitools
from pipython.pidevice.interfaces.pisocket import PISocket

port = int(sys.argv[2])
axes = ["X", "Y", "Z", "U", "V", "W"]


def expect(good, what):
    if not good:
        sys.exit(f"PIPython: {what}")


def near(values, expected):
    return all(abs(values[axis] - value) < 1e-3 for axis, value in expected.items())


def drive(device):
    expect("C-887" in device.qIDN(), "another name")
    expect(device.axes == axes, f"axes {device.axes}")
    expect(device.HasMOV() and device.HasqPOS() and not device.HasINI(), "the list of commands")
    expect(not any(device.qFRF().values()), "referenced before it was")
    try:
        device.MOV("X", 1)
        sys.exit("PIPython: it moves before it is referenced")
    except GCSError as error:
        expect(error.val == 5, f"error {error.val} instead of 5")
    pitools.startup(device, refmodes="FRF")
    expect(all(device.qFRF().values()) and all(device.qSVO().values()), "not referenced, or a servo is off")

    device.VLS(20.0)
    expect(device.qVLS() == 20.0, "VLS?")
    device.MOV({"X": 2, "Y": -1.23456789012345, "W": 0.5})
    expect(device.IsMoving("X")["X"], "it does not move")
    pitools.waitontarget(device, axes)
    expect(near(device.qPOS(), {"X": 2, "Y": -1.23456789, "Z": 0, "W": 0.5}), f"at {device.qPOS()}")
    expect(not device.IsMoving("X")["X"] and device.IsControllerReady(), "it does not come to rest")

    expect(device.qTMX("X")["X"] > 45 and device.qTMN("X")["X"] < -45, "limits")
    expect(device.qVMO({"X": 1.0}) and not device.qVMO({"X": 100.0}), "VMO?")
    expect(device.qCST("X")["X"] == "H-840.D2" and device.qPUN("W")["W"] == "DEG", "CST? or PUN?")
    try:
        device.MOV("X", 100)
        sys.exit("PIPython: it moves beyond its limits")
    except GCSError as error:
        expect(error.val == 7, f"error {error.val} instead of 7")
    device.MOV("W", 0)
    pitools.waitontarget(device, axes)
    device.SPI({"R": 0, "S": 0, "T": 12.5})
    expect(device.qSPI() == {"R": 0, "S": 0, "T": 12.5}, f"SPI? {device.qSPI()}")

    for stop in (device.StopAll, device.STP, device.HLT):
        device.MOV("X", 20 if device.qPOS("X")["X"] < 10 else -20)
        time.sleep(0.2)
        try:
            stop()
            sys.exit("PIPython: a stop is no error 10")
        except GCSError as error:
            expect(error.val == 10, f"error {error.val} instead of 10")
        time.sleep(0.2)
        stood = device.qPOS("X")["X"]
        time.sleep(0.1)
        expect(device.qPOS("X")["X"] == stood and abs(stood) < 19, "it does not stay where it stopped")

    device.embederr = True  # the command and ERR? in one segment
    device.MOV("X", 0)
    device.embederr = False
    pitools.waitontarget(device, axes)
    expect(near(device.qPOS(), {"X": 0}), "two commands in one segment")
    expect(device.qERR() == 0, "an error is left")


def drip():
    """One byte at a time, and an answer all the same."""
    with socket.create_connection(("127.0.0.1", port), 5) as wire:
        wire.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        for byte in b"POS? X Y\nERR?\n":
            wire.sendall(bytes([byte]))
            time.sleep(0.002)
        answer = b""
        while answer.count(b"\n") < 3:
            more = wire.recv(100)
            expect(more, "it closed")
            answer += more
        expect(answer.startswith(b"X=") and b" \nY=" in answer and answer.endswith(b"\n0\n"), f"{answer}")


one = GCSDevice(gateway=PISocket(host="127.0.0.1", port=port))
drive(one)
one.close()
time.sleep(0.1)
drip()
