#include "app/trace/trace_profile.hpp"

#include "estimator/common/error.hpp"
#include "storage/profiles/erd_writer.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace macadam {
namespace {

constexpr double kmh_per_mps = 3.6;

bool passes_lead_in(const IriRun& run) {
    return run.cell_m * static_cast<double>(run.centre_mm_per_m.size()) > run.lead_in_m;
}

std::filesystem::path numbered(const std::filesystem::path& file, std::size_t number) {
    return number == 1 ? file
                       : file.parent_path() / fmt::format("{}-{}{}",
                                                          file.stem().string(),
                                                          number,
                                                          file.extension().string());
}

/// Returns the remarks that make the file understandable on its own.
std::vector<std::string> remarks_of(const IriRun& run, const Vehicle& vehicle, Method method) {
    const auto [slowest, fastest] = std::ranges::minmax(run.speed_mps);
    return {
        fmt::format("Vehicle {}, {:.0f} to {:.0f} km/h, method {}",
                    vehicle.name,
                    kmh_per_mps * static_cast<double>(slowest),
                    kmh_per_mps * static_cast<double>(fastest),
                    method == Method::smoother ? "smoother" : "kf"),
        fmt::format("Waves of {} to 60 m are observed, others are not; the first {:g} m lead in",
                    method == Method::smoother ? 1 : 2,
                    run.lead_in_m)};
}

ErdProfile erd_of(const IriRun& run, const Vehicle& vehicle, Method method) {
    const auto& profile = run.profile;
    ErdProfile erd{.title = "Estimated by macadam trace from a car's vibration, not measured",
                   .start_m = profile.start_travel_m,
                   .step_m = profile.step_m,
                   .channels = {},
                   .remarks = remarks_of(run, vehicle, method)};
    const auto add = [&](std::string name, const std::vector<float>& track_m) {
        erd.channels.push_back({std::move(name), {track_m.begin(), track_m.end()}});
    };
    if (profile.left_m.empty()) {
        add("centre", profile.centre_m);
    } else {
        add("left", profile.left_m);
        add("right", profile.right_m);
    }
    return erd;
}

} // namespace

std::vector<WrittenProfile> write_profiles(const std::filesystem::path& file,
                                           const TripTrace& trace,
                                           const Vehicle& vehicle,
                                           Method method) {
    std::vector<WrittenProfile> written;
    bool lateral_alone = false;
    for (const auto& run : trace.roughness.runs) {
        lateral_alone = lateral_alone || run.profile.centre_m.empty();
        if (run.profile.centre_m.size() < 2 || !passes_lead_in(run)) {
            continue;
        }
        const auto& profile = run.profile;
        const double length_m = profile.step_m * static_cast<double>(profile.centre_m.size() - 1);
        written.push_back({.file = numbered(file, written.size() + 1),
                           .from_m = profile.start_travel_m,
                           .to_m = profile.start_travel_m + length_m,
                           .tracks = !profile.left_m.empty()});
        write_erd(written.back().file, erd_of(run, vehicle, method));
    }
    if (written.empty()) {
        throw InputError{
            lateral_alone
                ? "was estimated from lateral acceleration only, which does not give "
                  "elevations, expected vertical acceleration for --profile"
                : "has no part driven steadily for more than 60 m, expected one for --profile"};
    }
    return written;
}

} // namespace macadam
