#include "app/cli/server_commands.hpp"

#include "app/database/lock_wait_messages.hpp"
#include "app/database/segment_options.hpp"

#include "estimator/common/error.hpp"
#include "storage/postgres/server_address.hpp"
#include "storage/store/copy/region_cut.hpp"
#include "storage/store/privacy/privacy_key.hpp"
#include "storage/store/server/copy/store_copy.hpp"
#include "storage/store/server/cut/server_cut.hpp"
#include "storage/surveys/area_file.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace macadam {
namespace {

/// Checks that addresses can be shown.
void expect_no_secrets(const std::string& from, const std::string& to) {
    try {
        for (const auto& database : {from, to}) {
            if (is_server_address(database)) {
                expect_address_without_secrets(database);
            }
        }
    } catch (const InputError& error) {
        throw UsageError{error.what()};
    }
}

/// Checks that one of both is a file and the other one an address.
void expect_file_and_server(const std::string& from, const std::string& to) {
    if (is_server_address(from) == is_server_address(to)) {
        throw UsageError{is_server_address(from)
                             ? "FROM and TO are both on servers, expected one .gpkg file"
                             : "FROM and TO are both files, expected one address "
                               "postgresql://USER@HOST/DATABASE, or --bbox or --area, which cut a "
                               "region out; cp copies files"};
    }
}

/// Region to be cut out; `std::nullopt`: the whole database is copied.
std::optional<Region> parse_region(const Arguments& arguments) {
    Region region;
    if (const auto degrees = arguments.numbers("--bbox", 4)) {
        region.place.box = box_of(*degrees);
        region.words = fmt::format("the box {}", *arguments.value("--bbox"));
    }
    if (const auto file = arguments.value("--area")) {
        region.place.area = std::make_shared<const Area>(read_area(*file));
        region.words += fmt::format("{}the area {}",
                                    region.words.empty() ? "" : " within ",
                                    std::filesystem::path{*file}.filename().string());
    }
    if (region.words.empty()) {
        return std::nullopt;
    }
    return region;
}

StoreCopy cut_region(const std::string& from,
                     const std::string& to,
                     const Region& region,
                     const Console& console) {
    if (is_server_address(to)) {
        throw UsageError{"--bbox and --area cut a region out into a file, expected TO to be a new "
                         ".gpkg file; copy that to the server"};
    }
    const auto progress = console.progress("copying");
    return is_server_address(from)
               ? cut_from_server(from, region, to, progress)
               : cut_from_file(from, region, to, wait_policy_for(from, console), progress);
}

StoreCopy copy_whole(const std::string& from, const std::string& to, const Console& console) {
    expect_file_and_server(from, to);
    const auto progress = console.progress("copying");
    return is_server_address(to)
               ? copy_to_server(from, to, wait_policy_for(from, console), progress)
               : copy_from_server(from, to, progress);
}

/// Tells where the key of a copy is, or belongs.
void tell_of_key(const StoreCopy& copy, bool is_with_server, const Console& console) {
    const auto file = copy.key_file.string();
    if (!read_key(copy.key_file)) {
        console.say(fmt::format("{}: put the key of the cars here before you import trips", file));
    } else {
        console.say(fmt::format(
            "{}: key of the cars{}; keep it", file, is_with_server ? ", not on the server" : ""));
    }
}

std::string json_of(const StoreCopy& copy) {
    JsonObject object;
    object.add("trips", static_cast<std::int64_t>(copy.trips))
        .add("passes", static_cast<std::int64_t>(copy.passes))
        .add("digest", copy.digest);
    return object.text() + "\n";
}

void run_copy(const Arguments& arguments, const Console& console) {
    const auto& from = arguments.operand("FROM");
    const auto& to = arguments.operand("TO");
    expect_no_secrets(from, to);
    const auto region = parse_region(arguments);
    const auto copy =
        region ? cut_region(from, to, *region, console) : copy_whole(from, to, console);
    warn_of_server(copy, to, console);
    if (arguments.flag("--json")) {
        print(json_of(copy));
    } else {
        print_words(fmt::format("{}: {}, {}; digest on both sides: {}\n",
                                to,
                                counted(copy.trips, "trip"),
                                counted(copy.passes, "pass"),
                                copy.digest));
    }
    tell_of_key(copy, is_server_address(from) || is_server_address(to), console);
}

constexpr std::array operands{
    Operand{"FROM", "The road database: a .gpkg file, or postgresql://USER@HOST/DATABASE."},
    Operand{"TO", "The other one: an address of a database without one, or a new .gpkg file."}};
constexpr std::array options{
    Option{"--bbox",
           "W,S,E,N",
           "Only the region in this box, in degrees, into a file; W > E crosses the antimeridian."},
    Option{"--area",
           "FILE",
           "Only the region in these polygons, into a file: GeoJSON, GeoPackage, Shapefile, KML."},
    Option{"--json", "", "Print the result as one JSON object."}};

} // namespace

const Command copy_command{
    .name = "copy",
    .summary = "Copy a database between a file and a PostgreSQL server, or cut out a region",
    .about =
        "Copies all content and verifies this with the digest ('macadam info --digest'), which "
        "is computed on both\nsides. All is one transaction: on any failure there is no copy. "
        "The server needs PostgreSQL 15 and PostGIS;\nQGIS shows its view macadam.roughness. "
        "Passwords come from ~/.pgpass (docs/reference/postgresql.md).\n\n"
        "With --bbox or --area, TO is a new file of that region, whether FROM is a file or on a "
        "server: the roads that\ntouch it, by intervals of some 500 m, with their passes and "
        "values, and the trips and cars that drove there. The\nrest of their ways and the ways "
        "that meet them come along without values. Trips keep their total lengths.",
    .example = "  macadam copy roads.gpkg postgresql://me@db.example.org/roads\n"
               "  macadam copy postgresql://me@db.example.org/roads back.gpkg\n"
               "  macadam copy roads.gpkg town.gpkg --bbox 16.3,48.1,16.5,48.3",
    .operands = operands,
    .options = options,
    .run = run_copy};

} // namespace macadam
