"""pyOpenHaptics drives the fake libHD.so: python3 pyopenhaptics_client.py FOLDER. The device stands in its zero position, with
its button pressed. Ends with 0 where all is as it must be, after its force was exerted for a while."""
import sys
import time

sys.path.insert(0, sys.argv[1])
from pyOpenHaptics import hd
from pyOpenHaptics.hd_callback import hd_callback
from pyOpenHaptics.hd_device import HapticDevice

seen = {"calls": 0}


@hd_callback
def turn():
    matrix = hd.get_transform()
    seen["tip"] = tuple(matrix[3][i] for i in range(3))
    seen["joints"] = tuple(hd.get_joints())
    seen["gimbals"] = tuple(hd.get_gimbals())
    seen["buttons"] = hd.get_buttons()
    hd.set_force([1.0, -2.0, 3.0])  # N: right, down, towards the person
    seen["calls"] += 1


def expect(good, what):
    if not good:
        sys.exit(f"pyOpenHaptics: {what}: {seen}")


device = HapticDevice(device_name="Default Device", callback=turn)
expect(device.__vendor__() == "Encounter fake", "another vendor")
expect(device.__model__() == "PHANToM Premium 1.0A", "another model")
deadline = time.monotonic() + 15
while seen["calls"] < 500 and time.monotonic() < deadline:
    time.sleep(0.01)
expect(seen["calls"] >= 500, "its scheduler makes too few calls")
expect(all(abs(x) < 1e-9 for x in seen["tip"]), "the tip is not at the zero of its coordinates")
expect(all(abs(q) < 1e-12 for q in seen["joints"]), "the joints are not at 0")
expect(seen["buttons"] == 1, "the button is not pressed")
device.close()
calls = seen["calls"]
time.sleep(0.1)
expect(seen["calls"] == calls, "calls after the end")
