#include "storage/photos/photo_file.hpp"

#include "estimator/common/error.hpp"
#include "support/files/sample_photo.hpp"
#include "support/program/program.hpp"
#include "support/program/shell.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <functional>
#include <vector>

#include <sys/stat.h>

namespace macadam {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::EndsWith;
using testing::fresh_folder;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::read_file;
using testing::SampleExif;
using testing::write_file;
using testing::write_photo;

constexpr GeoPoint krems{48.410034, 15.602053};
constexpr double a_centimetre_deg = 1e-7;

std::array<std::uint8_t, 3> grey(int /*x*/, int /*y*/) {
    return {128, 128, 128};
}

std::string refusal(const std::function<void()>& of) {
    try {
        of();
    } catch (const InputError& error) {
        return error.what();
    }
    return "none";
}

/// A photo whose bytes after its EXIF data are changed.
class Photo : public ::testing::Test {
protected:
    fs::path photo(const SampleExif& exif = {.at = krems}) const {
        return write_photo(folder_ / "photo.jpg", 64, 48, grey, exif);
    }
    std::string refusal_of_place(const fs::path& file) const {
        return refusal([&] { read_photo_place(file); });
    }
    std::string refusal_of_pixels(const fs::path& file) const {
        return refusal([&] { reduce_photo(file, 32); });
    }

