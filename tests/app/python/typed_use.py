"""What users write, for the type checker; never run."""

from pathlib import Path

import numpy as np

import macadam

table: macadam.Table = macadam.iri(np.zeros(1000), step_m=0.1, length_m=20)
iri: np.ndarray[tuple[int], np.dtype[np.float64]] = table["iri_profile"]
units: dict[str, str] = table.units
rows: int = table.rows
macadam.trace(Path("drive.trip.csv"), "suv", method="kf")
macadam.trace({"t_s": np.arange(3.0), "acc_z_mps2": [9.8, 9.8, 9.8], "vehicle_id": "suv"})
roads: macadam.Database = macadam.open("roads.gpkg")
roads.segments(near=(48.4, 15.6), class_name="poor").rows
roads.worst(10, highway="residential")["iri"].max()

macadam.trace("drive.trip.csv", method="best")  # type: ignore[arg-type]
macadam.iri("profile.csv", length=100)  # type: ignore[call-arg]
roads.segments(48.4)  # type: ignore[misc, arg-type]
