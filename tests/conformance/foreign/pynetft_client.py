"""pynetft drives the fake Net F/T: python3 pynetft_client.py FOLDER RECORDS_PORT PAGE_PORT. Says in a line that it waits for
SECOND, for FIRST again, for a threshold that is met, for a saturated sensor. Ends with 0 where all is as it must be."""
import sys
import time

sys.path.insert(0, sys.argv[1])
import pynetft

# As in foreign_test.cpp: N and N m, counts of each, and 7 samples of the sensor in a record.
FIRST = (1.234567, -23.456789, -123.456789, 0.345678, -4.567891, 9.876543)
SECOND = (-7.654321, 31.415926, -60.5, -1.25, 2.718281, -8.000001)
NOTHING = (0.0,) * 6
PER = (1e6, 1e6, 1e6, 2e6, 2e6, 2e6)
STEP = 7
WARNED, SATURATED = 0x80010000, 0x80030000  # the threshold is still met


def expect(good, what):
    if not good:
        sys.exit(f"pynetft: {what}")


def says(sample, values):
    counts = tuple(round(value * per) for value, per in zip(values, PER, strict=True))
    return sample.raw_wrench == counts and sample.wrench == tuple(
        count / per for count, per in zip(counts, PER, strict=True)
    )


def over(values, bias):
    return tuple(value - zero for value, zero in zip(values, bias, strict=True))


def until(stream, before, after, status=0):
    """The first sample that says `after`, with this status; all others before it say one of the two."""
    deadline = time.monotonic() + 15
    for sample in stream:
        if says(sample, after) and sample.status == status:
            return sample
        expect(says(sample, before) or says(sample, after), f"neither {before} nor {after}: {sample}")
        expect(time.monotonic() < deadline, f"not {after} with status {status:#x}: {sample}")
    sys.exit(f"pynetft: no {after}: its stream ends")


def last_of(stream, values):
    """The last of 100 samples, whose values stand and whose two numbers go on together."""
    before = None
    for _ in range(100):
        sample = next(stream)
        expect(says(sample, values) and sample.status == 0, f"not {values}: {sample}")
        if before:
            records = sample.rdt_sequence - before.rdt_sequence
            samples = sample.ft_sequence - before.ft_sequence
            expect(records > 0 and samples == STEP * records, f"{samples} samples in {records} records")
        if sample.rdt_sequence > 1:  # the first answers the request, between two of the clock's
            before = sample
    return before


def expect_anew(before, after):
    """The sensor's number goes on and the record's begins again."""
    records = after.rdt_sequence - before.rdt_sequence
    samples = after.ft_sequence - before.ft_sequence
    expect(samples > 0 and samples > STEP * records, f"not begun anew: {before}, {after}")


def expect_untroubled(client):
    """All that came is counted, and nothing else. Of a run without a bias: pynetft takes what still comes of the run before
    it for the new one, and its first numbers for old ones."""
    health = client.health()
    expect(health.state is pynetft.ClientState.STREAMING, f"{health}")
    expect(health.last_rdt_sequence == health.received_count + health.lost_count, f"{health}")
    for kind in ("device_error", "warning", "duplicate", "out_of_order", "malformed", "timeout", "reconnect"):
        expect(getattr(health, f"{kind}_count") == 0, f"{kind}: {health}")
    for kind in ("ft_stall", "ft_backward", "ft_restart", "calibration_change"):
        expect(getattr(health, f"{kind}_count") == 0, f"{kind}: {health}")


config = pynetft.Config(
    sensor_host="127.0.0.1",
    rdt_port=int(sys.argv[2]),
    http_port=int(sys.argv[3]),
    receive_timeout=10.0,
    configuration_connect_timeout=10.0,
    configuration_timeout=10.0,
    recovery_policy=pynetft.RecoveryPolicy.FAIL_STOP,
)
with pynetft.Client(config) as client:
    expect(client.wait_for_first_sample(10.0), "no record")
    one = client.latest_sample()
    expect(says(one, FIRST), f"not {FIRST}: {one}")
    expect(one.status == 0 and one.rdt_sequence > 0, f"status or number: {one}")
    expect(one.force_unit is pynetft.ForceUnit.NEWTON, f"unit {one.force_unit}")
    expect(one.torque_unit is pynetft.TorqueUnit.NEWTON_METER, f"unit {one.torque_unit}")

    found = client.health().sensor_configuration  # of its page
    expect(found.product_name == "Net F/T", f"product {found.product_name}")
    expect(found.source is pynetft.CalibrationSource.SENSOR, f"source {found.source}")
    units = (pynetft.ForceUnit.NEWTON, pynetft.TorqueUnit.NEWTON_METER)
    expect(found.calibration == pynetft.Calibration(PER[0], PER[5], *units), f"{found.calibration}")

    stream = client.samples(timeout=10.0)
    last = last_of(stream, FIRST)
    expect_untroubled(client)

    client.bias()  # and asks for records anew
    zeroed = until(stream, FIRST, NOTHING)
    expect_anew(last, zeroed)
    last_of(stream, NOTHING)
    print("biased", flush=True)
    until(stream, NOTHING, over(SECOND, FIRST))
    last_of(stream, over(SECOND, FIRST))

    client.bias()  # against what is there, not against the bias before
    until(stream, over(SECOND, FIRST), NOTHING)
    print("biased again", flush=True)
    until(stream, NOTHING, over(FIRST, SECOND))
    last = last_of(stream, over(FIRST, SECOND))

with pynetft.Client(config) as client:
    stream = client.samples(timeout=10.0)
    expect_anew(last, next(stream))
    last_of(stream, over(FIRST, SECOND))  # the bias has stayed
    expect_untroubled(client)

    print("started again", flush=True)
    until(stream, over(FIRST, SECOND), over(FIRST, SECOND), WARNED)
    health = client.health()
    expect(health.state is pynetft.ClientState.STREAMING, f"a warning ended it: {health}")
    expect(health.warning_count > 0 and health.device_error_count == 0, f"a warning is not counted as one: {health}")

    print("warned", flush=True)
    try:
        until(stream, over(FIRST, SECOND), over(FIRST, SECOND), SATURATED)
        sys.exit("pynetft: it goes on with a saturated sensor")
    except pynetft.SensorFaultError as error:
        expect(error.fault_code is pynetft.FaultCode.SERIOUS_STATUS, f"fault {error.fault_code}")
        expect(error.health.last_status == SATURATED, f"status {error.health.last_status:#x}")
        expect(error.health.device_error_count == 1, f"{error.health}")
