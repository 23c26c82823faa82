#include "storage/networks/network_file.hpp"

#include "estimator/common/error.hpp"
#include "mapping/network/image/network_image.hpp"
#include "storage/atomic/atomic_file.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <memory>
#include <utility>

namespace macadam {
namespace {

[[noreturn]] void cannot_read(const std::filesystem::path& file, int error) {
    throw InputError{fmt::format("{}: cannot be read: {}", file.string(), std::strerror(error))};
}

class Descriptor {
public:
    explicit Descriptor(const std::filesystem::path& file)
        : number_{::open(file.c_str(), O_RDONLY | O_CLOEXEC)} {
        if (number_ < 0) {
            cannot_read(file, errno);
        }
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() { ::close(number_); }

    int number() const { return number_; }

private:
    int number_;
};

/// Read-only memory map of a file, valid during its lifetime even if the file is removed.
class MappedFile {
public:
    explicit MappedFile(const std::filesystem::path& file) {
        const Descriptor descriptor{file};
        struct stat status {};
        if (::fstat(descriptor.number(), &status) != 0) {
            cannot_read(file, errno);
        }
        if (!S_ISREG(status.st_mode)) {
            throw InputError{fmt::format("{}: is not a file", file.string())};
        }
        if (status.st_size == 0) {
            return;
        }
        size_ = static_cast<std::size_t>(status.st_size);
        start_ =
            ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE | MAP_POPULATE, descriptor.number(), 0);
        if (start_ == MAP_FAILED) {
            cannot_read(file, errno);
        }
    }
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;
    ~MappedFile() {
        if (size_ > 0) {
            ::munmap(start_, size_);
        }
    }

    std::span<const std::byte> bytes() const {
        return {static_cast<const std::byte*>(start_), size_};
    }

private:
    void* start_ = nullptr;
    std::size_t size_ = 0;
};

std::string_view text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

} // namespace

void write_network_file(const RoadNetwork& roads,
                        std::string_view source,
                        const std::filesystem::path& file) {
    static constexpr std::array<char, image_alignment> zeros{};
    const auto image = image_of(roads, source);
    AtomicFile whole{file};
    whole.write(image.head);
    for (const auto& section : image.sections) {
        const auto beyond = section.size() % image_alignment;
        whole.write(text_of(section));
        whole.write({zeros.data(), beyond == 0 ? 0 : image_alignment - beyond});
    }
    whole.commit();
}

NetworkFile open_network_file(const std::filesystem::path& file) {
    const auto mapped = std::make_shared<const MappedFile>(file);
    try {
        auto content = network_in(mapped->bytes(), mapped);
        return {std::move(content.roads), std::move(content.source)};
    } catch (const InputError& error) {
        throw InputError{fmt::format("{}: {}", file.string(), error.what())};
    }
}

bool is_network_file(const std::filesystem::path& file) {
    std::array<char, image_alignment> start{};
    std::ifstream in{file, std::ios::binary};
    in.read(start.data(), start.size());
    return begins_as_image(
        std::as_bytes(std::span{start}).first(static_cast<std::size_t>(in.gcount())));
}

std::filesystem::path network_file_of(const std::filesystem::path& store) {
    auto name = store;
    name += "-network";
    return name;
}

RoadNetwork load_or_build_network(const StoreReader& store,
                                  const std::function<void(const std::string&)>& warn) {
    const auto file = network_file_of(store.file());
    try {
        auto kept = open_network_file(file);
        if (kept.source == store.network_hash() &&
            kept.roads.segment_length_m == store.settings().segment_length_m) {
            return std::move(kept.roads);
        }
    } catch (const InputError& error) {
        std::error_code unseen;
        if (warn && std::filesystem::exists(file, unseen)) {
            warn(fmt::format("{}; its roads are read from the database instead", error.what()));
        }
    }
    auto roads = store.roads();
    cache_network(store, roads);
    return roads;
}

bool cache_network(const StoreReader& store, const RoadNetwork& roads) {
    constexpr std::size_t digits = 64;
    const auto source = store.network_hash();
    if (source.size() != digits) { // the database was modified
        return false;
    }
    try {
        write_network_file(roads, source, network_file_of(store.file()));
        return true;
    } catch (const InputError&) {
        return false;
    }
}

} // namespace macadam
