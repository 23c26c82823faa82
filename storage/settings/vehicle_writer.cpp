#include "storage/settings/vehicle_writer.hpp"

#include "estimator/vehicle/vehicle_prior.hpp"

#include <fmt/format.h>

#include <string_view>

namespace macadam {
namespace {

std::string line(std::string_view key, double value) {
    return fmt::format("{} = {:.6g}\n", key, value);
}

/// Quotes text as a TOML string.
std::string in_quotes(std::string_view text) {
    std::string quoted{'"'};
    for (const char letter : text) {
        if (letter == '"' || letter == '\\') {
            quoted += '\\';
        }
        quoted += letter;
    }
    return quoted + '"';
}

std::string half_car_text(const HalfCar& car) {
    return "\n[half_car]\n" + line("ms_kg", car.ms_kg) + line("mu_kg", car.mu_kg) +
           line("ks_n_per_m", car.ks_n_per_m) + line("cs_ns_per_m", car.cs_ns_per_m) +
           line("kt_n_per_m", car.kt_n_per_m) + line("is_kgm2", car.is_kgm2) +
           line("l_m", car.l_m) +
           (car.antiroll_n_per_m > 0 ? line("antiroll_n_per_m", car.antiroll_n_per_m) : "") +
           (car.friction_n ? line("friction_n", *car.friction_n) : "");
}

std::string axles_text(const Axles& axles) {
    return "\n[axles]\n" + line("wheelbase_m", axles.wheelbase_m) +
           line("cg_to_front_m", axles.cg_to_front_m) + line("dynamic_index", axles.dynamic_index) +
           line("rear_ratio", axles.rear_ratio);
}

/// Nothing of a low-pass that is not known.
std::string lowpass_text(double lowpass_hz) {
    const double stated_hz = lowpass_hz == no_lowpass_hz ? 0 : lowpass_hz;
    return lowpass_hz > 0 ? line("lowpass_hz", stated_hz) : "";
}

std::string imu_text(const ImuMount& imu) {
    return "\n[imu]\n" + line("x_m", imu.x_m) + line("y_m", imu.y_m) +
           line("height_above_roll_axis_m", imu.height_above_roll_axis_m) +
           lowpass_text(imu.lowpass_hz) + line("lowpass_order", imu.lowpass_order) +
           line("noise_mps2", imu.noise_mps2) + line("noise_radps", imu.noise_radps);
}

} // namespace

std::string vehicle_text(const Vehicle& vehicle) {
    auto text = fmt::format("name = {}\n", in_quotes(vehicle.name)) + line("gain", vehicle.gain);
    if (vehicle.one_axle_gain) {
        text += line("one_axle_gain", *vehicle.one_axle_gain);
    }
    text += half_car_text(vehicle.half_car);
    if (vehicle.axles) {
        text += axles_text(*vehicle.axles);
    }
    text += imu_text(vehicle.imu);
    if (!vehicle.uncertainty.empty()) {
        text += "\n[uncertainty]\n";
        for (const auto& [key, sd] : vehicle.uncertainty) {
            text += line(key, sd);
        }
    }
    return text;
}

} // namespace macadam
