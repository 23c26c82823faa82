// Files of a site's segments, made again after trips: the same as if all were made anew.

#include "app/export/site_segments.hpp"

#include "storage/store/road_store.hpp"
#include "support/files/files.hpp"
#include "support/roads/store_world.hpp"
#include "support/roads/town.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;

std::map<std::string, std::string> files_of(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator{folder}) {
        if (entry.is_regular_file()) {
            std::ifstream in{entry.path(), std::ios::binary};
            files[fs::relative(entry.path(), folder)] = {std::istreambuf_iterator<char>{in}, {}};
        }
    }
    return files;
}

/// Files with two names: those that two sites share.
std::size_t shared_files(const fs::path& folder) {
    const auto files = fs::recursive_directory_iterator{folder};
    return static_cast<std::size_t>(std::ranges::count_if(files, [](const auto& entry) {
        return entry.is_regular_file() && entry.hard_link_count() > 1;
    }));
}

std::vector<SegmentRecord> measured(const StoreReader& store) {
    std::vector<SegmentRecord> records;
    store.visit({}, [&](const SegmentRecord& record) { records.push_back(record); });
    return records;
}

/// Passes of a trip over some neighbouring segments, or all.
std::vector<Pass> drive(const std::vector<SegmentKey>& keys, int number) {
    auto pass = passes_of(number).front();
    const auto from = number == 0 ? 0 : static_cast<std::size_t>(number) * 997 % (keys.size() - 60);
    const auto past = number == 0 ? keys.size() : from + 60;
    std::vector<Pass> passes;
    for (auto i = from; i < past; ++i) {
        if (number == 0 && i % 9 == 8) { // not yet driven
            continue;
        }
        pass.segment = keys[i];
        pass.iri_um = static_cast<IriUm>(900 + 37 * i % 2000);
        passes.push_back(pass);
    }
    return passes;
}

TEST(SiteSegments, AreTheSameFilesWithAnEarlierSiteAndWithout) {
    const auto folder = test_folder();
    const auto roads = made_up_town(14);
    const auto keys = keys_of(roads);
    ASSERT_GT(keys.size(), 2000U);
    auto store = RoadStore::create(folder / "a.gpkg", roads, {});
    const auto write = [&](const std::string& name,
                           const std::vector<std::string>& months,
                           const EarlierSite* earlier) {
        const auto place = folder / name;
        const auto records = measured(store);
        return write_segments(store, {}, records, months, {place, place}, earlier, {});
    };
    const auto import_drive = [&](int number, int day) {
        auto trip = trip_record(number);
        trip.t0_utc_ms = 1'767'225'600'000 + 86'400'000LL * day; // from 1 January 2026
        ASSERT_TRUE(add_trip(store, trip, drive(keys, number)));
        store.importer.refresh();
    };
    import_drive(0, 0);
    std::vector<std::string> months{"2026-01"};
    EarlierSite earlier{folder / "0", write("0", months, nullptr), {}};
    ASSERT_GT(earlier.segments.shards.size(), 5U);
    for (int number = 1; number <= 5; ++number) {
        const auto moment = store.moment();
        if (number == 5) { // some segments had no other drive
            ForgetRequest request;
            request.trips = {trip_record(2).trip_id};
            ASSERT_EQ(store.maintenance.forget(request).trips, 1U);
        } else {
            import_drive(number, number == 4 ? -10 : number * 12);
        }
        if (number == 3) {
            months.emplace_back("2026-02");
        } else if (number == 4) { // of a log that comes late: all others have other numbers
            months.insert(months.begin(), "2025-12");
        }
        earlier.changed = store.changed_since(moment).value();
        ASSERT_FALSE(earlier.changed.empty());
        const auto name = std::to_string(number), anew = name + " anew";
        auto made = write(name, months, &earlier);
        write(anew, months, nullptr);
        const auto files = files_of(folder / name);
        EXPECT_TRUE(files == files_of(folder / anew)) << number;
        EXPECT_GT(shared_files(folder / name), files.size() / 3) << number;
        EXPECT_EQ(shared_files(folder / anew), 0U);
        earlier = {folder / name, std::move(made), {}};
    }
}

TEST(SiteSegments, AreCutAtPlacesThatAnotherSegmentHardlyMoves) {
    std::vector<SegmentRecord> records;
    for (std::int64_t way = 1; way <= 400; ++way) {
        for (std::uint32_t i = 0; i < 50; ++i) {
            auto& record = records.emplace_back();
            record.segment.key = {1000 + 7 * way, true, i};
        }
    }
    const auto starts_of = [](const std::vector<SiteShard>& shards) {
        std::vector<SegmentKey> starts;
        for (const auto& shard : shards) {
            starts.push_back(shard.first);
        }
        return starts;
    };
    const auto before = shards_of(records);
    std::size_t count = 0;
    for (const auto& shard : before) {
        EXPECT_LE(shard.count, 512U);
        count += shard.count;
    }
    EXPECT_EQ(count, records.size());
    EXPECT_GT(before.size(), records.size() / 400);
    records.erase(records.begin() + 7777);
    const auto starts = starts_of(before), starts_after = starts_of(shards_of(records));
    std::vector<SegmentKey> moved;
    std::ranges::set_symmetric_difference(starts, starts_after, std::back_inserter(moved));
    EXPECT_LE(moved.size(), 12U);
}

} // namespace
} // namespace macadam::testing
