# %% [markdown]
# # Methods compared on a measured profile
#
# The reference IRI of a profile is known exactly (ASTM E1926). A simulated car drives over it; the
# smoother and the published Kalman filter estimate the IRI from what its sensor read, and both are
# held against the reference. The simulation (four wheels, friction, tyres) has none of the estimator's code.

# %%
import pathlib
import tempfile

import matplotlib.pyplot as plt
import numpy as np

import macadam

here = pathlib.Path(__file__).resolve().parents[2]
folder = pathlib.Path(tempfile.mkdtemp(prefix="macadam-notebook-"))
measured_m = np.loadtxt(here / "tests/data/sorel/profile_1.txt")[:, 1]
step_m = 0.25

# %% [markdown]
# The measured 544 m are driven forward, backward and forward again, without a step between them.

# %%
track_m = np.concatenate([measured_m, measured_m[-2::-1], measured_m[1:]])
reference = macadam.iri(track_m, step_m=step_m, length_m=20)
print(f"{step_m * (len(track_m) - 1):.0f} m, reference IRI {reference['iri_profile'].mean():.2f} mm/m "
      f"({reference.details['method']})")

# %% [markdown]
# ## One drive, two methods
#
# The car is described by what is in its papers; the drive itself knows nothing else.

# %%
car = folder / "compact.toml"
macadam.add_vehicle(car, mass_kg=1430, wheelbase_m=2.62, body="compact", mount="fixed")
drive = macadam.simulate_drive(track_m, car, step_m=step_m, speed_mps=18)
estimates = {"smoother": macadam.trace(drive, car), "kf": macadam.trace(drive, car, method="kf")}

# %%
rows = min(reference.rows, *(table.rows for table in estimates.values()))
settled = ~reference["lead_in"][:rows]
truth = reference["iri_profile"][:rows]
figure, axes = plt.subplots(figsize=(9, 3.5), layout="constrained")
axes.step(reference["from_m"][:rows], truth, where="post", color="black", label="reference")
for method, table in estimates.items():
    iri = table["iri"][:rows]
    used = settled & ~np.isnan(iri)
    error = (iri[used] - truth[used]) / truth[used]
    print(f"{method:>8}: {used.sum()} segments of 20 m, bias {100 * error.mean():+.1f} %, "
          f"RMS error {100 * np.sqrt(np.mean(error**2)):.1f} %")
    axes.step(table["from_m"][:rows], iri, where="post", label=method)
axes.set(xlabel="travel (m)", ylabel="IRI (mm/m)", ylim=(0, None))
axes.legend()
figure.savefig(folder / "methods.png", dpi=120)
print(f"the picture is in {folder}")
