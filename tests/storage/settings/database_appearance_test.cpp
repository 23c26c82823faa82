#include "storage/settings/database_appearance.hpp"

#include "support/files/files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include <sys/stat.h>

using namespace macadam;
using namespace macadam::testing;
using ::testing::EndsWith;
using ::testing::HasSubstr;

namespace {

std::string refusal_of_text(const std::string& text) {
    return refusal_of([&] { parse_appearance(text, "macadam.toml"); });
}

} // namespace

TEST(DatabaseAppearance, HasUnitLanguageThemeAndColours) {
    const auto appearance = parse_appearance(
        "unit = \"in/mi\"\nlanguage = \"de\"\ntheme = \"dark\"\n[colours]\nink = \"#102030\"\n",
        "macadam.toml");
    EXPECT_EQ(appearance.unit, "in/mi");
    EXPECT_EQ(appearance.language, "de");
    EXPECT_EQ(appearance.theme, "dark");
    EXPECT_EQ(appearance.colours.ink, 0x102030U);
    EXPECT_FALSE(appearance.colours.page);
}

TEST(DatabaseAppearance, RefusesAllOtherKeys) {
    for (const auto* const text : {"jobs = 4\n",
                                   "classes = \"five\"\n",
                                   "min_passes = 9\n",
                                   "style = \"/etc/passwd\"\n",
                                   "[legend]\ntitle = \"Perfect roads\"\n",
                                   "[render]\nunit = \"in/mi\"\n"}) {
        EXPECT_THAT(refusal_of_text(text), HasSubstr("macadam.toml:1: unknown key")) << text;
        EXPECT_THAT(refusal_of_text(text), EndsWith("expected unit, language, theme, colours"))
            << text;
    }
    EXPECT_THAT(refusal_of_text("[colours]\nunmeasured = \"#2c7bb6\"\n"),
                HasSubstr("unknown key 'colours.unmeasured'"));
    EXPECT_THAT(refusal_of_text("[colours]\nclass = \"#000000\"\n"),
                HasSubstr("macadam.toml:2: unknown key"));
    EXPECT_THAT(refusal_of_text("unit = \"furlong\"\n"), HasSubstr("one of mm/m, in/mi"));
    EXPECT_THAT(refusal_of_text("language = \"/etc/passwd.po\"\n"),
                HasSubstr("expected a code such as \"de\""));
}

TEST(DatabaseAppearance, LiesBesideTheDatabaseAndMayBeMissing) {
    EXPECT_EQ(appearance_file_of("maps/roads.gpkg"), "maps/macadam.toml");
    EXPECT_EQ(appearance_file_of("roads.gpkg"), "macadam.toml");
    EXPECT_FALSE(read_appearance(test_folder() / "macadam.toml"));
}

TEST(DatabaseAppearance, IsNotReadThroughALinkNorFromAPipeOrFolder) {
    const auto folder = test_folder();
    const auto elsewhere = written(folder, "secret.toml", "theme = \"dark\"\n");
    const auto file = folder / "macadam.toml";
    std::filesystem::create_symlink(elsewhere, file);
    EXPECT_THAT(refusal_of([&] { read_appearance(file); }),
                EndsWith("macadam.toml: is a link, which is not followed"));
    std::filesystem::remove(file);
    ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
    EXPECT_THAT(refusal_of([&] { read_appearance(file); }), EndsWith("is no regular file"));
    std::filesystem::remove(file);
    std::filesystem::create_directory(file);
    EXPECT_THAT(refusal_of([&] { read_appearance(file); }), EndsWith("is no regular file"));
}

TEST(DatabaseAppearance, IsOfBoundedSize) {
    const auto folder = test_folder();
    const std::string theme = "theme = \"dark\"\n";
    const auto full = theme + std::string(max_appearance_bytes - theme.size(), '#');
    EXPECT_EQ(read_appearance(written(folder, "macadam.toml", full))->theme, "dark");
    const auto file = written(folder, "macadam.toml", full + "#");
    EXPECT_THAT(refusal_of([&] { read_appearance(file); }),
                EndsWith("macadam.toml: is longer than 16384 bytes"));
}
