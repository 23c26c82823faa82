#include "storage/strip_segments.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

namespace macadam {
namespace {

constexpr std::size_t most_known = 10'000; // strips: some 3 MB

const char* direction_of(bool forward) {
    return forward ? "forward" : "backward";
}

} // namespace

StripSegments::StripSegments(Database& database, std::int64_t segments_in_strip)
    : database_{&database}, select_{database.prepare(
                                "SELECT seq, fid FROM segment WHERE way_id = ? AND direction = ?"
                                " AND seq >= ? AND seq < ?")},
      segments_in_strip_{segments_in_strip} {}

std::int64_t StripSegments::row_of(const SegmentKey& segment) {
    const auto count = static_cast<std::uint32_t>(segments_in_strip_);
    const auto& rows = rows_of({segment.way_id, segment.forward, segment.index / count});
    if (const auto row = rows[segment.index % count]; row != 0) {
        return row;
    }
    throw InputError{fmt::format("{}: has no segment '{}', expected passes over its own network",
                                 database_->file().string(),
                                 name_of(segment))};
}

std::int64_t StripSegments::row_of(const StripKey& strip) {
    const auto& rows = rows_of(strip);
    const auto first = std::ranges::find_if(rows, [](std::int64_t row) { return row != 0; });
    if (first == rows.end()) {
        throw InputError{fmt::format("{}: has no strip {} of way '{}' {}, expected traces over its "
                                     "own network",
                                     database_->file().string(),
                                     strip.number,
                                     strip.way_id,
                                     direction_of(strip.forward))};
    }
    return *first;
}

const StripSegments::Rows& StripSegments::rows_of(const StripKey& strip) {
    if (const auto found = known_.find(strip); found != known_.end()) {
        return found->second;
    }
    if (known_.size() >= most_known) {
        known_.clear();
    }
    Rows rows(static_cast<std::size_t>(segments_in_strip_));
    const auto first = strip.number * segments_in_strip_;
    for (select_.bind(strip.way_id, direction_of(strip.forward), first, first + segments_in_strip_);
         select_.step();) {
        rows[static_cast<std::size_t>(select_.integer(0) - first)] = select_.integer(1);
    }
    select_.reset();
    return known_.emplace(strip, std::move(rows)).first->second;
}

std::size_t StripSegments::Hash::operator()(const StripKey& key) const {
    const auto number = 2 * std::uint64_t{key.number} + (key.forward ? 1 : 0);
    return std::hash<std::uint64_t>{}(static_cast<std::uint64_t>(key.way_id) * 1'000'003 + number);
}

} // namespace macadam
