#include "app/export/site_folder.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <fstream>
#include <system_error>

namespace macadam {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file) {
    throw InputError{fmt::format("{}: cannot be written", file.string())};
}

} // namespace

void SiteFolder::write(const std::filesystem::path& name,
                       std::string_view text,
                       std::ios::openmode mode) const {
    const auto file = place / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream out{file, std::ios::binary | mode};
    out << text << std::flush;
    if (!out) {
        fail(shown / name);
    }
}

bool SiteFolder::take(const std::filesystem::path& file, const std::filesystem::path& name) const {
    std::error_code failed;
    std::filesystem::create_directories((place / name).parent_path());
    std::filesystem::create_hard_link(file, place / name, failed);
    if (failed == std::errc::no_such_file_or_directory) {
        return false;
    }
    if (failed) { // a file system without links
        std::filesystem::copy_file(file, place / name, failed);
    }
    if (failed) {
        fail(shown / name);
    }
    return true;
}

} // namespace macadam
