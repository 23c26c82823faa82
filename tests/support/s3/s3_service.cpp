#include "support/s3/s3_service.hpp"
#include "support/program/places.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <stdexcept>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace macadam::testing {

S3Service::S3Service(const std::filesystem::path& folder, const std::vector<std::string>& options) {
    std::array<int, 2> input{}, output{};
    if (pipe2(input.data(), O_CLOEXEC) != 0 || pipe2(output.data(), O_CLOEXEC) != 0) {
        throw std::runtime_error{"no pipe for the service"};
    }
    std::vector<std::string> words{
        MACADAM_NODE, source_folder() + "/tests/support/s3/server.mjs", folder.string()};
    words.insert(words.end(), options.begin(), options.end());
    std::vector<char*> argv;
    for (auto& word : words) {
        argv.push_back(word.data());
    }
    argv.push_back(nullptr);
    child_ = fork();
    if (child_ == 0) {
        dup2(input[0], STDIN_FILENO);
        dup2(output[1], STDOUT_FILENO);
        execv(argv[0], argv.data());
        _exit(127);
    }
    close(input[0]);
    close(output[1]);
    input_ = input[1];
    std::string line;
    for (char c = 0; read(output[0], &c, 1) == 1 && c != '\n';) {
        line += c;
    }
    close(output[0]);
    port_ = std::atoi(line.c_str());
    if (port_ == 0) {
        throw std::runtime_error{"s3rver did not start; ./run test installs it (npm ci in "
                                 "tests/support/s3)"};
    }
    setenv("AWS_ENDPOINT_URL", fmt::format("http://127.0.0.1:{}", port_).c_str(), 1);
    setenv("AWS_ACCESS_KEY_ID", "S3RVER", 1);
    setenv("AWS_SECRET_ACCESS_KEY", "S3RVER", 1);
    for (const auto* const name : {"AWS_ENDPOINT_URL_S3", "AWS_SESSION_TOKEN", "http_proxy"}) {
        unsetenv(name);
    }
}

S3Service::~S3Service() {
    close(input_);
    waitpid(child_, nullptr, 0);
}

} // namespace macadam::testing
