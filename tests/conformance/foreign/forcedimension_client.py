"""forcedimension-core drives the fake libdhd.so: python3 forcedimension_client.py FOLDER. The variable FDSDK is the folder
with the fake under the name of libdrd. The device is 10, -20 and 30 mm from its origin and reports 0.1, -0.2 and 0.3 m/s,
with its button pressed. Ends with 0 where all is as it must be, after its force was exerted for a while."""
import sys
import time

import forcedimension_parts

forcedimension_parts.import_from(sys.argv[1])
from forcedimension_core import containers, dhd


def expect(good, what):
    if not good:
        sys.exit(f"forcedimension-core: {what}: {dhd.errorGetLastStr()}")


def turns(count):
    """Reads the position and sets the force, as a haptic loop does; returns the last position."""
    at = [0.0, 0.0, 0.0]
    for _ in range(count):
        expect(dhd.getPosition(at) >= 0, "no position")
        expect(dhd.setForce([1.0, -2.0, 3.0]) >= 0, "the force is refused")
    return at


expect(dhd.getSDKVersion()[:2] == (3, 17), "another version")
expect(dhd.open() >= 0, "it does not open")
expect("omega.3" in dhd.getSystemName(), "another device")
status = containers.Status()
expect(dhd.getStatus(status) >= 0 and status.power and not status.reset and not status.force, "another state")
at = turns(1)
expect(max(abs(a - b) for a, b in zip(at, (0.01, -0.02, 0.03))) < 1e-9, f"the tip is at {at}")
velocity = [0.0, 0.0, 0.0]
expect(dhd.getLinearVelocity(velocity) >= 0, "no velocity")
expect(max(abs(a - b) for a, b in zip(velocity, (0.1, -0.2, 0.3))) < 1e-9, f"its velocity is {velocity}")
expect(dhd.getButtonMask() == 1, "the button is not pressed")
expect(dhd.expert.setWatchdog(40) < 0, "a watchdog without expert mode")
expect(dhd.expert.enableExpertMode() >= 0 and dhd.expert.setWatchdog(40) >= 0, "no watchdog")
expect(dhd.enableForce(True) >= 0, "no force")
turns(500)
expect(dhd.getStatus(status) >= 0 and status.force and not status.brake, "the force is not on")
expect(dhd.stop() >= 0 and dhd.getStatus(status) >= 0 and not status.force and status.brake, "the brakes are not on")
turns(50)
expect(dhd.close() >= 0, "it does not close")
time.sleep(0.1)
