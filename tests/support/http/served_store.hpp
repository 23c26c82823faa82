#pragma once

#include "app/cli/console.hpp"
#include "app/serve/api_server.hpp"
#include "support/files/files.hpp"
#include "support/http/http_client.hpp"
#include "support/roads/store_world.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <future>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>

namespace macadam::testing {

/// Server of a database with three trips over way 1, for as long as it lives.
struct ServedWorld {
    explicit ServedWorld(const HttpServerConfig& config = {.port = 0},
                         const ServedAddress& address = {},
                         const std::optional<SectionOptions>& sections = {},
                         const SiteLook& look = {})
        : server{[this, config, address, sections, look] {
              serve_database(
                  file,
                  Audience::anyone,
                  config,
                  address,
                  Console{Verbosity::quiet, stop.get_token()},
                  [this](std::uint16_t its_port) { started.set_value(its_port); },
                  {},
                  sections,
                  look);
          }} {}
    ~ServedWorld() { stop.request_stop(); }
    ServedWorld(const ServedWorld&) = delete;
    ServedWorld& operator=(const ServedWorld&) = delete;

    Answer ask(const std::string& target, std::string_view headers = {}) const {
        return get(port, target, headers);
    }

    nlohmann::json page(const std::string& target) const {
        const auto answer = ask(target);
        EXPECT_EQ(answer.status, 200) << target << answer.body;
        return nlohmann::json::parse(answer.body);
    }

    /// Follows an address of this server.
    nlohmann::json follow(const std::string& href) const { return page(target_of(href)); }

    /// Part of an address of this server that a request names.
    std::string target_of(const std::string& href) const {
        const auto base = fmt::format("http://127.0.0.1:{}", port);
        EXPECT_TRUE(href.starts_with(base)) << href;
        return href.substr(base.size());
    }

    static std::filesystem::path new_file() {
        const auto path = test_folder() / "roads.gpkg";
        auto store = new_store(path);
        import_trips(store, 3);
        return path;
    }

    std::filesystem::path file = new_file();
    std::stop_source stop;
    std::promise<std::uint16_t> started;
    std::jthread server;
    std::uint16_t port = started.get_future().get();
};

} // namespace macadam::testing
