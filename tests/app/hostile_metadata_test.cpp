// Names and files made to harm: each stays text wherever it is shown, and what is not ours is
// refused with what it is.

#include "storage/sqlite.hpp"
#include "support/drive.hpp"
#include "support/program.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

struct Hostile {
    std::string what;
    std::string text;
};

const std::array hostile{
    Hostile{"sql", "x'; DROP TABLE pass; --"},
    Hostile{"path", "../../../../etc/passwd"},
    Hostile{"formula", "=cmd|' /C calc'!A0"},
    Hostile{"markup", "</title><script>alert(1)</script>"},
    Hostile{"terminal", "\x1b]0;owned\x07\x1b[2J\x7f"},
    Hostile{"direction", "abc\u202egpj.exe"},
    Hostile{"format", "%s%n{}{0}"},
    Hostile{"quotes", "\"',;\\"},
    Hostile{"no_utf8", "caf\xe9 \xff\xfe \xc3"},
    Hostile{"long", std::string(1'000'000, 'A')},
};

std::string text_of_trip(const Drive& drive) {
    return text_of(drive_over(patched_road([](double) { return false; }, 1),
                              drive,
                              *built_in_vehicle("golden-car")),
                   drive);
}

/// Controls of ECMA-48 other than ends of lines; a terminal would obey them.
bool steers_a_terminal(const std::string& text) {
    return std::ranges::any_of(text, [](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return (byte < 0x20 && c != '\n') || byte == 0x7f;
    });
}

class HostileMetadata : public ::testing::TestWithParam<Hostile> {};

