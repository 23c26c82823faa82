#include "storage/files/byte_stream.hpp"

#include "estimator/common/error.hpp"

#include <fmt/core.h>

#include <cerrno>
#include <fcntl.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace macadam {

namespace {

class FileBytes final : public ByteStream {
public:
    FileBytes(std::string name, int file) : name_{std::move(name)}, file_{file} {
        if (file_ < 0) {
            fail();
        }
    }
    ~FileBytes() override { ::close(file_); }

    std::size_t read(std::span<char> into) override {
        const auto count = ::read(file_, into.data(), into.size());
        if (count < 0) {
            fail();
        }
        consumed_ += static_cast<std::uint64_t>(count);
        return static_cast<std::size_t>(count);
    }

    std::uint64_t consumed() const override { return consumed_; }

private:
    [[noreturn]] void fail() const {
        const auto cause = std::generic_category().message(errno);
        throw InputError{fmt::format("{}: cannot be read: {}", name_, cause)};
    }

    std::string name_;
    int file_;
    std::uint64_t consumed_ = 0;
};

} // namespace

std::unique_ptr<ByteStream> file_bytes(const std::filesystem::path& file) {
    return std::make_unique<FileBytes>(file.string(), ::open(file.c_str(), O_RDONLY | O_CLOEXEC));
}

std::unique_ptr<ByteStream> standard_input_bytes() {
    return std::make_unique<FileBytes>("standard input", ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0));
}

} // namespace macadam
