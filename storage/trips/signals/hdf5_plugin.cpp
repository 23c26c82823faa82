#include "storage/trips/signals/hdf5_plugin.hpp"

#include "estimator/common/error.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <hdf5.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <new>
#include <utility>

namespace macadam {
namespace {

constexpr rlim_t max_cpu_s = 20;
constexpr int max_wait_ms = 30'000; // for more of the numbers; the process may be stuck
constexpr std::size_t longest_words = 4096;

/// Handle of the library, closed at its end.
class Handle {
public:
    Handle(hid_t id, herr_t (*close)(hid_t), const char* words) : id_{id}, close_{close} {
        if (id < 0) {
            throw InputError{words};
        }
    }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    ~Handle() { close_(id_); }
    operator hid_t() const {
        return id_;
    } // NOLINT(*-explicit-*): as the library's functions take it

private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

/// Opens a file in memory, without any way out of it.
Handle opened(std::string_view bytes) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    H5PLset_loading_state(0);         // no plug-ins
    H5Lunregister(H5L_TYPE_EXTERNAL); // no other files
    const Handle access{H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "not enough memory"};
    constexpr std::size_t step = 1 << 16;
    H5Pset_fapl_core(access, step, 0);
    std::string copy{bytes}; // the library takes it as it is
    H5Pset_file_image(access, copy.data(), copy.size());
    return {H5Fopen("in memory", H5F_ACC_RDONLY, access),
            H5Fclose,
            "is no HDF5 file, or damaged or truncated"};
}

void expect_safe_storage(hid_t dataset) {
    const Handle creation{H5Dget_create_plist(dataset), H5Pclose, "cannot be read"};
    const auto layout = H5Pget_layout(creation);
    if (layout != H5D_COMPACT && layout != H5D_CONTIGUOUS && layout != H5D_CHUNKED) {
        throw InputError{"has a virtual layout, expected numbers in this file"};
    }
    if (H5Pget_external_count(creation) != 0) {
        throw InputError{"is stored in another file, expected numbers in this file"};
    }
    const int filters = H5Pget_nfilters(creation);
    for (int i = 0; i < filters; ++i) {
        unsigned flags = 0;
        std::size_t values = 0;
        unsigned config = 0;
        const auto filter = H5Pget_filter2(
            creation, static_cast<unsigned>(i), &flags, &values, nullptr, 0, nullptr, &config);
        if (filter != H5Z_FILTER_DEFLATE && filter != H5Z_FILTER_SHUFFLE &&
            filter != H5Z_FILTER_FLETCHER32) {
            throw InputError{
                fmt::format("uses the filter {}, expected deflate, shuffle, fletcher32 "
                            "or none",
                            filter)};
        }
    }
}

void expect_numbers(hid_t dataset) {
    constexpr std::size_t largest = 8;
    const Handle type{H5Dget_type(dataset), H5Tclose, "cannot be read"};
    const auto kind = H5Tget_class(type);
    if ((kind != H5T_INTEGER && kind != H5T_FLOAT) || H5Tget_size(type) > largest) {
        throw InputError{"has no numbers, expected integers or floats"};
    }
}

Hdf5Dataset numbers_of(hid_t file, const std::string& name, std::size_t most) {
    constexpr int max_dimensions = 2;
    const Handle dataset{H5Dopen2(file, name.c_str(), H5P_DEFAULT),
                         H5Dclose,
                         "is not in the file (or in another one, which is not opened)"};
    expect_safe_storage(dataset);
    expect_numbers(dataset);
    const Handle space{H5Dget_space(dataset), H5Sclose, "cannot be read"};
    std::array<hsize_t, max_dimensions> size{0, 1};
    const int dimensions = H5Sget_simple_extent_ndims(space);
    if (H5Sget_simple_extent_type(space) != H5S_SIMPLE || dimensions < 1 ||
        dimensions > max_dimensions ||
        H5Sget_simple_extent_dims(space, size.data(), nullptr) != dimensions) {
        throw InputError{fmt::format("has {} dimensions, expected 1 or 2", dimensions)};
    }
    const auto limit = most / sizeof(double);
    if (size[1] == 0 || size[0] > limit / size[1]) {
        throw InputError{fmt::format("has {} rows of {} numbers, expected at most {} numbers in a "
                                     "file of this size",
                                     size[0],
                                     size[1],
                                     limit)};
    }
    Hdf5Dataset numbers{
        .rows = size[0], .columns = size[1], .values = std::vector<double>(size[0] * size[1])};
    if (!numbers.values.empty() &&
        H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.values.data()) <
            0) {
        throw InputError{"cannot be read: its data are damaged"};
    }
    return numbers;
}

// ------------------------------------------------------------------- between the two processes

bool send(int to, const void* from, std::size_t size) {
    const auto* at = static_cast<const char*>(from);
    while (size > 0) {
        const auto count = ::write(to, at, size);
        if (count < 0 && errno != EINTR) {
            return false;
        }
        at += std::max<ssize_t>(count, 0);
        size -= static_cast<std::size_t>(std::max<ssize_t>(count, 0));
    }
    return true;
}

bool receive(int from, void* into, std::size_t size) {
    auto* at = static_cast<char*>(into);
    while (size > 0) {
        pollfd ready{.fd = from, .events = POLLIN, .revents = 0};
        if (::poll(&ready, 1, max_wait_ms) == 0) {
            return false;
        }
        const auto count = ::read(from, at, size);
        if (count == 0 || (count < 0 && errno != EINTR)) {
            return false;
        }
        at += std::max<ssize_t>(count, 0);
        size -= static_cast<std::size_t>(std::max<ssize_t>(count, 0));
    }
    return true;
}

/// Sent before the numbers of a dataset, or before words.
struct Message {
    std::uint64_t rows;
    std::uint64_t columns; ///< 0: `rows` bytes of words follow, a refusal
};

void send_words(int to, std::string_view words) {
    words = words.substr(0, longest_words);
    const Message message{.rows = words.size(), .columns = 0};
    send(to, &message, sizeof message);
    send(to, words.data(), words.size());
}

void run_child(std::string_view bytes,
               std::span<const std::string> datasets,
               std::size_t most,
               int to) {
    for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGINT, SIGTERM}) {
        std::signal(signal, SIG_DFL); // handlers of the program are not for this process
    }
    const rlimit cpu{max_cpu_s, max_cpu_s};
    const rlimit none{0, 0};
    setrlimit(RLIMIT_CPU, &cpu);
    setrlimit(RLIMIT_CORE, &none);
    std::string name;
    try {
        const auto file = opened(bytes);
        for (const auto& dataset : datasets) {
            name = fmt::format("dataset '{}': ", dataset);
            const auto numbers = numbers_of(file, dataset, most);
            most -= numbers.values.size() * sizeof(double);
            const Message message{.rows = numbers.rows, .columns = numbers.columns};
            send(to, &message, sizeof message);
            send(to, numbers.values.data(), numbers.values.size() * sizeof(double));
        }
    } catch (const std::exception& error) {
        send_words(to, name + error.what());
    }
}

