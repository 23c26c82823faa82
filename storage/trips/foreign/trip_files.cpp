#include "storage/trips/foreign/trip_files.hpp"

#include "estimator/common/error.hpp"
#include "storage/files/decompress.hpp"
#include "storage/text/text.hpp"
#include "storage/trips/source/trip_contents.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace macadam {

namespace {

namespace fs = std::filesystem;

/// Location of a trip's files: a folder, or a folder within an archive.
struct TripFolder {
    fs::path file;
    std::string prefix; ///< of members; "" at the root of the archive
};

TripFolder place_of(const TripSource& source) {
    if (source.mapping == nullptr) {
        return {source.file, source.member};
    }
    if (source.member.empty()) { // not in an archive
        return {source.file.parent_path(), ""};
    }
    return {source.file, source.member.substr(0, source.member.rfind('/') + 1)};
}

} // namespace

std::string name_of_file(const TripSource& source, const std::string& file) {
    const auto place = place_of(source);
    return (place.file / (place.prefix + file)).string();
}

TripSource with_contents(TripSource source) {
    if (source.contents) {
        return source;
    }
    TripContents contents;
    std::vector<char> block(1 << 20);
    for (const auto& file : source.files) {
        const auto path = place_of(source).file / file;
        auto& kept = contents.files.emplace_back(file);
        try { // a file that nobody uses may be unreadable
            const auto bytes = decompressed(file_bytes(path), path.string());
            while (const auto count = bytes->read(block)) {
                kept.bytes.append(block.data(), count);
            }
        } catch (const InputError& error) {
            kept = {file, {}, error.what()};
        }
    }
    source.contents = std::make_shared<const TripContents>(std::move(contents));
    return source;
}

std::string_view text_of_file(const TripSource& source, const std::string& file) {
    bytes_of_file(source, file); // throws if it is missing
    return std::ranges::find(source.contents->files, file, &TripContents::File::name)->bytes;
}

std::unique_ptr<ByteStream> bytes_of_file(const TripSource& source, const std::string& file) {
    const auto place = place_of(source);
    auto bytes = bytes_of(source.contents, file);
    if (bytes == nullptr) {
        throw InputError{fmt::format(
            "{}: has no file {}", place.file.string(), in_quotes(place.prefix + file, 200))};
    }
    return bytes;
}

} // namespace macadam
