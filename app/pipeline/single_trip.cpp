#include "app/pipeline/single_trip.hpp"

#include "storage/trips/trip_search.hpp"

#include <fmt/format.h>

#include <algorithm> // IWYU pragma: keep; std::ranges::upper_bound is not attributed to it
#include <cmath>
#include <utility>

namespace macadam {
namespace {

constexpr double longest_silence_s = 10;

} // namespace

TripSource one_trip(const std::filesystem::path& path,
                    const std::shared_ptr<const TripMapping>& mapping,
                    const std::filesystem::path& positions) {
    auto found = first_trip(path, {.mapping = mapping, .tracks = true, .positions = positions});
    const bool is_export = found.count == 1 && !found.trip->files.empty();
    if (std::filesystem::is_directory(path) && !is_export) {
        throw InputError{fmt::format("{}: is a folder, expected one trip log", path.string())};
    }
    if (found.count != 1) {
        throw InputError{
            fmt::format("{}: contains {} trip logs, expected one", path.string(), found.count)};
    }
    return std::move(*found.trip);
}

TripPositions::TripPositions(const TripLog& trip) {
    for (const auto& fix : trip.fixes) {
        if (std::isfinite(fix.at.lat_deg) && std::isfinite(fix.at.lon_deg)) {
            t_s_.push_back(fix.t_s - trip.meta.gnss_latency_s);
            at_.push_back(fix.at);
        }
    }
}

std::optional<GeoPoint> TripPositions::operator()(double t_s) const {
    const auto after = std::ranges::upper_bound(t_s_, t_s);
    if (after == t_s_.begin() || after == t_s_.end()) {
        return std::nullopt;
    }
    const auto i = static_cast<std::size_t>(after - t_s_.begin());
    const double step_s = t_s_[i] - t_s_[i - 1];
    if (step_s > longest_silence_s) {
        return std::nullopt;
    }
    return between(at_[i - 1], at_[i], (t_s - t_s_[i - 1]) / step_s);
}

} // namespace macadam
