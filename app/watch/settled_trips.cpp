#include "app/watch/settled_trips.hpp"

#include "storage/trips/positions/position_files.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace macadam {
namespace {

namespace fs = std::filesystem;

/// Tests for the end row of a plain log, "# end rows: N", in its last bytes.
bool has_end_row(const fs::path& log) {
    constexpr std::streamoff enough = 256;
    std::ifstream in{log, std::ios::binary};
    in.seekg(0, std::ios::end);
    in.seekg(-std::min<std::streamoff>(enough, in.tellg()), std::ios::end);
    std::string end(static_cast<std::size_t>(enough), '\0');
    in.read(end.data(), enough);
    end.resize(static_cast<std::size_t>(in.gcount()));
    return end.find("# end rows:") != std::string::npos;
}

/// Tests whether a program of this machine has the file open for writing: then the kernel refuses
/// a read lease. False also if it cannot be told, as of another user's file or a network folder.
bool is_being_written(const fs::path& file) {
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) {
        return false;
    }
    // A writer that comes while the lease is held would end this program by SIGIO.
    ::fcntl(descriptor, F_SETSIG, SIGURG);
    const bool is_refused = ::fcntl(descriptor, F_SETLEASE, F_RDLCK) < 0 && errno == EAGAIN;
    ::fcntl(descriptor, F_SETLEASE, F_UNLCK);
    ::close(descriptor);
    return is_refused;
}

bool holds_file_being_written(const fs::path& trip) {
    std::error_code gone;
    if (!fs::is_directory(trip, gone)) {
        return fs::is_regular_file(trip, gone) && is_being_written(trip);
    }
    for (fs::recursive_directory_iterator file{trip, gone}, end; !gone && file != end;
         file.increment(gone)) {
        if (file->is_regular_file(gone) && is_being_written(file->path())) {
            return true;
        }
    }
    return false;
}

} // namespace

SettledTrips::SettledTrips(fs::path folder, TripWalkConfig config)
    : folder_{std::move(folder)}, config_{std::move(config)} {}

SettledTrips::Version SettledTrips::version_of(const fs::path& trip) {
    std::error_code gone;
    Version version;
    if (fs::is_symlink(trip, gone) && !fs::exists(trip, gone)) {
        version.changed = {}; // a link without a target is there, to be reported
        return version;
    }
    const auto add = [&](const fs::path& file) {
        const auto bytes = fs::file_size(file, gone);
        version.bytes += gone ? 0 : bytes;
        const auto changed = fs::last_write_time(file, gone);
        version.changed = gone ? version.changed : std::max(version.changed, changed);
    };
    if (fs::is_directory(trip, gone)) { // the export of a phone
        for (fs::recursive_directory_iterator file{trip, gone}, end; !gone && file != end;
             file.increment(gone)) {
            add(file->path());
        }
    } else {
        add(trip);
        if (const auto positions = positions_beside(trip)) { // which may come later
            add(*positions);
        }
    }
    return version;
}

bool SettledTrips::is_complete(const fs::path& trip,
                               const Candidate& candidate,
                               Clock::time_point now) const {
    if (candidate.version == Version{}) {
        return false; // it vanished meanwhile
    }
    Clock::duration age = now - candidate.since;
    if (is_first_look_) { // later, an old time of change may be that of a copy in progress
        age = std::max<Clock::duration>(
            age, fs::file_time_type::clock::now() - candidate.version.changed);
    }
    if (trip.filename().string().ends_with(".trip.csv")) {
        return has_end_row(trip) ? candidate.is_closed || age >= settling : age >= end_row_wait;
    }
    return age >= (candidate.has_changed ? settling_after_change : settling) &&
           !holds_file_being_written(trip);
}

std::vector<fs::path> SettledTrips::take(const std::set<fs::path>& closed, Clock::time_point now) {
    std::map<fs::path, Candidate> found;
    std::vector<fs::path> complete;
    has_incomplete_ = false;
    for (const auto& trip : TripWalk{folder_, config_}.files()) {
        const auto before = candidates_.find(trip);
        Candidate candidate{.version = version_of(trip), .since = now};
        if (before != candidates_.end()) {
            const bool is_same = before->second.version == candidate.version;
            candidate.has_changed = true;
            candidate = is_same ? before->second : candidate;
        }
        candidate.is_closed = candidate.is_closed || closed.contains(trip);
        if (!candidate.is_taken) {
            candidate.is_taken = is_complete(trip, candidate, now);
            if (candidate.is_taken) {
                complete.push_back(trip);
            } else {
                has_incomplete_ = true;
            }
        }
        found.insert_or_assign(trip, candidate);
    }
    candidates_ = std::move(found);
    is_first_look_ = false;
    return complete;
}

} // namespace macadam
