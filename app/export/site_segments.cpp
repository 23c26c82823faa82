#include "app/export/site_segments.hpp"

#include "app/site/site_json.hpp"
#include "app/site/site_manifest.hpp"
#include "estimator/common/error.hpp"
#include "mapping/style/iri_class.hpp"
#include "mapping/tiles/tile_grid.hpp"
#include "storage/store/rows/segment_row.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <system_error>
#include <tuple>
#include <utility>

namespace macadam {
namespace {

void expect_not_stopped(const Progress& progress) {
    if (progress.stop.stop_requested()) {
        throw InputError{"stopped"};
    }
}

/// Returns runs of neighbouring keys.
std::vector<SegmentRange> ranges_of(std::span<const SegmentRecord> records) {
    std::vector<SegmentRange> ranges;
    for (const auto& record : records) {
        const auto& key = record.segment.key;
        if (!ranges.empty() && ranges.back().way_id == key.way_id &&
            ranges.back().forward == key.forward && ranges.back().past == key.index) {
            ++ranges.back().past;
        } else {
            ranges.push_back({key.way_id, key.forward, key.index, key.index + 1});
        }
    }
    return ranges;
}

using MonthsOfSegments = std::map<SegmentKey, std::vector<SegmentMonth>>;

/// Reads what the passes of each month alone say about some segments.
MonthsOfSegments months_of(const StoreReader& store,
                           const SegmentFilter& filter,
                           std::span<const SegmentRecord> records,
                           const std::vector<std::string>& months) {
    MonthsOfSegments found;
    SegmentFilter selected = filter; // of cars and references, too
    selected.ranges = ranges_of(records);
    selected.min_passes = 0;
    selected.min_vehicles = 0;
    selected.class_name.clear();
    for (const auto& month : months) {
        selected.period = period_of_month(month);
        store.visit(selected, [&](const SegmentRecord& record) {
            if (record.state) {
                found[record.segment.key].push_back({month, *record.state});
            }
        });
    }
    return found;
}

// -------------------------------------------------------------------------------------- months

/// Tile to whose file a segment belongs.
TileId compare_tile(const SegmentRecord& record) {
    const auto place = tile_position(record.segment.line.front(), compare_zoom);
    return {compare_zoom, static_cast<std::uint32_t>(place.x), static_cast<std::uint32_t>(place.y)};
}

std::string compare_file(const TileId& tile) {
    return fmt::format("months/{}/{}/{}.json", tile.zoom, tile.x, tile.y);
}

/// Files with the months of the segments of each tile, for the comparison of two.
class CompareFiles {
public:
    CompareFiles(const SiteFolder& folder, const std::vector<std::string>& months)
        : folder_{&folder}, months_{&months} {}

    void add(std::span<const SegmentRecord> records, const MonthsOfSegments& found) {
        std::map<TileId, std::string> texts;
        for (const auto& record : records) {
            const auto months = found.find(record.segment.key);
            if (months == found.end()) {
                continue;
            }
            const auto tile = compare_tile(record);
            auto& text = texts[tile];
            text += begun_.insert(tile).second ? "{" : ",\n";
            text += fmt::format(
                "{}:{}", json_text(name_of(record.segment.key)), months_json(months->second));
        }
        for (const auto& [tile, text] : texts) {
            folder_->write(compare_file(tile), text, std::ios::app);
        }
    }

    void finish() const {
        for (const auto& tile : begun_) {
            folder_->write(compare_file(tile), "}", std::ios::app);
        }
    }

private:
    std::string months_json(std::span<const SegmentMonth> months) const {
        std::vector<std::string> rows;
        for (const auto& [month, state] : months) {
            rows.push_back(fmt::format("[{},{:.3f},{:.3f}]",
                                       std::ranges::lower_bound(*months_, month) - months_->begin(),
                                       mm_per_m(state.iri_um),
                                       mm_per_m(state.sd_um)));
        }
        return json_array(rows);
    }

    const SiteFolder* folder_;
    const std::vector<std::string>* months_;
    std::set<TileId> begun_;
};

// ------------------------------------------------------------------------------------- changes

SegmentKey first_of(const SegmentRange& range) {
    return {range.way_id, range.forward, range.first};
}
SegmentKey last_of(const SegmentRange& range) {
    return {range.way_id, range.forward, range.past - 1};
}

/// Tells which files of an earlier site serve again, and finds them.
class Changes {
public:
    Changes(const EarlierSite& earlier, const std::vector<std::string>& months)
        : earlier_{&earlier}, changed_{earlier.changed} {
        std::ranges::sort(changed_, {}, first_of);
        for (const auto& month : earlier.segments.months) {
            numbers_.push_back(std::ranges::lower_bound(months, month) - months.begin());
        }
    }

    /// Takes over the months of a tile without changes, which may have other numbers now. Without
    /// dated passes there is no file.
    void take_compare_file(const std::string& name, const SiteFolder& folder) const {
        const auto file = earlier_->folder / name;
        if (numbers_.empty() || numbers_.back() + 1 == std::ssize(numbers_)) {
            folder.take(file, name);
        } else if (std::ifstream in{file, std::ios::binary}; in) {
            folder.write(name, renumbered({std::istreambuf_iterator<char>{in}, {}}));
        }
    }

    const std::vector<SegmentRange>& ranges() const { return changed_; }

    bool touch(const SegmentKey& first, const SegmentKey& last) const {
        const auto next = std::ranges::lower_bound(changed_, first, {}, last_of);
        return next != changed_.end() && first_of(*next) <= last;
    }

