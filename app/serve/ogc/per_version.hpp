#pragma once

#include <chrono>
#include <exception>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace macadam {

/// Value takes longer to compute than a request may wait.
struct StillComputing {};

/// Value that is computed once for each version of the database, by who first needs it. Others wait
/// for it; those that need what is there already are never held up.
template <typename Value>
class PerVersion {
public:
    using Shared = std::shared_ptr<const Value>;

    /// \throws StillComputing  after max_time, if another computes it
    template <typename Make>
    Shared get(const std::string& version, const Make& make) {
        std::optional<std::promise<Shared>> own;
        std::shared_future<Shared> value;
        {
            const std::lock_guard lock{mutex_};
            if (!value_.valid() || version_ != version) {
                value_ = own.emplace().get_future().share();
                version_ = version;
            }
            value = value_;
        }
        if (own) {
            compute(*own, version, make);
        } else if (value.wait_for(max_time) != std::future_status::ready) {
            throw StillComputing{};
        }
        return value.get();
    }

    static constexpr std::chrono::seconds max_time{10};

private:
    template <typename Make>
    void compute(std::promise<Shared>& promise, const std::string& version, const Make& make) {
        try {
            promise.set_value(std::make_shared<const Value>(make()));
        } catch (...) {
            promise.set_exception(std::current_exception());
            const std::lock_guard lock{mutex_};
            if (version_ == version) { // the next one tries again
                value_ = {};
            }
        }
    }

    std::mutex mutex_;
    std::string version_;
    std::shared_future<Shared> value_;
};

} // namespace macadam
