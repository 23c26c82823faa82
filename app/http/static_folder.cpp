#include "app/http/static_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>

#include <sys/stat.h>

namespace macadam {
namespace {

using Pair = std::pair<std::string_view, std::string_view>;
constexpr std::array types{Pair{".html", "text/html; charset=utf-8"},
                           Pair{".css", "text/css; charset=utf-8"},
                           Pair{".js", "text/javascript; charset=utf-8"},
                           Pair{".mjs", "text/javascript; charset=utf-8"},
                           Pair{".json", "application/json"},
                           Pair{".geojson", "application/geo+json"},
                           Pair{".webmanifest", "application/manifest+json"},
                           Pair{".svg", "image/svg+xml"},
                           Pair{".png", "image/png"},
                           Pair{".ico", "image/x-icon"},
                           Pair{".pbf", "application/x-protobuf"},
                           Pair{".pmtiles", "application/vnd.pmtiles"},
                           Pair{".woff2", "font/woff2"},
                           Pair{".csv", "text/csv; charset=utf-8"},
                           Pair{".txt", "text/plain; charset=utf-8"}};

} // namespace

std::string_view media_type_of(const std::filesystem::path& file) {
    const auto suffix = file.extension().string();
    const auto* const found = std::ranges::find(types, suffix, &Pair::first);
    return found == types.end() ? "application/octet-stream" : found->second;
}

std::optional<HttpResponse> file_response(const std::filesystem::path& folder,
                                          std::string_view path) {
    auto file = folder;
    struct stat status {};
    auto rest = path.substr(1);
    while (!rest.empty()) {
        const auto name = rest.substr(0, rest.find('/'));
        rest.remove_prefix(std::min(name.size() + 1, rest.size()));
        if (name.empty() || name.starts_with('.') || name.find('\\') != std::string_view::npos) {
            return std::nullopt;
        }
        file /= name;
        if (lstat(file.c_str(), &status) != 0 || S_ISLNK(status.st_mode)) {
            return std::nullopt;
        }
    }
    if (path.ends_with('/')) {
        file /= "index.html";
    }
    if (lstat(file.c_str(), &status) != 0) {
        return std::nullopt;
    }
    if (S_ISDIR(status.st_mode) && !path.ends_with('/')) { // its links are relative to the slash
        HttpResponse moved{.status = 308, .type = "text/plain", .route = "file"};
        moved.headers.emplace_back("Location", percent_encoded(file.filename().string()) + "/");
        return moved;
    }
    if (!S_ISREG(status.st_mode)) {
        return std::nullopt;
    }
    auto open = std::make_shared<const HttpOpenFile>(file);
    if (open->number() < 0 || fstat(open->number(), &status) != 0 || !S_ISREG(status.st_mode)) {
        return std::nullopt;
    }
    return HttpResponse{
        .type = std::string{media_type_of(file)},
        .file = HttpFile{std::move(open), static_cast<std::uint64_t>(status.st_size)},
        .etag = fmt::format("{:x}-{:x}-{:x}",
                            status.st_ino,
                            status.st_size,
                            status.st_mtim.tv_sec * 1'000'000'000 + status.st_mtim.tv_nsec),
        .route = "file"};
}

} // namespace macadam
