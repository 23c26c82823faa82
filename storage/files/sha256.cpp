#include "storage/files/sha256.hpp"

#include <fmt/core.h>
#include <openssl/evp.h>

#include <array>
#include <new>
#include <span>

namespace macadam {

struct Sha256::State {
    struct Free {
        void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
    };
    std::unique_ptr<EVP_MD_CTX, Free> context{EVP_MD_CTX_new()};
};

// OpenSSL's digest calls fail only for lack of memory.
Sha256::Sha256() : state_{std::make_unique<State>()} {
    if (!state_->context || EVP_DigestInit_ex(state_->context.get(), EVP_sha256(), nullptr) != 1) {
        throw std::bad_alloc{};
    }
}

Sha256::Sha256(Sha256&&) noexcept = default;
Sha256& Sha256::operator=(Sha256&&) noexcept = default;
Sha256::~Sha256() = default;

void Sha256::add(std::string_view bytes) {
    if (EVP_DigestUpdate(state_->context.get(), bytes.data(), bytes.size()) != 1) {
        throw std::bad_alloc{};
    }
}

std::string Sha256::hex() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int size = 0;
    if (EVP_DigestFinal_ex(state_->context.get(), digest.data(), &size) != 1) {
        throw std::bad_alloc{};
    }
    std::string text;
    for (const auto byte : std::span{digest}.first(size)) {
        text += fmt::format("{:02x}", byte);
    }
    return text;
}

} // namespace macadam
