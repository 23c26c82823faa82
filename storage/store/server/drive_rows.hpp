#pragma once

#include "mapping/passes/chunk_trace.hpp"
#include "storage/postgres/copy_stream.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/server/drive_body.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace macadam {

/// Trace of a drive, as columns of table drive.
struct DriveTrace {
    std::int64_t first_m;
    std::int64_t place_sd_mm;
    std::string iri;
    std::optional<std::string> left;
};

/// Passes and trace of one drive of a trip over a chunk.
struct ChunkDrive {
    std::vector<DrivePass> passes;
    std::optional<DriveTrace> trace;
};

/// Names a drive: rows of chunk and trip, and its number, or -1 for passes without a trace.
struct DriveName {
    std::int64_t chunk;
    std::int64_t trip;
    std::int64_t drive;
    friend auto operator<=>(const DriveName&, const DriveName&) = default;
};

/// Number of the drive to which a pass belongs.
inline std::int64_t drive_number(const Pass& pass) {
    return pass.drive ? std::int64_t{*pass.drive} : -1;
}

DriveTrace drive_trace_of(const RoughnessTrace& trace);

/// Trace from columns first_m, place_sd_mm, iri and iri_left of a file, the first of which is
/// `first`.
DriveTrace drive_trace_in(const Statement& row, int first);

/// Writes a row of table drive.
void write_drive(CopyWriter& writer, std::int32_t cell, const DriveName& name, ChunkDrive drive);

} // namespace macadam
