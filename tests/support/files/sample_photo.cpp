#include "support/files/sample_photo.hpp"

#include "support/program/program.hpp"
#include "support/program/shell.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace macadam::testing {
namespace {

constexpr std::size_t start_bytes = 2; // of a JPEG, before its segments

/// TIFF structure of EXIF data, in the byte order of a camera.
class TiffWriter {
public:
    explicit TiffWriter(bool big_endian)
        : big_endian_{big_endian}, bytes_{big_endian ? "MM" : "II"} {
        put(42, 2);
        put(8, 4); // the first directory follows
    }

    /// Field of a directory: a value of at most four bytes, or the place of its bytes.
    struct Field {
        std::uint16_t tag, type;
        std::uint32_t count;
        std::string value;
    };

    void put(std::uint64_t number, int bytes) { bytes_ += text_of(number, bytes); }

    std::string text_of(std::uint64_t number, int bytes) const {
        std::string text;
        for (int i = 0; i < bytes; ++i) {
            const int shift = 8 * (big_endian_ ? bytes - 1 - i : i);
            text += static_cast<char>(number >> static_cast<unsigned>(shift));
        }
        return text;
    }

    /// \param room  bytes of directories that follow at once
    void put_directory(const std::vector<Field>& fields, std::size_t room) {
        constexpr std::size_t field_bytes = 12, frame_bytes = 6;
        const auto begin = bytes_.size();
        auto data_at = begin + frame_bytes + field_bytes * fields.size() + room;
        std::string data;
        put(fields.size(), 2);
        for (const auto& [tag, type, count, value] : fields) {
            put(tag, 2);
            put(type, 2);
            put(count, 4);
            if (value.size() <= 4) {
                bytes_ += value + std::string(4 - value.size(), '\0');
            } else {
                put(data_at + data.size(), 4);
                data += value;
            }
        }
        put(0, 4);
        bytes_.append(room, '\0');
        bytes_ += data;
    }

    std::size_t size() const { return bytes_.size(); }
    const std::string& bytes() const { return bytes_; }
    std::string& bytes() { return bytes_; }

private:
    bool big_endian_;
    std::string bytes_;
};

constexpr std::uint16_t ascii = 2, number_16 = 3, number_32 = 4, rational = 5;

std::string angle_of(const TiffWriter& tiff, double degrees, std::uint32_t denominator) {
    std::string value;
    const auto add = [&](double number, std::uint32_t of) {
        value += tiff.text_of(static_cast<std::uint64_t>(std::llround(number * of)), 4) +
                 tiff.text_of(of, 4);
    };
    degrees = std::abs(degrees);
    if (denominator > 0) {
        add(degrees, denominator);
        return value + std::string(16, '\0'); // 0/0 minutes and seconds
    }
    const double minutes = 60 * (degrees - std::floor(degrees));
    add(std::floor(degrees), 1);
    add(std::floor(minutes), 1);
    add(60 * (minutes - std::floor(minutes)), 10000);
    return value;
}

} // namespace

std::string exif_segment(const SampleExif& exif) {
    TiffWriter tiff{exif.big_endian};
    const auto letter = [](bool positive, char a, char b) {
        return std::string{positive ? a : b, '\0'};
    };
    const auto text = [](const std::string& of) { return of + '\0'; };
    // Directories in order: main, EXIF, GPS; each is laid at a place that is known beforehand.
    constexpr std::size_t exif_at = 400, gps_at = 600;
    std::vector<TiffWriter::Field> main{
        {0x0112, number_16, 1, tiff.text_of(exif.orientation, 2)},
        {0x013b, ascii, std::uint32_t(exif.artist.size() + 1), text(exif.artist)},
        {0x8769, number_32, 1, tiff.text_of(exif_at, 4)}};
    if (exif.at) {
        main.push_back({0x8825, number_32, 1, tiff.text_of(gps_at, 4)});
    }
    tiff.put_directory(main, 0);
    tiff.bytes().resize(exif_at, '\0');
    tiff.put_directory({{0x9003, ascii, std::uint32_t(exif.time.size() + 1), text(exif.time)}}, 0);
    if (exif.at) {
        tiff.bytes().resize(gps_at, '\0');
        tiff.put_directory(
            {{1, ascii, 2, letter(exif.at->lat_deg >= 0, 'N', 'S')},
             {2, rational, 3, angle_of(tiff, exif.at->lat_deg, exif.degree_denominator)},
             {3, ascii, 2, letter(exif.at->lon_deg >= 0, 'E', 'W')},
             {4, rational, 3, angle_of(tiff, exif.at->lon_deg, exif.degree_denominator)}},
            0);
    }
    const auto content = std::string{"Exif\0\0", 6} + tiff.bytes();
    const auto length = content.size() + 2;
    return std::string{"\xff\xe1"} + static_cast<char>(length >> 8U) +
           static_cast<char>(length & 0xffU) + content;
}

std::filesystem::path
write_photo(const std::filesystem::path& file,
            int width_px,
            int height_px,
            const std::function<std::array<std::uint8_t, 3>(int x, int y)>& colour,
            const std::optional<SampleExif>& exif,
            const std::string& more) {
    auto pixels = fmt::format("P6\n{} {}\n255\n", width_px, height_px);
    for (int y = 0; y < height_px; ++y) {
        for (int x = 0; x < width_px; ++x) {
            for (const auto value : colour(x, y)) {
                pixels += static_cast<char>(value);
            }
        }
    }
    const auto raw = file.parent_path() / "photo.ppm";
    write_file(raw, pixels);
    const auto said = output_of(
        file.parent_path(),
        fmt::format("gdal_translate -q -of JPEG {} '{}' '{}'", more, raw.string(), file.string()));
    std::filesystem::remove(raw);
    std::filesystem::remove(file.parent_path() / "output.txt");
    std::filesystem::remove(file.string() + ".aux.xml");
    auto jpeg = read_file(file);
    if (jpeg.size() < start_bytes) {
        throw std::runtime_error{"no photo was made: " + said};
    }
    if (exif) {
        jpeg.insert(start_bytes, exif_segment(*exif));
    }
    write_file(file, jpeg);
    return file;
}

std::filesystem::path write_photo_at(const std::filesystem::path& file, const GeoPoint& at) {
    const auto grey = [](int, int) { return std::array<std::uint8_t, 3>{128, 128, 128}; };
    return write_photo(file, 64, 48, grey, SampleExif{.at = at});
}

} // namespace macadam::testing
