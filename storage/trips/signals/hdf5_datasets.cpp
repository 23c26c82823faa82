#include "storage/trips/signals/hdf5_datasets.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/plugin_library.hpp"
#include "storage/trips/signals/hdf5_process.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <iterator>
#include <utility>

namespace macadam {
namespace {

constexpr int max_wait_ms = 30'000;

/// Descriptor that is closed at its end.
class Descriptor {
public:
    explicit Descriptor(int number) : number_{number} {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() { close(); }

    void close() {
        if (number_ >= 0) {
            ::close(std::exchange(number_, -1));
        }
    }
    int number() const { return number_; }

private:
    int number_;
};

/// File without a name that holds the bytes.
int file_in_memory(std::string_view bytes) {
    const int file = ::memfd_create("macadam_hdf5", MFD_CLOEXEC);
    while (file >= 0 && !bytes.empty()) {
        const auto count = ::write(file, bytes.data(), bytes.size());
        if (count <= 0 && errno != EINTR) {
            ::close(file);
            return -1;
        }
        bytes.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    }
    return file;
}

/// The process that reads a file, and the pipe from it. It does not outlive this object.
class Hdf5Process {
public:
    Hdf5Process(std::string_view bytes, std::span<const std::string> datasets, std::size_t most)
        : file_{file_in_memory(bytes)} {
        std::array<int, 2> ends{-1, -1};
        if (file_.number() < 0 || ::pipe2(ends.data(), O_CLOEXEC) != 0) {
            throw InputError{"cannot be read: no memory, or no more files can be open"};
        }
        from_ = ends[0];
        Descriptor to{ends[1]};
        start(to.number(), datasets, most);
    }
    Hdf5Process(const Hdf5Process&) = delete;
    Hdf5Process& operator=(const Hdf5Process&) = delete;
    ~Hdf5Process() {
        ::close(from_);
        if (process_ > 0) {
            ::kill(process_, SIGKILL);
            while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
            }
        }
    }

    bool receive(void* into, std::size_t size) const {
        auto* at = static_cast<char*>(into);
        while (size > 0) {
            pollfd ready{.fd = from_, .events = POLLIN, .revents = 0};
            if (::poll(&ready, 1, max_wait_ms) == 0) {
                return false;
            }
            const auto count = ::read(from_, at, size);
            if (count == 0 || (count < 0 && errno != EINTR)) {
                return false;
            }
            at += std::max<ssize_t>(count, 0);
            size -= static_cast<std::size_t>(std::max<ssize_t>(count, 0));
        }
        return true;
    }

private:
    void start(int to, std::span<const std::string> datasets, std::size_t most) {
        auto program = plugin_path("macadam_hdf5");
        auto limit = fmt::format("{}", most);
        std::vector<std::string> names{datasets.begin(), datasets.end()};
        std::vector<char*> arguments{program.data(), limit.data()};
        std::ranges::transform(
            names, std::back_inserter(arguments), [](std::string& name) { return name.data(); });
        arguments.push_back(nullptr);
        std::array<char*, 1> environment{nullptr};

        posix_spawn_file_actions_t files;
        posix_spawnattr_t signals;
        sigset_t ended_by;
        sigfillset(&ended_by);
        posix_spawn_file_actions_init(&files);
        posix_spawn_file_actions_adddup2(&files, file_.number(), STDIN_FILENO);
        posix_spawn_file_actions_adddup2(&files, to, STDOUT_FILENO);
        posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
        posix_spawnattr_init(&signals);
        posix_spawnattr_setsigdefault(&signals, &ended_by);
        posix_spawnattr_setflags(&signals, POSIX_SPAWN_SETSIGDEF);
        const int error = ::posix_spawn(
            &process_, program.c_str(), &files, &signals, arguments.data(), environment.data());
        posix_spawnattr_destroy(&signals);
        posix_spawn_file_actions_destroy(&files);
        if (error != 0) {
            process_ = -1;
            ::close(from_);
            throw InputError{fmt::format("cannot be read: '{}' does not start", program)};
        }
    }

    Descriptor file_;
    int from_ = -1;
    pid_t process_ = -1;
};

[[noreturn]] void refuse_crash(const std::string& dataset) {
    throw InputError{
        fmt::format("dataset '{}': the HDF5 library cannot read it: the file is damaged", dataset)};
}

Hdf5Dataset received(const Hdf5Process& process, const std::string& dataset, std::size_t most) {
    Hdf5Message message{};
    if (!process.receive(&message, sizeof message)) {
        refuse_crash(dataset);
    }
    if (message.columns == 0) {
        std::string words(std::min<std::uint64_t>(message.rows, max_hdf5_words), '\0');
        process.receive(words.data(), words.size());
        throw InputError{words};
    }
    if (message.rows > most / sizeof(double) / message.columns) {
        refuse_crash(dataset);
    }
    Hdf5Dataset numbers{.rows = message.rows,
                        .columns = message.columns,
                        .values = std::vector<double>(message.rows * message.columns)};
    if (!process.receive(numbers.values.data(), numbers.values.size() * sizeof(double))) {
        refuse_crash(dataset);
    }
    return numbers;
}

} // namespace

std::vector<Hdf5Dataset> read_hdf5_datasets(std::string_view bytes,
                                            std::span<const std::string> datasets,
                                            std::size_t most) {
    const Hdf5Process process{bytes, datasets, most};
    std::vector<Hdf5Dataset> read;
    for (const auto& dataset : datasets) {
        read.push_back(received(process, dataset, most));
        most -= read.back().values.size() * sizeof(double);
    }
    return read;
}

} // namespace macadam
