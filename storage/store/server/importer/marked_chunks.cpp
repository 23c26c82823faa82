#include "storage/store/server/importer/marked_chunks.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace macadam {
namespace {

// The first mark of a chunk is about its oldest: rows of trips rise.
constexpr const char* select_marked =
    "WITH RECURSIVE marked AS ((SELECT chunk FROM macadam.chunk_dirty"
    " WHERE chunk > $1::bigint AND chunk <= $2::bigint ORDER BY chunk LIMIT 1) UNION ALL SELECT"
    " (SELECT chunk FROM macadam.chunk_dirty AS other WHERE other.chunk > marked.chunk"
    " AND other.chunk <= $2::bigint ORDER BY chunk LIMIT 1) FROM marked WHERE chunk IS NOT NULL)"
    " SELECT chunk, (SELECT since_ms FROM macadam.chunk_dirty AS mark"
    " WHERE mark.chunk = marked.chunk ORDER BY trip LIMIT 1)"
    " FROM marked WHERE chunk IS NOT NULL LIMIT $3::bigint";

} // namespace

void MarkedChunks::begin_round() {
    begin_ = after_;
    has_wrapped_ = false;
}

std::vector<std::int64_t> MarkedChunks::next() {
    auto chunks = read(has_wrapped_ ? begin_ : std::numeric_limits<std::int64_t>::max());
    if (chunks.empty() && !has_wrapped_) {
        has_wrapped_ = true;
        after_ = 0;
        chunks = read(begin_);
    }
    if (chunks.empty()) {
        after_ = 0;
    }
    return chunks;
}

std::vector<std::int64_t> MarkedChunks::read(std::int64_t to) {
    if (after_ >= to) {
        return {};
    }
    const auto numbers = server_->numbers(
        select_marked, {std::to_string(after_), std::to_string(to), std::to_string(at_a_time_)});
    std::vector<std::pair<std::int64_t, std::int64_t>> marks; // since, chunk
    for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
        marks.emplace_back(numbers[i + 1], numbers[i]);
        last_ = numbers[i];
    }
    std::ranges::sort(marks);
    std::vector<std::int64_t> chunks;
    for (const auto& [since_ms, chunk] : marks) {
        chunks.push_back(chunk);
    }
    return chunks;
}

} // namespace macadam
