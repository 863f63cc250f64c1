"""pymodbus as the coupler, for our driver: python3 pymodbus_server.py FOLDER. Says its port in a line, closes the jaws 50 ms
after its output is set, and ends with its input. Ends with 0 where it was told what it must be."""
import asyncio
import socket
import sys
import time

import pymodbus_parts
from pymodbus_parts import expect

pymodbus_parts.import_from(sys.argv[1])
from pymodbus.server import ModbusTcpServer
from pymodbus.simulator import DataType, SimData, SimDevice


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def words(address, *values):
    return SimData(address, values=list(values), datatype=DataType.REGISTERS)


def bits(*values):
    return SimData(0, values=list(values) + (16 - len(values)) * [False], datatype=DataType.BITS)


name = "EK9000".ljust(14, "\0")
registers = [
    words(0x1000, *[ord(name[i]) << 8 | ord(name[i + 1]) for i in range(0, 14, 2)]),
    words(0x1012, 4, 4),
    words(0x1021, 1),
    words(0x1040, 1),
    words(0x1120, 500, 0, 2, 1),
]
told, gripped = [], []


async def act(function, start, address, _count, block, values):
    if values is not None:
        told.append((address, [int(value) for value in values]))
        if (address, list(values)) == (1, [True]):
            gripped.append(time.monotonic() + 0.05)
    elif function == 2:
        block[0] = 2 if gripped and time.monotonic() > gripped[-1] else 1
    elif address == 0x1021 and (0x1121, [0xAFFE]) in told:
        block[0x1021 - start] = 0


async def serve():
    port = free_port()
    device = SimDevice(1, simdata=([bits()], [bits(True)], registers, [words(0, 0)]), action=act)
    server = ModbusTcpServer(device, address=("127.0.0.1", port))
    await server.serve_forever(background=True)
    print(port, flush=True)
    await asyncio.get_running_loop().run_in_executor(None, sys.stdin.read)
    await server.shutdown()


asyncio.run(serve())
expected = [(0x1120, [1000]), (0x1122, [1]), (0x1123, [0]), (0x1121, [0xBECF]), (0x1121, [0xAFFE]), (0, [0]), (1, [0]), (1, [1])]
expect(told == expected, f"told {told}")
