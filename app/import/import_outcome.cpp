#include "app/import/import_outcome.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

namespace macadam {
namespace {

/// Returns the distinct rounded positions of trips: "47.69, 17.67 and 48.20, 16.37".
std::string places_text(std::span<const GeoPoint> trips, int decimals) {
    constexpr std::size_t max_places = 3;
    std::set<std::string> known;
    std::vector<std::string> first;
    for (const auto& [lat_deg, lon_deg] : trips) {
        auto place = fmt::format("{:.{}f}, {:.{}f}", lat_deg, decimals, lon_deg, decimals);
        if (known.insert(place).second && first.size() < max_places) {
            first.push_back(std::move(place));
        }
    }
    if (known.size() <= max_places) {
        return fmt::format("{}", fmt::join(first, " and "));
    }
    const auto others = counted(known.size() - 1, "other place");
    return fmt::format("{} and {}", first.front(), others);
}

} // namespace

std::string outside_text(std::span<const GeoPoint> outside,
                         std::size_t looked_at,
                         const GeoBox& map,
                         PrivacyProfile privacy) {
    const auto who = outside.size() < looked_at ? fmt::format("{} of {} {} outside this map",
                                                              outside.size(),
                                                              counted(looked_at, "trip"),
                                                              outside.size() == 1 ? "is" : "are")
                     : looked_at == 1
                         ? std::string{"the trip does not touch this map"}
                         : fmt::format("none of {} touches this map", counted(looked_at, "trip"));
    constexpr double margin_m = 1000;
    const auto near_map = grown(map, margin_m);
    const auto lies_exchanged = [&](const GeoPoint& at) {
        return contains(near_map, {at.lon_deg, at.lat_deg}) && !contains(near_map, at);
    };
    return fmt::format("{}: {} near {}; map covers {:.2f},{:.2f} to {:.2f},{:.2f} (W,S to E,N){}",
                       who,
                       outside.size() == 1 ? "trip" : "trips",
                       places_text(outside, privacy == PrivacyProfile::crowd ? 1 : 2),
                       map.west_deg,
                       map.south_deg,
                       map.east_deg,
                       map.north_deg,
                       std::ranges::any_of(outside, lies_exchanged)
                           ? "; latitude and longitude are probably exchanged in the log: the "
                             "other way round the trip would be on the map"
                           : "");
}

void warn_of_earlier_settings(const ImportTotals& totals,
                              const std::filesystem::path& store,
                              const std::filesystem::path& path,
                              const Console& console) {
    for (const auto& [settings, count] : totals.earlier_settings) {
        console.warn(fmt::format("{} imported before with {} and stay{} so; to apply other "
                                 "options: macadam reprocess {} {} ...",
                                 counted(count, "trip") + (count == 1 ? " was" : " were"),
                                 settings,
                                 count == 1 ? "s" : "",
                                 store.string(),
                                 path.string()));
    }
}

void expect_on_map(const ImportTotals& totals, const StoreReader& store, const Console& console) {
    if (totals.outside.empty()) {
        return;
    }
    const auto text =
        outside_text(totals.outside, totals.looked_at(), store.map_box(), store.settings().privacy);
    if (totals.outside.size() == totals.looked_at()) {
        throw InputError{text};
    }
    console.warn(text);
}

} // namespace macadam
