#include "app/http/http_stream.hpp"

#include <algorithm>
#include <utility>

namespace macadam {

void HttpStream::send(std::string_view bytes) {
    const std::lock_guard lock{mutex_};
    bytes_ += bytes;
    wake_up();
}

void HttpStream::end() {
    const std::lock_guard lock{mutex_};
    has_ended_ = true;
    wake_up();
}

bool HttpStream::is_closed() const {
    const std::lock_guard lock{mutex_};
    return is_closed_;
}

std::optional<std::size_t> HttpStream::take(std::span<char> to,
                                            const std::function<void()>& wait,
                                            std::function<void()> wake) {
    const std::lock_guard lock{mutex_};
    if (bytes_.empty() && !has_ended_) {
        wait(); // before anybody can wake it
        wake_ = std::move(wake);
        return std::nullopt;
    }
    const auto count = std::min(bytes_.size(), to.size());
    std::copy_n(bytes_.begin(), count, to.begin());
    bytes_.erase(0, count);
    return count;
}

void HttpStream::close() {
    const std::lock_guard lock{mutex_};
    is_closed_ = true;
    wake_ = nullptr;
}

void HttpStream::wake_up() {
    if (const auto wake = std::exchange(wake_, nullptr)) {
        wake();
    }
}

void OpenStreams::add(const std::shared_ptr<HttpStream>& stream) {
    const std::lock_guard lock{mutex_};
    std::erase_if(streams_, [](const auto& each) { return each.expired(); });
    streams_.push_back(stream);
    if (has_ended_) {
        stream->end();
    }
}

void OpenStreams::end_all() {
    const std::lock_guard lock{mutex_};
    has_ended_ = true;
    for (const auto& each : streams_) {
        if (const auto stream = each.lock()) {
            stream->end();
        }
    }
}

} // namespace macadam
