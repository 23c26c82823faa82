#pragma once

#include "app/cli/arguments.hpp"
#include "mapping/network/road_network.hpp"
#include "mapping/surveys/reference_passes.hpp"
#include "storage/store/road_store.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

inline constexpr Option reference_option{
    "--reference", "FILE.csv", "Import a survey by a better instrument as a reference."};
inline constexpr Option accuracy_option{
    "--accuracy", "PERCENT", "With --reference: standard deviation of its values.", "3"};
inline constexpr Option reference_date_option{
    "--date", "YYYY-MM-DD", "With --reference: date of the measurement."};
inline constexpr Option reference_name_option{
    "--name", "TEXT", "With --reference: its name.", "the file's name"};
inline constexpr Option control_option{
    "--control", "FILE.csv", "Control sections of known IRI, to monitor the cars."};
inline constexpr Option known_unit_option{
    "--unit", "UNIT", "IRI unit of the --reference and --control files: mm/m or in/mi.", "mm/m"};

/// Files of known roughness that an import is to bring.
struct KnownRoughness {
    std::optional<std::filesystem::path> survey;
    std::optional<std::filesystem::path> control;
    double relative_sd = usual_reference_accuracy; ///< of the survey
    std::optional<std::int64_t> utc_ms;            ///< its day
    std::string name;                              ///< of the survey
    double mm_per_m_of_one = 1;                    ///< what an IRI of 1 in the files is
    bool readmit = false; ///< let the survey in again that 'macadam forget' took out
};

/// Of the options above. \throws UsageError  for a value that does not fit, or goes with a file
/// that is not there.
KnownRoughness parse_known_roughness(const Arguments& arguments);

/// What became of a survey.
struct SurveyOutcome {
    std::string file;
    std::string name;
    std::string sha256;
    bool known = false; ///< it was in the store already
    std::size_t rows = 0;
    double relative_sd = 0;
    std::optional<std::int64_t> utc_ms;
    ReferencePasses found;
    std::vector<std::string> warnings;
};

/// Brings the survey into the store, in one transaction.
///
/// \throws InputError  if it cannot be read, none of its rows lies on the store's roads, or it was
///                     forgotten and is not taken back.
SurveyOutcome
import_survey(RoadStore& store, const RoadNetwork& roads, const KnownRoughness& known);

/// For people, with newlines; and one JSON object with the keys of a trip's.
std::string text_lines(const SurveyOutcome& outcome);
std::string json_line(const SurveyOutcome& outcome);

} // namespace macadam
