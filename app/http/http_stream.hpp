#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Body of a response that goes on: its bytes are sent as they come. Thread-safe.
class HttpStream {
public:
    HttpStream() = default;
    HttpStream(const HttpStream&) = delete;
    HttpStream& operator=(const HttpStream&) = delete;

    /// Adds bytes to be sent.
    void send(std::string_view bytes);

    /// Ends the body after the bytes that were added.
    void end();

    /// Tells whether nobody receives it any longer.
    bool is_closed() const;

    /// Copies bytes that are to be sent. \returns their number, 0 at the end; `std::nullopt`: there
    /// are none yet, and `wait` was called, and later `wake` is, once, from any thread.
    std::optional<std::size_t>
    take(std::span<char> to, const std::function<void()>& wait, std::function<void()> wake);

    /// Tells that nobody receives it any longer; `wake` is not called from then on.
    void close();

private:
    void wake_up();

    mutable std::mutex mutex_; ///< guards the members below
    std::string bytes_;
    bool has_ended_ = false;
    bool is_closed_ = false;
    std::function<void()> wake_; ///< set while the receiver waits
};

/// Streams that are being sent, which end when the server stops. Thread-safe.
class OpenStreams {
public:
    void add(const std::shared_ptr<HttpStream>& stream);

    /// Ends them, and those that are added later.
    void end_all();

private:
    std::mutex mutex_; ///< guards the members below
    std::vector<std::weak_ptr<HttpStream>> streams_;
    bool has_ended_ = false;
};

} // namespace macadam
