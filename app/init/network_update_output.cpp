#include "app/init/network_update_output.hpp"

#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>
#include <vector>

namespace macadam {
namespace {

constexpr double m_per_km = 1000;

struct WayChangeCount {
    std::string_view name;
    std::string_view words;
    SegmentTotal ChangeSummary::*total;
};

constexpr std::array fates{WayChangeCount{"kept", "unchanged", &ChangeSummary::kept},
                           WayChangeCount{"renamed", "unchanged, new id", &ChangeSummary::renamed},
                           WayChangeCount{"split", "from split ways", &ChangeSummary::split},
                           WayChangeCount{"merged", "from merged ways", &ChangeSummary::merged},
                           WayChangeCount{"moved", "changed or moved", &ChangeSummary::moved},
                           WayChangeCount{"lost", "lost", &ChangeSummary::lost},
                           WayChangeCount{"new", "new", &ChangeSummary::added}};

std::int64_t whole(std::size_t count) {
    return static_cast<std::int64_t>(count);
}

} // namespace

std::string text_of(const NetworkUpdate& update) {
    auto text = fmt::format("{:<26}{:>12}{:>12}\n", "roads", "km", "segments");
    for (const auto& [name, words, total] : fates) {
        const auto& [segments, length_m] = update.roads.*total;
        text += fmt::format("{:<26}{:>12.1f}{:>12}\n", words, length_m / m_per_km, segments);
    }
    text += fmt::format("{:<26}{:>12}\n"
                        "{:<26}{:>12}{:>12} now\n"
                        "{:<26}{:>12}\n",
                        "passes unchanged",
                        update.passes_kept,
                        "passes moved",
                        update.passes_carried,
                        update.passes_now,
                        "passes lost",
                        update.passes_lost);
    for (const auto& name : update.lost_sections) {
        text += fmt::format("lost control section {}\n", name);
    }
    for (const auto& [name, length_m] : update.roads.lost_roads) {
        text += fmt::format("lost {:>8.2f} km  {}\n", length_m / m_per_km, name);
    }
    return text;
}

std::string json_of(const NetworkUpdate& update) {
    JsonObject object;
    for (const auto& [name, words, total] : fates) {
        const auto& [segments, length_m] = update.roads.*total;
        JsonObject entry;
        entry.add("km", JsonNumber{length_m / m_per_km, 3}).add("segments", whole(segments));
        object.add(name, JsonRaw{entry.text()});
    }
    std::vector<std::string> lost;
    for (const auto& [name, length_m] : update.roads.lost_roads) {
        JsonObject entry;
        entry.add("name", name).add("km", JsonNumber{length_m / m_per_km, 3});
        lost.push_back(entry.text());
    }
    object.add("passes_kept", whole(update.passes_kept))
        .add("passes_carried", whole(update.passes_carried))
        .add("passes_lost", whole(update.passes_lost))
        .add("passes_now", whole(update.passes_now))
        .add("lost_roads", JsonRaw{json_array(lost)})
        .add("lost_control_sections", JsonRaw{json_string_array(update.lost_sections)})
        .add("generation", std::int64_t{update.generation})
        .add("changed", update.changed);
    return object.text() + "\n";
}

} // namespace macadam
