#include "app/serve/ogc/segment_selections.hpp"

#include "storage/exports/export.hpp"

#include <algorithm>

namespace macadam {
namespace {

std::vector<SegmentKey> found_keys(const StoreReader& store, const ItemsQuery& query) {
    std::vector<SegmentKey> keys;
    TimeLimit limit;
    if (query.tests.empty()) {
        store.visit_summaries(filter_of(query), [&](const SegmentSummary& segment) {
            limit.check();
            keys.push_back(segment.key);
        });
        return keys;
    }
    const auto& classes = *class_table(store.settings().class_table);
    store.visit(filter_of(query), [&](const SegmentRecord& record) {
        limit.check();
        const ClassedSegment row{record, classes};
        const Feature feature{.id = {}, .line = record.segment.line, .row = &row};
        if (std::ranges::all_of(query.tests, [&](const auto& test) { return test(feature); })) {
            keys.push_back(record.segment.key);
        }
    });
    return keys;
}

} // namespace

void TimeLimit::check() {
    constexpr std::size_t look_every = 16; // a filter takes at most 10 ms for a feature
    if (calls_++ % look_every == 0 && std::chrono::steady_clock::now() > end_) {
        throw SelectionTooLong{};
    }
}

SelectedKeys SegmentSelections::keys(const StoreReader& store,
                                     const std::string& version,
                                     const ItemsQuery& query) {
    const auto name = version + query.selection;
    {
        const std::lock_guard lock{mutex_};
        const auto found = std::ranges::find(recent_, name, &Selection::name);
        if (found != recent_.end()) {
            recent_.splice(recent_.begin(), recent_, found);
            return found->keys;
        }
    }
    auto keys = std::make_shared<const std::vector<SegmentKey>>(found_keys(store, query));
    const std::lock_guard lock{mutex_};
    recent_.push_front({name, keys});
    count_ += keys->size();
    constexpr std::size_t max_selections = 256;
    while ((count_ > max_keys || recent_.size() > max_selections) && recent_.size() > 1) {
        count_ -= recent_.back().keys->size();
        recent_.pop_back();
    }
    return keys;
}

SegmentFilter filter_of(const ItemsQuery& query) {
    SegmentFilter filter;
    filter.box = query.box;
    filter.period = query.period;
    return filter;
}

std::vector<SegmentRange> ranges_of(std::span<const SegmentKey> keys) {
    std::vector<SegmentRange> ranges;
    for (const auto& [way_id, forward, index] : keys) {
        const bool follows = !ranges.empty() && ranges.back().way_id == way_id &&
                             ranges.back().forward == forward && ranges.back().past == index;
        if (follows) {
            ++ranges.back().past;
        } else {
            ranges.push_back({way_id, forward, index, index + 1});
        }
    }
    return ranges;
}

} // namespace macadam
