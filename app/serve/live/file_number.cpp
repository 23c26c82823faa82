#include "app/serve/live/file_number.hpp"

#include <fcntl.h>
#include <sys/stat.h>

namespace macadam {

std::uint64_t file_number(const std::filesystem::path& file) {
    struct statx status {};
    if (statx(AT_FDCWD, file.c_str(), 0, STATX_INO | STATX_BTIME, &status) != 0) {
        return 0;
    }
    std::uint64_t number = status.stx_ino;
    if ((status.stx_mask & STATX_BTIME) != 0) { // the inode may be that of a file before
        constexpr std::uint64_t spread = 0x9e3779b97f4a7c15U; // odd: different times stay different
        number = (number ^ static_cast<std::uint64_t>(status.stx_btime.tv_sec) * spread) * spread +
                 status.stx_btime.tv_nsec;
    }
    return number == 0 ? 1 : number;
}

} // namespace macadam
