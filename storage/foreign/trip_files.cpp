#include "storage/foreign/trip_files.hpp"

namespace macadam {

namespace {

namespace fs = std::filesystem;

/// Where the files of a trip lie: a folder, or a folder within an archive.
struct Place {
    fs::path file;
    std::string prefix; ///< of members; "" at the archive's top
    bool is_archive;
};

Place place_of(const TripSource& source) {
    if (source.mapping == nullptr) {
        return {source.file, source.member, !fs::is_directory(source.file)};
    }
    if (source.member.empty()) {
        return {source.file.parent_path(), "", false};
    }
    return {source.file, source.member.substr(0, source.member.rfind('/') + 1), true};
}

} // namespace

std::string name_of_file(const TripSource& source, const std::string& file) {
    const auto place = place_of(source);
    return (place.file / (place.prefix + file)).string();
}

std::unique_ptr<ByteStream> bytes_of_file(const TripSource& source, const std::string& file) {
    const auto place = place_of(source);
    const auto name = name_of_file(source, file);
    if (!place.is_archive) {
        return decompressed(file_bytes(place.file / file), name);
    }
    return decompressed(bounded(member_bytes(place.file, place.prefix + file), name), name);
}

} // namespace macadam
