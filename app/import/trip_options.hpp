#pragma once

#include "app/import/trip_inputs.hpp"
#include "app/pipeline/column_mapping_option.hpp"
#include "app/pipeline/estimation_options.hpp"
#include "app/pipeline/vehicle_lookup.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace macadam {

/// Options of commands that estimate the trips of a database: which cars, how, and how they report.
inline constexpr std::array trip_options{
    vehicle_option,
    vehicles_option,
    vehicle_id_option,
    mapping_option,
    positions_option,
    jobs_option,
    method_option,
    channels_option,
    no_filters_option,
    rate_option,
    max_members_option,
    Option{"--json", "", "One JSON object per trip on standard output, one per line."}};

/// Returns the options above, followed by those of one command.
template <std::size_t N>
constexpr auto trip_options_and(const std::array<Option, N>& own) {
    std::array<Option, trip_options.size() + N> all{};
    std::ranges::copy(own, std::ranges::copy(trip_options, all.begin()).out);
    return all;
}

} // namespace macadam
