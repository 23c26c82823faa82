#include "storage/settings/sample_scenario.hpp"

namespace macadam {

std::string_view sample_recipe() {
    return R"(# A fleet for `macadam simulate`. Every key may be left out; what is written here is then taken.
# Two numbers in brackets are bounds, from which a value is drawn. sd: standard deviation.

[trips]
count = 20
length_km = [6, 12]
from = "2025-01-01"         # days of driving, the last included
to = "2025-12-31"
places = 24                 # between which people drive
return_share = 0.5          # of the trips, those that go back the way of the trip before
stop_share = 0.1            # of junctions (not of motorways and trunk roads), those with a stop
stop_s = [3, 25]
driver = [0.85, 1.1]        # a trip's speed over the usual one of its roads
acceleration_mps2 = 1.4
braking_mps2 = 1.8
lateral_mps2 = 2.5          # at most, in curves
driving_side = "right"      # or "left"
lane_offset_m = 1.75        # of the lane of a two-way road from the line on the map
oneway_offset_m = 0
corner_m = 17               # corners are rounded by three moving means of this length
wander_m = 0.15             # sd of the car's place in its lane, ...
wander_length_m = 200       # ... which changes over this distance

[speed_kmh]                 # usual, by class of road
residential = 36

[gnss]
rate_hz = 5
sigma_m = 1.5               # sd of the slow error of position, each axis
correlation_s = 60          # over which it changes
white_m = 0.2               # sd of the quick error
speed_sd_mps = 0.1          # along and across; across makes the error of the course
latency_s = [0, 0.4]        # by how much stamps are late, drawn for each car
latency_stated = false      # does the log say so?
outages_per_hour = 4
outage_s = [5, 40]
first_fix_s = [0, 10]       # before the first position of a trip
antenna_ahead_m = 0         # of the centre of gravity
antenna_left_m = 0

[imu]                       # of all cars; a car may say otherwise
rate_hz = 100
noise_mps2 = 0.03
noise_radps = 0.001
lowpass_hz = 0              # 0: none
lowpass_order = 2
mount_hz = 0                # resonance of a holder; 0: none
mount_damping = 0.08
quantum_mps2 = 0.0012       # 4 g in 16 bits
quantum_radps = 0.00013     # 250 degrees a second in 16 bits
jitter_s = 0.0002           # of time stamps
acc_bias_mps2 = 0.03        # sd, drawn for each car, as are these:
gyro_bias_radps = 0.002
tilt_deg = 0.3

[odometer]
rate_hz = 50
scale_sd = 0.01             # of logged over true speed, drawn for each car
noise_mps = 0.01
quantum_mps = 0.01

[knowledge]
relative_sd = 0.05          # how wrong the vehicle files are that are written, and state that they are;
                            # ms_kg, mu_kg, ks_n_per_m, cs_ns_per_m, kt_n_per_m and is_kgm2 may each
                            # have another
# dynamic_index = 0         # the same of these two, which are right without it
# gain = 0

# Roads. Every rule that fits a way says what it has to say, the later ones over the earlier ones.
# Conditions: highway (one or several), way_id, name, share (of the ways that fit).

[[road]]
iri_mm_per_m = [1.5, 3.5]   # drawn for each way and direction
waviness = 2.0              # of the spectrum (ISO 8608)
# long_wave_ratio = [0.4, 7.8]    # bend the spectrum: slopes in waves of 15 to 30 m and ...
# short_wave_ratio = [0.24, 0.76] # ... of 1 to 2 m over those of 4 to 8 m (power), drawn for each way
level_sd = 0.25             # of the logarithm of roughness along a road, ...
level_length_m = 150        # ... which changes over this distance
coherency_length_m = 3      # both tracks are alike in waves longer than a few of these
patches_per_km = 3

[[road]]
highway = ["motorway", "motorway_link", "trunk", "trunk_link"]
iri_mm_per_m = [0.7, 1.2]
patches_per_km = 0.5

[[road]]
highway = ["motorway", "trunk"]
share = 0.2
iri_mm_per_m = [1.4, 2.0]
joint_spacing_m = 5         # concrete slabs
joint_step_mm = 2

[[road]]
highway = ["primary", "primary_link", "secondary", "secondary_link"]
iri_mm_per_m = [1.2, 2.5]

[[road]]
highway = ["residential", "living_street", "service", "track"]
iri_mm_per_m = [3, 5]
patches_per_km = 8
potholes_per_km = 2

# Cars. `like` is a built-in car whose masses, springs and dampers are taken; each may also be said:
# ms_kg, mu_kg, ks_n_per_m, cs_ns_per_m, kt_n_per_m, is_kgm2, l_m. `sensors` says which columns the
# logs have: acc, gyro, speed (of the wheels).

[[car]]
id = "town-car"
like = "small-car"
wheelbase_m = 2.45
cg_to_front_m = 1.05
imu_x_m = -0.2              # ahead of the centre of gravity; behind it is below 0
imu_y_m = 0.1               # to the left
imu_height_m = 0.35         # above the roll axis
friction_n = 30             # of each suspension
rebound_ratio = 1.4         # of the dampers, over the mean of both ways
# antiroll_n_per_m = 8000      # anti-roll bars, at each wheel
# cg_above_roll_axis_m = 0.45  # lever arm of the lean in curves
# pitch_arm_m = 0.35           # lever arm of the dive in braking

[[car]]
id = "hatchback"
like = "generic"
ms_kg = 1300
is_kgm2 = 280
wheelbase_m = 2.62
cg_to_front_m = 1.15
imu_x_m = 0.3
imu_height_m = 0.3

[[car]]
id = "estate"
like = "generic"
ms_kg = 1650
ks_n_per_m = 29000
wheelbase_m = 2.85
cg_to_front_m = 1.35
imu_height_m = 0.4
imu_rate_hz = 125
gnss_rate_hz = 10

[[car]]
id = "suv"
like = "suv"
wheelbase_m = 2.75
cg_to_front_m = 1.3
imu_x_m = 0.1
imu_y_m = -0.2
imu_height_m = 0.5
friction_n = 50

[[car]]
id = "van"
like = "van"
wheelbase_m = 3.3
cg_to_front_m = 1.5
imu_x_m = 0.5
imu_height_m = 0.45
friction_n = 60
dynamic_index = 1.1         # k^2 / (a b)
gnss_rate_hz = 1
sensors = ["acc", "gyro"]   # its only speed is the receiver's
)";
}

} // namespace macadam
