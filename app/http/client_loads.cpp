#include "app/http/client_loads.hpp"

namespace macadam {

bool ClientLoads::add_request(const std::string& client, std::size_t most) {
    const auto load = loads_.try_emplace(client).first;
    const bool has_room = load->second.requests < most;
    load->second.requests += has_room ? 1 : 0;
    drop_if_empty(load);
    return has_room;
}

void ClientLoads::remove_request(const std::string& client) {
    const auto load = loads_.find(client);
    --load->second.requests;
    drop_if_empty(load);
}

bool ClientLoads::add_unread(const std::string& client, std::uint64_t bytes, std::uint64_t most) {
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

void ClientLoads::remove_unread(const std::string& client, std::uint64_t bytes) {
    if (bytes == 0) {
        return;
    }
    const auto load = loads_.find(client);
    load->second.unread_bytes -= bytes;
    unread_bytes_ -= bytes;
    drop_if_empty(load);
}

void ClientLoads::drop_if_empty(std::map<std::string, Load>::iterator load) {
    if (load->second.requests == 0 && load->second.unread_bytes == 0) {
        loads_.erase(load);
    }
}

} // namespace macadam
