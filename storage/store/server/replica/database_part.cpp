#include "storage/store/server/replica/database_part.hpp"

#include "storage/store/server/copy/new_copy.hpp"
#include "storage/store/server/server_tables.hpp"

namespace macadam {

std::vector<ServerChunk> chunks_in(const std::vector<std::int64_t>& numbers) {
    std::vector<ServerChunk> chunks;
    for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
        chunks.push_back({static_cast<std::int32_t>(numbers[i]), numbers[i + 1]});
    }
    return chunks;
}

void fill_database_part(RowsFromServer& rows, Database& file, const DatabasePart& part) {
    const auto copy_others = [&] {
        rows.copy_passes_elsewhere(part.trips_with_all_passes, part.chunks);
        // The next operation gets the row after the last one.
        rows.copy_rows(server_table("audit"), "id = (SELECT max(id) FROM macadam.audit)");
        rows.copy_rows(server_table("publication"));
    };
    fill_part(rows,
              file,
              part.chunks,
              {.passes = true,
               .publications = true,
               .background = false,
               .roads_alone = part.other_chunks,
               .trips = part.trips,
               .others = copy_others});
}

} // namespace macadam
