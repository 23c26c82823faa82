#include "app/commands.hpp"
#include "app/segment_options.hpp"
#include "app/store_patience.hpp"

#include "estimator/common/error.hpp"
#include "storage/text.hpp"

#include <fmt/format.h>

#include <array>

namespace macadam {
namespace {

void expect_crowd(const std::string& profile, const std::filesystem::path& file) {
    const auto named = privacy_profile_named(profile);
    if (!named) {
        throw UsageError{fmt::format("PROFILE is {}, expected crowd", in_quotes(profile))};
    }
    if (*named == PrivacyProfile::own) {
        throw InputError{fmt::format("{}: what was taken out of a crowd's database does not come "
                                     "back; expected crowd, or a new database of one's own cars",
                                     file.string())};
    }
}

void run_privacy(const Arguments& arguments, const Console& console) {
    const auto file = store_file(arguments);
    expect_crowd(arguments.operand("PROFILE"), file);
    auto store = opened_store(file, RoadStore::Access::write, console);
    const auto progress = console.progress("trimming");
    const auto made = store.make_crowd(progress);
    print_words(fmt::format("a crowd's database from now on: {} trimmed, {} taken out\n",
                            counted(made.trips, "trip"),
                            counted(made.passes, "pass")));
    console.say("nothing leaves it before 'macadam publish'; exports and copies that were made "
                "before are beyond reach");
    if (!made.log_is_clean) {
        console.warn(fmt::format("{}-wal: others read the store, so its log still holds what was "
                                 "taken out, until the last of them closes it",
                                 file.string()));
    }
}

constexpr std::array operands{store_operand, Operand{"PROFILE", "crowd."}};

} // namespace

const Command privacy_command{
    .name = "privacy",
    .summary = "Turn a database of one's own cars into a crowd's, for good",
    .about =
        "Takes what lies near the ends and long stops of every trip out of the database and "
        "overwrites the bytes, as\nif the trips had come into a database made by 'init --privacy "
        "crowd'; since the database keeps no positions,\nit takes out more than an import would. "
        "From then on only publications leave it. There is no way back.",
    .example = "  macadam privacy roads.gpkg crowd",
    .operands = operands,
    .options = {},
    .run = run_privacy};

} // namespace macadam
