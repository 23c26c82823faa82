#include "storage/trips/trip_follower.hpp"

#include "storage/files/decompress.hpp"
#include "storage/text/text.hpp"

#include <fmt/core.h>

namespace macadam {
namespace {

std::unique_ptr<ByteStream> open(const std::filesystem::path& file, const std::string& name) {
    return decompressed(file == "-" ? standard_input_bytes() : file_bytes(file), name);
}

TripSource source_of(const std::filesystem::path& file) {
    return {.file = file == "-" ? std::filesystem::path{"standard input"} : file, .member = ""};
}

} // namespace

TripFollower::TripFollower(const std::filesystem::path& file, const TripNeeds& needs)
    : name_{source_of(file).name()},
      rows_{open(file, source_of(file).name()), source_of(file), needs}, streams_{needs,
                                                                                  rows_.header()} {}

std::optional<TripLog> TripFollower::next() {
    const auto row = rows_.next();
    if (!row) {
        return std::nullopt;
    }
    streams_.add(*row);
    return streams_.take_rows();
}

std::string TripFollower::row_text() const {
    return fmt::format("{}: {}", rows_.where(), in_quotes(rows_.line()));
}

} // namespace macadam
