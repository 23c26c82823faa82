#pragma once

#include "app/cli/arguments.hpp"
#include "mapping/network/road_network.hpp"
#include "mapping/surveys/reference_passes.hpp"
#include "storage/store/import_store.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

inline constexpr Option reference_option =
    in_group("reference measurements",
             {"--reference", "FILE.csv", "Import a survey by a better instrument as a reference."});
inline constexpr Option accuracy_option = rare(in_group(
    "reference measurements",
    {"--accuracy", "PERCENT", "With --reference: standard deviation of its values.", "3"}));
inline constexpr Option reference_date_option =
    rare(in_group("reference measurements",
                  {"--date", "YYYY-MM-DD", "With --reference: date of the measurement."}));
inline constexpr Option reference_name_option = formerly(
    "--name",
    rare(in_group("reference measurements",
                  {"--survey-name", "TEXT", "With --reference: its name.", "the file's name"})));
inline constexpr Option control_option = rare(
    in_group("reference measurements",
             {"--control", "FILE.csv", "Control sections of known IRI, to monitor the cars."}));
inline constexpr Option known_unit_option =
    rare(one_of("mm/m|in/mi",
                in_group("reference measurements",
                         {"--unit",
                          "UNIT",
                          "IRI unit of the --reference and --control files: mm/m or in/mi.",
                          "mm/m"})));

/// Files of known roughness to import.
struct KnownRoughness {
    std::optional<std::filesystem::path> survey;
    std::optional<std::filesystem::path> control;
    double relative_sd = usual_reference_accuracy; ///< relative standard deviation of the survey
    std::optional<std::int64_t> utc_ms;            ///< date of the survey
    std::string name;                              ///< name of the survey
    double mm_per_m_of_one = 1;                    ///< mm/m of an IRI of 1 in the files
    bool readmit = false; ///< re-admit the survey if 'macadam forget' deleted it
};

/// Parses the options above.
/// \throws UsageError  for an invalid value, or one for a file that is not given.
KnownRoughness parse_known_roughness(const Arguments& arguments);

/// Result of one survey's import.
struct SurveyOutcome {
    std::string file;
    std::string name;
    std::string sha256;
    bool known = false; ///< already in the database
    std::size_t rows = 0;
    double relative_sd = 0;
    std::optional<std::int64_t> utc_ms;
    ReferencePasses found;
    std::vector<std::string> warnings;
};

/// Imports the survey in one transaction.
///
/// \throws InputError  if it cannot be read, none of its rows lies on the database's roads, or it
///                     was deleted and is not re-admitted.
SurveyOutcome
import_survey(ImportTarget& trips, const RoadNetwork& roads, const KnownRoughness& known);

/// Formats the result for people, with newlines, or as one JSON object with the keys of a trip's.
std::string text_lines(const SurveyOutcome& outcome);
std::string json_line(const SurveyOutcome& outcome);

} // namespace macadam
