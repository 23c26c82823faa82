#include "storage/store/server/drive_rows.hpp"

#include <string_view>

namespace macadam {
namespace {

std::string bytes_of(const std::vector<RoughnessCode>& codes) {
    return {codes.begin(), codes.end()};
}

} // namespace

DriveTrace drive_trace_of(const RoughnessTrace& trace) {
    DriveTrace row{trace.first_m, trace.place_sd_mm, bytes_of(trace.iri), std::nullopt};
    if (!trace.left.empty()) {
        row.left = bytes_of(trace.left);
    }
    return row;
}

DriveTrace drive_trace_in(const Statement& row, int first) {
    DriveTrace trace{
        row.integer(first), row.integer(first + 1), std::string{row.blob(first + 2)}, std::nullopt};
    if (!row.is_null(first + 3)) {
        trace.left = std::string{row.blob(first + 3)};
    }
    return trace;
}

void write_drive(CopyWriter& writer, std::int32_t cell, const DriveName& name, ChunkDrive drive) {
    const auto count = static_cast<std::int32_t>(drive.passes.size());
    const auto body = body_of(std::move(drive.passes));
    writer.begin_row();
    writer.put(cell);
    writer.put(name.chunk);
    writer.put(name.trip);
    writer.put(name.drive);
    writer.put(count);
    writer.put(ServerBytes{body});
    if (drive.trace) {
        writer.put(drive.trace->first_m);
        writer.put(drive.trace->place_sd_mm);
        writer.put(ServerBytes{drive.trace->iri});
    } else {
        writer.put(std::nullopt);
        writer.put(std::nullopt);
        writer.put(std::nullopt);
    }
    if (drive.trace && drive.trace->left) {
        writer.put(ServerBytes{*drive.trace->left});
    } else {
        writer.put(std::nullopt);
    }
    writer.end_row();
}

} // namespace macadam