    fs::path folder_ = fresh_folder();
};

TEST_F(Photo, TellsItsPlaceAndDayInEitherByteOrderAndWayOfWritingAngles) {
    for (const bool big_endian : {false, true}) {
        for (const std::uint32_t denominator : {0U, 10'000'000U}) {
            for (const auto& at : {krems, GeoPoint{-33.868820, -151.209296}}) {
                const auto place = read_photo_place(
                    photo({.at = at, .big_endian = big_endian, .degree_denominator = denominator}));
                EXPECT_NEAR(place.at.lat_deg, at.lat_deg, a_centimetre_deg);
                EXPECT_NEAR(place.at.lon_deg, at.lon_deg, a_centimetre_deg);
                EXPECT_EQ(place.day, "2026-03-12");
            }
        }
    }
}

TEST_F(Photo, WithAClockThatWasNeverSetHasNoDay) {
    for (const auto* const time : {"0000:00:00 00:00:00", "    :  :     :  :  ", "12.03.2026"}) {
        EXPECT_EQ(read_photo_place(photo({.at = krems, .time = time})).day, "") << time;
    }
}

TEST_F(Photo, WithoutAPlaceOnTheGlobeIsRefused) {
    const auto none = "tells no position, expected a photo with GPS in its EXIF data";
    EXPECT_THAT(refusal_of_place(photo({.at = std::nullopt})), EndsWith(none));
    EXPECT_THAT(refusal_of_place(photo({.at = GeoPoint{91, 15}})), EndsWith(none));
    EXPECT_THAT(refusal_of_place(write_photo(folder_ / "bare.jpg", 64, 48, grey, std::nullopt)),
                EndsWith(none));
}

TEST_F(Photo, ThatIsNoJpegInARegularFileIsRefused) {
    write_file(folder_ / "notes.jpg", "no photo");
    write_file(folder_ / "empty.jpg", "");
    fs::create_symlink(photo(), folder_ / "link.jpg");
    ASSERT_EQ(mkfifo((folder_ / "pipe.jpg").c_str(), 0600), 0);
    using Refusal = std::function<std::string(const fs::path&)>;
    const std::vector<Refusal> refusals{[&](auto& file) { return refusal_of_place(file); },
                                        [&](auto& file) { return refusal_of_pixels(file); }};
    for (const auto& of : refusals) {
        EXPECT_THAT(of(folder_ / "notes.jpg"), EndsWith("notes.jpg: is not a JPEG"));
        EXPECT_THAT(of(folder_ / "empty.jpg"), EndsWith("empty.jpg: is not a JPEG"));
        for (const auto* const name : {"link.jpg", "pipe.jpg"}) {
            EXPECT_THAT(of(folder_ / name), EndsWith("is not a regular file, expected a JPEG"));
        }
    }
}

TEST_F(Photo, WithDamagedExifDataIsReadOrRefusedButDoesNoHarm) {
    const auto whole = read_file(photo());
    const auto exif_bytes = testing::exif_segment({.at = krems}).size();
    std::size_t refused = 0;
    for (std::size_t at = 2; at < exif_bytes; at += 3) {
        for (const char by : {'\0', '\xff'}) {
            auto bytes = whole;
            bytes[at] = by;
            write_file(folder_ / "damaged.jpg", bytes);
            const auto said = refusal_of_place(folder_ / "damaged.jpg");
            EXPECT_TRUE(said == "none" || said.find("damaged.jpg: ") != std::string::npos) << said;
            refused += said == "none" ? 0 : 1;
        }
    }
    EXPECT_GT(refused, 10U);
}

TEST_F(Photo, OfMorePixelsThanTheLimitIsRefusedBeforeItIsDecoded) {
    auto bytes = read_file(photo());
    const auto frame = bytes.find("\xff\xc0");
    ASSERT_NE(frame, std::string::npos);
    for (const std::size_t side : {5U, 7U}) { // height and width of the frame
        bytes[frame + side] = bytes[frame + side + 1] = '\xfa';
    }
    write_file(folder_ / "bomb.jpg", bytes);
    EXPECT_THAT(refusal_of_pixels(folder_ / "bomb.jpg"),
                EndsWith("has 64250 × 64250 pixels, expected at most 120 million"));
}

TEST_F(Photo, CutShortIsRefused) {
    const auto noise = [](int x, int y) {
        const auto value = static_cast<std::uint8_t>((x * 7919 + y * 104729) % 251);
        return std::array<std::uint8_t, 3>{value, value, value};
    };
    auto bytes = read_file(write_photo(folder_ / "whole.jpg", 256, 192, noise, std::nullopt));
    bytes.resize(bytes.size() / 2);
    write_file(folder_ / "short.jpg", bytes);
    EXPECT_THAT(refusal_of_pixels(folder_ / "short.jpg"), HasSubstr("short.jpg: is damaged: "));
}

TEST_F(Photo, OfMoreScansThanCamerasWriteIsRefusedAsEachCostsTheTimeOfAllPixels) {
    const auto file =
        write_photo(folder_ / "scans.jpg", 64, 48, grey, std::nullopt, "-co PROGRESSIVE=YES");
    const auto usual = read_file(file);
    EXPECT_EQ(refusal_of_pixels(file), "none");
    const auto last_scan = usual.rfind("\xff\xda");
    ASSERT_NE(last_scan, usual.npos);
    const auto scan = usual.substr(last_scan, usual.size() - last_scan - 2); // before the end
    auto bytes = usual.substr(0, usual.size() - 2);
    for (int i = 0; i < 32; ++i) {
        bytes += scan;
    }
    write_file(file, bytes + "\xff\xd9");
    EXPECT_THAT(refusal_of_pixels(file), HasSubstr("exceeds maximum scans (32)"));
}

TEST_F(Photo, IsReducedWithoutWordsAboutPeopleAndDevices) {
    const auto file = write_photo(folder_ / "large.jpg", 400, 300, grey, SampleExif{.at = krems});
    ASSERT_THAT(read_file(file), HasSubstr("Jane Doe"));
    const auto small = reduce_photo(file, 100);
    EXPECT_EQ(small.width_px, 100);
    EXPECT_EQ(small.height_px, 75);
    const std::string bytes{small.jpeg.begin(), small.jpeg.end()};
    EXPECT_THAT(bytes, AllOf(Not(HasSubstr("Jane")), Not(HasSubstr("Exif")), HasSubstr("JFIF")));
}

TEST_F(Photo, SmallerThanTheLimitKeepsItsSize) {
    const auto small = reduce_photo(photo(), 640);
    EXPECT_EQ(small.width_px, 64);
    EXPECT_EQ(small.height_px, 48);
}

/// Colour of a pixel, by another reader.
std::string pixel_of(const fs::path& folder, const SmallPhoto& photo, int x, int y) {
    write_file(folder / "small.jpg", {photo.jpeg.begin(), photo.jpeg.end()});
    return testing::output_of(
        folder,
        fmt::format("gdallocationinfo -valonly '{}' {} {}", (folder / "small.jpg").string(), x, y));
}

TEST_F(Photo, StandsUprightHoweverTheCameraWasHeld) {
    // The corner of the stored picture that is the upper left one of the upright picture.
    const std::array<std::pair<bool, bool>, 8> corners{{{false, false},
                                                        {true, false},
                                                        {true, true},
                                                        {false, true},
                                                        {false, false},
                                                        {false, true},
                                                        {true, true},
                                                        {true, false}}};
    for (std::uint16_t orientation = 1; orientation <= 8; ++orientation) {
        const auto [right, bottom] = corners[orientation - 1U];
        const auto colour = [=](int x, int y) {
            const bool white = (x >= 32) == right && (y >= 24) == bottom;
            return std::array<std::uint8_t, 3>(white ? std::array<std::uint8_t, 3>{250, 250, 250}
                                                     : std::array<std::uint8_t, 3>{5, 5, 5});
        };
        const auto small = reduce_photo(
            write_photo(
                folder_ / "turned.jpg", 64, 48, colour, SampleExif{.orientation = orientation}),
            64);
        EXPECT_EQ(small.width_px, orientation < 5 ? 64 : 48) << orientation;
        EXPECT_EQ(small.height_px, orientation < 5 ? 48 : 64) << orientation;
        EXPECT_THAT(pixel_of(folder_, small, 4, 4), HasSubstr("25")) << orientation;
        EXPECT_THAT(pixel_of(folder_, small, small.width_px - 4, small.height_px - 4),
                    Not(HasSubstr("25")))
            << orientation;
    }
}

} // namespace
} // namespace macadam
