#include "app/import/import_references.hpp"

#include "app/cli/console.hpp"
#include "app/cli/terminal_escape.hpp"

#include "estimator/common/error.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/surveys/reference_reader.hpp"
#include "storage/text/json.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <cmath>

namespace macadam {
namespace {

constexpr double min_accuracy_percent = 0.1;
constexpr double max_accuracy_percent = 50;

void expect_its_file(const Arguments& arguments) {
    for (const auto* const option : {"--accuracy", "--date", "--survey-name"}) {
        if (!arguments.value("--reference") && arguments.value(option)) {
            throw UsageError{fmt::format("{} requires --reference FILE.csv", option)};
        }
    }
    if (!arguments.value("--reference") && !arguments.value("--control") &&
        arguments.value("--unit")) {
        throw UsageError{"--unit requires --reference or --control"};
    }
}

double parse_accuracy(const Arguments& arguments) {
    const double percent = arguments.number("--accuracy", 100 * usual_reference_accuracy);
    if (!(percent >= min_accuracy_percent && percent <= max_accuracy_percent)) {
        throw UsageError{fmt::format("--accuracy is {}, expected {} to {} percent",
                                     percent,
                                     min_accuracy_percent,
                                     max_accuracy_percent)};
    }
    return percent / 100;
}

std::optional<std::int64_t> parse_day(const Arguments& arguments) {
    const auto text = arguments.value("--date");
    if (!text) {
        return std::nullopt;
    }
    const auto utc_s = parse_utc_s(*text + "T00:00:00Z");
    if (!utc_s) {
        throw UsageError{fmt::format("--date is '{}', expected a day such as 2026-03-01", *text)};
    }
    return std::llround(*utc_s * 1000);
}

std::string reasons_text(const std::map<std::string, std::size_t>& reasons) {
    std::string words;
    for (const auto& [reason, count] : reasons) {
        words += fmt::format("{}{} {}", words.empty() ? "" : ", ", count, reason);
    }
    return words;
}

TripRecord record_of(const SurveyOutcome& outcome) {
    TripRecord record;
    record.sha256 = outcome.sha256;
    record.trip_id = outcome.name;
    record.file_name = std::filesystem::path{outcome.file}.filename().string();
    record.t0_utc_ms = outcome.utc_ms;
    record.method = "reference";
    record.distance_mm = std::llround(outcome.found.placed_m * 1000);
    record.matched_mm = record.distance_mm;
    record.rows_read = outcome.rows;
    record.rows_used = outcome.found.used;
    record.row_reasons = outcome.found.reasons;
    record.reference =
        ReferenceNote{static_cast<std::int32_t>(std::lround(outcome.relative_sd * 1e6)),
                      static_cast<std::int32_t>(std::lround(outcome.found.row_m * 1000))};
    return record;
}

} // namespace

KnownRoughness parse_known_roughness(const Arguments& arguments) {
    expect_its_file(arguments);
    KnownRoughness known;
    known.survey = arguments.value("--reference");
    known.control = arguments.value("--control");
    known.relative_sd = parse_accuracy(arguments);
    known.utc_ms = parse_day(arguments);
    known.name = arguments.value("--survey-name")
                     .value_or(known.survey ? known.survey->stem().string() : std::string{});
    known.mm_per_m_of_one = arguments.choice("--unit") == "in/mi" ? 1 / in_per_mi_of_mm_per_m : 1;
    known.readmit = arguments.flag("--take-back");
    return known;
}

SurveyOutcome
import_survey(ImportTarget& trips, const RoadNetwork& roads, const KnownRoughness& known) {
    const auto survey = read_reference(*known.survey, known.mm_per_m_of_one);
    SurveyOutcome outcome{.file = known.survey->string(),
                          .name = known.name,
                          .sha256 = survey.sha256,
                          .known = trips.contains_trip(survey.sha256),
                          .rows = survey.rows.size(),
                          .relative_sd = known.relative_sd,
                          .utc_ms = known.utc_ms,
                          .found = {},
                          .warnings = {}};
    if (outcome.known) {
        outcome.warnings.emplace_back("was imported before and stays unchanged, whatever the "
                                      "options say now");
        return outcome;
    }
    if (trips.has_forgotten(survey.sha256) && !known.readmit) {
        throw InputError{fmt::format("{}: was permanently deleted on request; --take-back "
                                     "re-admits it",
                                     outcome.file)};
    }
    outcome.found =
        reference_passes(survey, placed_on(roads, survey), {.relative_sd = known.relative_sd});
    if (outcome.found.passes.empty()) {
        throw InputError{fmt::format("{}: none of its {} can be used: {}",
                                     outcome.file,
                                     counted(outcome.rows, "row"),
                                     reasons_text(outcome.found.reasons))};
    }
    if (!known.utc_ms) {
        outcome.warnings.emplace_back("no --date: the survey is undated");
    }
    const auto record = record_of(outcome);
    const NewTrip trip{&record, outcome.found.passes, {}, known.readmit};
    outcome.known = !trips.add_trips({&trip, 1}).front();
    return outcome;
}

std::string text_lines(const SurveyOutcome& outcome) {
    std::string lines;
    if (outcome.known) {
        lines = fmt::format("skipped   {}: already imported\n", printable_name(outcome.file));
    } else {
        lines = fmt::format("imported  {}: reference '{}', {} of {:.2f} km, accurate to {:g} "
                            "%\n          {} rows, {} used",
                            printable_name(outcome.file),
                            printable_name(outcome.name),
                            counted(outcome.found.passes.size(), "segment"),
                            outcome.found.placed_m / 1000,
                            100 * outcome.relative_sd,
                            outcome.rows,
                            outcome.found.used);
        const auto reasons = reasons_text(outcome.found.reasons);
        lines += (reasons.empty() ? "" : ", skipped: " + reasons) + "\n";
    }
    for (const auto& warning : outcome.warnings) {
        lines += fmt::format("          note: {}\n", warning);
    }
    return lines;
}

std::string json_line(const SurveyOutcome& outcome) {
    const auto whole = [](std::size_t n) { return static_cast<std::int64_t>(n); };
    JsonObject reasons;
    for (const auto& [reason, count] : outcome.found.reasons) {
        reasons.add(reason, whole(count));
    }
    JsonObject line;
    line.add("file", outcome.file)
        .add("trip_id", outcome.name)
        .add("sha256", outcome.sha256)
        .add("result", outcome.known ? "known" : "imported")
        .add("rows_read", whole(outcome.rows))
        .add("rows_used", whole(outcome.found.used))
        .add("rows_rejected", whole(outcome.known ? 0 : outcome.rows - outcome.found.used))
        .add("reasons", JsonRaw{reasons.text()})
        .add("distance_m", JsonNumber{outcome.found.placed_m, 1})
        .add("matched_m", JsonNumber{outcome.found.placed_m, 1})
        .add("passes", whole(outcome.found.passes.size()))
        .add("vehicle", nullptr)
        .add("warnings", JsonRaw{json_string_array(outcome.warnings)})
        .add("reference", true);
    return line.text() + "\n";
}

} // namespace macadam
