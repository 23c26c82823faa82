#pragma once

#include "app/query/monthly_history.hpp"
#include "mapping/surveys/control_section.hpp"
#include "storage/store/road_store.hpp"
#include "storage/text/json.hpp"

#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// A control section, what is known of it and what the cars say.
struct WatchedSection {
    ControlSection section;
    RoadMean cars;                  ///< on the day of the newest pass; length_m 0: no pass yet
    double off = 0;                 ///< cars less known, mm/m
    double off_sd = 0;              ///< of both together
    std::vector<MonthRow> months{}; ///< of cars alone
    std::optional<Drift> drift{};   ///< nothing: too few months to tell
};

/// All control sections of a store, in the order of their names. References are left out of what
/// the cars say. None of a crowd whose published figures are read: months of some days are watched.
std::vector<WatchedSection> watched_sections(const RoadStore& store);

/// A table for people, "" where there is none.
std::string text_of(const std::vector<WatchedSection>& sections);

/// An array of objects.
std::string json_of(const std::vector<WatchedSection>& sections);

/// The reference surveys of a store, likewise.
std::string text_of(const std::vector<SurveyUse>& surveys);
std::string json_of(const std::vector<SurveyUse>& surveys);

} // namespace macadam
