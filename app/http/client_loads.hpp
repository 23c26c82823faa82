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

} // namespace macadam
