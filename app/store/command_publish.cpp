#include "app/cli/commands.hpp"
#include "app/database/lock_wait_messages.hpp"
#include "app/database/publication_messages.hpp"
#include "app/database/server_store.hpp"
#include "app/jobs/job_options.hpp"

#include "estimator/common/error.hpp"
#include "storage/networks/network_file.hpp"
#include "storage/postgres/server_address.hpp"
#include "storage/store/connection/import_lock.hpp"
#include "storage/store/server/reader_rights.hpp"
#include "storage/store/server/replica/server_replica.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>

namespace macadam {
namespace {

std::int64_t now_utc_ms() {
    using namespace std::chrono;
    return duration_cast<milliseconds>(system_clock::now().time_since_epoch()).count();
}

RoadStore opened_to_publish(const std::filesystem::path& file, const Console& console) {
    if (!is_server_address(file.string())) {
        return opened_store(file, console);
    }
    console.detail(fmt::format("opening {}", file.string()));
    return RoadStore{open_replica_to_publish(
        file.string(), wait_policy_for(file, console), console.progress("reading drives"))};
}

/// All roads, of which the copy of a part does not hold all. While it is open, they stay the same.
RoadNetwork
roads_of(const RoadStore& store, const std::filesystem::path& file, const Console& console) {
    return is_server_address(file.string())
               ? load_or_build_network(opened_for_import(file, console).map)
               : load_or_build_network(store);
}

void run_publish(const Arguments& arguments, const Console& console) {
    const auto file = file_or_server(arguments);
    auto store = opened_to_publish(file, console);
    if (is_import_running(file)) {
        throw InputError{
            fmt::format("{}: an import is running; a publication holds for a month, so "
                        "publish when it has ended",
                        file.string())};
    }
    const auto progress = console.progress("publishing");
    const auto done =
        store.maintenance.publish(roads_of(store, file, console), now_utc_ms(), progress);
    if (arguments.flag("--json")) {
        print(json_of(std::optional{done.publication}) + "\n");
    } else {
        print_words(words_for(done.publication) + "\n");
    }
    console.say(fmt::format("{} new or with more passes", counted(done.changed, "segment")));
    if (is_server_address(file.string())) {
        auto server = opened_server(file.string());
        if (is_activity_open(server)) {
            warn_of_open_activity(file.string(), console);
        }
    }
}

constexpr std::array operands{import_operand};
constexpr std::array options{Option{"--json", "", "Print the publication as one JSON object."}};

} // namespace

const Command publish_command{
    .name = "publish",
    .summary = "Publish the values of a crowd database, once a month",
    .about = "A database of other people's cars (init --privacy crowd) exports only the values of "
             "its latest publication.\n"
             "Each of them is based on five cars or more and changes only when five cars or more "
             "have new data, so that\n"
             "single cars cannot be told from the difference of two publications. Needs the key of "
             "the database. A\n"
             "publication stays unchanged until the next one, in the next calendar month or later "
             "(docs/privacy.md).",
    .example = "  macadam publish crowd.gpkg\n  macadam export crowd.gpkg -o roads.geojson     "
               " published values only",
    .operands = operands,
    .options = options,
    .run = run_publish};

} // namespace macadam
