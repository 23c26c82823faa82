#include "storage/store/fusion/chunk_passes.hpp"

#include "mapping/passes/chunk_trace.hpp"
#include "storage/store/rows/segment_row.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <tuple>
#include <utility>

namespace macadam {

ChunkPasses::ChunkPasses(Database& database)
    : select_trip_{database.prepare("SELECT sha256, vehicle, t0_utc_ms, reference_ppm, method"
                                    " FROM trip WHERE id = ?")},
      // The rows of a chunk's segments are consecutive.
      select_places_{
          database.prepare("SELECT fid, way_id, direction, seq, from_m, to_m FROM segment"
                           " WHERE fid >= ?1 AND fid < ?1 + ?2 AND strip = ?1 ORDER BY fid")},
      select_passes_{database.prepare(
          fmt::format("SELECT segment, trip, {} FROM pass WHERE segment >= ? AND segment <= ?"
                      " ORDER BY segment, trip, occurrence",
                      pass_columns))} {}

std::vector<ChunkPass> ChunkPasses::of(std::int64_t chunk, std::int64_t segments_per_chunk) {
    std::vector<ChunkPass> passes;
    const auto places = places_of(chunk, segments_per_chunk);
    if (places.empty()) {
        return passes;
    }
    auto place = places.begin();
    for (select_passes_.bind(chunk, places.back().fid); select_passes_.step();) {
        const auto fid = select_passes_.integer(0);
        while (place->fid < fid) {
            ++place;
        }
        if (auto pass = place->fid == fid ? pass_at(*place) : std::nullopt) {
            passes.push_back(std::move(*pass));
        }
    }
    select_passes_.reset();
    std::ranges::sort(passes, {}, [](const ChunkPass& pass) {
        return std::tuple<std::int64_t, std::string_view, std::uint32_t>{
            pass.fid, pass.input.trip_sha256, pass.input.pass.occurrence};
    });
    return passes;
}

std::vector<ChunkPasses::SegmentInterval> ChunkPasses::places_of(std::int64_t chunk,
                                                                 std::int64_t segments_per_chunk) {
    std::vector<SegmentInterval> places;
    for (select_places_.bind(chunk, segments_per_chunk); select_places_.step();) {
        const auto key = key_in(select_places_, 1);
        places.push_back({select_places_.integer(0),
                          key,
                          station_m(key.forward, select_places_.real(key.forward ? 4 : 5)),
                          station_m(key.forward, select_places_.real(key.forward ? 5 : 4))});
    }
    select_places_.reset();
    return places;
}

/// Pass in the current row; `std::nullopt` if its trip does not exist.
std::optional<ChunkPass> ChunkPasses::pass_at(const SegmentInterval& place) {
    const auto* of = trip(select_passes_.integer(1));
    if (of == nullptr) {
        return std::nullopt;
    }
    ChunkPass pass{place.fid,
                   {pass_in(select_passes_, 2, place.key), of->sha256, of->vehicle, {}},
                   place.from_m,
                   place.to_m};
    pass.input.utc_ms = utc_ms_of(of->t0_utc_ms, pass.input.pass);
    pass.input.reference = of->reference;
    pass.input.by_filter = of->by_filter;
    return pass;
}

const ChunkPasses::Trip* ChunkPasses::trip(std::int64_t row) {
    if (const auto known = trips_.find(row); known != trips_.end()) {
        return &known->second;
    }
    const Trip* found = nullptr;
    if (select_trip_.bind(row).step()) {
        const bool reference = !select_trip_.is_null(3);
        found = &trips_
                     .emplace(row,
                              Trip{select_trip_.text(0),
                                   reference ? -row : select_trip_.integer(1),
                                   known_utc_ms(select_trip_, 2),
                                   reference,
                                   select_trip_.text(4) == "kf"})
                     .first->second;
    }
    select_trip_.reset();
    return found;
}

} // namespace macadam
