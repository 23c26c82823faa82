#include "fuzz/input_file.hpp"
#include "fuzz/rules.hpp"
#include "fuzz/targets.hpp"

#include "storage/export.hpp"
#include "storage/road_store.hpp"
#include "storage/store_world.hpp"

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

/// Three roads, three cars, every segment of one road driven.
std::string good_store() {
    const auto file = input_file("good.gpkg", "");
    fs::remove(file);
    auto store = testing::new_store(file);
    testing::import_trips(store, 3);
    return content_of(file);
}

const std::string& store_to_spoil() {
    static const std::string content = good_store();
    return content;
}

/// Everything that commands read of a store.
Answer read_store(const fs::path& file) {
    const auto store = RoadStore::open(file, RoadStore::Access::read);
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
    read([&] { store.glance(everything, [](const SegmentGlance&) {}); });
    read([&] {
        store.visit(everything, [&](const SegmentRecord& record) { csv_row(record, classes); });
    });
    SegmentFilter of_a_month;
    of_a_month.period = Period{};
    read([&] { store.visit(of_a_month, [](const SegmentRecord&) {}); });
    const SegmentKey driven{1, true, 3};
    read([&] { store.history(driven); });
    read([&] { store.changes(driven); });
    read([&] { store.vehicle_uses(); });
    read([&] { store.day_uses(); });
    read([&] { store.seen(); });
    read([&] { store.road_class_lengths(); });
    read([&] { store.row_reasons(); });
    read([&] { store.audit(); });
    read([&] { store.valid_since(); });
    read([&] { store.calibrated_cars(); });
    read([&] { store.surveys(); });
    read([&] { store.reference_readings(); });
    read([&] { store.control_sections(); });
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

int too_long(void*) {
    return 1;
}

/// As far as it is SQL, and not for long: the reader's time is what counts here.
void run_sql(const fs::path& file, const std::string& sql) {
    constexpr int most_steps = 200'000;
    constexpr int most_bytes = 1 << 20; // of one value
    sqlite3* handle = nullptr;
    const int code = sqlite3_open(file.c_str(), &handle);
    const std::unique_ptr<sqlite3, Close> database{handle};
    if (code != SQLITE_OK) {
        throw std::runtime_error{"cannot open the store to spoil"};
    }
    sqlite3_set_authorizer(handle, allow, nullptr);
    sqlite3_progress_handler(handle, most_steps, too_long, nullptr);
    sqlite3_limit(handle, SQLITE_LIMIT_LENGTH, most_bytes);
    sqlite3_exec(handle, sql.c_str(), nullptr, nullptr, nullptr);
}

} // namespace

Answer store_bytes(std::string_view input) {
    return read_spoilt(input_file("a.gpkg", patched(store_to_spoil(), input)));
}

Answer store_content(std::string_view input) {
    const auto file = input_file("a.gpkg", store_to_spoil());
    run_sql(file, std::string{input});
    return read_spoilt(file);
}

} // namespace macadam::fuzz
