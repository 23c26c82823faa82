#include "storage/trips/signals/hdf5_process.hpp"

#include "estimator/common/error.hpp"

#include <fmt/core.h>
#include <hdf5.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <exception>
#include <limits>
#include <string>
#include <string_view>

// The program that reads HDF5, and the one place that opens it: the library was not made for
// hostile files, so it runs where its crash is a refusal. Arguments: bytes that all numbers may
// take, and the datasets; standard input: the file; standard output: what hdf5_process.hpp says.

namespace macadam {
namespace {

constexpr rlim_t max_cpu_s = 20;
constexpr rlim_t own_bytes = rlim_t{1} << 30; // addresses of the program and its libraries

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

void send(const void* from, std::size_t size) {
    const auto* at = static_cast<const char*>(from);
    while (size > 0) {
        const auto count = ::write(STDOUT_FILENO, at, size);
        if (count < 0 && errno != EINTR) {
            ::_exit(1);
        }
        at += std::max<ssize_t>(count, 0);
        size -= static_cast<std::size_t>(std::max<ssize_t>(count, 0));
    }
}

void set_limits([[maybe_unused]] std::size_t file_bytes, [[maybe_unused]] std::size_t most) {
    const rlimit cpu{max_cpu_s, max_cpu_s};
    const rlimit none{0, 0};
    setrlimit(RLIMIT_CPU, &cpu);
    setrlimit(RLIMIT_CORE, &none);
#ifndef __SANITIZE_ADDRESS__ // which takes terabytes of addresses
    const rlim_t bytes = own_bytes + 4 * file_bytes + 2 * most;
    const rlimit addresses{bytes, bytes};
    setrlimit(RLIMIT_AS, &addresses);
#endif
}

/// The file on standard input, in memory until the process ends.
std::string_view file_on_input() {
    struct stat status {};
    if (::fstat(STDIN_FILENO, &status) != 0 || status.st_size <= 0) {
        throw InputError{"is empty"};
    }
    const auto size = static_cast<std::size_t>(status.st_size);
    const void* const bytes = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, STDIN_FILENO, 0);
    if (bytes == MAP_FAILED) {
        throw InputError{"cannot be read: no memory"};
    }
    return {static_cast<const char*>(bytes), size};
}

void send_datasets(int count, char** arguments) {
    std::string name;
    try {
        std::size_t most = 0;
        const std::string_view limit = count > 1 ? arguments[1] : "";
        std::from_chars(limit.data(), limit.data() + limit.size(), most);
        const auto bytes = file_on_input();
        set_limits(bytes.size(), most);
        const auto file = opened(bytes);
        for (int i = 2; i < count; ++i) {
            name = fmt::format("dataset '{}': ", arguments[i]);
            const auto numbers = numbers_of(file, arguments[i], most);
            most -= numbers.values.size() * sizeof(double);
            const Hdf5Message message{.rows = numbers.rows, .columns = numbers.columns};
            send(&message, sizeof message);
            send(numbers.values.data(), numbers.values.size() * sizeof(double));
        }
    } catch (const std::exception& error) {
        const auto words = (name + error.what()).substr(0, max_hdf5_words);
        const Hdf5Message message{.rows = words.size(), .columns = 0};
        send(&message, sizeof message);
        send(words.data(), words.size());
    }
}

} // namespace
} // namespace macadam

int main(int count, char** arguments) {
    macadam::send_datasets(count, arguments);
    return 0;
}
