#include "fuzz/input_file.hpp"
#include "fuzz/rules.hpp"
#include "fuzz/targets.hpp"

#include "storage/exports/export.hpp"
#include "storage/store/road_store.hpp"
#include "support/roads/store_world.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>

namespace macadam::fuzz {
namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& file) {
    std::ifstream in{file, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
}

/// A survey of the road that the cars drive.
void add_survey(RoadStore& store) {
    auto survey = testing::trip_record(1000);
    survey.trip_id = "survey";
    survey.vehicle_id = "";
    survey.vehicle_model = "";
    survey.method = "reference";
    survey.reference = ReferenceNote{.relative_sd_ppm = 30'000, .row_mm = 20'000};
    testing::add_trip(store, survey, testing::passes_of(1000));
}

/// Three roads, four cars, every segment of one road driven and surveyed, one of them mended, a
/// stretch of known roughness.
void fill(RoadStore& store) {
    constexpr std::int64_t mended_ms = 1'770'000'000'000;
    const ControlSection known{.name = "known",
                               .way_id = 1,
                               .forward = true,
                               .from_m = 20,
                               .to_m = 80,
                               .iri_mm_per_m = 2,
                               .sd_mm_per_m = 0.1,
                               .utc_ms = {}};
    add_survey(store);
    testing::import_trips(store, 4);
    store.maintenance.put_control_sections({&known, 1});
    const SegmentKey mended{1, true, 4};
    store.maintenance.set_valid_from({&mended, 1}, mended_ms, "mended");
}

std::string good_store() {
    const auto file = input_file("good.gpkg", "");
    fs::remove(file);
    {
        auto store = testing::new_store(file);
        fill(store);
    } // until it is closed, all of this stands in the log beside it
    return content_of(file);
}

const std::string& store_to_spoil() {
    static const std::string content = good_store();
    return content;
}

constexpr std::int64_t october_2025_ms = 1'759'276'800'000; // its first moment
constexpr std::int64_t november_2026_ms = 1'793'491'200'000;

/// Everything that commands read of a store.
Answer read_store(const fs::path& file) {
    const auto store = StoreReader::open(file);
    const auto& classes = *class_table(store.settings().class_table);
    auto answer = may_refuse([&] { store.info(); });
    const auto read = [&](const auto& what) { answer = both(answer, may_refuse(what)); };
    read([&] { store.digest(); });
    read([&] { store.roads(); });
    SegmentFilter worst_here;
    worst_here.box = GeoBox{4, 45, 5, 46};
    worst_here.worst = 5;
    read([&] { store.visit(worst_here, [](const SegmentRecord&) {}); });
    SegmentFilter everything;
    everything.with_state_only = false;
    read([&] { store.visit_summaries(everything, [](const SegmentSummary&) {}); });
    read([&] {
        store.visit(everything, [&](const SegmentRecord& record) {
            csv_line(segment_columns(), {record, classes});
        });
    });
    SegmentFilter of_a_month;
    of_a_month.period = Period{october_2025_ms, november_2026_ms};
    const SegmentKey driven{1, true, 3};
    SegmentFilter crossing; // whose lines begin on one side of the box and end on the other
    crossing.box = GeoBox{4.85140, 45.7, 4.85141, 45.8};
    SegmentFilter of_cars;
    of_cars.key = driven;
    of_cars.cars_alone = true;
    SegmentFilter of_a_way;
    of_a_way.way_id = 1;
    of_a_way.class_name = "poor";
    of_a_way.min_passes = 2;
    SegmentFilter named;
    named.name_part = "rue";
    named.highway = "residential";
    SegmentFilter service = everything;
    service.highway = "service";
    SegmentFilter stretch;
    stretch.ranges = {{1, true, 2, 6}, {1, false, 0, 3}};
    for (const auto& filter : {of_a_month, crossing, of_cars, of_a_way, named, service, stretch}) {
        read([&] { store.visit(filter, [](const SegmentRecord&) {}); });
    }
    read([&] {
        store.visit(
            everything, [](const SegmentRecord&) {}, StateDetail::tiles);
    });
    read([&] { store.history(driven); });
    read([&] { store.changes({1, true, 4}); });
    read([&] { store.latest_publication(); });
    read([&] { store.network_hash(); });
    read([&] { store.waiting(); });
    read([&] { store.alignment(); });
    read([&] { store.contains_trip(testing::trip_record(1).sha256); });
    read([&] { store.has_forgotten(testing::trip_record(1).sha256); });
    read([&] { store.usage(); });
    read([&] { store.seen(); });
    read([&] { store.mean_speeds_kmh(); });
    read([&] { store.audit(); });
    read([&] { store.valid_since(); });
    read([&] { store.surveys(); });
    read([&] { store.reference_readings(); });
    read([&] { store.control_sections(); });
    read([&] { store.expect_in_place(); });
    expect(store.file() == file && !store.is_operator(), "a store is read under its own name");
    return answer;
}

Answer read_spoilt(const fs::path& file) {
    auto answer = Answer::refused; // as opening it may be
    may_refuse([&] { answer = read_store(file); });
    return answer;
}

// ------------------------------------------------------------------------------------- patches

std::string patched(std::string bytes, std::string_view patches) {
    constexpr std::size_t head = 5;
    while (patches.size() > head) {
        std::uint32_t place = 0;
        std::memcpy(&place, patches.data(), sizeof(place));
        const auto at = place % bytes.size();
        const std::size_t wished = static_cast<std::uint8_t>(patches[sizeof(place)]);
        const auto count = std::min({wished, bytes.size() - at, patches.size() - head});
        bytes.replace(at, count, patches.substr(head, count));
        patches.remove_prefix(head + count);
    }
    return bytes;
}

// ----------------------------------------------------------------------------------------- SQL

struct Close {
    void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
};

/// Other files are out of reach.
int allow(void*, int action, const char*, const char*, const char*, const char*) {
    return action == SQLITE_ATTACH ? SQLITE_DENY : SQLITE_OK;
}

/// Stops when the whole script has had its time.
int is_over(void* left) {
    return --*static_cast<int*>(left) < 0 ? 1 : 0;
}

void no_limit(sqlite3_context* context, int, sqlite3_value**) {
    sqlite3_result_int(context, 0);
}

/// The store's triggers call them when a line is changed.
void add_geometry_functions(sqlite3* handle) {
    for (const auto* const name : {"ST_IsEmpty", "ST_MinX", "ST_MaxX", "ST_MinY", "ST_MaxY"}) {
        sqlite3_create_function_v2(
            handle, name, 1, SQLITE_UTF8, nullptr, no_limit, nullptr, nullptr, nullptr);
    }
}

/// Each line of it that is SQL, and not for long: the reader's time is what counts here.
void run_sql(const fs::path& file, std::string_view sql) {
    constexpr int steps_between_looks = 10'000;
    int looks_left = 20;
    constexpr int max_bytes = 1 << 20; // of one value
    sqlite3* handle = nullptr;
    const int code = sqlite3_open(file.c_str(), &handle);
    const std::unique_ptr<sqlite3, Close> database{handle};
    if (code != SQLITE_OK) {
        throw std::runtime_error{"cannot open the store to spoil"};
    }
    sqlite3_set_authorizer(handle, allow, nullptr);
    sqlite3_progress_handler(handle, steps_between_looks, is_over, &looks_left);
    sqlite3_limit(handle, SQLITE_LIMIT_LENGTH, max_bytes);
    add_geometry_functions(handle);
    while (!sql.empty() && looks_left >= 0) {
        const auto end = std::min(sql.find('\n'), sql.size());
        const std::string line{sql.substr(0, end)};
        sqlite3_exec(handle, line.c_str(), nullptr, nullptr, nullptr);
        sql.remove_prefix(std::min(end + 1, sql.size()));
    }
}

} // namespace

Answer store_bytes(std::string_view input) {
    return read_spoilt(input_file("a.gpkg", patched(store_to_spoil(), input)));
}

Answer store_content(std::string_view input) {
    const auto file = input_file("a.gpkg", store_to_spoil());
    run_sql(file, input);
    return read_spoilt(file);
}

} // namespace macadam::fuzz
