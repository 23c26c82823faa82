#include "app/commands.hpp"
#include "app/publication_words.hpp"
#include "app/segment_options.hpp"
#include "app/store_patience.hpp"

#include "storage/network_file.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>

namespace macadam {
namespace {

std::int64_t now_utc_ms() {
    using namespace std::chrono;
    return duration_cast<milliseconds>(system_clock::now().time_since_epoch()).count();
}

void run_publish(const Arguments& arguments, const Console& console) {
    const auto file = store_file(arguments);
    auto store = opened_store(file, RoadStore::Access::write, console);
    const auto progress = console.progress("publishing");
    const auto done = store.publish(kept_roads(store), now_utc_ms(), progress);
    if (arguments.flag("--json")) {
        print(json_of(std::optional{done.publication}) + "\n");
    } else {
        print_words(words_for(done.publication) + "\n");
    }
    console.say(fmt::format("{} new or of more passes", counted(done.changed, "segment")));
}

constexpr std::array operands{store_operand};
constexpr std::array options{Option{"--json", "", "What is published as one JSON object."}};

} // namespace

const Command publish_command{
    .name = "publish",
    .summary = "Publish what a crowd's cars found, once a month",
    .about =
        "A database of others' cars (init --privacy crowd) hands on what its latest publication "
        "tells, and nothing\nelse. Each figure of one rests on five cars or more; it changes only "
        "when five cars or more have something\nnew to say, so that two publications cannot be "
        "told apart car by car. Needs the database's key. A publication\nstays as it is until the "
        "next one, which can be made in the next calendar month (docs/privacy.md).",
    .example = "  macadam publish crowd.gpkg\n"
               "  macadam export crowd.gpkg -o roads.geojson      what is published",
    .operands = operands,
    .options = options,
    .run = run_publish};

} // namespace macadam
