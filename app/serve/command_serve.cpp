#include "app/cli/server_commands.hpp"

#include "app/database/lock_wait_messages.hpp"
#include "app/database/publication_messages.hpp"
#include "app/database/server_store.hpp"
#include "app/http/cross_origin.hpp"
#include "app/http/listening_socket.hpp"
#include "app/parallel/jobs_option.hpp"
#include "app/pipeline/estimation_options.hpp"
#include "app/pipeline/vehicle_lookup.hpp"
#include "app/query/section_options.hpp"
#include "app/query/section_query.hpp"
#include "app/serve/api_server.hpp"
#include "estimator/common/ascii.hpp"
#include "estimator/common/error.hpp"
#include "storage/store/reader/store_reader.hpp"
#include "storage/store/server/reader/local_copy.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace macadam {
namespace {

/// Parses "127.0.0.1:8080", "[::1]:8080" or "unix:/run/macadam/web".
void parse_listen(const std::string& text, HttpServerConfig& config) {
    constexpr std::string_view local = "unix:";
    if (text.starts_with(local)) {
        config.unix_socket = text.substr(local.size());
        if (config.unix_socket.empty()) {
            throw UsageError{"--listen is 'unix:', expected a file, such as unix:/run/macadam/web"};
        }
        return;
    }
    const auto colon = text.rfind(':');
    const auto number = colon == std::string::npos ? "" : text.substr(colon + 1);
    const auto* const end = number.data() + number.size();
    const auto [stop, error] = std::from_chars(number.data(), end, config.port);
    if (number.empty() || error != std::errc{} || stop != end) {
        throw UsageError{fmt::format(
            "--listen is '{}', expected an address with a port, such as 127.0.0.1:8080", text)};
    }
    config.host = text.substr(0, colon);
    if (config.host.starts_with('[') && config.host.ends_with(']')) {
        config.host = config.host.substr(1, config.host.size() - 2);
    }
    if (!is_loopback(config.host)) {
        throw UsageError{fmt::format(
            "--listen is '{}', expected an address of this machine alone, 127.0.0.1 or [::1]; "
            "for others, put a web server such as nginx in front and give --behind-proxy",
            text)};
    }
}

/// Parses the public address of --behind-proxy: "https://roads.example.org/iri".
void parse_proxy(const std::string& url, HttpServerConfig& config, ServedAddress& address) {
    constexpr std::string_view allowed =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-_~:/[]";
    const auto colon = url.find("://");
    const auto scheme = url.substr(0, colon);
    const bool is_web = colon != std::string::npos && (scheme == "https" || scheme == "http");
    const auto host = is_web ? url.substr(colon + 3, url.find('/', colon + 3) - colon - 3) : "";
    if (host.empty() || url.find_first_not_of(allowed) != std::string::npos) {
        throw UsageError{fmt::format("--behind-proxy is '{}', expected the public address, such as "
                                     "https://roads.example.org",
                                     url)};
    }
    config.behind_proxy = true;
    config.hosts.push_back(host);
    address.base = url.substr(0, url.find_last_not_of('/') + 1);
}

/// Parses the origins of --allow-origin.
std::vector<std::string> parse_origins(const Arguments& arguments) {
    auto origins = arguments.values("--allow-origin");
    for (auto& origin : origins) {
        origin = in_lower_case(origin);
        if (!is_origin(origin)) {
            throw UsageError{fmt::format("--allow-origin is '{}', expected an origin without a "
                                         "path, such as https://maps.example.org, or *",
                                         origin)};
        }
        if (origin == "*" && origins.size() > 1) {
            throw UsageError{"--allow-origin is '*' and names sites, expected one of both"};
        }
    }
    return origins;
}

TripReception parse_reception(const Arguments& arguments) {
    constexpr std::int64_t max_workers = 64;
    const auto workers = arguments.integer("--workers").value_or(1);
    if (workers < 0 || workers > max_workers) {
        throw UsageError{fmt::format("--workers is {}, expected 0 to {}", workers, max_workers)};
    }
    TripReception reception{.workers = static_cast<std::size_t>(workers),
                            .only_with_token = arguments.flag("--only-with-token")};
    for (const std::string name : {"--vehicles", "--method"}) {
        if (const auto value = arguments.value(name)) {
            reception.import_words.insert(reception.import_words.end(), {name, *value});
        }
    }
    return reception;
}

/// Parses the header by which a proxy names members of the staff. Over TCP any local program could
/// send it.
std::string parse_staff_header(const Arguments& arguments, const HttpServerConfig& config) {
    auto header = in_lower_case(arguments.value("--staff-header").value_or(""));
    if (header.empty()) {
        return header;
    }
    if (config.unix_socket.empty()) {
        throw UsageError{"--staff-header is believed on a Unix socket only, expected --listen "
                         "unix:FILE"};
    }
    constexpr std::string_view allowed = "abcdefghijklmnopqrstuvwxyz0123456789-";
    if (header.find_first_not_of(allowed) != std::string::npos || header == "authorization") {
        throw UsageError{fmt::format("--staff-header is '{}', expected the name of a header that "
                                     "the proxy sets, such as X-Forwarded-User",
                                     header)};
    }
    return header;
}

/// Rejects options that have no effect on a folder.
void expect_no_database_options(const Arguments& arguments) {
    for (const auto* const option : {"--staff-header", "--only-with-token"}) {
        if (arguments.is_given(option)) {
            throw UsageError{fmt::format("{} is for a database; a folder is shown to all", option)};
        }
    }
    for (const auto* const option : {"--title", "--left-hand"}) {
        if (arguments.is_given(option)) {
            throw UsageError{fmt::format("{} is for a database; a folder has what it was given by "
                                         "'macadam export --format site'",
                                         option)};
        }
    }
    if (parse_sections(arguments, false)) {
        throw UsageError{"--sections is for a database; a folder has no collections"};
    }
}

/// Rejects options of workers, which a database on a server has elsewhere.
void expect_no_workers(const Arguments& arguments) {
    for (const auto* const option : {"--workers", "--vehicles", "--method"}) {
        if (arguments.is_given(option)) {
            throw UsageError{fmt::format("{} is for a .gpkg file; 'macadam worker' imports what a "
                                         "database on a server receives",
                                         option)};
        }
    }
}

/// Keeps the copy of a database on a server up to date, in a thread of its own.
class CopyFollower {
public:
    CopyFollower(LocalCopy& copy, const Console& console)
        : thread_{[&copy, &console](const std::stop_token& stop) { follow(copy, console, stop); }} {
    }

private:
    static void follow(LocalCopy& copy, const Console& console, const std::stop_token& stop) {
        std::mutex mutex;
        std::unique_lock lock{mutex};
        std::condition_variable_any stopped;
        std::string trouble;
        while (!stopped.wait_for(lock, stop, look_every, [&] { return stop.stop_requested(); })) {
            try {
                copy.refresh({.report = {}, .stop = stop});
                trouble.clear();
            } catch (const std::exception& error) { // what was copied is served on
                if (std::exchange(trouble, error.what()) != error.what()) {
                    console.warn(error.what());
                }
            }
        }
    }

