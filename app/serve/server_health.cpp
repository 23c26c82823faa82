#include "app/serve/server_health.hpp"

#include "storage/text/json.hpp"

#include <utility>

namespace macadam {

void ServerHealth::warn(std::string reason) {
    const std::lock_guard lock{mutex_};
    reason_ = std::move(reason);
}

HttpResponse ServerHealth::response() const {
    JsonObject health;
    {
        const std::lock_guard lock{mutex_};
        health.add("status", reason_.empty() ? "pass" : "warn");
        if (!reason_.empty()) {
            health.add("output", reason_);
        }
    }
    return {.type = "application/health+json",
            .body = health.text() + "\n",
            .cache_control = "no-store",
            .route = "/health"};
}

} // namespace macadam
