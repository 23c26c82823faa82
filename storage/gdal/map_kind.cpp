#include "storage/gdal/map_kind.hpp"

#include "estimator/common/ascii.hpp"
#include "estimator/common/error.hpp"
#include "storage/gdal/sqlite_map.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>

namespace macadam {
namespace {

namespace fs = std::filesystem;
using namespace std::string_view_literals;

struct KindInfo {
    MapKind kind;
    const char* driver;
    bool lines;
    bool pictures;
};
constexpr std::array kinds{
    KindInfo{MapKind::geopackage, "GPKG", true, true},
    KindInfo{MapKind::sqlite, "SQLite", true, false},
    KindInfo{MapKind::mbtiles, "MBTiles", false, true},
    KindInfo{MapKind::shapefile, "ESRI Shapefile", true, false},
    KindInfo{MapKind::geojson, "GeoJSON", true, false},
    KindInfo{MapKind::geojson_lines, "GeoJSONSeq", true, false},
    KindInfo{MapKind::flatgeobuf, "FlatGeobuf", true, false},
    KindInfo{MapKind::gml, "GML", true, false},
    KindInfo{MapKind::kml, "LIBKML", true, false},
    KindInfo{MapKind::mapinfo, "MapInfo File", true, false},
    KindInfo{MapKind::file_geodatabase, "OpenFileGDB", true, false},
    KindInfo{MapKind::geotiff, "GTiff", false, true},
    KindInfo{MapKind::png, "PNG", false, true},
    KindInfo{MapKind::jpeg, "JPEG", false, true},
    KindInfo{MapKind::jpeg_2000, "JP2OpenJPEG", false, true},
    KindInfo{MapKind::webp, "WEBP", false, true},
    KindInfo{MapKind::virtual_raster, "VRT", false, true},
};

const KindInfo* info_of(MapKind kind) {
    const auto* const found = std::ranges::find(kinds, kind, &KindInfo::kind);
    return found != kinds.end() ? found : nullptr;
}

struct Signature {
    std::string_view bytes;
    MapKind kind;
};
constexpr std::array signatures{
    Signature{"SQLite format 3\0"sv, MapKind::sqlite},
    Signature{"\0\0\x27\x0a"sv, MapKind::shapefile},
    Signature{"fgb\x03"sv, MapKind::flatgeobuf},
    Signature{"II*\0"sv, MapKind::geotiff},
    Signature{"MM\0*"sv, MapKind::geotiff},
    Signature{"II+\0"sv, MapKind::geotiff}, // larger than 4 GB
    Signature{"MM\0+"sv, MapKind::geotiff},
    Signature{"\x89PNG\r\n\x1a\n"sv, MapKind::png},
    Signature{"\xff\xd8\xff"sv, MapKind::jpeg},
    Signature{"\0\0\0\x0cjP  "sv, MapKind::jpeg_2000},
    Signature{"\xff\x4f\xff\x51"sv, MapKind::jpeg_2000},
    Signature{"\x1e", MapKind::geojson_lines}, // RFC 8142
};

std::string head_of(const fs::path& file) {
    constexpr std::size_t max_bytes = 1 << 16;
    std::string head(max_bytes, '\0');
    std::ifstream in{file, std::ios::binary};
    in.read(head.data(), std::ssize(head));
    if (!in && !in.eof()) {
        throw InputError{
            fmt::format("{}: cannot be read: {}", file.string(), std::strerror(errno))};
    }
    head.resize(static_cast<std::size_t>(in.gcount()));
    return head;
}

/// Tests whether another JSON text follows the first, that is for one feature per line. If the
/// first feature is longer than the head, the file name decides.
bool are_json_lines(std::string_view text, const fs::path& file) {
    int depth = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quoted) {
            quoted = c != '"';
            i += c == '\\' ? 1 : 0;
        } else if (c == '"') {
            quoted = true;
        } else if (c == '{' || c == '[') {
            ++depth;
        } else if ((c == '}' || c == ']') && --depth == 0) {
            const auto next = text.find_first_not_of(" \t\r\n", i + 1);
            return next != text.npos && (text[next] == '{' || text[next] == '\x1e');
        }
    }
    const auto suffix = in_lower_case(file.extension().string());
    return suffix == ".geojsonl" || suffix == ".geojsons" || suffix == ".ndjson";
}

/// Format by root element. XML with a document type, which may declare entities, is not supported.
MapKind kind_of_xml(std::string_view text) {
    auto at = text.find('<');
    while (at != text.npos &&
           (text.substr(at).starts_with("<?") || text.substr(at).starts_with("<!--"))) {
        const auto end = text[at + 1] == '?' ? text.find("?>", at) : text.find("-->", at);
        at = end == text.npos ? end : text.find('<', end);
    }
    if (at == text.npos) {
        return MapKind::unknown;
    }
    const auto root = text.substr(at + 1, text.find_first_of(" \t\r\n>", at) - at - 1);
    if (root == "VRTDataset") {
        return MapKind::virtual_raster;
    }
    if (root == "kml" || root.ends_with(":kml")) {
        return MapKind::kml;
    }
    const bool is_element = !root.empty() && (std::isalpha(root[0]) != 0 || root[0] == '_');
    const auto start = text.substr(at, text.find('>', at) - at);
    return is_element && start.find("opengis.net/gml") != text.npos ? MapKind::gml
                                                                    : MapKind::unknown;
}

MapKind kind_of_text(std::string_view text, const fs::path& file) {
    if (text.starts_with("\xef\xbb\xbf")) {
        text.remove_prefix(3);
    }
    const auto first = text.find_first_not_of(" \t\r\n");
    if (first == text.npos) {
        return MapKind::unknown;
    }
    text.remove_prefix(first);
    if (text[0] == '{') {
        return are_json_lines(text, file) ? MapKind::geojson_lines : MapKind::geojson;
    }
    if (text[0] == '<') {
        return kind_of_xml(text);
    }
    const auto start = in_lower_case(text.substr(0, 16));
    return start.starts_with("!table") || start.starts_with("version ") ? MapKind::mapinfo
                                                                        : MapKind::unknown;
}

MapKind kind_of_bytes(std::string_view head, const fs::path& file) {
    if (head.starts_with("RIFF") &&
        head.substr(std::min<std::size_t>(8, head.size())).starts_with("WEBP")) {
        return MapKind::webp;
    }
    const auto* const found = std::ranges::find_if(
        signatures, [&](const auto& each) { return head.starts_with(each.bytes); });
    return found != signatures.end() ? found->kind : kind_of_text(head, file);
}

} // namespace

MapKind kind_of_map(const fs::path& file) {
    std::error_code error;
    if (fs::is_directory(file, error)) {
        return fs::is_regular_file(file / "a00000001.gdbtable", error) ? MapKind::file_geodatabase
                                                                       : MapKind::unknown;
    }
    if (!fs::is_regular_file(file, error)) {
        throw InputError{fmt::format("{}: is not a regular file, expected a map", file.string())};
    }
    const auto kind = kind_of_bytes(head_of(file), file);
    return kind == MapKind::sqlite ? kind_of_sqlite_map(file) : kind;
}

const char* driver_of(MapKind kind) {
    const auto* const info = info_of(kind);
    return info != nullptr ? info->driver : "";
}

bool may_hold_lines(MapKind kind) {
    const auto* const info = info_of(kind);
    return info != nullptr && info->lines;
}

bool may_hold_pictures(MapKind kind) {
    const auto* const info = info_of(kind);
    return info != nullptr && info->pictures;
}

} // namespace macadam
