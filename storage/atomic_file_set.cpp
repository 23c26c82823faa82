#include "storage/atomic_file_set.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

namespace macadam {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, const std::string& cause) {
    throw InputError{fmt::format("{}: cannot be written: {}", file.string(), cause)};
}

void sync(const fs::path& name, int flags, const fs::path& file) {
    const int descriptor = ::open(name.c_str(), flags | O_CLOEXEC);
    const bool done = descriptor >= 0 && ::fsync(descriptor) == 0;
    const int error = errno;
    if (descriptor >= 0) {
        ::close(descriptor);
    }
    if (!done) {
        fail(file, std::strerror(error));
    }
}

fs::path parent_of(const fs::path& file) {
    return file.has_parent_path() ? file.parent_path() : fs::path{"."};
}

/// Moves that can be taken back, the last first.
class Moves {
public:
    Moves() = default;
    Moves(const Moves&) = delete;
    Moves& operator=(const Moves&) = delete;
    ~Moves() {
        std::error_code ignored;
        for (auto move = moves_.rbegin(); move != moves_.rend(); ++move) {
            fs::rename(move->second, move->first, ignored);
        }
    }

    void move(const fs::path& from, const fs::path& to) {
        std::error_code error;
        fs::rename(from, to, error);
        if (error) {
            fail(to, error.message());
        }
        moves_.emplace_back(from, to);
    }

    void are_final() { moves_.clear(); }

private:
    std::vector<std::pair<fs::path, fs::path>> moves_;
};

} // namespace

AtomicFileSet::AtomicFileSet(fs::path main_file) : main_file_{std::move(main_file)} {
    folder_ = main_file_;
    folder_ += fmt::format(".part-{}", ::getpid());
    if (fs::is_directory(main_file_)) {
        fail(main_file_, std::strerror(EISDIR));
    }
    std::error_code error;
    fs::create_directory(folder_, error);
    if (error) {
        fail(main_file_, error.message());
    }
}

AtomicFileSet::~AtomicFileSet() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
}

void AtomicFileSet::commit(const std::vector<std::string>& stale) {
    const auto place = parent_of(main_file_);
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator{folder_}) {
        names.push_back(entry.path().filename().string());
    }
    std::ranges::sort(names);
    for (const auto& name : names) {
        sync(folder_ / name, O_RDONLY, place / name);
    }

    const auto before = folder_ / "before";
    fs::create_directory(before);
    Moves moves;
    const auto set_aside = [&](const std::string& name) {
        std::error_code none;
        const auto there = fs::symlink_status(place / name, none);
        if (fs::is_directory(there)) {
            fail(place / name, std::strerror(EISDIR));
        }
        if (fs::exists(there)) {
            moves.move(place / name, before / name);
        }
    };
    std::ranges::for_each(names, set_aside);
    std::ranges::for_each(stale, set_aside);
    for (const auto& name : names) {
        moves.move(folder_ / name, place / name);
    }
    moves.are_final();
    sync(place, O_RDONLY | O_DIRECTORY, main_file_);
}

} // namespace macadam
