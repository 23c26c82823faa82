"""Writes drive.mf4, 6 s of sample_data/gyor/gyor_q3_00.trip.csv as an ASAM MDF 4.10 file, and frames.mf4, the frames of
tests/data/can/drive.log as a bus logger writes them.

    make_mf4.py ROOT

Written after ASAM MDF 4.1.0, "Programmers guide", chapter 5, with the standard library alone. Data group 1 is
sorted, in a header list of a data list of deflated blocks: plain, transposed, and one that is not deflated; records
lie over the ends of blocks. Data group 2 is unsorted: a group with big endian floats and virtual master, one of
variable length, one with positions.

frames.mf4 ("Bus logging", chapter 4) has the frames in three data groups by turns: with data of a maximum length, of
variable length in a block, and, unsorted, of variable length in a group of their own; and a group of error frames.
"""

import csv
import pathlib
import struct
import sys
import zlib

START_NS = 1772352040 * 10**9  # 2026-03-01T08:00:40Z; invented
FROM_S, TO_S = 40.0, 46.0


class File:
    def __init__(self):
        self.bytes = bytearray(b"MDF     4.10    macadam " + bytes(4) + struct.pack("<H", 410) + bytes(34))
        assert len(self.bytes) == 64

    def put(self, kind, links, data):
        """Appends a block, and returns its place."""
        self.bytes += bytes(-len(self.bytes) % 8)
        at = len(self.bytes)
        self.bytes += struct.pack("<4sIQQ", b"##" + kind, 0, 24 + 8 * len(links) + len(data), len(links))
        self.bytes += b"".join(struct.pack("<Q", link) for link in links) + data
        return at

    def link(self, block, number, to):
        struct.pack_into("<Q", self.bytes, block + 24 + 8 * number, to)

    def text(self, words):
        return self.put(b"TX", [], words.encode() + b"\0")

    def linear(self, offset, factor):
        return self.put(b"CC", [0, 0, 0, 0], struct.pack("<BBHHHdddd", 1, 0, 0, 0, 2, 0, 0, offset, factor))

    def channel(self, name, unit, kind, data_type, byte, bits, conversion=0, invalid=None, bit=0, parts=0,
                values=0):
        """kind: 0 value, 1 variable length, 2 master, 3 virtual master"""
        sync = 1 if kind in (2, 3) else 0
        data = struct.pack("<BBBBIIIIBBHdddddd", kind, sync, data_type, bit, byte, bits,
                           0 if invalid is None else 2, invalid or 0, 0, 0, 0, 0, 0, 0, 0, 0, 0)
        return self.put(b"CN", [0, parts, self.text(name), 0, conversion, values, self.text(unit) if unit else 0, 0], data)

    def group(self, name, record_id, count, channels, data_bytes, invalid_bytes=0, flags=0):
        for before, after in zip(channels, channels[1:]):
            self.link(before, 0, after)
        return self.put(b"CG", [0, channels[0] if channels else 0, self.text(name), 0, 0, 0],
                        struct.pack("<QQHHIII", record_id, count, flags, 0, 0, data_bytes, invalid_bytes))

    def deflated(self, data, columns=0):
        turned = data
        if columns:
            lines = len(data) // columns
            whole = data[:lines * columns]
            turned = b"".join(whole[column::columns] for column in range(columns)) + data[lines * columns:]
        packed = zlib.compress(turned)
        return self.put(b"DZ", [], struct.pack("<2sBBIQQ", b"DT", 1 if columns else 0, 0, columns, len(data),
                                               len(packed)) + packed)


def rows(root):
    lines = [line for line in (root / "sample_data/gyor/gyor_q3_00.trip.csv").read_text().splitlines()
             if not line.startswith("#")]
    all_rows = [{key: float(cell) for key, cell in row.items() if cell} for row in csv.DictReader(lines)]
    return [row for row in all_rows if FROM_S <= row["t_s"] < TO_S]


def frames_of(root):
    """Time since the start, bus, identifier, whether it has 29 bits, data."""
    for line in (root / "tests/data/can/drive.log").read_text().splitlines():
        time, bus, frame = line.split()[:3]
        identifier, data = frame.split("#", 1)
        if data.startswith("#"):
            data = data[2:]  # flags of CAN FD
        yield (float(time[1:-1]) - START_NS / 1e9, int(bus[3:]) + 1, int(identifier, 16), len(identifier) == 8,
               bytes.fromhex(data.split("_")[0]))