    static constexpr std::chrono::seconds look_every{5};
    std::jthread thread_;
};

/// Parses the sections, and cuts them once, so that an invalid file is refused at once.
std::optional<SectionOptions> parse_served_sections(const Arguments& arguments,
                                                    const std::filesystem::path& store) {
    auto sections = parse_sections(arguments, false);
    if (sections) {
        each_section(StoreReader::open(store), *sections, {}, [](const NamedSection&) {});
    }
    return sections;
}

void run_serve(const Arguments& arguments, const Console& console) {
    HttpServerConfig config;
    ServedAddress address;
    parse_listen(arguments.value("--listen").value_or("127.0.0.1:8080"), config);
    if (const auto url = arguments.value("--behind-proxy")) {
        parse_proxy(*url, config, address);
    }
    config.allowed_origins = parse_origins(arguments);
    config.workers = jobs_of(arguments);
    address.has_access_log = arguments.flag("--access-log");
    const auto started = [&](std::uint16_t port) {
        if (!config.unix_socket.empty()) {
            console.say(
                fmt::format("serving on unix:{}; Ctrl-C ends", config.unix_socket.string()));
            return;
        }
        const bool is_v6 = config.host.find(':') != std::string::npos;
        console.say(fmt::format("serving on http://{}{}{}:{}/; Ctrl-C ends",
                                is_v6 ? "[" : "",
                                config.host,
                                is_v6 ? "]" : "",
                                port));
    };
    const std::filesystem::path given = arguments.operand("STORE");
    if (std::filesystem::is_directory(given)) {
        expect_no_database_options(arguments);
        serve_folder(given, config, address, console, started);
        return;
    }
    const auto store = file_or_server(arguments);
    // Members of the staff see more of a crowd than the publications, if the key is here.
    LocalCopy copy{store,
                   wait_policy_for(store, console),
                   console.progress("reading drives"),
                   arguments.is_given("--staff-header") ? Audience::operator_ : Audience::anyone};
    const auto& file = copy.file();
    const bool is_on_server = copy.is_of_server();
    if (is_on_server) {
        expect_no_workers(arguments);
    }
    tell_publication(StoreReader::open(file), console);
    auto reception = parse_reception(arguments);
    reception.staff_header = parse_staff_header(arguments, config);
    const auto sections = parse_served_sections(arguments, file);
    std::optional<CopyFollower> follower;
    if (is_on_server) {
        follower.emplace(copy, console);
        reception.server = store.string();
    }
    serve_database(file,
                   Audience::anyone,
                   config,
                   address,
                   console,
                   started,
                   reception,
                   sections,
                   parse_site_look(arguments, store));
}

constexpr std::array operands{Operand{"STORE",
                                      "The road database, a .gpkg file or postgresql://..., or a "
                                      "folder made by 'macadam export --format site'."}};

constexpr std::array options{
    Option{"--listen",
           "HOST:PORT",
           "Address of this machine and port, 0 for any free one; or unix:FILE, a socket.",
           "127.0.0.1:8080"},
    Option{"--behind-proxy",
           "URL",
           "The public address, if a web server in front passes requests on; it must set "
           "X-Forwarded-For."},
    rare({"--staff-header",
          "NAME",
          "On a Unix socket: who is named in this header, by a proxy that logs staff in, may do as "
          "an operator."}),
    repeatable({"--allow-origin",
                "ORIGIN",
                "Let pages of this site, or * for all, read the answers (CORS); can be repeated."}),
    Option{"--only-with-token", "", "Show nothing without a token of scope read or operator."},
    Option{"--workers",
           "N",
           "Number of threads that import received trips; 0: 'macadam worker' does it.",
           "1"},
    vehicles_option,
    rare(method_option),
    sections_option,
    section_length_option,
    homogeneous_option,
    exclude_option,
    exclude_radius_option,
    Option{"--title", "TEXT", "Title of the page.", "the database's name"},
    preference(rare(
        {"--left-hand", "", "Traffic keeps left: maps draw each direction on the left side."})),
    Option{"--access-log", "", "Print a line for each request, without addresses and positions."},
    preference(
        {"--jobs", "N", "Number of requests that are worked on at once.", default_jobs_words})};

} // namespace

const Command serve_command{
    .name = "serve",
    .summary = "Serve a database to browsers and GIS programs",
    .about = "Answers on one address, until stopped: the map as a web page, OGC API - Features and "
             "Tiles for QGIS, ArcGIS and\n"
             "scripts, /health, and /metrics for Prometheus. A folder is served as files. Values "
             "follow the database while\n"
             "trips are imported; of a crowd database only the latest publication is shown. "
             "Holders of a token "
             "('macadam token')\n"
             "send trips, which are imported. Without a "
             "web server in front, only\n"
             "this machine can ask; docs/reference/serve.md has a configuration for nginx. INT and "
             "TERM (Ctrl-C) end the command\n"
             "with exit status 0.",
    .example = "  macadam serve roads.gpkg\n"
               "  curl 'http://127.0.0.1:8080/collections/segments/items?class=poor&limit=10'\n"
               "  macadam serve roads.gpkg --behind-proxy https://roads.example.org",
    .operands = operands,
    .options = options,
    .run = run_serve,
    .runs_until_stopped = true};

} // namespace macadam
