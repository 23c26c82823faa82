"""Files in the formats of the program."""

from __future__ import annotations

import csv
import os
from collections import abc
from typing import Union

import numpy as np
import numpy.typing as npt

from . import _macadam
from ._results import PathLike, Table


def write_trip(path: PathLike, trip: abc.Mapping[str, Union[npt.ArrayLike, str]]) -> None:
    """Writes columns as a trip log (docs/reference/trip-logs.md).

    Args:
        path: the file, whose name ends in .trip.csv.
        trip: arrays of one shape (n,) by the names of columns, NaN for no sample; text is a line of
            the head, such as ``{"t_s": t, "acc_z_mps2": a, "speed_mps": v, "vehicle_id": "van-7"}``.

    Raises:
        InputError: the arrays differ in length, or a text has more than one line.
    """
    head = {key: value for key, value in trip.items() if isinstance(value, str)}
    columns = {key: np.asarray(value, dtype=float) for key, value in trip.items()
               if not isinstance(value, str)}
    for key, value in head.items():
        if len(value.splitlines()) > 1:
            raise _macadam.InputError(f"{key}: has several lines, expected one")
    rows = {column.shape for column in columns.values()}
    if len(rows) != 1 or len(next(iter(rows))) != 1:
        shapes = ", ".join(f"{key} {column.shape}" for key, column in columns.items())
        raise _macadam.InputError(f"trip: has columns of shapes {shapes or 'none'}, expected one (n,)")
    with open(os.fspath(path), "w", encoding="utf-8", newline="") as file:
        file.write("# macadam-trip 1\n")
        file.writelines(f"# {key}: {value}\n" for key, value in head.items())
        file.write(",".join(columns) + "\n")
        lines = zip(*(column.tolist() for column in columns.values()))
        count = 0
        for line in lines:
            file.write(",".join("" if value != value else repr(value) for value in line) + "\n")
            count += 1
        file.write(f"# end rows: {count}\n")


def read_truth(path: PathLike) -> Table:
    """Reads truth.csv of a simulation."""
    with open(os.fspath(path), encoding="utf-8", newline="") as file:
        names, *rows = csv.reader(file)
    columns: dict[str, np.ndarray] = {}  # type: ignore[type-arg]
    for name, values in zip(names, zip(*rows)):
        kind = object if name in ("segment", "direction") else int if name == "way_id" else float
        columns[name] = np.array(values, dtype=object).astype(kind)
    units = {name: "m" if name.endswith("_m") else "mm/m" for name in names
             if name.startswith("iri") or name in ("mri", "hri", "from_m", "to_m")}
    return Table(columns, units)
