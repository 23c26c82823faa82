#include "app/import/trip_outcome_output.hpp"

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

std::string json_line(const TripOutcome& outcome) {
    const auto whole = [](std::size_t n) { return static_cast<std::int64_t>(n); };
    const auto& trip = outcome.trip;
    JsonObject line;
    line.add("file", outcome.file)
        .add("trip_id", outcome.trip_id)
        .add("sha256", outcome.sha256)
        .add("result", std::string{name_of(outcome.result)})
        .add("rows_read", whole(trip.rows.read))
        .add("rows_used", whole(trip.rows.used))
        .add("rows_rejected", whole(trip.rows.rejected))
        .add("reasons", JsonRaw{reasons_json(trip.rows)})
        .add("distance_m", JsonNumber{trip.distance_m, 1})
        .add("matched_m", JsonNumber{trip.matched_m, 1})
        .add("passes", whole(trip.passes.size()))
        .add("vehicle", outcome.vehicle)
        .add("warnings", JsonRaw{json_string_array(trip.warnings)});
    if (!outcome.error.empty()) {
        line.add("error", outcome.error);
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

std::string text_lines(const TripOutcome& outcome) {
    const auto result = name_of(outcome.result);
    if (outcome.result == TripOutcome::Result::rejected) {
        return fmt::format("{:<9} {}\n", result, printable_name(outcome.error));
    }
    const auto& trip = outcome.trip;
    if (outcome.result == TripOutcome::Result::known ||
        outcome.result == TripOutcome::Result::unknown) {
        const bool is_explained =
            outcome.result == TripOutcome::Result::unknown || !trip.warnings.empty();
        return fmt::format("skipped   {}{}\n",
                           printable_name(outcome.file),
                           is_explained ? "" : ": already imported") +
               notes(trip.warnings);
    }
    const auto lines =
        fmt::format("{:<9} {}: {}; {:.2f} km driven, {:.2f} km on the network; car '{}'\n"
                    "          {}\n",
                    result,
                    printable_name(outcome.file),
                    counted(trip.passes.size(), "pass"),
                    trip.distance_m / 1000,
                    trip.matched_m / 1000,
                    printable_name(outcome.vehicle),
                    spoken(trip.rows));
    return lines + notes(trip.warnings);
}

} // namespace

void print_outcome(const TripOutcome& outcome, bool json, const Console& console) {
    if (json) {
        print(json_line(outcome));
    } else if (console.is_quiet() && outcome.result != TripOutcome::Result::rejected) {
        for (const auto& warning : outcome.trip.warnings) {
            console.warn(fmt::format("{}: {}", outcome.file, warning));
        }
    } else {
        print_words(text_lines(outcome));
    }
    flush_results();
}

} // namespace macadam
