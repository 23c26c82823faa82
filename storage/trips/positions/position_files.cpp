#include "storage/trips/positions/position_files.hpp"

#include "estimator/common/ascii.hpp"
#include "estimator/common/error.hpp"
#include "storage/files/byte_stream.hpp"
#include "storage/trips/positions/gpx_reader.hpp"
#include "storage/trips/positions/nmea_reader.hpp"

namespace macadam {

namespace {

namespace fs = std::filesystem;

/// Name without the suffixes of logs and of compression.
std::string stem_of(std::string name) {
    for (const std::string_view suffix :
         {".gz", ".zst", ".csv", ".txt", ".vbo", ".log", ".asc", ".mf4", ".h5", ".hdf5", ".trip"}) {
        if (in_lower_case(name).ends_with(suffix) && name.size() > suffix.size()) {
            name.resize(name.size() - suffix.size());
        }
    }
    return name;
}

bool may_be_nmea(std::string_view name) {
    const auto lower = in_lower_case(name);
    return lower.ends_with(".log") || lower.ends_with(".txt");
}

} // namespace

bool is_track_name(std::string_view name) {
    return is_gpx_name(name) || is_nmea_name(name);
}

bool is_nmea_file(const fs::path& file) {
    constexpr std::size_t looked_at = 1 << 14;
    const auto name = file.filename().string();
    if (is_nmea_name(name)) {
        return true;
    }
    if (!may_be_nmea(name) || !fs::is_regular_file(file)) {
        return false;
    }
    std::string head(looked_at, '\0');
    head.resize(file_bytes(file)->read(head));
    return is_nmea_text(head);
}

std::optional<fs::path> positions_beside(const fs::path& log) {
    const auto stem = stem_of(log.filename().string());
    for (const auto* const suffix :
         {".nmea", ".nmea.gz", ".nmea.zst", ".gpx", ".gpx.gz", ".gpx.zst", ".log", ".txt"}) {
        auto beside = log.parent_path() / (stem + suffix);
        std::error_code unreadable;
        if (beside == log || !fs::is_regular_file(beside, unreadable)) {
            continue;
        }
        try {
            if (is_gpx_name(beside.string()) || is_nmea_file(beside)) {
                return beside;
            }
        } catch (const InputError&) { // an unreadable file, which belongs to nobody
        }
    }
    return std::nullopt;
}

} // namespace macadam