    /// Returns the earlier file of an unchanged shard.
    std::optional<std::filesystem::path> file_of(const SiteShard& shard) const {
        const auto& shards = earlier_->segments.shards;
        const auto found = std::ranges::lower_bound(shards, shard.first, {}, &SiteShard::first);
        const bool is_same = found != shards.end() && found->first == shard.first &&
                             found->last == shard.last && found->count == shard.count &&
                             !touch(shard.first, shard.last);
        return is_same ? std::optional{earlier_->folder /
                                       fmt::format("segments/{}.json", found - shards.begin())}
                       : std::nullopt;
    }

private:
    /// Replaces the number of the month at the beginning of each row.
    std::string renumbered(const std::string& text) const {
        std::string result;
        for (std::size_t i = 0; i < text.size(); ++i) {
            result += text[i];
            if (text[i] != '[') {
                continue;
            }
            std::size_t number = 0;
            const auto* const begin = text.data() + i + 1;
            const auto [end, error] = std::from_chars(begin, text.data() + text.size(), number);
            if (error == std::errc{} && number < numbers_.size()) {
                result += std::to_string(numbers_[number]);
                i += static_cast<std::size_t>(end - begin);
            }
        }
        return result;
    }

    const EarlierSite* earlier_;
    std::vector<SegmentRange> changed_;
    std::vector<std::ptrdiff_t> numbers_; ///< of the earlier months in the new list
};

/// Writes the files of tiles with changed segments, and takes over the others.
void update_compare_files(const StoreReader& store,
                          const SegmentFilter& filter,
                          std::span<const SegmentRecord> records,
                          const std::vector<std::string>& months,
                          const SiteFolder& folder,
                          const Changes& changes) {
    std::map<TileId, bool> tiles; // those that change
    for (const auto& record : records) {
        const auto& key = record.segment.key;
        auto& changed = tiles[compare_tile(record)];
        changed = changed || changes.touch(key, key);
    }
    SegmentFilter without_values; // segments that may have lost theirs
    without_values.with_state_only = false;
    without_values.ranges = changes.ranges();
    store.visit(without_values, [&](const SegmentRecord& record) {
        if (const auto tile = tiles.find(compare_tile(record)); tile != tiles.end()) {
            tile->second = true;
        }
    });
    std::map<TileId, std::vector<SegmentRecord>> to_write;
    for (const auto& record : records) {
        if (const auto tile = compare_tile(record); tiles.at(tile)) {
            to_write[tile].push_back(record);
        }
    }
    CompareFiles compare{folder, months};
    for (const auto& [tile, of_tile] : to_write) {
        compare.add(of_tile, months_of(store, filter, of_tile, months));
    }
    compare.finish();
    for (const auto& [tile, changed] : tiles) {
        if (!changed) {
            changes.take_compare_file(compare_file(tile), folder);
        }
    }
}

/// Tests whether a shard may end before a key, for one of 128 at random.
///
/// Source: G. Steele, D. Lea, C. Flood, "Fast splittable pseudorandom number generators", OOPSLA
/// 2014: the mixing function.
bool is_border(const SegmentKey& key) {
    auto mixed = static_cast<std::uint64_t>(key.way_id) * 0x9e3779b97f4a7c15U +
                 2 * std::uint64_t{key.index} + (key.forward ? 1 : 0);
    mixed = (mixed ^ (mixed >> 30U)) * 0xbf58476d1ce4e5b9U;
    mixed = (mixed ^ (mixed >> 27U)) * 0x94d049bb133111ebU;
    constexpr unsigned top_bits = 57;
    return mixed >> top_bits == 0;
}

} // namespace

std::vector<SiteShard> shards_of(std::span<const SegmentRecord> records) {
    constexpr std::size_t least = 128, most = 512;
    std::vector<SiteShard> shards;
    for (const auto& record : records) {
        const auto& key = record.segment.key;
        const bool ends = shards.empty() || shards.back().count == most ||
                          (shards.back().count >= least && is_border(key));
        if (ends) {
            shards.push_back({key, key, 0});
        }
        shards.back().last = key;
        ++shards.back().count;
    }
    return shards;
}

SiteSegments write_segments(const StoreReader& store,
                            const SegmentFilter& filter,
                            std::span<const SegmentRecord> records,
                            const std::vector<std::string>& months,
                            const SiteFolder& folder,
                            const EarlierSite* earlier,
                            const Progress& progress) {
    const auto& classes = *class_table(store.settings().class_table);
    std::optional<Changes> changes;
    if (earlier != nullptr && std::ranges::includes(months, earlier->segments.months)) {
        changes.emplace(*earlier, months);
    }
    SiteSegments made{shards_of(records), months};
    std::vector<std::string> first_keys;
    CompareFiles compare{folder, months};
    std::size_t begin = 0;
    for (const auto& shard : made.shards) {
        progress(begin, records.size());
        expect_not_stopped(progress);
        const auto segments = records.subspan(begin, shard.count);
        begin += shard.count;
        const auto name = fmt::format("segments/{}.json", first_keys.size());
        first_keys.push_back(name_of(shard.first));
        if (const auto file = changes ? changes->file_of(shard) : std::nullopt;
            file && folder.take(*file, name)) {
            continue;
        }
        const auto found = months_of(store, filter, segments, months);
        JsonObject object;
        for (const auto& record : segments) {
            const auto each = found.find(record.segment.key);
            object.add(name_of(record.segment.key),
                       JsonRaw{segment_json(record,
                                            classes,
                                            each == found.end() ? std::span<const SegmentMonth>{}
                                                                : each->second)});
        }
        folder.write(name, object.text());
        if (!changes) {
            compare.add(segments, found);
        }
    }
    if (changes) {
        update_compare_files(store, filter, records, months, folder, *changes);
    } else {
        compare.finish();
    }
    folder.write("segments/index.json", json_string_array(first_keys));
    return made;
}

} // namespace macadam
