#include "app/jobs/upload_server.hpp"

#include "storage/files/sha256.hpp"
#include "support/program/program.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <csignal>
#include <thread>
#include <vector>

namespace macadam::testing {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto patience = 60s; // of a machine that is busy

} // namespace

std::string sha256_of(std::string_view bytes) {
    Sha256 hash;
    hash.add(bytes);
    return hash.hex();
}

std::string target_of(std::string_view log) {
    return "/v1/trips/" + sha256_of(log);
}

void UploadServer::start() {
    program_ = std::make_unique<PipedProgram>(std::vector<std::string>{
        "serve", address_, "--listen", fmt::format("127.0.0.1:{}", port_), "--quiet"});
    for (const auto end = Clock::now() + patience; Clock::now() < end;) {
        if (get(port_, "/health").status == 200) {
            return;
        }
        std::this_thread::sleep_for(10ms);
    }
    ADD_FAILURE() << "the server does not answer";
}

void UploadServer::kill() {
    program_->signal(SIGKILL);
    program_->wait();
}

std::string UploadServer::token(const std::string& owner, const std::string& scope) const {
    auto made = run_macadam({"token", "create", address_, owner, "--scope", scope, "--quiet"});
    EXPECT_EQ(made.exit_status, 0) << made.err;
    made.out.erase(made.out.find_last_not_of('\n') + 1);
    return made.out;
}

Answer UploadServer::ask(std::string_view method,
                         std::string_view target,
                         std::string_view token,
                         std::string_view body) const {
    Answer answer;
    for (const auto end = Clock::now() + patience; Clock::now() < end;) {
        HttpClient client{port_};
        client.send(fmt::format(
            "{} {} HTTP/1.1\r\nHost: localhost\r\n{}Content-Type: text/csv\r\n{}\r\n{}",
            method,
            target,
            token.empty() ? std::string{} : fmt::format("Authorization: Bearer {}\r\n", token),
            body.empty() ? std::string{} : fmt::format("Content-Length: {}\r\n", body.size()),
            body));
        answer = client.answer();
        if (answer.status != 503 || answer.body.find("cannot be") == std::string::npos) {
            break;
        }
        std::this_thread::sleep_for(100ms);
    }
    return answer;
}

Answer UploadServer::put(std::string_view log, std::string_view token) const {
    return ask("PUT", target_of(log), token, log);
}

bool UploadServer::await(std::string_view target, std::string_view token, int status) const {
    for (const auto end = Clock::now() + patience; Clock::now() < end;) {
        if (ask("GET", target, token).status == status) {
            return true;
        }
        std::this_thread::sleep_for(200ms); // wrong tokens are counted
    }
    return false;
}

std::string UploadServer::state(std::string_view log, std::string_view token) const {
    return nlohmann::json::parse(ask("GET", target_of(log), token).body)
        .at("state")
        .get<std::string>();
}

} // namespace macadam::testing
