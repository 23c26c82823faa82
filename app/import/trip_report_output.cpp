#include "app/import/trip_report_output.hpp"

#include "app/cli/terminal_escape.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {
namespace {

std::string reasons_json(const RowCount& rows) {
    JsonObject reasons;
    for (const auto& [reason, count] : rows.reasons) {
        reasons.add(reason, static_cast<std::int64_t>(count));
    }
    return reasons.text();
}

std::string json_line(const TripReport& trip) {
    const auto whole = [](std::size_t n) { return static_cast<std::int64_t>(n); };
    JsonObject line;
    line.add("file", trip.file)
        .add("trip_id", trip.trip_id)
        .add("sha256", trip.sha256)
        .add("result", std::string{name_of(trip.result)})
        .add("rows_read", whole(trip.rows.read))
        .add("rows_used", whole(trip.rows.used))
        .add("rows_rejected", whole(trip.rows.rejected))
        .add("reasons", JsonRaw{reasons_json(trip.rows)})
        .add("distance_m", JsonNumber{trip.distance_m, 1})
        .add("matched_m", JsonNumber{trip.matched_m, 1})
        .add("passes", whole(trip.passes))
        .add("vehicle", trip.vehicle)
        .add("warnings", JsonRaw{json_string_array(trip.warnings)});
    if (!trip.error.empty()) {
        line.add("error", trip.error);
    }
    return line.text() + "\n";
}

/// Returns a reason in words for people; files and JSON keep its name.
std::string words_for(std::string_view reason) {
    static constexpr std::pair<std::string_view, std::string_view> own_words[] = {
        {"wrong_cell_count", "wrong number of cells"},
        {"bad_number", "not a number"},
        {"unused_channel", "sensor not needed"},
        {"short_stretch", "continuous drive too short"},
        {"repeated_fix", "repeated position"}};
    const auto* const found =
        std::ranges::find(own_words, reason, &std::pair<std::string_view, std::string_view>::first);
    std::string words{found == std::end(own_words) ? reason : found->second};
    std::ranges::replace(words, '_', ' ');
    return words;
}

std::string spoken(const RowCount& rows) {
    auto words = fmt::format("{} rows, {} used", rows.read, rows.used);
    std::string_view before = ", skipped: ";
    for (const auto& [reason, count] : rows.reasons) {
        words += fmt::format("{}{} {}", before, count, words_for(reason));
        before = ", ";
    }
    return words;
}

std::string notes(const std::vector<std::string>& warnings) {
    std::string lines;
    for (const auto& warning : warnings) {
        lines += fmt::format("          note: {}\n", printable_name(warning));
    }
    return lines;
}

std::string text_lines(const TripReport& trip) {
    const auto result = name_of(trip.result);
    if (trip.result == TripReport::Result::rejected) {
        return fmt::format("{:<9} {}\n", result, printable_name(trip.error));
    }
    if (trip.result == TripReport::Result::outside) {
        return fmt::format("{:<9} {}: touches no road of this map, {}\n",
                           result,
                           printable_name(trip.file),
                           trip.is_stored ? "its earlier passes stay" : "not stored");
    }
    if (trip.result == TripReport::Result::known || trip.result == TripReport::Result::unknown) {
        const bool is_explained =
            trip.result == TripReport::Result::unknown || !trip.warnings.empty();
        return fmt::format("skipped   {}{}\n",
                           printable_name(trip.file),
                           is_explained ? "" : ": already imported") +
               notes(trip.warnings);
    }
    const auto lines =
        fmt::format("{:<9} {}: {}; {:.2f} km driven, {:.2f} km on the network; car '{}'\n"
                    "          {}\n",
                    result,
                    printable_name(trip.file),
                    counted(trip.passes, "pass"),
                    trip.distance_m / 1000,
                    trip.matched_m / 1000,
                    printable_name(trip.vehicle),
                    spoken(trip.rows));
    return lines + notes(trip.warnings);
}

} // namespace

void print_report(const TripReport& trip, bool json, const Console& console) {
    if (json) {
        print(json_line(trip));
    } else if (console.is_quiet() && trip.result != TripReport::Result::rejected) {
        for (const auto& warning : trip.warnings) {
            console.warn(fmt::format("{}: {}", trip.file, warning));
        }
    } else {
        print_words(text_lines(trip));
    }
    flush_results();
}

} // namespace macadam
