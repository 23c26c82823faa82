"""Road roughness maps from the sensors of ordinary cars, as NumPy arrays.

    import macadam

    macadam.iri("profile.csv", length_m=100)              # reference IRI of a measured profile
    macadam.trace("drive.trip.csv", "generic")            # IRI along one trip
    macadam.match("drive.trip.csv", "town.osm.pbf")       # which roads it drove
    macadam.simulate("fleet", "town.osm.pbf")             # trips of made-up cars, with the truth
    roads = macadam.open("roads.gpkg")                    # a database, read
    roads.worst(10)

IRI is in mm/m (the same as m/km); other units are in the names of columns and parameters, and in
``Table.units``. Long calls leave the interpreter to other threads and answer Ctrl-C. Warnings are
``DataWarning``; other messages of the program go to the log "macadam". Defaults that users have set
for the program (macadam help config) do not apply.
"""

from ._database import Database, open
from ._engines import add_vehicle, iri, match, simulate, simulate_drive, trace
from ._files import write_trip
from ._macadam import Error, InputError, UsageError, __version__
from ._results import DataWarning, Table

__all__ = ["DataWarning", "Database", "Error", "InputError", "Table", "UsageError", "__version__",
           "add_vehicle", "iri", "match", "open", "simulate", "simulate_drive", "trace", "write_trip"]

for _error in (Error, InputError, UsageError):
    _error.__module__ = __name__
del _error
