#include "app/commands.hpp"
#include "app/segment_options.hpp"
#include "app/store_patience.hpp"

#include "storage/json.hpp"
#include "storage/privacy_key.hpp"
#include "storage/store_upgrade.hpp"

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
            "{}: is of version {} already, nothing to do\n", file.string(), done.to_version);
    }
    return fmt::format("{}: from version {} to {}; {} named under the key {}{}\n"
                       "digest before and after: {}\n",
                       file.string(),
                       done.from_version,
                       done.to_version,
                       counted(done.cars, "car"),
                       key_file_of(file).string(),
                       done.made_key ? ", which is new: keep a copy of it apart from the store"
                                     : "",
                       done.digest);
}

void run_upgrade(const Arguments& arguments, const Console& console) {
    const auto file = store_file(arguments);
    const auto done = upgrade_store(file, patience_for(file, console), [&](std::string_view part) {
        return console.progress(std::string{part});
    });
    if (arguments.flag("--json")) {
        print(json_of(done));
    } else {
        print_words(text_of(done, file));
    }
}

constexpr std::array operands{store_operand};
constexpr std::array options{Option{"--json", "", "What was done as one JSON object."}};

} // namespace

const Command upgrade_command{
    .name = "upgrade",
    .summary = "Bring a store of an earlier version to that of today",
    .about =
        "Keeps all that is in it, and proves it by the digest ('macadam info --digest'), which "
        "is taken before and\nafter. All is one transaction: whatever happens, the store is "
        "the old one or the new one. Cars get their\nnames under a key, which is laid beside "
        "the store (docs/store.md).",
    .example = "  macadam upgrade roads.gpkg",
    .operands = operands,
    .options = options,
    .run = run_upgrade};

} // namespace macadam
