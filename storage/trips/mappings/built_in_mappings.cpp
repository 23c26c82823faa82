#include "storage/trips/mappings/built_in_mappings.hpp"

namespace macadam {

namespace {

constexpr BuiltInMapping table[] = {
    {"racechrono",
     R"toml(# RaceChrono Pro, CSV v3. Vertical acceleration is not in it.
header_begins = "timestamp"
rows_under_header = 2            # units, and which device
gravity = "removed"

[time]
column = "timestamp"
format = "s"
epoch = "unix"

[channels]
acc_x_mps2 = {column = "longitudinal_acc", unit = "g"}
acc_y_mps2 = {column = "lateral_acc", unit = "g"}
lat_deg = {column = "latitude"}
lon_deg = {column = "longitude"}
gnss_speed_mps = {column = 15, unit = "m/s"}     # of three columns "speed" the receiver's
course_deg = {column = "bearing"}
)toml",
     "This file is created using RaceChrono"},
    {"trackaddict",
     R"toml(# TrackAddict 4, CSV. Y points ahead, X to the left.
comment = "#"
gravity = "removed"
axes = ["y", "x", "z"]

[time]
column = "UTC Time"
format = "s"
epoch = "unix"

[channels]
acc_x_mps2 = {column = "Accel X", unit = "g"}
acc_y_mps2 = {column = "Accel Y", unit = "g"}
acc_z_mps2 = {column = "Accel Z", unit = "g"}
lat_deg = {column = "Latitude"}
lon_deg = {column = "Longitude"}
gnss_speed_mps = {column = "Speed (Km/h)", unit = "km/h"}
course_deg = {column = "Heading"}
hacc_m = {column = "Accuracy (m)"}
)toml",
     "# RaceRender Data: TrackAddict"},
};

} // namespace

std::span<const BuiltInMapping> built_in_mappings() {
    return table;
}

} // namespace macadam
