#include "storage/atomic/unfinished_files.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <climits>
#include <cstdint>
#include <string_view>

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace macadam {
namespace {

/// Slot for a name. `turn` is odd while the name is valid and changes with the name, so that a
/// signal handler never combines halves of two names.
struct Slot {
    std::atomic<bool> is_taken;
    std::atomic<std::uint32_t> turn;
    std::atomic<pid_t> owner; ///< a forked process inherits names that it does not own
    std::array<char, PATH_MAX> name;
};

constexpr std::size_t slot_count = 32; // names beyond this limit are not removed
std::array<Slot, slot_count> slots;

static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

/// Directory entry of the kernel, getdents64(2); readdir() would allocate.
struct Entry {
    std::uint64_t inode;
    std::int64_t offset;
    std::uint16_t size;
    unsigned char type;
    char name[1]; ///< variable length
};

constexpr int deepest = 8; // levels of folders; tiles need three

bool remove_all(int at, const char* name, int depth);

/// Makes one pass over the entries of an open folder. \returns whether any was removed.
bool remove_entries(int folder, int depth) {
    alignas(Entry) std::array<char, 4096> block{};
    bool any_went = false;
    ::lseek(folder, 0, SEEK_SET);
    long size = 0;
    while ((size = ::syscall(SYS_getdents64, folder, block.data(), block.size())) > 0) {
        for (long i = 0; i < size;) {
            const auto* const entry = reinterpret_cast<const Entry*>(block.data() + i);
            const std::string_view inner{entry->name};
            if (inner != "." && inner != "..") {
                any_went = remove_all(folder, entry->name, depth) || any_went;
            }
            i += entry->size;
        }
    }
    return any_went;
}

/// Removes a file or folder without following links. \param name  in the open folder `at`
bool remove_all(int at, const char* name, int depth) {
    if (::unlinkat(at, name, 0) == 0) {
        return true;
    }
    const int folder =
        depth < deepest ? ::openat(at, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC) : -1;
    if (folder < 0) {
        return false;
    }
    while (remove_entries(folder, depth + 1)) { // entries may be skipped while others are removed
    }
    ::close(folder);
    return ::unlinkat(at, name, AT_REMOVEDIR) == 0;
}

} // namespace

RemovedIfCutOff::RemovedIfCutOff(const std::filesystem::path& name) : slot_{-1} {
    std::error_code ignored;
    const auto text = std::filesystem::absolute(name, ignored).string();
    for (std::size_t i = 0; i < slots.size() && text.size() < PATH_MAX && !ignored; ++i) {
        auto& slot = slots[i];
        if (slot.is_taken.exchange(true)) {
            continue;
        }
        std::ranges::copy(text, slot.name.begin());
        slot.name[text.size()] = '\0';
        slot.owner = ::getpid();
        ++slot.turn;
        slot_ = static_cast<int>(i);
        return;
    }
}

void RemovedIfCutOff::release() {
    if (slot_ >= 0) {
        auto& slot = slots[static_cast<std::size_t>(slot_)];
        ++slot.turn;
        slot.is_taken = false;
        slot_ = -1;
    }
}

void remove_unfinished() noexcept {
    static std::array<char, PATH_MAX> name; // only one signal handler runs at a time
    for (auto& slot : slots) {
        const auto turn = slot.turn.load();
        if (turn % 2 == 0 || slot.owner != ::getpid()) {
            continue;
        }
        name = slot.name;
        if (slot.turn.load() == turn) {
            remove_all(AT_FDCWD, name.data(), 0);
        }
    }
}

} // namespace macadam
