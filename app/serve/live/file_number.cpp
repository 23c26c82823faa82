#include "app/serve/live/file_number.hpp"

#include <sys/stat.h>

namespace macadam {

std::uint64_t file_number(const std::filesystem::path& file) {
    struct stat status {};
    return stat(file.c_str(), &status) == 0 ? status.st_ino : 0;
}

} // namespace macadam
