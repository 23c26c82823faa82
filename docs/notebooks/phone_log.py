# %% [markdown]
# # Ten minutes with the log of a phone
#
# A phone lay in a car in Győr. From its log come the roughness along the drive, a map of it, and a
# database that later drives refine. Run it cell by cell (VS Code, Spyder, Jupyter with jupytext), or as
# a script: `python3 docs/notebooks/phone_log.py`.

# %%
import pathlib
import subprocess
import tempfile

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import Normalize

import macadam

here = pathlib.Path(__file__).resolve().parents[2]
trip = here / "sample_data/gyor/gyor_q3_00.trip.csv"
folder = pathlib.Path(tempfile.mkdtemp(prefix="macadam-notebook-"))

# %% [markdown]
# ## Roughness along the drive
#
# Nobody knows the car, so the average car `generic` stands for it. Each row is 20 m of travel;
# `iri` is in mm/m with its 90 % interval.

# %%
along = macadam.trace(trip, "generic")
known = ~np.isnan(along["iri"])
print(along)
print(f"{known.sum()} of {along.rows} rows have a value; median IRI {np.median(along['iri'][known]):.2f} mm/m")
for reason, count in zip(*np.unique(along["validity"].astype(str), return_counts=True)):
    print(f"  {reason}: {count}")

# %%
figure, axes = plt.subplots(figsize=(9, 3.5), layout="constrained")
middle_km = (along["from_m"] + along["to_m"]) / 2000
axes.fill_between(middle_km, along["iri_low"], along["iri_high"], step="mid", alpha=0.3,
                  label="90 % interval")
axes.step(middle_km, along["iri"], where="mid", label="IRI")
axes.set(xlabel="travel (km)", ylabel="IRI (mm/m)", ylim=(0, None))
axes.legend()
figure.savefig(folder / "along.png", dpi=120)

# %% [markdown]
# ## The roads
#
# Without a map of roads, the drive itself makes one: the program's `init --trace` and `import`. With a
# map, `init --network town.osm.pbf` takes the place of the first line.

# %%
roads_file = folder / "roads.gpkg"
subprocess.run(["macadam", "init", roads_file, "--trace", trip], check=True)
subprocess.run(["macadam", "import", roads_file, trip, "--vehicle", "generic", "--quiet"], check=True)
roads = macadam.open(roads_file)
segments = roads.segments(geometry=True)
print(f"{segments.rows} segments; {roads.info()['km']:.1f} km driven")

# %%
figure, axes = plt.subplots(figsize=(6, 6), layout="constrained")
scale = Normalize(0, float(np.nanpercentile(segments["iri"], 95)))
colours = plt.get_cmap("RdYlBu_r")(scale(segments["iri"]))
for geometry, colour in zip(segments["geometry"], colours):
    lon_deg, lat_deg = np.array(geometry["coordinates"]).T
    axes.plot(lon_deg, lat_deg, color=colour, linewidth=4, solid_capstyle="butt")
axes.set_aspect(1 / np.cos(np.radians(np.mean(segments["lat_deg"]))))
axes.ticklabel_format(useOffset=False)
axes.locator_params(nbins=4)
axes.set(xlabel="longitude (°)", ylabel="latitude (°)")
figure.colorbar(plt.cm.ScalarMappable(scale, "RdYlBu_r"), ax=axes, shrink=0.6,
                label="IRI (mm/m)")
figure.savefig(folder / "map.png", dpi=120)

# %% [markdown]
# ## Where to look first

# %%
worst = roads.worst(3, min_length_m=60, above_mm_per_m=float(np.nanpercentile(segments["iri"], 75)))
for rank in range(worst.rows):
    print(f"{worst['rank'][rank]}. {worst['length_m'][rank]:.0f} m with IRI {worst['iri'][rank]:.1f} mm/m "
          f"({worst['iri_low'][rank]:.1f} to {worst['iri_high'][rank]:.1f})")
print(f"pictures are in {folder}")
