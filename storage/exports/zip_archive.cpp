#include "storage/exports/zip_archive.hpp"

#include <cassert>
#include <cstdint>
#include <initializer_list>
#include <limits>

#include <zlib.h>

namespace macadam {
namespace {

/// Little-endian number of so many bytes.
struct Field {
    std::size_t value;
    int bytes;
};

std::string record(std::initializer_list<Field> fields) {
    std::string bytes;
    for (auto [value, count] : fields) {
        for (; count > 0; --count, value >>= 8U) {
            bytes += static_cast<char>(value & 0xffU);
        }
    }
    return bytes;
}

} // namespace

std::string zip_archive(std::string_view name, std::string_view content) {
    assert(name.size() <= std::numeric_limits<std::uint16_t>::max());
    assert(content.size() < std::numeric_limits<std::uint32_t>::max());
    constexpr Field version{20, 2};     // 2.0
    constexpr Field flags{0x0800, 2};   // names in UTF-8
    constexpr Field stored{0, 2};       // not compressed
    constexpr Field midnight{0, 2};     // MS-DOS time
    constexpr Field first_day{0x21, 2}; // MS-DOS date: 1980-01-01
    const Field crc{crc32_z(0, reinterpret_cast<const Bytef*>(content.data()), content.size()), 4};
    const Field size{content.size(), 4};
    const Field name_size{name.size(), 2};
    std::string archive = record({{0x04034b50, 4},
                                  version,
                                  flags,
                                  stored,
                                  midnight,
                                  first_day,
                                  crc,
                                  size,
                                  size,
                                  name_size,
                                  {0, 2}});
    archive.append(name).append(content);
    const auto directory_at = archive.size();
    archive += record({{0x02014b50, 4},
                       version,
                       version,
                       flags,
                       stored,
                       midnight,
                       first_day,
                       crc,
                       size,
                       size,
                       name_size,
                       {0, 2},
                       {0, 2},
                       {0, 2},
                       {0, 2}, // no extras, first disk
                       {0, 4},
                       {0, 4}}); // attributes, offset
    archive.append(name);
    const auto directory_bytes = archive.size() - directory_at;
    return archive + record({{0x06054b50, 4},
                             {0, 2},
                             {0, 2},
                             {1, 2},
                             {1, 2},
                             {directory_bytes, 4},
                             {directory_at, 4},
                             {0, 2}});
}

} // namespace macadam