/// Child process, and the end of the pipe from it; it does not outlive this object.
class Child {
public:
    Child(pid_t process, int pipe_end) : from{pipe_end}, process_{process} {}
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child() {
        ::close(from);
        ::kill(process_, SIGKILL);
        while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
        }
    }

    const int from;

private:
    pid_t process_;
};

[[noreturn]] void refuse_crash(const std::string& dataset) {
    throw InputError{
        fmt::format("dataset '{}': the HDF5 library cannot read it: the file is damaged", dataset)};
}

Hdf5Dataset received(int from, const std::string& dataset, std::size_t most) {
    Message message{};
    if (!receive(from, &message, sizeof message)) {
        refuse_crash(dataset);
    }
    if (message.columns == 0) {
        std::string words(std::min<std::uint64_t>(message.rows, longest_words), '\0');
        receive(from, words.data(), words.size());
        throw InputError{words};
    }
    if (message.rows > most / sizeof(double) / message.columns) {
        refuse_crash(dataset);
    }
    Hdf5Dataset numbers{.rows = message.rows,
                        .columns = message.columns,
                        .values = std::vector<double>(message.rows * message.columns)};
    if (!receive(from, numbers.values.data(), numbers.values.size() * sizeof(double))) {
        refuse_crash(dataset);
    }
    return numbers;
}

} // namespace
} // namespace macadam

extern "C" void macadam_hdf5_read(std::string_view bytes,
                                  std::span<const std::string> datasets,
                                  std::size_t most,
                                  const std::function<void(macadam::Hdf5Dataset)>& take) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
        throw macadam::InputError{"cannot be read: no more files can be open"};
    }
    const auto process = ::fork();
    if (process < 0) {
        ::close(ends[0]);
        ::close(ends[1]);
        throw macadam::InputError{"cannot be read: no more processes can run"};
    }
    if (process == 0) {
        ::close(ends[0]);
        macadam::run_child(bytes, datasets, most, ends[1]);
        ::_exit(0);
    }
    ::close(ends[1]);
    const macadam::Child child{process, ends[0]};
    for (const auto& dataset : datasets) {
        auto numbers = macadam::received(child.from, dataset, most);
        most -= numbers.values.size() * sizeof(double);
        take(std::move(numbers));
    }
}
