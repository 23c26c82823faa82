"""Writes drive.log, drive.asc and log2asc.asc: 8 s of sample_data/gyor/gyor_q3_00.trip.csv as frames of car.dbc.

    make_can_logs.py ROOT        needs python3-can, which writes the first two, and log2asc of can-utils

Wheel and vehicle speeds are the receiver's, interpolated; frames come in the order of time.
"""

import bisect
import csv
import pathlib
import struct
import subprocess
import sys

import can

FIRST_UTC_S = 1772352000  # 2026-03-01T08:00:00Z, of t_s = 0; invented
FROM_S, TO_S = 40.0, 48.0


def rows(root):
    lines = [line for line in (root / "sample_data/gyor/gyor_q3_00.trip.csv").read_text().splitlines()
             if not line.startswith("#")]
    return [{key: float(cell) for key, cell in row.items() if cell} for row in csv.DictReader(lines)]


def frames(root):
    data = rows(root)
    speeds = [(row["t_s"], row["gnss_speed_mps"]) for row in data if "gnss_speed_mps" in row]
    times = [t for t, _ in speeds]
    yaw = 0.0
    count = 0
    for row in data:
        t = row["t_s"]
        yaw = row.get("gyro_z_radps", yaw)
        if not FROM_S <= t < TO_S:
            continue
        if "acc_z_mps2" in row:
            g = [round(row[f"acc_{axis}_mps2"] / 9.80665 / 0.0005) for axis in "zxy"]
            yield t, 0x130, False, struct.pack("<hh", g[0], g[1]) + struct.pack(
                ">hh", g[2], round(yaw * 57.29577951308232 / 0.01))
            i = bisect.bisect(times, t)
            (t0, v0), (t1, v1) = speeds[i - 1], speeds[i]
            kmh = 3.6 * (v0 + (v1 - v0) * (t - t0) / (t1 - t0))
            if count % 2 == 0:
                yield t + 0.001, 0x1A0, False, struct.pack("<4H", *[round(kmh / 0.01)] * 4)
            if count % 10 == 0:
                yield t + 0.002, 0x18FEF100, True, b"\xff" + struct.pack("<H", round(kmh * 256)) + b"\xff" * 5
                yield t + 0.002, 0x7DF, False, b"\x02\x01\x0d"
            if count % 50 == 0:
                yield t + 0.003, 0x200, None, bytes(24) + struct.pack("<f", row["acc_z_mps2"]) + bytes(4)
            count += 1
        if "gnss_speed_mps" in row:
            yield t, 0x3D0, False, b"\x00" + struct.pack("<i", round(row["lat_deg"] * 1e7)) + bytes(3)
            yield t + 0.0005, 0x3D0, False, b"\x01" + struct.pack("<i", round(row["lon_deg"] * 1e7)) + bytes(3)
            yield t + 0.001, 0x3D0, False, b"\x02" + struct.pack(
                ">HH", round(row["gnss_speed_mps"] / 0.01), round(row["course_deg"] / 0.01)) + bytes(3)


def main():
    root = pathlib.Path(sys.argv[1])
    here = root / "tests/data/can"
    messages = [can.Message(timestamp=FIRST_UTC_S + t, arbitration_id=number, is_extended_id=bool(extended),
                            is_fd=extended is None, data=data, channel="can0")
                for t, number, extended, data in sorted(frames(root), key=lambda frame: frame[0])]
    with can.CanutilsLogWriter(here / "drive.log") as log, can.ASCWriter(here / "drive.asc", channel=0) as asc:
        for message in messages:
            log.on_message_received(message)
            message.channel = None
            asc.on_message_received(message)
    subprocess.run(["log2asc", "-I", here / "drive.log", "-O", here / "log2asc.asc", "-4", "can0"], check=True)


main()