TEST_P(HostileMetadata, OfATripIsTextOrRefusedWithWords) {
    const auto folder = fresh_folder();
    const auto store = (folder / "roads.gpkg").string();
    const Drive drive{.length_m = 400};
    write_file(folder / "plain.trip.csv", text_of_trip(drive));
    const auto plain = (folder / "plain.trip.csv").string();
    ASSERT_EQ(run_macadam({"init", store, "--trace", plain}).exit_status, 0);
    ASSERT_EQ(run_macadam({"import", store, plain, "--method", "kf"}).exit_status, 0);

    auto odd = drive;
    odd.speed_mps = 17;
    odd.trip_id = GetParam().text;
    odd.vehicle_id = GetParam().text;
    write_file(folder / "odd.trip.csv", text_of_trip(odd));
    const auto odd_file = (folder / "odd.trip.csv").string();
    const auto run =
        run_macadam({"import", store, odd_file, "--method", "kf", "--vehicle", "golden-car"});
    EXPECT_FALSE(steers_a_terminal(run.out + run.err));
    EXPECT_LT(run.out.size() + run.err.size(), 10'000U);

    Database database{store, Database::Access::read};
    auto select = database.prepare("SELECT trip_id FROM trip WHERE file_name = 'odd.trip.csv'");
    const bool is_stored = select.step();
    EXPECT_EQ(run.exit_status, is_stored ? 0 : 1) << run.err;
    if (is_stored) {
        EXPECT_EQ(select.text(0), GetParam().text);
    } else {
        EXPECT_THAT(run.out, HasSubstr("odd.trip.csv:"));
    }
    EXPECT_GT(database.number("SELECT count(*) FROM pass"), 0); // there still is one

    const auto json = run_macadam(
        {"import", store, odd_file, "--method", "kf", "--vehicle", "golden-car", "--json"});
    EXPECT_TRUE(nlohmann::json::accept(json.out)) << json.out.substr(0, 500);
    for (const auto* const command : {"info", "report"}) {
        std::vector<std::string> words{command, store};
        if (command == std::string{"report"}) {
            words.insert(words.end(), {"-o", (folder / "report.html").string()});
        }
        const auto shown = run_macadam(words);
        EXPECT_EQ(shown.exit_status, 0) << shown.err;
        EXPECT_FALSE(steers_a_terminal(shown.out + shown.err)) << command;
    }
    EXPECT_THAT(read_file(folder / "report.html"), Not(HasSubstr("<script>alert(1)")));
}

/// A store of one road that is named like that.
fs::path store_of_a_road(const std::string& name, const fs::path& folder) {
    write_file(folder / "a.trip.csv", text_of_trip({.length_m = 400}));
    const auto trip = (folder / "a.trip.csv").string();
    const auto store = folder / "roads.gpkg";
    EXPECT_EQ(run_macadam({"init", store.string(), "--trace", trip}).exit_status, 0);
    EXPECT_EQ(run_macadam({"import", store.string(), trip, "--method", "kf"}).exit_status, 0);
    Database database{store, Database::Access::write};
    database.prepare("UPDATE way SET name = ?").run(name);
    return store;
}

TEST_P(HostileMetadata, OfARoadIsTextInEveryOutput) {
    const auto folder = fresh_folder();
    const auto store = store_of_a_road(GetParam().text, folder).string();
    const auto table = run_macadam({"query", store, "--worst", "3", "--segments"});
    EXPECT_EQ(table.exit_status, 0) << table.err;
    EXPECT_FALSE(steers_a_terminal(table.out + table.err));
    EXPECT_LT(table.out.size(), 10'000U);

    const auto worst = [&](const std::string& format) {
        const auto run =
            run_macadam({"query", store, "--worst", "3", "--segments", "--format", format});
        EXPECT_EQ(run.exit_status, 0) << run.err;
        return run.out;
    };
    EXPECT_TRUE(nlohmann::json::accept(worst("json")));
    EXPECT_TRUE(nlohmann::json::accept(worst("geojson")));
    EXPECT_THAT(worst("csv"), Not(HasSubstr(",=")));
    EXPECT_THAT(worst("csv"), Not(HasSubstr(",\"=")));

    for (const std::string kind : {"geojson", "csv", "gpkg", "fgb"}) {
        const auto file = (folder / ("out." + kind)).string();
        const auto run = run_macadam({"export", store, "-o", file});
        EXPECT_EQ(run.exit_status, 0) << kind << ": " << run.err.substr(0, 500);
    }
    Database exported{folder / "out.gpkg", Database::Access::read};
    auto select = exported.prepare("SELECT name FROM roughness");
    ASSERT_TRUE(select.step());
    EXPECT_EQ(select.text(0), GetParam().text);

    const auto page = (folder / "report.html").string();
    EXPECT_EQ(run_macadam({"report", store, "-o", page}).exit_status, 0);
    EXPECT_THAT(read_file(page), Not(HasSubstr("<script>alert(1)")));
}

INSTANTIATE_TEST_SUITE_P(Kinds,
                         HostileMetadata,
                         ::testing::ValuesIn(hostile),
                         [](const auto& test) { return test.param.what; });

TEST(HostileFileNames, AreShownAsTextAndKeptAsTheyAre) {
    const auto folder = fresh_folder();
    const Drive drive{.length_m = 400};
    write_file(folder / "plain.trip.csv", text_of_trip(drive));
    const auto store = (folder / "roads.gpkg").string();
    const auto plain = (folder / "plain.trip.csv").string();
    ASSERT_EQ(run_macadam({"init", store, "--trace", plain}).exit_status, 0);
    std::vector<std::string> names;
    for (const std::string name :
         {"'; DROP TABLE trip; --", "=1+1", "\x1b[31mred\n", "caf\xe9", "-rf", "$(reboot)"}) {
        names.push_back(name + ".trip.csv");
    }
    fs::create_directory(folder / "trips");
    for (std::size_t i = 0; i < names.size(); ++i) {
        auto odd = drive;
        odd.trip_id = fmt::format("odd-{}", i);
        write_file(folder / "trips" / names[i], text_of_trip(odd));
    }
    const auto run = run_macadam({"import", store, (folder / "trips").string(), "--method", "kf"});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    EXPECT_FALSE(steers_a_terminal(run.out + run.err));
    Database database{store, Database::Access::read};
    auto find = database.prepare("SELECT 1 FROM trip WHERE file_name = ?");
    for (const auto& name : names) {
        EXPECT_TRUE(find.bind(name).step()) << name;
    }
}

// ------------------------------------------------------------------------ files that are not ours

struct Foreign {
    std::string what;
    std::function<void(const fs::path&)> make;
    std::string refusal;
};

void make_database(const fs::path& file, const std::string& sql) {
    Database{file, Database::Access::create}.run(sql + "; CREATE TABLE a(b)");
}

const std::vector<Foreign> foreign{
    {"png",
     [](const fs::path& file) { write_file(file, "\x89PNG\r\n\x1a\n" + std::string(200, '\0')); },
     "is a PNG picture and no store"},
    {"text",
     [](const fs::path& file) { write_file(file, "just text, and long enough to be a file\n"); },
     "is text and no store"},
    {"empty", [](const fs::path& file) { write_file(file, ""); }, "is empty and no store"},
    {"sqlite", [](const fs::path& file) { make_database(file, "SELECT 1"); }, "SQLite database"},
    {"other_application",
     [](const fs::path& file) { make_database(file, "PRAGMA application_id = 252006674"); },
     "SQLite database of another application (0x0f055112)"},
    {"geopackage",
     [](const fs::path& file) { make_database(file, "PRAGMA application_id = 1196444487"); },
     "is a GeoPackage but no Macadam store"},
    {"folder", [](const fs::path& file) { fs::create_directory(file); }, "is a folder"},
};

class ForeignFile : public ::testing::TestWithParam<Foreign> {};

TEST_P(ForeignFile, IsRefusedWithWhatItIsAndLeftAlone) {
    const auto folder = fresh_folder();
    const auto file = folder / "roads.gpkg";
    GetParam().make(file);
    const auto content = fs::is_directory(file) ? "" : read_file(file);
    write_file(folder / "a.trip.csv", text_of_trip({.length_m = 100}));
    for (const auto& words : std::vector<std::vector<std::string>>{
             {"info", file.string()},
             {"query", file.string(), "--worst", "1"},
             {"import", file.string(), (folder / "a.trip.csv").string()}}) {
        const auto run = run_macadam(words);
        EXPECT_EQ(run.exit_status, 1);
        EXPECT_THAT(run.err, HasSubstr("roads.gpkg: "));
        EXPECT_THAT(run.err, HasSubstr(GetParam().refusal));
        EXPECT_THAT(run.err, HasSubstr("macadam init"));
    }
    EXPECT_EQ(fs::is_directory(file) ? "" : read_file(file), content);
    EXPECT_FALSE(fs::exists(file.string() + "-wal"));
}

INSTANTIATE_TEST_SUITE_P(Kinds, ForeignFile, ::testing::ValuesIn(foreign), [](const auto& test) {
    return test.param.what;
});

TEST(StoreOfAnotherVersion, IsRefusedWithWhatToDo) {
    const auto folder = fresh_folder();
    const auto store = store_of_a_road("a", folder);
    const auto refusal_of_version = [&](const std::string& version) {
        Database{store, Database::Access::write}
            .prepare("UPDATE meta SET value = ? WHERE key = 'version'")
            .run(version);
        const auto run = run_macadam({"info", store.string()});
        EXPECT_EQ(run.exit_status, 1);
        return run.err;
    };
    EXPECT_THAT(refusal_of_version("1"), HasSubstr("is a store of version '1', "));
    EXPECT_THAT(refusal_of_version("1"), HasSubstr("make it anew with 'macadam init'"));
    EXPECT_THAT(refusal_of_version("99"), HasSubstr("made by a newer macadam"));
}

} // namespace
} // namespace macadam::testing
