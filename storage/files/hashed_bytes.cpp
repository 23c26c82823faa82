#include "storage/files/hashed_bytes.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace macadam {
namespace {

constexpr std::size_t block_bytes = 64 << 10; // malloc keeps it for the next file

} // namespace

HashedBytes::HashedBytes(std::unique_ptr<ByteStream> from) : from_{std::move(from)} {}

std::size_t HashedBytes::read(std::span<char> into) {
    if (ahead_.empty()) {
        return fetch(into);
    }
    const auto& block = ahead_.front();
    const auto count = block.copy(into.data(), into.size(), at_);
    at_ += count;
    if (at_ == block.size()) {
        ahead_.pop_front();
        at_ = 0;
    }
    return count;
}

std::size_t HashedBytes::fetch(std::span<char> into) {
    if (failure_) {
        std::rethrow_exception(failure_);
    }
    if (ended_) { // also if the file has grown since
        return 0;
    }
    try {
        const auto count = from_->read(into);
        hash_.add({into.data(), count});
        ended_ = count == 0 && !into.empty();
        return count;
    } catch (...) {
        failure_ = std::current_exception();
        throw;
    }
}

bool HashedBytes::read_ahead(std::size_t max_bytes) {
    for (std::size_t size = 0; !ended_ && size < max_bytes;) {
        std::string block(std::min(block_bytes, max_bytes - size), '\0');
        std::size_t count = 0;
        while (count < block.size() && !ended_) {
            count += fetch(std::span{block}.subspan(count));
        }
        block.resize(count);
        size += count;
        if (count > 0) {
            ahead_.push_back(std::move(block));
        }
    }
    return ended_;
}

std::string HashedBytes::sha256() {
    if (sha256_.empty()) {
        std::vector<char> rest(block_bytes);
        while (!ended_) {
            fetch(rest);
        }
        sha256_ = hash_.hex();
    }
    return sha256_;
}

} // namespace macadam
