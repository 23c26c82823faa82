#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace macadam {

/// Table of what each client, by its address, has the server hold. For one thread.
class ClientLoads {
public:
    /// Counts a request at work. \returns false, and counts none, if there are `most` already.
    bool add_request(const std::string& client, std::size_t most);
    void remove_request(const std::string& client);

    /// Counts bytes of an answer that is kept in memory until the client has read it. \returns
    /// false, and counts none, if they and unread ones of earlier answers are more than `most`; an
    /// only answer may have any size.
    bool add_unread(const std::string& client, std::uint64_t bytes, std::uint64_t most);
    void remove_unread(const std::string& client, std::uint64_t bytes);

    std::uint64_t unread_bytes() const { return unread_bytes_; } ///< of all clients

private:
    struct Load {
        std::size_t requests = 0;
        std::uint64_t unread_bytes = 0;
    };

    void drop_if_empty(std::map<std::string, Load>::iterator load);

    std::map<std::string, Load> loads_;
    std::uint64_t unread_bytes_ = 0;
};

inline bool ClientLoads::add_request(const std::string& client, std::size_t most) {
    const auto load = loads_.try_emplace(client).first;
    const bool has_room = load->second.requests < most;
    load->second.requests += has_room ? 1 : 0;
    drop_if_empty(load);
    return has_room;
}

inline void ClientLoads::remove_request(const std::string& client) {
    const auto load = loads_.find(client);
    --load->second.requests;
    drop_if_empty(load);
}

inline bool
ClientLoads::add_unread(const std::string& client, std::uint64_t bytes, std::uint64_t most) {
    const auto load = loads_.try_emplace(client).first;
    auto& unread = load->second.unread_bytes;
    const bool has_room = unread == 0 || unread + bytes <= most;
    if (has_room) {
        unread += bytes;
        unread_bytes_ += bytes;
    }
    drop_if_empty(load);
    return has_room;
}

inline void ClientLoads::remove_unread(const std::string& client, std::uint64_t bytes) {
    if (bytes == 0) {
        return;
    }
    const auto load = loads_.find(client);
    load->second.unread_bytes -= bytes;
    unread_bytes_ -= bytes;
    drop_if_empty(load);
}

inline void ClientLoads::drop_if_empty(std::map<std::string, Load>::iterator load) {
    if (load->second.requests == 0 && load->second.unread_bytes == 0) {
        loads_.erase(load);
    }
}

} // namespace macadam
