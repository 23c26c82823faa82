#pragma once

#include "mapping/analysis/length_weighted_mean.hpp"
#include "mapping/surveys/control_section.hpp"
#include "mapping/surveys/reference_comparison.hpp"
#include "render/report/document/document.hpp"
#include "render/report/words/localised_text.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Reference survey, with the agreement of the cars over intervals of 100 m.
struct ComparedSurvey {
    std::string name;
    std::string day; ///< "2026-03-01", "" = not known
    double relative_sd;
    double row_m;
    std::size_t segments;
    double km;
    double alone_km; ///< without any passes
    SurveyScore score;
};

/// Comparison of the cars with the references, at one interval length.
struct ComparedPieces {
    std::vector<ReferencePair> pairs;
    ReferenceScores headline;
    ReferenceScores left; ///< without intervals in which either side lacks tracks
    ReferenceScores right;
};

/// Control section, with its known roughness and the cars' estimate.
struct ComparedControl {
    std::string name;
    double known;
    RoadMean cars; ///< length_m 0: no pass yet
    double off;
    double off_sd;
    std::size_t months;
    std::optional<Drift> drift;
};

/// First and last day of a period, "2026-03-01"; "" if not dated.
struct ComparedDays {
    std::string first;
    std::string last;
};

/// Days from the references to the newest passes: negative if the cars came first.
struct DaysAfter {
    double least;
    double middle; ///< median over all segments
    double most;
};

/// Comparison of the cars' own estimates with references, as plain values.
struct ReferenceReport {
    Localisation wording{};
    std::string title;
    double segment_length_m = 20;
    std::vector<ComparedSurvey> surveys;
    ComparedDays passed;
    ComparedDays surveyed;
    std::optional<DaysAfter> days_after; ///< `std::nullopt`: not known
    ComparedPieces segments;             ///< of surveys whose rows are not much longer
    ComparedPieces hundreds;
    std::vector<ComparedControl> controls;
    bool is_own = true; ///< as Report::is_own
};

/// Builds the document in the report's language and unit, for any kind of page.
Document reference_document(const ReferenceReport& report);

/// Returns one self-contained HTML page, like report_html. The same values give the same bytes.
std::string reference_html(const ReferenceReport& report);

/// Returns a sentence on the time between the cars' values and the references; "" = not known.
std::string days_after_text(const ReferenceReport& report, const Localisation& say);

} // namespace macadam
