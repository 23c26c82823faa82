#pragma once

#include <memory>
#include <mutex>
#include <string>

namespace macadam {

/// Value that is computed once for each version of the database, by who first needs it.
template <typename Value>
class PerVersion {
public:
    template <typename Make>
    std::shared_ptr<const Value> get(const std::string& version, const Make& make) {
        const std::lock_guard lock{mutex_};
        if (!value_ || version_ != version) {
            value_ = std::make_shared<const Value>(make());
            version_ = version;
        }
        return value_;
    }

private:
    std::mutex mutex_;
    std::string version_;
    std::shared_ptr<const Value> value_;
};

} // namespace macadam
