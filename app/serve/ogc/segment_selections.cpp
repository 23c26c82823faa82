#include "app/serve/ogc/segment_selections.hpp"

#include "app/serve/live/file_number.hpp"
#include "estimator/common/error.hpp"
#include "storage/exports/export.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

namespace macadam {
namespace {

/// \param ranges  among which to look
std::vector<SegmentKey> found_keys(const StoreReader& store,
                                   const ItemsQuery& query,
                                   const std::optional<std::vector<SegmentRange>>& ranges,
                                   TimeLimit& limit) {
    std::vector<SegmentKey> keys;
    auto filter = filter_of(query);
    filter.ranges = ranges;
    if (query.tests.empty()) {
        store.visit_summaries(filter, [&](const SegmentSummary& segment) {
            limit.check();
            keys.push_back(segment.key);
        });
        return keys;
    }
    const auto& classes = *class_table(store.settings().class_table);
    store.visit(filter, [&](const SegmentRecord& record) {
        limit.check();
        const ClassedSegment row{record, classes};
        const Feature feature{.id = {}, .line = record.segment.line, .row = &row};
        if (std::ranges::all_of(query.tests, [&](const auto& test) { return test(feature); })) {
            keys.push_back(record.segment.key);
        }
    });
    return keys;
}

/// Puts keys that were found in some ranges into the place of those that lie there.
std::vector<SegmentKey> with_ranges_replaced(std::span<const SegmentKey> keys,
                                             std::span<const SegmentRange> ranges,
                                             std::span<const SegmentKey> found) {
    std::vector<SegmentKey> all;
    all.reserve(keys.size() + found.size());
    auto left = keys.begin();
    auto next = found.begin();
    for (const auto& [way_id, forward, first, past] : ranges) {
        const SegmentKey past_it{way_id, forward, past};
        const auto begin =
            std::ranges::lower_bound(left, keys.end(), SegmentKey{way_id, forward, first});
        all.insert(all.end(), left, begin);
        left = std::ranges::lower_bound(begin, keys.end(), past_it);
        const auto end = std::ranges::lower_bound(next, found.end(), past_it);
        all.insert(all.end(), next, end);
        next = end;
    }
    all.insert(all.end(), left, keys.end());
    return all;
}

/// Text of the query of a selection.
constexpr auto selection_text = [](const auto& selection) -> const std::string& {
    return selection.query.selection;
};

bool is_in_place(const StoreReader& store) {
    try {
        store.expect_in_place();
        return true;
    } catch (const InputError&) {
        return false;
    }
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
    const auto known = latest(query.selection);
    if (known.keys && known.version == version) {
        return known.keys;
    }
    TimeLimit limit;
    auto selection = select(store, version, query, known, limit);
    auto keys = selection.keys;
    keep(std::move(selection));
    return keys;
}

void SegmentSelections::prepare(const StoreReader& store, const std::string& version) {
    TimeLimit limit{std::chrono::milliseconds{300}}; // of all: the version waits
    try {
        for (const auto& earlier : asked()) {
            if (changed_since(store, earlier)) {
                auto selection = select(store, version, earlier.query, earlier, limit);
                selection.is_asked = false;
                keep(std::move(selection));
            }
        }
    } catch (const SelectionTooLong&) { // whoever asks for the others waits for them
        return;
    }
}

/// What has changed since an earlier selection; `std::nullopt` if that may be all.
std::optional<std::vector<SegmentRange>>
SegmentSelections::changed_since(const StoreReader& store, const Selection& earlier) {
    return earlier.keys && earlier.file != 0 && earlier.file == file_number(store.file())
               ? store.changed_since(earlier.moment)
               : std::nullopt;
}

/// Selects from what has changed since an earlier selection of the same text, or from all.
SegmentSelections::Selection SegmentSelections::select(const StoreReader& store,
                                                       const std::string& version,
                                                       const ItemsQuery& query,
                                                       const Selection& earlier,
                                                       TimeLimit& limit) {
    const auto one_moment = store.hold();
    Selection now{.query = query,
                  .version = version,
                  .moment = store.moment(),
                  .file = file_number(store.file())};
    auto changed = changed_since(store, earlier);
    if (changed) {
        std::ranges::sort(*changed, {}, [](const SegmentRange& range) {
            return SegmentKey{range.way_id, range.forward, range.first};
        });
    }
    auto keys = found_keys(store, query, changed, limit);
    now.keys = std::make_shared<const std::vector<SegmentKey>>(
        changed ? with_ranges_replaced(*earlier.keys, *changed, keys) : std::move(keys));
    if (!is_in_place(store)) {
        now.file = 0;
    }
    return now;
}

/// The selection of a text, whatever its version; an empty one if there is none.
SegmentSelections::Selection SegmentSelections::latest(const std::string& text) {
    const std::lock_guard lock{mutex_};
    const auto found = std::ranges::find(recent_, text, selection_text);
    if (found == recent_.end()) {
        return {};
    }
    found->is_asked = true;
    recent_.splice(recent_.begin(), recent_, found);
    return *found;
}

/// Selections that somebody has asked for in their version, latest first.
std::vector<SegmentSelections::Selection> SegmentSelections::asked() {
    const std::lock_guard lock{mutex_};
    std::vector<Selection> selections;
    std::ranges::copy_if(recent_, std::back_inserter(selections), &Selection::is_asked);
    return selections;
}

void SegmentSelections::keep(Selection selection) {
    const std::lock_guard lock{mutex_};
    const auto before = std::ranges::find(recent_, selection_text(selection), selection_text);
    if (before != recent_.end()) {
        count_ -= before->keys->size();
        recent_.erase(before);
    }
    count_ += selection.keys->size();
    recent_.push_front(std::move(selection));
    constexpr std::size_t max_selections = 256;
    while ((count_ > max_keys || recent_.size() > max_selections) && recent_.size() > 1) {
        count_ -= recent_.back().keys->size();
        recent_.pop_back();
    }
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
