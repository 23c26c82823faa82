#include "app/cli/commands.hpp"
#include "app/database/lock_wait_messages.hpp"
#include "app/database/server_store.hpp"
#include "app/jobs/job_options.hpp"

#include "estimator/common/error.hpp"
#include "storage/postgres/server_address.hpp"
#include "storage/store/server/reader_rights.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

namespace macadam {
namespace {

void expect_crowd(const std::string& profile, const std::filesystem::path& file) {
    const auto named = privacy_profile_named(profile);
    if (!named) {
        throw UsageError{fmt::format("PROFILE is {}, expected crowd", in_quotes(profile))};
    }
    if (*named == PrivacyProfile::own) {
        throw InputError{fmt::format("{}: data removed from a crowd database cannot be "
                                     "restored; expected crowd, or a new database for your own "
                                     "cars",
                                     file.string())};
    }
}

void tell_of_open_activity(ServerConnection& server, const Console& console) {
    if (is_activity_open(server)) {
        warn_of_open_activity(server.address(), console);
    } else if (const auto others = open_databases_beside(server); !others.empty()) {
        console.warn(fmt::format("{}: whoever may connect to other databases of the server sees in "
                                 "its locks over which roads trips come in; a superuser ends this "
                                 "with 'REVOKE CONNECT ON DATABASE {} FROM PUBLIC'",
                                 server.address(),
                                 fmt::join(others, ", ")));
    }
}

/// Takes from readers of a crowd on a server what they were given since.
/// \returns false if it is none so far.
bool renew_rights(const std::string& address, const Console& console) {
    auto server = opened_server(address);
    if (!is_crowd(server)) {
        return false;
    }
    ServerTransaction all{server};
    show_publications_alone(server);
    all.commit();
    print_words("is a crowd database; readers see its publications alone\n");
    tell_of_open_activity(server, console);
    return true;
}

void run_privacy(const Arguments& arguments, const Console& console) {
    const auto file = file_or_server(arguments);
    const bool is_on_server = is_server_address(file.string());
    expect_crowd(arguments.operand("PROFILE"), file);
    if (is_on_server && renew_rights(file.string(), console)) {
        return;
    }
    auto store = opened_store(file, console);
    const auto progress = console.progress("trimming");
    const auto made = store.maintenance.make_crowd(progress);
    print_words(fmt::format("now a crowd database: {} trimmed, {} deleted{}\n",
                            counted(made.trips, "trip"),
                            counted(made.passes, "pass"),
                            made.trimmed_before == 0
                                ? ""
                                : fmt::format("; {} had been trimmed when recorded",
                                              counted(made.trimmed_before, "trip"))));
    console.say("nothing can be exported before 'macadam publish'; earlier exports and copies "
                "are not affected");
    if (is_on_server) {
        console.say(
            "deleted rows stay on the server's disk until 'VACUUM FULL', and in its log and "
            "backups until these expire");
        auto server = opened_server(file.string());
        tell_of_open_activity(server, console);
    }
    if (!made.log_is_clean) {
        console.warn(fmt::format("{}-wal: another program is reading the database, so its log "
                                 "still contains the deleted data until the last reader closes "
                                 "it",
                                 file.string()));
    }
}

constexpr std::array operands{import_operand,
                              Operand{.name = "PROFILE", .help = "crowd.", .choices = "crowd"}};

} // namespace

const Command privacy_command{
    .name = "privacy",
    .summary = "Convert a database of your own cars into a crowd database, permanently",
    .about =
        "Deletes all data near the ends and long stops of every trip and overwrites the bytes, "
        "as if the trips had\n"
        "been imported into a database made by 'init --privacy crowd'; since the database "
        "keeps no positions, it\n"
        "deletes more than an import would. Trips whose logs state that they were trimmed stay "
        "as they are.\n"
        "From then on only publications can be exported. This cannot be undone.\n"
        "On a server, roles without rights on trips see publications alone from then on; repeated, "
        "it includes roles that\n"
        "came later and, by a superuser, hides statistics and locks of the server from them.",
    .example = "  macadam privacy roads.gpkg crowd\n"
               "  macadam privacy postgresql://postgres@db.example.org/roads crowd",
    .operands = operands,
    .options = {},
    .run = run_privacy};

} // namespace macadam
