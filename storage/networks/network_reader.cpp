#include "storage/networks/network_reader.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/plugin_library.hpp"
#include "storage/networks/ogr_reader.hpp"
#include "storage/networks/osm_reader.hpp"
#include "storage/text/text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <utility>

namespace macadam {

namespace {

/// Rejects names that GDAL takes for URLs, connections or documents.
void expect_plain_name(const std::string& name) {
    static constexpr std::array<std::string_view, 5> others{"/vsi", "PG:", "MYSQL:", "<", "{"};
    const bool other = std::any_of(
        others.begin(), others.end(), [&](auto start) { return name.starts_with(start); });
    if (other || name.find("://") != std::string::npos) {
        throw InputError{
            fmt::format("{}: is not a file name, expected a map or a line layer", name)};
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

/// Size of the files of a layer: a Shapefile consists of several with one stem, a geodatabase is a
/// folder.
std::uint64_t bytes_of_layer(const std::filesystem::path& file) {
    namespace fs = std::filesystem;
    std::error_code none; // unreadable files do not count
    const bool is_folder = fs::is_directory(file, none);
    const auto folder = is_folder ? file : fs::absolute(file).parent_path();
    std::uint64_t bytes = is_folder ? 0 : fs::file_size(file, none);
    for (fs::directory_iterator entry{folder, none}, end; !none && entry != end;
         entry.increment(none)) {
        std::error_code gone;
        const auto& path = entry->path();
        const bool is_part =
            is_folder || (path.stem() == file.stem() && path.filename() != file.filename());
        const auto size =
            is_part && fs::is_regular_file(path, gone) ? fs::file_size(path, gone) : 0;
        bytes += gone ? 0 : size;
    }
    return bytes;
}

/// Limits on the output of a layer, because a view of a database or a compressed file can produce
/// any amount of data.
class LayerBounds {
public:
    explicit LayerBounds(const std::filesystem::path& file)
        : file_{file}, most_{free_bytes + bytes_of_layer(file)} {}

    void add(const Way& way) {
        bytes_ += 1 + way.line.size() + way.name.size() + way.highway.size();
        if (bytes_ > most_) {
            throw InputError{
                fmt::format("{}: contains more points and names than bytes, which no map does",
                            file_.string())};
        }
    }

private:
    static constexpr std::uint64_t free_bytes = 100'000;

    std::filesystem::path file_;
    std::uint64_t most_;
    std::uint64_t bytes_ = 0;
};

bool is_in(NetworkCut& cut, const Way& way) {
    ++cut.ways;
    bool is_near = false;
    for (const auto& point : way.line) {
        is_near = cut.see(point) || is_near;
    }
    return is_near;
}

std::vector<Way>
read_layer(const std::filesystem::path& file, const LayerColumns& columns, NetworkCut* cut) {
    std::vector<Way> ways;
    LayerBounds bounds{file};
    auto* const read = plugin_function<OgrReadLines>("macadam_gdal.so", ogr_read_lines_name);
    read(file, columns, [&](Way way) {
        bounds.add(way);
        if (way.line.size() >= 2 && (cut == nullptr || is_in(*cut, way))) {
            ways.push_back(std::move(way));
        }
    });
    std::sort(ways.begin(), ways.end(), [](const Way& a, const Way& b) { return a.id < b.id; });
    return ways;
}

bool has_far_step(const Way& way) {
    return std::adjacent_find(
               way.line.begin(), way.line.end(), [](const GeoPoint& a, const GeoPoint& b) {
                   return !(distance_m(a, b) <= longest_step_m);
               }) != way.line.end();
}

std::string counted(std::size_t ways) {
    return fmt::format("{} {}", ways, ways == 1 ? "way" : "ways");
}

/// Describes the omitted ways; "" if there are none.
std::string words_of(const LeftOutWays& left_out, const std::filesystem::path& file) {
    std::string words;
    if (left_out.far_steps > 0) {
        words = fmt::format("{} with points more than {:.0f} km apart",
                            counted(left_out.far_steps),
                            longest_step_m / 1000);
    }
    if (left_out.in_circles > 0) {
        words += fmt::format("{}{} repeating the same few nodes",
                             words.empty() ? "" : " and ",
                             counted(left_out.in_circles));
    }
    return words.empty() ? "" : fmt::format("{}: skipped: {}", file.string(), words);
}

/// Explains why an OSM file has no drivable road.
std::string reason_in(const LeftOutWays& left_out) {
    if (left_out.without_places > 0) {
        return fmt::format(": the positions of the points of its {} are missing",
                           counted(left_out.without_places));
    }
    if (left_out.closed.empty()) {
        return ": no way has a highway tag; expected a map extract with roads";
    }
    std::string kinds;
    for (const auto& kind : left_out.closed) {
        kinds += (kinds.empty() ? "" : ", ") + in_quotes(kind);
    }
    return fmt::format(": its ways are not open to cars (highway = {})", kinds);
}

} // namespace

std::vector<Way> read_network(const std::filesystem::path& file,
                              const LayerColumns& columns,
                              const Progress& progress,
                              const std::function<void(const std::string&)>& warn,
                              NetworkCut* cut) {
    expect_plain_name(file.string());
    expect_present(file);
    LeftOutWays left_out;
    auto ways = is_osm_file(file) ? read_osm(file, progress, left_out, cut)
                                  : read_layer(file, columns, cut);
    left_out.far_steps = std::erase_if(ways, has_far_step);
    const auto words = words_of(left_out, file);
    if (ways.empty() && (cut == nullptr || cut->ways == 0)) {
        throw InputError{words.empty()
                             ? fmt::format("{}: contains no drivable road{}",
                                           file.string(),
                                           is_osm_file(file) ? reason_in(left_out) : "")
                             : fmt::format("{}; it contains no other drivable road", words)};
    }
    if (warn && !words.empty()) {
        warn(words);
    }
    return ways;
}

} // namespace macadam
