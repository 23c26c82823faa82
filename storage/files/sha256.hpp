#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace macadam {

/// Computes the SHA-256 of bytes that arrive in blocks.
class Sha256 {
public:
    Sha256();
    Sha256(Sha256&&) noexcept;
    Sha256& operator=(Sha256&&) noexcept;
    ~Sha256();

    void add(std::string_view bytes);

    /// 64 lower-case hex digits over everything added so far; nothing can be added afterwards.
    std::string hex();

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace macadam
