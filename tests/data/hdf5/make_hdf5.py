"""Writes drive.h5: 6 s of sample_data/gyor/gyor_q3_00.trip.csv, and files that must be refused (refused/).

    make_hdf5.py ROOT        needs python3-h5py
"""

import csv
import pathlib
import sys

import h5py
import numpy

FIRST_UTC_NS = 1772352000 * 10**9  # 2026-03-01T08:00:00Z, of t_s = 0; invented
FROM_S, TO_S = 40.0, 46.0


def rows(root):
    lines = [line for line in (root / "sample_data/gyor/gyor_q3_00.trip.csv").read_text().splitlines()
             if not line.startswith("#")]
    all_rows = [{key: float(cell) for key, cell in row.items() if cell} for row in csv.DictReader(lines)]
    return [row for row in all_rows if FROM_S <= row["t_s"] < TO_S]


def columns(data, names):
    return numpy.array([[row[name] for name in names] for row in data if names[0] in row])


def times_ns(data, name):
    return numpy.array([FIRST_UTC_NS + round(row["t_s"] * 1e9) for row in data if name in row], dtype="int64")


def main():
    root = pathlib.Path(sys.argv[1])
    here = root / "tests/data/hdf5"
    data = rows(root)
    with h5py.File(here / "drive.h5", "w") as file:
        imu = file.create_group("imu")
        imu.create_dataset("time", data=times_ns(data, "acc_z_mps2"), chunks=(100,), compression="gzip",
                           shuffle=True, fletcher32=True)
        imu.create_dataset("acc", data=columns(data, ["acc_x_mps2", "acc_y_mps2", "acc_z_mps2"]) / 9.80665,
                           dtype="float32", chunks=(64, 3), compression="gzip")
        gnss = file.create_group("gnss")
        gnss.create_dataset("time", data=times_ns(data, "gnss_speed_mps"))
        gnss.create_dataset("position", data=columns(data, ["lat_deg", "lon_deg"]), dtype=">f8")
        gnss.create_dataset("speed", data=numpy.rint(100 * columns(data, ["gnss_speed_mps"])[:, 0]), dtype=">i2")
        file["link"] = h5py.SoftLink("/imu/acc")
        file["text"] = "no number"
        file["cube"] = numpy.zeros((2, 2, 2))

    refused = here / "refused"
    refused.mkdir(exist_ok=True)
    with h5py.File(refused / "external_link.h5", "w") as file:
        file["acc"] = h5py.ExternalLink("../drive.h5", "/imu/acc")
        file["t"] = [0.0, 1.0]
    with h5py.File(refused / "external_storage.h5", "w") as file:
        file.create_dataset("acc", (2,), "float64", external=[("/etc/passwd", 0, 16)])
        file["t"] = [0.0, 1.0]
    with h5py.File(refused / "virtual.h5", "w", libver="latest") as file:
        layout = h5py.VirtualLayout(shape=(2,), dtype="float64")
        layout[:] = h5py.VirtualSource("../drive.h5", "/gnss/speed", shape=(2,))
        file.create_virtual_dataset("acc", layout)
        file["t"] = [0.0, 1.0]
    with h5py.File(refused / "filter.h5", "w") as file:
        file.create_dataset("acc", data=[1.0, 2.0], chunks=(2,), compression="lzf")
        file["t"] = [0.0, 1.0]
    with h5py.File(refused / "huge.h5", "w") as file:
        file.create_dataset("acc", (10**12,), "float64", chunks=(1024,), compression="gzip")
        file["t"] = [0.0, 1.0]


main()
