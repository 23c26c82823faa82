#include "app/inspect/file_kind.hpp"

#include "app/inspect/can_kind.hpp"
#include "app/inspect/table_kind.hpp"

#include "storage/files/decompress.hpp"
#include "storage/gdal/map_kind.hpp"
#include "storage/networks/network_file.hpp"
#include "storage/store/schema/store_marker.hpp"
#include "storage/text/text.hpp"
#include "storage/trips/detection/csv_dialect.hpp"
#include "storage/trips/detection/text_sample.hpp"
#include "storage/trips/positions/gpx_reader.hpp"
#include "storage/trips/positions/nmea_reader.hpp"
#include "storage/trips/positions/position_files.hpp"
#include "storage/trips/rawlog/rawlog_reader.hpp"
#include "storage/trips/source/phone_export_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

namespace macadam {
namespace {

namespace fs = std::filesystem;
using namespace std::string_view_literals;
using Use = FileKind::Use;

constexpr std::string_view network_advice =
    "a network: macadam init STORE --network FILE, or macadam match TRIP --network FILE";
constexpr std::string_view base_map_advice = "a base map: macadam render STORE --base FILE";

/// Format that begins with fixed bytes.
struct Signature {
    std::size_t at;
    std::string_view bytes;
    std::string_view name;
    std::string_view advice;
};

constexpr std::array signatures{
    Signature{0,
              "%PDF",
              "PDF document",
              "not an input of Macadam; reports are written by 'macadam report'"},
    Signature{
        0, "PMTiles", "tile archive (PMTiles)", "an output of 'macadam export'; web maps read it"},
    Signature{0,
              "MDF     ",
              "measurement file (ASAM MDF before 4)",
              "convert it to MDF 4, then inspect that"},
    Signature{0,
              "UnFinMF",
              "measurement file (ASAM MDF, not finalised)",
              "finalise it with the software of its logger, then inspect that"},
    Signature{
        0, "TDSm", "measurement file (TDMS)", "export its channels as CSV, then inspect that"},
    Signature{0,
              "#ROSBAG",
              "recording of ROS",
              "write its IMU and GNSS topics as CSV, then inspect that"},
    Signature{0,
              "\x89MCAP",
              "recording of ROS 2 (MCAP)",
              "write its IMU and GNSS topics as CSV, then inspect that"},
    Signature{0,
              "\xb5\x62",
              "recording of a u-blox receiver (UBX)",
              "positions only; convert it to GPX, for example with u-center"},
    Signature{
        0,
        "\x89HDF",
        "HDF5 file",
        "read with --mapping FILE.toml, which has a table [hdf5] and names the datasets to take "
        "(docs/reference/other-loggers.md)"},
    Signature{0, "MATLAB", "MATLAB file", "export its data as CSV, then inspect that"},
    Signature{0, "PAR1", "Parquet file", "export its data as CSV, then inspect that"},
    Signature{
        8, ".FIT", "activity of a sports watch (FIT)", "export it as GPX; it has positions only"},
    Signature{4, "ftyp", "film", "not an input of Macadam"},
    Signature{0,
              "\x7f"
              "ELF",
              "program",
              "not an input of Macadam"},
    Signature{0, "GIF8", "picture (GIF)", "not an input of Macadam"},
    Signature{0, "7z\xbc\xaf", "archive (7z)", "extract it, then inspect its files"},
    Signature{0, "Rar!", "archive (RAR)", "extract it, then inspect its files"},
    Signature{
        0, "\xd0\xcf\x11\xe0", "old Office document", "save the sheet as CSV, then inspect that"},
};

std::string first_bytes(const fs::path& file) {
    constexpr std::size_t max_bytes = 1 << 16;
    std::string head(max_bytes, '\0');
    std::size_t size = 0;
    const auto bytes = decompressed(file_bytes(file), file.string());
    while (size < head.size()) {
        const auto count = bytes->read({head.data() + size, head.size() - size});
        if (count == 0) {
            break;
        }
        size += count;
    }
    head.resize(size);
    return head;
}

FileKind other(std::string_view name, std::string_view advice) {
    return {Use::other, std::string{name}, std::string{advice}};
}

std::optional<FileKind> by_signature(std::string_view head) {
    if (head.starts_with("LOGG")) {
        return can_log_kind("Vector BLF", false);
    }
    for (const auto& [at, bytes, name, advice] : signatures) {
        if (head.size() > at && head.substr(at).starts_with(bytes)) {
            return other(name, advice);
        }
    }
    if (head.starts_with("PK\x03\x04")) {
        return head.find("xl/") != std::string_view::npos ||
                       head.find("[Content_Types].xml") != std::string_view::npos
                   ? other("Office document (such as .xlsx)",
                           "save the sheet as CSV, then inspect that")
                   : other("zip archive", "give it a name that ends in .zip");
    }
    return std::nullopt;
}

std::string_view words_of(MapKind kind) {
    switch (kind) {
    case MapKind::geopackage:
        return "GeoPackage";
    case MapKind::mbtiles:
        return "tile archive (MBTiles)";
    case MapKind::geotiff:
        return "picture (TIFF)";
    case MapKind::png:
        return "picture (PNG)";
    case MapKind::jpeg:
        return "picture (JPEG)";
    case MapKind::webp:
        return "picture (WebP)";
    default:
        return driver_of(kind);
    }
}

std::optional<FileKind> by_map_kind(const fs::path& file, std::string_view head) {
    const auto kind = kind_of_map(file);
    const bool is_other_json =
        kind == MapKind::geojson && head.find("\"type\"") == std::string_view::npos;
    if (kind == MapKind::unknown || is_other_json) {
        return std::nullopt;
    }
    const auto name = fmt::format("map ({})", words_of(kind));
    return may_hold_lines(kind) ? other(name, network_advice)
                                : other(words_of(kind), base_map_advice);
}

/// Recognises XML by its first element.
std::optional<FileKind> by_element(std::string_view head) {
    const auto has = [&](std::string_view text) {
        return head.find(text) != std::string_view::npos;
    };
    if (!trimmed(head.substr(0, std::min<std::size_t>(head.size(), 64))).starts_with('<')) {
        return std::nullopt;
    }
    if (has("<osm ") || has("<osm>")) {
        return other("road map (OpenStreetMap, XML)", network_advice);
    }
    if (has("<gpx")) {
        return FileKind{Use::trip, "GPX track", "positions: macadam match FILE --network MAP"};
    }
    if (has("<html") || has("<HTML") || has("<!DOCTYPE html")) {
        return other("web page",
                     "not an input of Macadam; reports are written by 'macadam report'");
    }
    return std::nullopt;
}

std::optional<FileKind> by_text(const fs::path& file, std::string_view head) {
    if (is_nmea_text(head)) {
        return is_nmea_file(file) ? FileKind{Use::trip, "NMEA 0183 recording of a receiver", ""}
                                  : other("NMEA 0183 recording of a receiver",
                                          "give it a name that ends in .nmea");
    }
    if (head.starts_with('{') || head.starts_with('[')) {
        return other("JSON", "write its readings as CSV, then inspect that");
    }
    return std::nullopt;
}

std::optional<FileKind> by_name(const fs::path& file, std::string_view head) {
    const auto name = file.filename().string();
    if (name.ends_with(rawlog_suffix)) {
        return FileKind{Use::trip, "rawlog of MRPT", ""};
    }
    if (is_nmea_name(name)) {
        return FileKind{Use::trip, "NMEA 0183 recording of a receiver", ""};
    }
    if (is_gpx_name(name)) {
        return FileKind{Use::trip, "GPX track", ""};
    }
    if (marks_export(name)) {
        return other("one file of a phone export",
                     "give its folder instead: " +
                         (file.has_parent_path() ? file.parent_path().string() : "."));
    }
    if (name.ends_with(".toml")) {
        return kind_of_toml(file);
    }
    if (name.ends_with(".erd") || name.ends_with(".pro") || head.starts_with("ERDFILEV") ||
        head.starts_with("HEAD3")) {
        return kind_of_profile(file);
    }
    return std::nullopt;
}

} // namespace

FileKind kind_of_file(const fs::path& file) {
    const auto head = first_bytes(file);
    if (head.empty()) {
        return {Use::unknown, "empty file", "there is nothing to read"};
    }
    if (head.starts_with("# macadam-trip")) {
        return {Use::trip, "Macadam trip log", ""};
    }
    if (is_store(file)) {
        return other("road database", "macadam info FILE, and all commands that take STORE");
    }
    if (is_network_file(file)) {
        return other("network file beside a road database", "macadam match TRIP --network FILE");
    }
    if (head.substr(0, 64).find("OSMHeader") != std::string::npos) {
        return other("road map (OpenStreetMap, .osm.pbf)", network_advice);
    }
    if (auto kind = by_name(file, head)) {
        return *kind;
    }
    if (head.starts_with("MDF     4")) {
        return kind_of_mdf(file);
    }
    if (auto kind = by_signature(head)) {
        return *kind;
    }
    if (auto kind = by_element(head)) {
        return *kind;
    }
    if (auto kind = kind_of_can_text(file, head)) { // a DBC file begins like a MapInfo file
        return *kind;
    }
    if (auto kind = by_map_kind(file, head)) {
        return *kind;
    }
    if (auto kind = by_text(file, head)) {
        return *kind;
    }
    const auto bytes = decompressed(file_bytes(file), file.string());
    const auto sample = read_text_sample(*bytes, file.string());
    if (!sample) {
        return {Use::unknown,
                fmt::format("not recognised; it begins with {}", in_quotes(head, 16)),
                "it is not text"};
    }
    if (auto kind = kind_of_table(*sample)) {
        return *kind;
    }
    return detect_csv_dialect(sample->lines)
               ? FileKind{Use::table, "CSV file of another program", ""}
               : FileKind{Use::unknown, "text that is not a table", ""};
}

} // namespace macadam
