#include "storage/store/rows/segment_rowids.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

namespace macadam {
namespace {

constexpr std::size_t most_known = 10'000; // chunks: about 3 MB

const char* direction_of(bool forward) {
    return forward ? "forward" : "backward";
}

} // namespace

SegmentRowids::SegmentRowids(Database& database, std::int64_t segments_per_chunk)
    : database_{&database}, select_{database.prepare(
                                "SELECT seq, fid FROM segment WHERE way_id = ? AND direction = ?"
                                " AND seq >= ? AND seq < ?")},
      segments_in_chunk_{segments_per_chunk} {}

std::int64_t SegmentRowids::row_of(const SegmentKey& segment) {
    const auto count = static_cast<std::uint32_t>(segments_in_chunk_);
    const auto& rows = rows_of({segment.way_id, segment.forward, segment.index / count});
    if (const auto row = rows[segment.index % count]; row != 0) {
        return row;
    }
    throw InputError{fmt::format("{}: has no segment '{}', expected passes over its own network",
                                 database_->file().string(),
                                 name_of(segment))};
}

std::int64_t SegmentRowids::row_of(const ChunkKey& chunk) {
    const auto& rows = rows_of(chunk);
    const auto first = std::ranges::find_if(rows, [](std::int64_t row) { return row != 0; });
    if (first == rows.end()) {
        throw InputError{fmt::format("{}: has no strip {} of way '{}' {}, expected traces over its "
                                     "own network",
                                     database_->file().string(),
                                     chunk.number,
                                     chunk.way_id,
                                     direction_of(chunk.forward))};
    }
    return *first;
}

const SegmentRowids::Rows& SegmentRowids::rows_of(const ChunkKey& chunk) {
    if (const auto found = known_.find(chunk); found != known_.end()) {
        return found->second;
    }
    if (known_.size() >= most_known) {
        known_.clear();
    }
    Rows rows(static_cast<std::size_t>(segments_in_chunk_));
    const auto first = chunk.number * segments_in_chunk_;
    for (select_.bind(chunk.way_id, direction_of(chunk.forward), first, first + segments_in_chunk_);
         select_.step();) {
        rows[static_cast<std::size_t>(select_.integer(0) - first)] = select_.integer(1);
    }
    select_.reset();
    return known_.emplace(chunk, std::move(rows)).first->second;
}

std::size_t SegmentRowids::Hash::operator()(const ChunkKey& key) const {
    const auto number = 2 * std::uint64_t{key.number} + (key.forward ? 1 : 0);
    return std::hash<std::uint64_t>{}(static_cast<std::uint64_t>(key.way_id) * 1'000'003 + number);
}

} // namespace macadam
