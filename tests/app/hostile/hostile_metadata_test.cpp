// Names and files made to harm: each stays text wherever it is shown, and what is not ours is
// refused with what it is.

#include "storage/sqlite/sqlite.hpp"
#include "support/program/program.hpp"
#include "support/roads/drive.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <functional>
#include <ostream>
#include <sstream>

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

TripLog driven(const Drive& drive) {
    return drive_over(
        patched_road([](double) { return false; }, 1), drive, *built_in_vehicle("golden-car"));
}

std::string text_of_trip(const Drive& drive) {
    return text_of(driven(drive), drive);
}

/// Controls of ECMA-48 other than ends of lines; a terminal would obey them.
bool steers_a_terminal(const std::string& text) {
    return std::ranges::any_of(text, [](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return (byte < 0x20 && c != '\n') || byte == 0x7f;
    });
}

std::vector<std::string> import_words(const fs::path& store, const fs::path& trips) {
    return {"import", store.string(), trips.string(), "--method", "kf", "--vehicle", "golden-car"};
}

TEST(HostileMetadata, OfTripsIsTextOrRefusedWithWords) {
    const auto folder = fresh_folder();
    const auto store = folder / "roads.gpkg";
    fs::create_directory(folder / "trips");
    const auto log = driven({.length_m = 200});
    for (const auto& [what, text] : hostile) {
        const Drive drive{.length_m = 200, .trip_id = text, .vehicle_id = "car of " + text};
        write_file(folder / "trips" / (what + ".trip.csv"), text_of(log, drive));
    }
    const auto first = (folder / "trips/sql.trip.csv").string();
    ASSERT_EQ(run_macadam({"init", store.string(), "--trace", first}).exit_status, 0);
    const auto run = run_macadam(import_words(store, folder / "trips"));
    EXPECT_FALSE(steers_a_terminal(run.out + run.err));
    EXPECT_LT(run.out.size() + run.err.size(), 20'000U);

    {
        Database database{store, Database::Access::read};
        auto select = database.prepare("SELECT trip_id FROM trip WHERE file_name = ?");
        for (const auto& [what, text] : hostile) {
            if (select.bind(what + ".trip.csv").step()) {
                EXPECT_EQ(select.text(0), text);
            } else {
                EXPECT_THAT(run.out, HasSubstr(what + ".trip.csv:"));
            }
        }
        select.reset();
        EXPECT_GE(database.number("SELECT count(*) FROM trip"), 7);
    } // or the next import would wait for this reader

    auto words = import_words(store, folder / "trips");
    words.emplace_back("--json");
    std::istringstream lines{run_macadam(words).out};
    std::size_t told = 0;
    for (std::string line; std::getline(lines, line); ++told) {
        EXPECT_TRUE(nlohmann::json::accept(line)) << line.substr(0, 500);
    }
    EXPECT_EQ(told, hostile.size());
    const auto info = run_macadam({"info", store.string()});
    EXPECT_EQ(info.exit_status, 0) << info.err;
    EXPECT_FALSE(steers_a_terminal(info.out + info.err));
}

/// A store of one road that is named like that.
fs::path store_of_a_road(const std::string& name, const fs::path& folder) {
    const auto trip = folder / "a.trip.csv";
    write_file(trip, text_of_trip({.length_m = 200}));
    const auto store = folder / "roads.gpkg";
    EXPECT_EQ(run_macadam({"init", store.string(), "--trace", trip.string()}).exit_status, 0);
    EXPECT_EQ(run_macadam(import_words(store, trip)).exit_status, 0);
    Database database{store, Database::Access::write};
    database.prepare("UPDATE way SET name = ?").run(name);
    return store;
}

TEST(HostileMetadata, OfARoadIsTextInEveryOutput) {
    const auto folder = fresh_folder();
    std::string name = "=";
    for (const auto& [what, text] : hostile) {
        name += text;
    }
    const auto store = store_of_a_road(name, folder).string();
    const auto worst_in = [&](const std::string& format) {
        const auto run =
            run_macadam({"query", store, "--worst", "1", "--segments", "--format", format});
        EXPECT_EQ(run.exit_status, 0) << run.err;
        return run.out;
    };
    const auto table = worst_in("table");
    EXPECT_FALSE(steers_a_terminal(table));
    EXPECT_LT(table.size(), 10'000U);
    EXPECT_TRUE(nlohmann::json::accept(worst_in("json")));
    EXPECT_TRUE(nlohmann::json::accept(worst_in("geojson")));
    EXPECT_THAT(worst_in("csv"), HasSubstr(",\"'=x'; DROP TABLE pass"));

    const auto exported = folder / "out.gpkg";
    EXPECT_EQ(run_macadam({"export", store, "-o", exported.string()}).exit_status, 0);
    Database database{exported, Database::Access::read};
    auto select = database.prepare("SELECT name FROM roughness");
    ASSERT_TRUE(select.step());
    EXPECT_EQ(select.text(0), name);

    const auto page = (folder / "report.html").string();
    EXPECT_EQ(run_macadam({"report", store, "-o", page}).exit_status, 0);
    EXPECT_THAT(read_file(page), Not(HasSubstr("<script>alert(1)")));
}

TEST(HostileFileNames, AreShownAsTextAndKeptAsTheyAre) {
    const auto folder = fresh_folder();
    const Drive drive{.length_m = 200};
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

void PrintTo(const Foreign& file, std::ostream* out) {
    *out << file.what;
}

void make_database(const fs::path& file, const std::string& sql) {
    Database{file, Database::Access::create}.run(sql + "; CREATE TABLE a(b)");
}

const std::vector<Foreign> foreign{
    {"png",
     [](const fs::path& file) { write_file(file, "\x89PNG\r\n\x1a\n" + std::string(200, '\0')); },
     "is a PNG picture"},
    {"text",
     [](const fs::path& file) { write_file(file, "just text, and long enough to be a file\n"); },
     "is a text file"},
    {"empty", [](const fs::path& file) { write_file(file, ""); }, "is empty"},
    {"sqlite",
     [](const fs::path& file) { make_database(file, "SELECT 1"); },
     "it is an SQLite database without an application id"},
    {"other_application",
     [](const fs::path& file) { make_database(file, "PRAGMA application_id = 252006674"); },
     "SQLite database of another application (0x0f055112)"},
    {"geopackage",
     [](const fs::path& file) { make_database(file, "PRAGMA application_id = 1196444487"); },
     "is a GeoPackage, but not a Macadam database"},
    {"folder", [](const fs::path& file) { fs::create_directory(file); }, "it is a folder"},
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
    EXPECT_THAT(refusal_of_version("1"), HasSubstr("is a database of version '1', "));
    EXPECT_THAT(refusal_of_version("2"), HasSubstr("that does not belong to Macadam")); // but of 3
    EXPECT_THAT(refusal_of_version("1"), HasSubstr("create it again with 'macadam init'"));
    EXPECT_THAT(refusal_of_version("99"), HasSubstr("made by a newer version of Macadam"));
}

} // namespace
} // namespace macadam::testing
