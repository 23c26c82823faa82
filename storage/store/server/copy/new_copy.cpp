#include "storage/store/server/copy/new_copy.hpp"

#include "storage/geopackage/geopackage_geometry.hpp"
#include "storage/postgres/server_array.hpp"
#include "storage/store/schema/network_rows.hpp"
#include "storage/store/schema/new_store.hpp"
#include "storage/store/schema/store_marker.hpp"
#include "storage/store/schema/store_schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {
namespace {

constexpr std::array shown_publications{std::string_view{"publication"},
                                        std::string_view{"published_state"},
                                        std::string_view{"published_figure"},
                                        std::string_view{"published_event"}};
constexpr std::array background_tables{"background", "place", "road_ref"};
constexpr std::array tables_of_publications{"published_state",
                                            "published_until",
                                            "published_pending",
                                            "published_figure",
                                            "published_event"};
/// Tables that fusion of chosen passes reads besides the passes.
constexpr std::array tables_of_fusion{"fusion_setting", "valid_from", "control_section"};

void fill_new(RowsFromServer& rows, Database& file, const std::function<void()>& fill) {
    add_geometry_functions(file);
    fill_new_store(file, std::string{rows.classes().name}, rows.privacy(), [&] {
        auto insert = file.prepare("INSERT INTO meta VALUES (?, ?)");
        insert.run("format", store_format);
        insert.run("version", fmt::format("{}", store_version));
        rows.copy_meta();
        static_cast<void>(read_settings(file)); // checks them
        fill();
        return rows.box();
    });
}

bool belongs_to(ServerContent content, const ServerTable& table) {
    const std::string_view name{table.name};
    switch (content) {
    case ServerContent::network:
        return name == "way" || name == "segment";
    case ServerContent::roads:
        return table.use == ServerUse::road || name == "chunk_dirty";
    case ServerContent::published:
        return (table.use == ServerUse::road && !name.ends_with("_state")) ||
               std::ranges::find(shown_publications, name) != shown_publications.end();
    case ServerContent::all:
        break;
    }
    return true;
}

std::vector<std::int64_t> numbers_in(Database& file, const char* sql) {
    std::vector<std::int64_t> numbers;
    auto select = file.prepare(sql);
    while (select.step()) {
        numbers.push_back(select.integer(0));
    }
    return numbers;
}

/// Calls for parts of a list that statements can name one by one.
template <typename Item, typename Call>
void in_batches(std::span<const Item> items, Call call) {
    constexpr std::size_t most = 2000;
    for (std::size_t done = 0; done < items.size(); done += most) {
        call(items.subspan(done, std::min(most, items.size() - done)));
    }
}

void copy_trips_of_passes(RowsFromServer& rows,
                          Database& file,
                          std::span<const std::int64_t> others) {
    const auto trips =
        numbers_in(file, "SELECT trip FROM pass UNION SELECT trip FROM trace ORDER BY 1");
    for (const auto& some : {std::span{trips}, others}) {
        in_batches(some, [&](auto batch) { rows.copy_trips(batch); });
    }
    const auto cars = numbers_in(file, "SELECT id FROM vehicle");
    in_batches(std::span{cars}, [&](auto batch) {
        for (const auto* const table : {"calibration", "calibration_period"}) {
            rows.copy_rows(server_table(table),
                           fmt::format("vehicle = ANY('{}'::bigint[])", array_of(batch)));
        }
    });
    for (const auto* const table : tables_of_fusion) {
        rows.copy_rows(server_table(table));
    }
}

} // namespace

void fill_copy(RowsFromServer& rows, Database& file, ServerContent content) {
    fill_new(rows, file, [&] {
        for (const auto& table : server_tables()) {
            const std::string_view name{table.name};
            if (!belongs_to(content, table)) {
                continue;
            }
            if (name == "segment") {
                rows.copy_segments({});
            } else if (name == "drive") {
                rows.copy_drives({});
            } else if (name == "segment_state") {
                rows.copy_states({});
            } else if (name == "chunk_dirty") {
                rows.copy_marks();
            } else if (name == "publication" && content == ServerContent::published) {
                rows.copy_publications();
            } else if (table.file_table != nullptr) {
                rows.copy_rows(table);
            }
        }
        if (content == ServerContent::all) {
            reserve_published_rows(file);
        }
    });
}

void copy_chunks(RowsFromServer& rows, std::span<const ServerChunk> chunks, bool passes) {
    in_batches(chunks, [&](auto batch) {
        rows.copy_states(batch);
        rows.copy_rows_of(server_table("chunk_state"), batch);
        if (passes) {
            rows.copy_drives(batch);
            rows.copy_rows_of(server_table("event"), batch);
            rows.copy_rows_of(server_table("state_change"), batch);
        }
    });
    if (passes) {
        rows.copy_audit_of_changes();
    }
}

void fill_part(RowsFromServer& rows,
               Database& file,
               std::span<const ServerChunk> chunks,
               const PartContent& content) {
    fill_new(rows, file, [&] {
        for (const auto some : {chunks, content.roads_alone}) {
            in_batches(some, [&](auto batch) { rows.copy_segments(batch); });
        }
        const auto ways = numbers_in(file, "SELECT DISTINCT way_id FROM segment");
        in_batches(std::span{ways}, [&](auto batch) {
            const auto condition = fmt::format("way_id = ANY('{}'::bigint[])", array_of(batch));
            rows.copy_rows(server_table("way"), condition);
        });
        copy_chunks(rows, chunks, content.passes);
        if (content.passes) {
            copy_trips_of_passes(rows, file, content.trips);
        }
        rows.copy_marks();
        if (content.publications) {
            in_batches(chunks, [&](auto batch) {
                for (const auto* const table : tables_of_publications) {
                    rows.copy_rows_of(server_table(table), batch);
                }
            });
        }
        if (content.background) {
            for (const auto* const table : background_tables) {
                rows.copy_rows(server_table(table));
            }
        }
        if (content.others) {
            content.others();
        }
    });
}

} // namespace macadam
