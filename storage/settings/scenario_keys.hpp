#pragma once

#include "mapping/simulation/fleet_scenario.hpp"
#include "storage/tables/toml.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <string_view>

/// Numeric keys of a scenario: name, valid range and target field.
namespace macadam::recipe_keys {

inline constexpr TomlRange share{[](double x) { return x >= 0 && x <= 1; }, "a number from 0 to 1"};
inline constexpr TomlRange short_distance{[](double x) { return std::abs(x) <= 20; },
                                          "metres, from -20 to 20"};
inline constexpr TomlRange wheelbase{[](double x) { return x > 0 && x <= 20; },
                                     "metres, above 0 and at most 20"};
inline constexpr TomlRange trip_km{[](double x) { return x >= 0 && x <= 300; },
                                   "a number from 0 to 300"}; // ten hours in a town
inline constexpr TomlRange iri{[](double x) { return x >= 0.01 && x <= 50; },
                               "a number from 0.01 to 50"}; // as in check() of a RoadRecipe
inline constexpr TomlRange wave_ratio{
    [](double x) { return x >= min_wave_ratio && x <= max_wave_ratio; }, "a number from 0.2 to 8"};
// Limits that keep the duration of a drive, and the number of events in it, within memory.
inline constexpr TomlRange gain{[](double x) { return x >= 0.05 && x <= 100; },
                                "m/s2, from 0.05 to 100"};
inline constexpr TomlRange duration{[](double x) { return x >= 0 && x <= 86400; },
                                    "seconds, from 0 to 86400"};
inline constexpr TomlRange per_hour{[](double x) { return x >= 0 && x <= 3600; },
                                    "a number from 0 to 3600"};
inline constexpr TomlRange factor{[](double x) { return x >= 0.1 && x <= 10; },
                                  "a number from 0.1 to 10"};
inline constexpr TomlRange kmh{[](double x) { return x >= 1 && x <= 400; }, "km/h, from 1 to 400"};
inline constexpr TomlRange some_way{[](double x) { return x >= 0.1 && x <= 100'000; },
                                    "metres, from 0.1 to 100000"};
inline constexpr TomlRange rate{[](double x) { return x > 0 && x <= 1000; },
                                "a number of hertz, above 0 and at most 1000"};

/// Numeric key with its valid range and target field.
template <typename Recipe>
struct NumberKey {
    std::string_view name;
    TomlRange range;
    double& (*place)(Recipe&);
};

template <typename Recipe>
struct BoundsKey {
    std::string_view name;
    TomlRange range;
    Bounds& (*place)(Recipe&);
};

template <typename Recipe>
struct OptionalKey {
    std::string_view name;
    TomlRange range;
    std::optional<double>& (*place)(Recipe&);
};

// clang-format off
inline constexpr std::array driving_numbers{
    NumberKey<DrivingRecipe>{"return_share", share, [](auto& r) -> double& { return r.return_share; }},
    NumberKey<DrivingRecipe>{"stop_share", share, [](auto& r) -> double& { return r.stop_share; }},
    NumberKey<DrivingRecipe>{"acceleration_mps2", gain, [](auto& r) -> double& { return r.acceleration_mps2; }},
    NumberKey<DrivingRecipe>{"braking_mps2", gain, [](auto& r) -> double& { return r.braking_mps2; }},
    NumberKey<DrivingRecipe>{"lateral_mps2", gain, [](auto& r) -> double& { return r.lateral_mps2; }},
    NumberKey<DrivingRecipe>{"lane_offset_m", short_distance, [](auto& r) -> double& { return r.lane_offset_m; }},
    NumberKey<DrivingRecipe>{"oneway_offset_m", short_distance, [](auto& r) -> double& { return r.oneway_offset_m; }},
    NumberKey<DrivingRecipe>{"corner_m", some_way, [](auto& r) -> double& { return r.corner_m; }},
    NumberKey<DrivingRecipe>{"wander_m", not_negative_number, [](auto& r) -> double& { return r.wander_m; }},
    NumberKey<DrivingRecipe>{"wander_length_m", some_way, [](auto& r) -> double& { return r.wander_length_m; }},
};
inline constexpr std::array driving_bounds{
    BoundsKey<DrivingRecipe>{"length_km", trip_km, [](auto& r) -> Bounds& { return r.length_km; }},
    BoundsKey<DrivingRecipe>{"stop_s", duration, [](auto& r) -> Bounds& { return r.stop_s; }},
    BoundsKey<DrivingRecipe>{"driver", factor, [](auto& r) -> Bounds& { return r.driver; }},
};
inline constexpr std::array gnss_numbers{
    NumberKey<GnssRecipe>{"rate_hz", rate, [](auto& r) -> double& { return r.rate_hz; }},
    NumberKey<GnssRecipe>{"sigma_m", not_negative_number, [](auto& r) -> double& { return r.sigma_m; }},
    NumberKey<GnssRecipe>{"correlation_s", not_negative_number, [](auto& r) -> double& { return r.correlation_s; }},
    NumberKey<GnssRecipe>{"white_m", not_negative_number, [](auto& r) -> double& { return r.white_m; }},
    NumberKey<GnssRecipe>{"speed_sd_mps", not_negative_number, [](auto& r) -> double& { return r.speed_sd_mps; }},
    NumberKey<GnssRecipe>{"outages_per_hour", per_hour, [](auto& r) -> double& { return r.outages_per_hour; }},
    NumberKey<GnssRecipe>{"antenna_ahead_m", short_distance, [](auto& r) -> double& { return r.antenna_ahead_m; }},
    NumberKey<GnssRecipe>{"antenna_left_m", short_distance, [](auto& r) -> double& { return r.antenna_left_m; }},
};
inline constexpr std::array gnss_bounds{
    BoundsKey<GnssRecipe>{"latency_s", duration, [](auto& r) -> Bounds& { return r.latency_s; }},
    BoundsKey<GnssRecipe>{"outage_s", duration, [](auto& r) -> Bounds& { return r.outage_s; }},
    BoundsKey<GnssRecipe>{"first_fix_s", duration, [](auto& r) -> Bounds& { return r.first_fix_s; }},
};
inline constexpr std::array imu_numbers{
    NumberKey<ImuRecipe>{"rate_hz", rate, [](auto& r) -> double& { return r.rate_hz; }},
    NumberKey<ImuRecipe>{"noise_mps2", positive_number, [](auto& r) -> double& { return r.noise_mps2; }},
    NumberKey<ImuRecipe>{"noise_radps", positive_number, [](auto& r) -> double& { return r.noise_radps; }},
    NumberKey<ImuRecipe>{"lowpass_hz", not_negative_number, [](auto& r) -> double& { return r.lowpass_hz; }},
    NumberKey<ImuRecipe>{"mount_hz", not_negative_number, [](auto& r) -> double& { return r.mount_hz; }},
    NumberKey<ImuRecipe>{"mount_damping", positive_number, [](auto& r) -> double& { return r.mount_damping; }},
    NumberKey<ImuRecipe>{"quantum_mps2", not_negative_number, [](auto& r) -> double& { return r.quantum_mps2; }},
    NumberKey<ImuRecipe>{"quantum_radps", not_negative_number, [](auto& r) -> double& { return r.quantum_radps; }},
    NumberKey<ImuRecipe>{"jitter_s", not_negative_number, [](auto& r) -> double& { return r.jitter_s; }},
};
inline constexpr std::array spread_numbers{
    NumberKey<SensorSpread>{"acc_bias_mps2", not_negative_number, [](auto& r) -> double& { return r.acc_bias_mps2; }},
    NumberKey<SensorSpread>{"gyro_bias_radps", not_negative_number, [](auto& r) -> double& { return r.gyro_bias_radps; }},
    NumberKey<SensorSpread>{"tilt_deg", not_negative_number, [](auto& r) -> double& { return r.tilt_deg; }},
};
inline constexpr std::array odometer_numbers{
    NumberKey<OdometerRecipe>{"rate_hz", rate, [](auto& r) -> double& { return r.rate_hz; }},
    NumberKey<OdometerRecipe>{"scale_sd", share, [](auto& r) -> double& { return r.scale_sd; }},
    NumberKey<OdometerRecipe>{"noise_mps", not_negative_number, [](auto& r) -> double& { return r.noise_mps; }},
    NumberKey<OdometerRecipe>{"quantum_mps", not_negative_number, [](auto& r) -> double& { return r.quantum_mps; }},
};
inline constexpr std::array knowledge_numbers{
    NumberKey<KnowledgeRecipe>{"ms_kg", share, [](auto& r) -> double& { return r.ms_kg; }},
    NumberKey<KnowledgeRecipe>{"mu_kg", share, [](auto& r) -> double& { return r.mu_kg; }},
    NumberKey<KnowledgeRecipe>{"ks_n_per_m", share, [](auto& r) -> double& { return r.ks_n_per_m; }},
    NumberKey<KnowledgeRecipe>{"cs_ns_per_m", share, [](auto& r) -> double& { return r.cs_ns_per_m; }},
    NumberKey<KnowledgeRecipe>{"kt_n_per_m", share, [](auto& r) -> double& { return r.kt_n_per_m; }},
    NumberKey<KnowledgeRecipe>{"is_kgm2", share, [](auto& r) -> double& { return r.is_kgm2; }},
    NumberKey<KnowledgeRecipe>{"dynamic_index", share, [](auto& r) -> double& { return r.dynamic_index; }},
    NumberKey<KnowledgeRecipe>{"gain", share, [](auto& r) -> double& { return r.gain; }},
};
inline constexpr std::array road_numbers{
    OptionalKey<RoadRule>{"waviness", positive_number, [](auto& r) -> std::optional<double>& { return r.waviness; }},
    OptionalKey<RoadRule>{"level_sd", not_negative_number, [](auto& r) -> std::optional<double>& { return r.level_sd; }},
    OptionalKey<RoadRule>{"level_length_m", positive_number, [](auto& r) -> std::optional<double>& { return r.level_length_m; }},
    OptionalKey<RoadRule>{"coherency_length_m", not_negative_number, [](auto& r) -> std::optional<double>& { return r.coherency_length_m; }},
    OptionalKey<RoadRule>{"joint_spacing_m", not_negative_number, [](auto& r) -> std::optional<double>& { return r.joint_spacing_m; }},
    OptionalKey<RoadRule>{"joint_step_mm", not_negative_number, [](auto& r) -> std::optional<double>& { return r.joint_step_mm; }},
    OptionalKey<RoadRule>{"patches_per_km", not_negative_number, [](auto& r) -> std::optional<double>& { return r.patches_per_km; }},
    OptionalKey<RoadRule>{"potholes_per_km", not_negative_number, [](auto& r) -> std::optional<double>& { return r.potholes_per_km; }},
};
inline constexpr std::array car_numbers{
    NumberKey<CarRecipe>{"ms_kg", positive_number, [](auto& r) -> double& { return r.vehicle.half_car.ms_kg; }},
    NumberKey<CarRecipe>{"mu_kg", positive_number, [](auto& r) -> double& { return r.vehicle.half_car.mu_kg; }},
    NumberKey<CarRecipe>{"ks_n_per_m", positive_number, [](auto& r) -> double& { return r.vehicle.half_car.ks_n_per_m; }},
    NumberKey<CarRecipe>{"cs_ns_per_m", positive_number, [](auto& r) -> double& { return r.vehicle.half_car.cs_ns_per_m; }},
    NumberKey<CarRecipe>{"kt_n_per_m", positive_number, [](auto& r) -> double& { return r.vehicle.half_car.kt_n_per_m; }},
    NumberKey<CarRecipe>{"is_kgm2", positive_number, [](auto& r) -> double& { return r.vehicle.half_car.is_kgm2; }},
    NumberKey<CarRecipe>{"l_m", positive_number, [](auto& r) -> double& { return r.vehicle.half_car.l_m; }},
    NumberKey<CarRecipe>{"wheelbase_m", wheelbase, [](auto& r) -> double& { return r.vehicle.axles->wheelbase_m; }},
    NumberKey<CarRecipe>{"cg_to_front_m", positive_number, [](auto& r) -> double& { return r.vehicle.axles->cg_to_front_m; }},
    NumberKey<CarRecipe>{"dynamic_index", positive_number, [](auto& r) -> double& { return r.vehicle.axles->dynamic_index; }},
    NumberKey<CarRecipe>{"rear_ratio", positive_number, [](auto& r) -> double& { return r.vehicle.axles->rear_ratio; }},
    NumberKey<CarRecipe>{"imu_x_m", short_distance, [](auto& r) -> double& { return r.vehicle.imu.x_m; }},
    NumberKey<CarRecipe>{"imu_y_m", short_distance, [](auto& r) -> double& { return r.vehicle.imu.y_m; }},
    NumberKey<CarRecipe>{"imu_height_m", short_distance, [](auto& r) -> double& { return r.vehicle.imu.height_above_roll_axis_m; }},
    NumberKey<CarRecipe>{"friction_n", not_negative_number, [](auto& r) -> double& { return r.friction_n; }},
    NumberKey<CarRecipe>{"rebound_ratio", positive_number, [](auto& r) -> double& { return r.rebound_ratio; }},
    NumberKey<CarRecipe>{"bump_stop_gap_m", positive_number, [](auto& r) -> double& { return r.bump_stop_gap_m; }},
    NumberKey<CarRecipe>{"tyre_nonuniformity_n", not_negative_number, [](auto& r) -> double& { return r.tyre_nonuniformity_n; }},
    NumberKey<CarRecipe>{"cg_above_roll_axis_m", not_negative_number, [](auto& r) -> double& { return r.cg_above_roll_axis_m; }},
    NumberKey<CarRecipe>{"pitch_arm_m", not_negative_number, [](auto& r) -> double& { return r.pitch_arm_m; }},
    NumberKey<CarRecipe>{"antiroll_n_per_m", not_negative_number, [](auto& r) -> double& { return r.antiroll_n_per_m; }},
};
// clang-format on

} // namespace macadam::recipe_keys
