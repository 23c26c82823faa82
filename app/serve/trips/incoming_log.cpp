#include "app/serve/trips/incoming_log.hpp"

#include "estimator/common/ascii.hpp"
#include "estimator/common/error.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

namespace macadam {
namespace {

/// Longer ones first: ".trip.csv.gz" ends with ".csv.gz", too.
constexpr std::array<std::string_view, 14> suffixes{".trip.csv.zst",
                                                    ".trip.csv.gz",
                                                    ".trip.csv",
                                                    ".csv.zst",
                                                    ".csv.gz",
                                                    ".csv",
                                                    ".txt",
                                                    ".vbo",
                                                    ".rawlog",
                                                    ".zip",
                                                    ".tar.zst",
                                                    ".tar.gz",
                                                    ".tgz",
                                                    ".tar"};

constexpr std::array<std::pair<std::string_view, std::string_view>, 9> suffixes_by_type{
    {{"text/csv", ".csv"},
     {"text/plain", ".csv"},
     {"application/csv", ".csv"},
     {"application/gzip", ".csv.gz"},
     {"application/x-gzip", ".csv.gz"},
     {"application/zstd", ".csv.zst"},
     {"application/zip", ".zip"},
     {"application/x-zip-compressed", ".zip"},
     {"application/x-tar", ".tar"}}};

constexpr unsigned readable_by_owner = 0600;

} // namespace

std::optional<std::string> suffix_of_upload(const HttpRequest& request) {
    auto name = in_lower_case(request.header("content-disposition"));
    name.resize(name.find_last_not_of("\"; ") + 1);
    for (const auto suffix : suffixes) {
        if (name.ends_with(suffix)) {
            return std::string{suffix};
        }
    }
    const auto stated = request.header("content-type");
    const auto type = in_lower_case(trimmed(stated.substr(0, stated.find(';'))));
    const auto* const found = std::ranges::find(
        suffixes_by_type, type, &std::pair<std::string_view, std::string_view>::first);
    return found == suffixes_by_type.end() ? std::nullopt
                                           : std::optional{std::string{found->second}};
}

bool has_free(const std::filesystem::path& folder, std::uint64_t bytes) {
    std::error_code unknown;
    const auto space = std::filesystem::space(folder, unknown);
    return unknown || space.available >= bytes;
}

IncomingLog::IncomingLog(const std::filesystem::path& spool,
                         Upload upload,
                         std::uint64_t min_free_bytes)
    : spool_{spool}, min_free_bytes_{min_free_bytes}, upload_{std::move(upload)} {}

AtomicFile& IncomingLog::file() {
    if (!file_) {
        file_.emplace(upload_.file_in(spool_), readable_by_owner);
    }
    return *file_;
}

void IncomingLog::add(std::string_view bytes) {
    upload_.bytes += static_cast<std::int64_t>(bytes.size());
    hash_.add(bytes);
    file().write(bytes);
    constexpr std::int64_t look_every = 256 * 1024; // bytes
    if (upload_.bytes - looked_at_bytes_ >= look_every) {
        looked_at_bytes_ = upload_.bytes;
        if (!has_free(spool_, min_free_bytes_)) {
            throw InputError{
                fmt::format("uploads leave less than {} MiB of the disk", min_free_bytes_ >> 20U)};
        }
    }
}

} // namespace macadam
