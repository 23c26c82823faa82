#include "app/query/mean_cells.hpp"

#include "storage/text/utc.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

const char* direction_of(const StretchPart& part) {
    return part.forward ? "forward" : "backward";
}

const Columns<StretchPart> part_columns{
    {"way_id", as::integer, [](auto& part) { return part.way_id; }},
    {"direction", as::text, direction_of},
    {"from_m", as::metres(2), [](auto& part) { return part.from_m; }},
    {"to_m", as::metres(2), [](auto& part) { return part.to_m; }}};

template <typename Text>
std::string list_of(const std::vector<StretchPart>& parts, Text text) {
    std::vector<std::string> values;
    for (const auto& part : parts) {
        values.push_back(fmt::format("{}", text(part)));
    }
    return fmt::format("{}", fmt::join(values, ";"));
}

} // namespace

std::string interval_text(const RoadMean& mean) {
    return fmt::format("{:>5.2f} - {:>5.2f}", mean.low, mean.high);
}

std::string passes_cell(std::int32_t min_passes, double median_passes) {
    return min_passes == median_passes ? fmt::format("{}", min_passes)
                                       : fmt::format("{}-{:g}", min_passes, median_passes);
}

Cell day_cell(const std::optional<std::int64_t>& utc_ms) {
    return utc_ms ? Cell{utc_day(*utc_ms)} : Cell{};
}

std::string way_ids_list(const std::vector<StretchPart>& parts) {
    return list_of(parts, [](const auto& part) { return part.way_id; });
}

std::string directions_list(const std::vector<StretchPart>& parts) {
    return list_of(parts, direction_of);
}

std::string metres_list(const std::vector<StretchPart>& parts, double StretchPart::*border) {
    return list_of(parts, [&](const auto& part) { return fmt::format("{:.2f}", part.*border); });
}

std::string parts_json(const std::vector<StretchPart>& parts) {
    return json_rows(part_columns, parts);
}

} // namespace macadam
