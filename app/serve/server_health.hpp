#pragma once

#include "app/http/http_message.hpp"

#include <mutex>
#include <string>

namespace macadam {

/// Health of a server as monitors ask for it (draft-inadarei-api-health-check-06). Thread-safe.
class ServerHealth {
public:
    /// \param reason  what is wrong though the server answers, for all to read; "" = all is well
    void warn(std::string reason);

    /// Answer to /health, whose status is 200 while the server answers.
    HttpResponse response() const;

private:
    mutable std::mutex mutex_;
    std::string reason_; ///< guarded by the mutex
};

} // namespace macadam
