#include "storage/network_reader.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/late_library.hpp"
#include "storage/late/ogr.hpp"
#include "storage/osm_reader.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <utility>

namespace macadam {

namespace {

/// GDAL takes names that begin so for addresses, connections or documents, not for files.
void expect_plain_name(const std::string& name) {
    static constexpr std::array<std::string_view, 5> others{"/vsi", "PG:", "MYSQL:", "<", "{"};
    const bool other = std::any_of(
        others.begin(), others.end(), [&](auto start) { return name.starts_with(start); });
    if (other || name.find("://") != std::string::npos) {
        throw InputError{fmt::format("{}: is no file name, expected a map or a line layer", name)};
    }
}

void expect_present(const std::filesystem::path& file) {
    std::error_code failure;
    const auto kind = std::filesystem::status(file, failure);
    if (!std::filesystem::exists(kind)) {
        throw InputError{fmt::format("{}: cannot be read: {}",
                                     file.string(),
                                     failure ? failure.message() : "No such file or directory")};
    }
}

std::vector<Way> read_layer(const std::filesystem::path& file, const LayerColumns& columns) {
    std::vector<Way> ways;
    auto* const read = late_function<OgrReadLines>("macadam_gdal.so", ogr_read_lines_name);
    read(file, columns, [&](Way way) { ways.push_back(std::move(way)); });
    std::sort(ways.begin(), ways.end(), [](const Way& a, const Way& b) { return a.id < b.id; });
    return ways;
}

} // namespace

std::vector<Way> read_network(const std::filesystem::path& file,
                              const LayerColumns& columns,
                              const Progress& progress) {
    expect_plain_name(file.string());
    expect_present(file);
    auto ways = is_osm_file(file) ? read_osm(file, progress) : read_layer(file, columns);
    if (ways.empty()) {
        throw InputError{fmt::format("{}: holds no drivable road", file.string())};
    }
    return ways;
}

} // namespace macadam
