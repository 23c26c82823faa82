#include "app/cli/commands.hpp"
#include "app/database/lock_wait_messages.hpp"
#include "app/database/server_store.hpp"

#include "storage/postgres/server_address.hpp"
#include "storage/store/privacy/privacy_key.hpp"
#include "storage/store/server/server_schema.hpp"
#include "storage/store/upgrade/store_upgrade.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <string>

namespace macadam {
namespace {

std::string json_of(const StoreUpgrade& done) {
    JsonObject object;
    object.add("from_version", std::int64_t{done.from_version})
        .add("to_version", std::int64_t{done.to_version})
        .add("cars", static_cast<std::int64_t>(done.cars))
        .add("trips_renamed", static_cast<std::int64_t>(done.trips))
        .add("digest", done.digest.empty() ? JsonValue{nullptr} : JsonValue{done.digest});
    return object.text() + "\n";
}

std::string text_of(const StoreUpgrade& done, const std::filesystem::path& file) {
    if (done.from_version == done.to_version) {
        return fmt::format(
            "{}: is already of version {}, nothing to do\n", file.string(), done.to_version);
    }
    const auto cars =
        done.cars == 0 && !done.made_key
            ? std::string{}
            : fmt::format("; {} pseudonymised with the key {}{}",
                          counted(done.cars, "car"),
                          key_file_of(file).string(),
                          done.made_key ? ", which is new: keep a copy of it apart from the "
                                          "database"
                                        : "");
    constexpr int first_version_with_events = 4;
    const auto* const potholes = done.from_version < first_version_with_events
                                     ? "run 'macadam reprocess' to search the trips for potholes\n"
                                     : "";
    constexpr int first_version_with_background = 6;
    const auto background =
        done.from_version < first_version_with_background
            ? fmt::format("run 'macadam init {} --update MAP' for water, green and names of "
                          "places on maps\n",
                          file.string())
            : std::string{};
    return fmt::format("{}: upgraded from version {} to {}{}\n"
                       "digest before and after: {}\n"
                       "{}{}",
                       file.string(),
                       done.from_version,
                       done.to_version,
                       cars,
                       done.digest,
                       potholes,
                       background);
}

/// Upgrades the schema of a database on a server, whose data stay as they are.
void upgrade_server(const std::string& address, bool json) {
    ServerConnection server{address};
    const int before = upgrade_server_schema(server);
    if (json) {
        JsonObject object;
        object.add("from_version", std::int64_t{before})
            .add("to_version", std::int64_t{server_schema_version});
        print(object.text() + "\n");
    } else {
        print_words(
            before == server_schema_version
                ? fmt::format("{}: is already of version {}, nothing to do\n", address, before)
                : fmt::format("{}: schema upgraded from version {} to {}\n",
                              address,
                              before,
                              server_schema_version));
    }
}

void run_upgrade(const Arguments& arguments, const Console& console) {
    const auto file = file_or_server(arguments);
    if (is_server_address(file.string())) {
        upgrade_server(file.string(), arguments.flag("--json"));
        return;
    }
    const auto done =
        upgrade_store(file, wait_policy_for(file, console), [&](std::string_view part) {
            return console.progress(std::string{part});
        });
    if (arguments.flag("--json")) {
        print(json_of(done));
    } else {
        print_words(text_of(done, file));
    }
}

constexpr std::array operands{source_operand};
constexpr std::array options{Option{"--json", "", "Print the result as one JSON object."}};

} // namespace

const Command upgrade_command{
    .name = "upgrade",
    .summary = "Upgrade a database of an earlier version",
    .about = "Keeps all content and verifies this with the digest ('macadam info --digest'), "
             "which is computed before and\n"
             "after. All is one transaction: on any failure the database is unchanged. Cars "
             "get pseudonyms under a key,\n"
             "which is written beside the database (docs/reference/database.md). On a server, "
             "missing migrations of the schema run.",
    .example = "  macadam upgrade roads.gpkg\n"
               "  macadam upgrade postgresql://me@db.example.org/roads",
    .operands = operands,
    .options = options,
    .run = run_upgrade};

} // namespace macadam
