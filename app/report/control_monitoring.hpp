#pragma once

#include "app/query/monthly_history.hpp"
#include "mapping/surveys/control_section.hpp"
#include "storage/store/road_store.hpp"

#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Control section with its known IRI and the cars' estimate.
struct WatchedSection {
    ControlSection section;
    RoadMean cars;                  ///< on the day of the newest pass; length_m 0: no pass yet
    double off = 0;                 ///< cars minus known, mm/m
    double off_sd = 0;              ///< standard deviation of both combined
    std::vector<MonthRow> months{}; ///< cars only
    std::optional<Drift> drift{};   ///< `std::nullopt`: too few months
};

/// Returns all control sections of a database, sorted by name. References do not count towards the
/// cars' estimate. Empty if only published values of a crowd database are readable, since
/// monitoring selects passes by day.
std::vector<WatchedSection> watched_sections(const RoadStore& store);

/// Formats a table for people; "" if there are no sections.
std::string text_of(const std::vector<WatchedSection>& sections);

/// Formats an array of objects.
std::string json_of(const std::vector<WatchedSection>& sections);

/// Formats the reference surveys of a database in the same way.
std::string text_of(const std::vector<SurveyUse>& surveys);
std::string json_of(const std::vector<SurveyUse>& surveys);

} // namespace macadam
