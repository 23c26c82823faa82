#include "app/cli/server_commands.hpp"
#include "app/database/server_store.hpp"
#include "app/jobs/job_options.hpp"
#include "estimator/common/error.hpp"
#include "storage/jobs/server_tokens.hpp"
#include "storage/postgres/server_address.hpp"
#include "storage/store/reader/store_reader.hpp"
#include "storage/text/json.hpp"
#include "storage/text/text.hpp"
#include "storage/text/utc.hpp"
#include "storage/uploads/access_token.hpp"
#include "storage/uploads/upload_database.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace macadam {
namespace {

constexpr std::int64_t ms_per_day = 86'400'000;
constexpr std::int64_t default_days = 365;

std::int64_t now_ms() {
    return std::chrono::duration_cast<std::chrono::milliseconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
}

std::int64_t expiry_in(const Arguments& arguments, std::int64_t now) {
    constexpr std::int64_t max_days = 3650;
    const auto days = arguments.integer("--days").value_or(default_days);
    if (days < 1 || days > max_days) {
        throw UsageError{fmt::format("--days is {}, expected 1 to {}", days, max_days)};
    }
    return now + days * ms_per_day;
}

/// Returns the operand NAME, a name of its own line in lists.
const std::string& name_in(const Arguments& arguments) {
    constexpr std::size_t longest = 100;
    const auto& names = arguments.operands("NAME");
    if (names.empty()) {
        throw UsageError{"NAME is missing, expected whose token it is"};
    }
    const auto& name = names.front();
    const bool is_plain = std::ranges::none_of(
        name, [](unsigned char letter) { return letter < ' ' || letter == '\x7f'; });
    if (trimmed(name).empty() || name.size() > longest || !is_plain) {
        throw UsageError{fmt::format(
            "NAME is {}, expected 1 to {} bytes on one line", in_quotes(name), longest)};
    }
    return name;
}

/// Place of the tokens: beside a file, or on a server.
using Place = std::variant<Database, ServerConnection>;

Place made_place(const std::filesystem::path& store) {
    if (is_server_address(store.string())) {
        return opened_server(store.string());
    }
    make_uploads_folder(store);
    return open_uploads(store);
}

/// Opens the place; `std::nullopt` for a file that has none so far.
std::optional<Place> opened_place(const std::filesystem::path& store) {
    return is_server_address(store.string()) || takes_uploads(store)
               ? std::optional{made_place(store)}
               : std::nullopt;
}

void create(const Arguments& arguments,
            const std::filesystem::path& store,
            const Console& console) {
    const auto now = now_ms();
    const AccessToken token{.id = {},
                            .owner = name_in(arguments),
                            .scope = *scope_named(arguments.choice("--scope")),
                            .created_ms = now,
                            .expires_ms = expiry_in(arguments, now)};
    auto place = made_place(store);
    print(std::visit([&](auto& uploads) { return create_token(uploads, token); }, place) + "\n");
    console.say(fmt::format("valid until {}; it cannot be shown again", utc_day(token.expires_ms)));
}

void invite(const Arguments& arguments,
            const std::filesystem::path& store,
            const Console& console) {
    constexpr std::int64_t days_to_accept = 14;
    const auto url = arguments.value("--url");
    if (!url || !url->starts_with("http")) {
        throw UsageError{"--url is missing, expected the public address of the server: "
                         "https://roads.example.org"};
    }
    const auto now = now_ms();
    const Invitation invitation{.owner = name_in(arguments),
                                .expires_ms = now + days_to_accept * ms_per_day,
                                .token_expires_ms = expiry_in(arguments, now)};
    auto place = made_place(store);
    print(fmt::format(
        "{}/drive/#invite={}\n",
        url->substr(0, url->find_last_not_of('/') + 1),
        std::visit([&](auto& uploads) { return create_invitation(uploads, invitation); }, place)));
    console.say(fmt::format("for one phone, until {}; it cannot be shown again",
                            utc_day(invitation.expires_ms)));
}

void list(const Arguments& arguments, const std::filesystem::path& store) {
    std::vector<AccessToken> tokens;
    if (auto place = opened_place(store)) {
        tokens = std::visit([](auto& uploads) { return all_tokens(uploads); }, *place);
    }
    if (arguments.flag("--json")) {
        std::vector<std::string> items;
        for (const auto& token : tokens) {
            JsonObject item;
            item.add("id", token.id)
                .add("name", token.owner)
                .add("scope", std::string{name_of(token.scope)})
                .add("created", utc_text(token.created_ms))
                .add("expires", utc_text(token.expires_ms));
            items.push_back(item.text());
        }
        print(json_array(items) + "\n");
        return;
    }
    std::string lines;
    for (const auto& token : tokens) {
        lines += fmt::format("{}  {:<8}  until {}{}  {}\n",
                             token.id,
                             name_of(token.scope),
                             utc_day(token.expires_ms),
                             token.expires_ms <= now_ms() ? ", expired" : "",
                             token.owner);
    }
    print_words(tokens.empty() ? "no tokens\n" : lines);
}

void revoke(const Arguments& arguments,
            const std::filesystem::path& store,
            const Console& console) {
    const auto& name = name_in(arguments);
    std::size_t count = 0;
    if (auto place = opened_place(store)) {
        count = std::visit([&](auto& uploads) { return revoke_tokens(uploads, name); }, *place);
    }
    if (count == 0) {
        throw InputError{fmt::format("{}: has no token {}, expected an id or a name of 'macadam "
                                     "token list'",
                                     store.string(),
                                     in_quotes(name))};
    }
    console.say(fmt::format("{} revoked; trips stay", count));
}

void run_token(const Arguments& arguments, const Console& console) {
    const auto& action = arguments.operand("ACTION");
    const auto store = file_or_server(arguments);
    if (!is_server_address(store.string())) {
        static_cast<void>(StoreReader::open(store)); // refuses other files
    }
    if (action == "create") {
        create(arguments, store, console);
    } else if (action == "invite") {
        invite(arguments, store, console);
    } else if (action == "list") {
        list(arguments, store);
    } else if (action == "revoke") {
        revoke(arguments, store, console);
    } else {
        throw UsageError{fmt::format("ACTION is {}, expected create, invite, list or revoke",
                                     in_quotes(action))};
    }
}

constexpr std::array operands{
    Operand{.name = "ACTION",
            .help = "create, invite, list or revoke.",
            .choices = "create|invite|list|revoke"},
    import_operand,
    Operand{.name = "NAME",
            .help = "Whose token it is; tokens of one name share their trips. 'revoke' also takes "
                    "an id.",
            .optional = true}};

constexpr std::array options{
    one_of("upload|read|operator",
           {"--scope",
            "SCOPE",
            "upload: send trips, see and delete one's own. read: read a server. operator: all.",
            "upload"}),
    Option{"--days", "N", "Days until it expires.", "365"},
    Option{"--url", "URL", "With 'invite': the public address of the server."},
    Option{"--json", "", "With 'list': one JSON array."}};

} // namespace

const Command token_command{
    .name = "token",
    .summary = "Make and revoke the tokens by which others send trips to a server",
    .about = "Prints a new token, lists the tokens, or revokes those of a name; a running server "
             "follows at once. A token has\n"
             "256 random bits, and only its SHA-256 is kept, in the folder STORE.uploads/ beside "
             "the database, or on its server. Clients send it\n"
             "as 'Authorization: Bearer TOKEN', or as the password of HTTP Basic with any user "
             "name.\n"
             "'invite' prints the address of the recorder with an invitation, by which one phone "
             "gets a token within 14 days.",
    .example = "  macadam token create roads.gpkg anna\n"
               "  macadam token create roads.gpkg office --scope operator --days 30\n"
               "  macadam token invite roads.gpkg ben --url https://roads.example.org\n"
               "  macadam token list roads.gpkg\n"
               "  macadam token revoke roads.gpkg anna",
    .operands = operands,
    .options = options,
    .run = run_token};

} // namespace macadam
