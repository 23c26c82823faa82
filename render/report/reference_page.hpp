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

/// A reference survey, and how near the cars come to it over pieces of 100 m.
struct ComparedSurvey {
    std::string name;
    std::string day; ///< "2026-03-01", "" = not known
    double relative_sd;
    double row_m;
    std::size_t segments;
    double km;
    double alone_km; ///< where no car has been
    SurveyScore score;
};

/// How near the cars come to the references, at one length of the pieces.
struct ComparedPieces {
    std::vector<ReferencePair> pairs;
    ReferenceScores headline;
    ReferenceScores left; ///< without pieces where no track is known to both
    ReferenceScores right;
};

/// A control section, what is known of it and what the cars say.
struct ComparedControl {
    std::string name;
    double known;
    RoadMean cars; ///< length_m 0: no pass yet
    double off;
    double off_sd;
    std::size_t months;
    std::optional<Drift> drift;
};

/// First and last day of something, "2026-03-01"; "" where it is not dated.
struct ComparedDays {
    std::string first;
    std::string last;
};

/// From the references to the newest passes, in days: less than 0 where the cars came first.
struct DaysAfter {
    double least;
    double middle; ///< of all segments
    double most;
};

/// What the cars alone say beside what references say, as plain values.
struct ReferenceReport {
    Localisation wording{};
    std::string title;
    double segment_length_m = 20;
    std::vector<ComparedSurvey> surveys;
    ComparedDays passed;
    ComparedDays surveyed;
    std::optional<DaysAfter> days_after; ///< nothing: not known
    ComparedPieces segments;             ///< of surveys whose rows are not much longer
    ComparedPieces hundreds;
    std::vector<ComparedControl> controls;
    bool is_own = true; ///< as Report::is_own
};

/// What the report says, in its language and unit, for any kind of page.
Document reference_document(const ReferenceReport& report);

/// One HTML page that needs nothing else, like report_html. The same values give the same bytes.
std::string reference_html(const ReferenceReport& report);

/// How far the cars' values are from the references in time, a sentence; "" = not known.
std::string days_after_text(const ReferenceReport& report, const Localisation& say);

} // namespace macadam
