#include "storage/trips/foreign/trip_files.hpp"

#include "estimator/common/error.hpp"
#include "storage/files/decompress.hpp"
#include "storage/text/text.hpp"
#include "storage/trips/source/trip_contents.hpp"

#include <fmt/core.h>

namespace macadam {

namespace {

namespace fs = std::filesystem;

/// Location of a trip's files: a folder, or a folder within an archive.
struct Place {
    fs::path file;
    std::string prefix; ///< of members; "" at the root of the archive
};

Place place_of(const TripSource& source) {
    if (source.mapping == nullptr) {
        return {source.file, source.member};
    }
    if (!source.contents) {
        return {source.file.parent_path(), ""};
    }
    return {source.file, source.member.substr(0, source.member.rfind('/') + 1)};
}

} // namespace

std::string name_of_file(const TripSource& source, const std::string& file) {
    const auto place = place_of(source);
    return (place.file / (place.prefix + file)).string();
}

std::unique_ptr<ByteStream> bytes_of_file(const TripSource& source, const std::string& file) {
    const auto place = place_of(source);
    if (!source.contents) {
        return decompressed(file_bytes(place.file / file), name_of_file(source, file));
    }
    auto bytes = bytes_of(source.contents, file);
    if (bytes == nullptr) {
        throw InputError{fmt::format(
            "{}: has no file {}", place.file.string(), in_quotes(place.prefix + file, 200))};
    }
    return bytes;
}

} // namespace macadam