def frame_channels(file, kind, at, bits, values=0, with_length=True):
    """Channels of frames: time, and the members of CAN_DataFrame as its parts."""
    parts = [file.channel("CAN_DataFrame.BusChannel", "", 0, 0, 8, 8),
             file.channel("CAN_DataFrame.ID", "", 0, 0, 9, 29),
             file.channel("CAN_DataFrame.IDE", "", 0, 0, 12, 1, bit=7),
             file.channel("CAN_DataFrame.DataBytes", "", kind, 10, at, bits, values=values)]
    if with_length:
        parts.append(file.channel("CAN_DataFrame.DataLength", "", 0, 0, 13, 8))
        file.link(parts[3], 5, parts[4] if kind == 5 else values)
    for before, after in zip(parts, parts[1:]):
        file.link(before, 0, after)
    return [file.channel("Timestamp", "s", 2, 4, 0, 64),
            file.channel("CAN_DataFrame", "", 0, 10, 8, 8 * (at + bits // 8 - 8), parts=parts[0])]


def frame_head(frame):
    time, bus, identifier, is_extended, data = frame
    return struct.pack("<dBIB", time, bus, identifier | (1 << 31 if is_extended else 0), len(data))


def write_frames(root):
    bus_event = 2 | 4
    frames = list(frames_of(root))
    file = File()
    head = file.put(b"HD", [0] * 6, struct.pack("<QhhBBBBdd", START_NS, 60, 0, 2, 0, 0, 0, 0, 0))

    part = frames[0::3]
    group = file.group("CAN", 0, len(part), frame_channels(file, 5, 14, 256), 46, flags=bus_event)
    data = b"".join(frame_head(frame) + frame[4].ljust(32, b"\xaa") for frame in part)
    first = file.put(b"DG", [0, group, file.put(b"DT", [], data), 0], bytes(8))

    part = frames[1::3]
    values, data = b"", b""
    for frame in part:
        data += frame_head(frame) + struct.pack("<Q", len(values))
        values += struct.pack("<I", len(frame[4])) + frame[4]
    group = file.group("CAN", 0, len(part), frame_channels(file, 1, 14, 64, file.put(b"SD", [], values)), 22,
                       flags=bus_event)
    second = file.put(b"DG", [0, group, file.put(b"DT", [], data), 0], bytes(8))

    part = frames[2::3]
    values = file.group("", 2, len(part), [], 0, flags=1)
    group = file.group("CAN", 1, len(part), frame_channels(file, 1, 14, 64, values, with_length=False), 22,
                       flags=bus_event)
    errors = file.group("CAN", 3, 1, [file.channel("Timestamp", "s", 2, 4, 0, 64),
                                      file.channel("CAN_ErrorFrame.ErrorType", "", 0, 0, 8, 8)], 9, flags=bus_event)
    file.link(values, 0, group)
    file.link(group, 0, errors)
    data, place = struct.pack("<BdB", 3, 0.5, 1), 0
    for frame in part:
        data += b"\1" + frame_head(frame) + struct.pack("<Q", place)
        data += b"\2" + struct.pack("<I", len(frame[4])) + frame[4]
        place += 4 + len(frame[4])
    third = file.put(b"DG", [0, values, file.put(b"DT", [], data), 0], bytes([1]) + bytes(7))

    file.link(head, 0, first)
    file.link(first, 0, second)
    file.link(second, 0, third)
    (root / "tests/data/mdf/frames.mf4").write_bytes(file.bytes)


def main():
    root = pathlib.Path(sys.argv[1])
    write_frames(root)
    data = rows(root)
    file = File()
    head = file.put(b"HD", [0] * 6, struct.pack("<QhhBBBBdd", START_NS, 60, 0, 2, 0, 0, 0, 0, 0))

    inertial = [row for row in data if "acc_z_mps2" in row]
    scale = file.linear(0, 0.001)
    parts = [file.channel(f"Acc{axis}", "m/s^2", 0, 2, 8 + 2 * i, 16, scale, invalid=i)
             for i, axis in enumerate("XYZ")]
    for before, after in zip(parts, parts[1:]):
        file.link(before, 0, after)
    channels = [file.channel("t", "s", 2, 4, 0, 64),
                file.channel("Acc", "", 0, 10, 8, 48, parts=parts[0]),
                file.channel("State", "", 0, 0, 14, 3, bit=2)]
    records = b"".join(struct.pack("<dhhhBB", row["t_s"] - FROM_S,
                                   *[round(row[f"acc_{axis}_mps2"] * 1000) for axis in "xyz"], 0x14,
                                   1 if i % 100 == 50 else 0)
                       for i, row in enumerate(inertial))
    group = file.group("IMU", 0, len(inertial), channels, 15, 1)
    cuts = [records[:1005], records[1005:4999], records[4999:]]
    blocks = [file.deflated(cuts[0]), file.deflated(cuts[1], columns=16), file.put(b"DT", [], cuts[2])]
    tail = file.put(b"DL", [0, blocks[2]], struct.pack("<BBHIQ", 0, 0, 0, 1, 4999))
    lists = file.put(b"DL", [tail, blocks[0], blocks[1]], struct.pack("<BBHIQQ", 0, 0, 0, 2, 0, 1005))
    first = file.put(b"DG", [0, group, file.put(b"HL", [lists], struct.pack("<HBB4x", 0, 1, 0)), 0], bytes(8))

    fixes = [row for row in data if "gnss_speed_mps" in row]
    speed = file.group("Wheels", 1, len(fixes),
                       [file.channel("index", "s", 3, 0, 0, 0, file.linear(fixes[0]["t_s"] - FROM_S, 1.0)),
                        file.channel("Speed", "km/h", 0, 5, 0, 32)], 4)
    remarks = file.group("Remarks", 2, 2, [], 0, flags=1)
    gnss = file.group("GNSS", 3, len(fixes),
                      [file.channel("t", "s", 2, 0, 0, 32, file.linear(0, 0.001)),
                       file.channel("Latitude", "deg", 0, 3, 4, 32, file.linear(0, 1e-7)),
                       file.channel("Longitude", "deg", 0, 4, 8, 64),
                       file.channel("Speed", "m/s", 0, 4, 16, 32)], 20)
    file.link(speed, 0, remarks)
    file.link(remarks, 0, gnss)
    unsorted = b""
    for row in fixes:
        unsorted += struct.pack(">Bf", 1, 3.6 * row["gnss_speed_mps"])
        unsorted += struct.pack("<BI", 2, 6) + b"remark"
        unsorted += struct.pack("<BI", 3, round(1000 * (row["t_s"] - FROM_S)))
        unsorted += struct.pack(">i", round(row["lat_deg"] * 1e7))
        unsorted += struct.pack("<df", row["lon_deg"], row["gnss_speed_mps"])
    second = file.put(b"DG", [0, speed, file.put(b"DT", [], unsorted), 0], bytes([1]) + bytes(7))
    file.link(first, 0, second)
    file.link(head, 0, first)
    (root / "tests/data/mdf/drive.mf4").write_bytes(file.bytes)


main()
