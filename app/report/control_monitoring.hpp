#pragma once

#include "app/query/monthly_history.hpp"
#include "mapping/surveys/control_section.hpp"
#include "storage/store/reader/store_reader.hpp"
#include "storage/text/columns.hpp"
#include "storage/text/unit_system.hpp"

#include <optional>
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
std::vector<WatchedSection> watched_sections(const StoreReader& store);

/// Columns of control sections, and of the reference surveys of a database.
Columns<WatchedSection> control_section_columns(UnitSystem units);
Columns<SurveyUse> survey_columns(UnitSystem units);

} // namespace macadam
