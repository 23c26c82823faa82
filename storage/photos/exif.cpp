#include "storage/photos/exif.hpp"

#include <libexif/exif-data.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <memory>
#include <string_view>

namespace macadam {
namespace {

using Exif = std::unique_ptr<ExifData, decltype(&exif_data_unref)>;

const ExifEntry* entry_of(const ExifData& exif, ExifIfd directory, unsigned tag) {
    return exif_content_get_entry(exif.ifd[directory], static_cast<ExifTag>(tag));
}

/// Returns degrees, of which minutes and seconds are parts; NaN if the entry is damaged.
double degrees_in(const ExifEntry& entry, ExifByteOrder order) {
    constexpr std::size_t parts = 3;
    constexpr std::size_t bytes = 8; // of a rational number
    double degrees = 0, unit = 1;
    if (entry.format != EXIF_FORMAT_RATIONAL || entry.components != parts ||
        entry.size < parts * bytes) {
        return std::nan("");
    }
    for (std::size_t i = 0; i < parts; ++i, unit /= 60) {
        const auto [numerator, denominator] = exif_get_rational(entry.data + i * bytes, order);
        if (numerator != 0) { // some cameras write 0/0 for no seconds
            degrees += unit * numerator / denominator;
        }
    }
    return degrees;
}

/// Returns an angle with its sign, by the letter beside it; NaN if it is missing or damaged.
double signed_degrees(const ExifData& exif,
                      ExifByteOrder order,
                      unsigned tag,
                      unsigned letter_tag,
                      std::string_view letters) {
    const auto* const angle = entry_of(exif, EXIF_IFD_GPS, tag);
    const auto* const letter = entry_of(exif, EXIF_IFD_GPS, letter_tag);
    if (angle == nullptr || letter == nullptr || letter->size == 0) {
        return std::nan("");
    }
    const auto found = letters.find(static_cast<char>(letter->data[0]));
    return found == letters.npos ? std::nan("") : degrees_in(*angle, order) * (found == 0 ? 1 : -1);
}

std::optional<GeoPoint> position_of(const ExifData& exif, ExifByteOrder order) {
    const GeoPoint at{
        signed_degrees(exif, order, EXIF_TAG_GPS_LATITUDE, EXIF_TAG_GPS_LATITUDE_REF, "NS"),
        signed_degrees(exif, order, EXIF_TAG_GPS_LONGITUDE, EXIF_TAG_GPS_LONGITUDE_REF, "EW")};
    const bool on_the_globe = std::abs(at.lat_deg) <= 90 && std::abs(at.lon_deg) <= 180;
    return on_the_globe ? std::optional{at} : std::nullopt; // NaN is not
}

/// Returns the day of a time, "2026:03:12 10:11:12"; "" for what is none.
std::string day_in(const ExifEntry* entry) {
    constexpr std::string_view form = "dddd:dd:dd";
    if (entry == nullptr || entry->format != EXIF_FORMAT_ASCII || entry->size < form.size()) {
        return {};
    }
    std::string day{entry->data, entry->data + form.size()};
    const bool fits = std::ranges::equal(day, form, [](char c, char like) {
        return like == 'd' ? std::isdigit(static_cast<unsigned char>(c)) != 0 : c == like;
    });
    if (!fits) {
        return {};
    }
    std::ranges::replace(day, ':', '-');
    const auto number = [&](std::size_t at) {
        int value = 0;
        std::from_chars(day.data() + at, day.data() + at + 2, value);
        return value;
    };
    const bool is_day = 1 <= number(5) && number(5) <= 12 && 1 <= number(8) && number(8) <= 31;
    return is_day ? day : std::string{};
}

int orientation_in(const ExifEntry* entry, ExifByteOrder order) {
    if (entry == nullptr || entry->format != EXIF_FORMAT_SHORT || entry->size < 2) {
        return 1;
    }
    const int value = exif_get_short(entry->data, order);
    return 1 <= value && value <= 8 ? value : 1;
}

} // namespace

ExifValues read_exif(const std::string& head) {
    const Exif exif{exif_data_new(), exif_data_unref};
    ExifValues values;
    if (!exif) {
        return values;
    }
    exif_data_unset_option(exif.get(), EXIF_DATA_OPTION_FOLLOW_SPECIFICATION); // read, not mended
    exif_data_load_data(
        exif.get(),
        reinterpret_cast<const unsigned char*>(head.data()), // NOLINT(*-reinterpret-cast)
        static_cast<unsigned>(head.size()));
    const auto order = exif_data_get_byte_order(exif.get());
    values.at = position_of(*exif, order);
    values.day = day_in(entry_of(*exif, EXIF_IFD_EXIF, EXIF_TAG_DATE_TIME_ORIGINAL));
    values.orientation = orientation_in(entry_of(*exif, EXIF_IFD_0, EXIF_TAG_ORIENTATION), order);
    return values;
}

} // namespace macadam
