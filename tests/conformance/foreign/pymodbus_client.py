"""pymodbus drives the fake coupler: python3 pymodbus_client.py FOLDER PORT. Says "closed" in a line when the tool is gripped,
and goes on at the end of its input. Ends with 0 where all is as it must be."""
import sys
import time

import pymodbus_parts
from pymodbus_parts import expect

pymodbus_parts.import_from(sys.argv[1])
from pymodbus.client import ModbusTcpClient

client = ModbusTcpClient("127.0.0.1", port=int(sys.argv[2]), timeout=10)
expect(client.connect(), "no connection")
UNIT = {"device_id": 1}


def registers(address, count=1):
    answer = client.read_holding_registers(address, count=count, **UNIT)
    expect(not answer.isError(), f"register {address:#x}: {answer}")
    return answer.registers


def refused(answer, code):
    expect(answer.isError() and answer.exception_code == code, f"not refused with {code}: {answer}")


def inputs():
    return client.read_discrete_inputs(0, count=2, **UNIT).bits[:2]


def until(wanted):
    for _ in range(500):
        if inputs() == wanted:
            return
        time.sleep(0.01)
    sys.exit(f"pymodbus: the inputs are {inputs()}, not {wanted}")


words = registers(0x1000, 7)
name = "".join(chr(word & 0xFF) + chr(word >> 8) for word in words)
expect(name == "Encounter fake", f"its name is {name!r}")
expect(registers(0x1012, 2) == [8, 8], "its terminals")
expect(registers(0x1040) == [1], "the state of its bus")
expect(registers(0x1120) == [1000] and registers(0x1122, 2) == [1, 0], "its watchdog")
until([True, False])

expect(not client.write_coils(0, [False, True], **UNIT).isError(), "both outputs at once")
expect(client.read_coils(0, count=8, **UNIT).bits == [False, True] + 6 * [False], "its outputs")
expect(registers(0x0800) == [2], "the image of its outputs")
until([False, True])
expect(client.read_input_registers(0, count=1, **UNIT).registers == [2], "the image of its inputs")

refused(client.read_holding_registers(0x2000, count=1, **UNIT), 2)
refused(client.read_coils(0, count=9, **UNIT), 2)
refused(client.write_coil(8, True, **UNIT), 2)
refused(client.write_register(0x1122, 7, **UNIT), 3)
refused(client.read_device_information(**UNIT), 1)
refused(client.read_coils(0, count=1, device_id=7), 11)

# A watchdog of 200 ms without a telegram: the outputs go off, and stay off until it is reset.
expect(not client.write_register(0x1120, 200, **UNIT).isError(), "the time of its watchdog")
print("closed", flush=True)
sys.stdin.read()
expect(registers(0x1021) == [1] and registers(0x0800) == [0], "its watchdog did not run out")
until([False, True])  # the grip stays
refused(client.write_coil(0, True, **UNIT), 4)
for word in (0xBECF, 0xAFFE):
    expect(not client.write_register(0x1121, word, **UNIT).isError(), "the reset of its watchdog")
expect(not client.write_coil(0, True, **UNIT).isError(), "the output 'open'")
until([True, False])
client.close()
