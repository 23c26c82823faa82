
#include "storage/files/decompress.hpp"

#include "estimator/common/error.hpp"

#include <fmt/core.h>
#include <zlib.h>
#include <zstd.h>

#include <new>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {

namespace {

constexpr std::size_t input_block = 256 << 10;

/// Stream whose first bytes were already read to detect its format.
class PrefixedStream final : public ByteStream {
public:
    PrefixedStream(std::string head, std::unique_ptr<ByteStream> from)
        : head_{std::move(head)}, from_{std::move(from)} {}

    std::size_t read(std::span<char> into) override {
        if (head_.empty()) {
            return from_->read(into);
        }
        const auto count = head_.copy(into.data(), into.size());
        head_.erase(0, count);
        return count;
    }

    std::uint64_t consumed() const override { return from_->consumed(); }

private:
    std::string head_;
    std::unique_ptr<ByteStream> from_;
};

/// Input block of a decoder.
class Input {
public:
    explicit Input(std::unique_ptr<ByteStream> from)
        : from_{std::move(from)}, block_(input_block) {}

    /// Unread bytes of the block, or the next block; empty at the end.
    std::span<char> rest() {
        if (rest_.empty()) {
            rest_ = std::span{block_}.first(from_->read(block_));
        }
        return rest_;
    }

    void keep_last(std::size_t count) { rest_ = rest_.last(count); }
    std::uint64_t consumed() const { return from_->consumed(); }

private:
    std::unique_ptr<ByteStream> from_;
    std::vector<char> block_;
    std::span<char> rest_;
};

class Gunzipped final : public ByteStream {
public:
    Gunzipped(std::unique_ptr<ByteStream> from, std::string name)
        : input_{std::move(from)}, name_{std::move(name)} {
        if (inflateInit2(&state_, gzip_only) != Z_OK) {
            throw std::bad_alloc{};
        }
    }
    ~Gunzipped() override { inflateEnd(&state_); }

    std::size_t read(std::span<char> into) override {
        state_.next_out = reinterpret_cast<Bytef*>(into.data()); // NOLINT(*-reinterpret-cast)
        state_.avail_out = static_cast<uInt>(into.size());
        while (state_.avail_out == into.size() && !into.empty()) {
            const auto rest = input_.rest();
            if (rest.empty() && !within_) {
                return 0;
            }
            inflate_some(rest); // output may remain when all input was consumed
            if (rest.empty() && state_.avail_out == into.size()) {
                throw InputError{fmt::format("{}: the gzip data is truncated", name_)};
            }
        }
        return into.size() - state_.avail_out;
    }

    std::uint64_t consumed() const override { return input_.consumed(); }

private:
    static constexpr int gzip_only = 15 + 16; // zlib.h: window bits, plus 16 for a gzip header

    void inflate_some(std::span<char> rest) {
        state_.next_in = reinterpret_cast<Bytef*>(rest.data()); // NOLINT(*-reinterpret-cast)
        state_.avail_in = static_cast<uInt>(rest.size());
        within_ = true;
        const auto result = inflate(&state_, Z_NO_FLUSH);
        input_.keep_last(state_.avail_in);
        if (result == Z_STREAM_END) { // another member may follow: "cat a.gz b.gz"
            within_ = false;
            inflateReset(&state_);
        } else if (result != Z_OK && result != Z_BUF_ERROR) {
            throw InputError{fmt::format("{}: the gzip data is damaged: {}",
                                         name_,
                                         state_.msg != nullptr ? state_.msg : "not readable")};
        }
    }

    Input input_;
    std::string name_;
    z_stream state_{};
    bool within_ = false;
};

class Unzstded final : public ByteStream {
public:
    Unzstded(std::unique_ptr<ByteStream> from, std::string name)
        : input_{std::move(from)}, name_{std::move(name)}, state_{ZSTD_createDStream()} {
        if (!state_) {
            throw std::bad_alloc{};
        }
    }

    std::size_t read(std::span<char> into) override {
        ZSTD_outBuffer out{into.data(), into.size(), 0};
        while (out.pos == 0 && !into.empty()) {
            const auto rest = input_.rest();
            ZSTD_inBuffer in{rest.data(), rest.size(), 0};
            if (rest.empty() && !within_) {
                return 0;
            }
            const auto result = ZSTD_decompressStream(state_.get(), &out, &in);
            if (ZSTD_isError(result) != 0) {
                throw InputError{fmt::format(
                    "{}: the zstd data is damaged: {}", name_, ZSTD_getErrorName(result))};
            }
            if (rest.empty() && out.pos == 0) {
                throw InputError{fmt::format("{}: the zstd data is truncated", name_)};
            }
            input_.keep_last(rest.size() - in.pos);
            within_ = result != 0; // 0: the frame has ended and is fully decoded
        }
        return out.pos;
    }

    std::uint64_t consumed() const override { return input_.consumed(); }

private:
    struct Free {
        void operator()(ZSTD_DStream* state) const { ZSTD_freeDStream(state); }
    };

    Input input_;
    std::string name_;
    std::unique_ptr<ZSTD_DStream, Free> state_;
    bool within_ = false;
};

class Bounded final : public ByteStream {
public:
    Bounded(std::unique_ptr<ByteStream> from, std::string name)
        : from_{std::move(from)}, name_{std::move(name)} {}

    std::size_t read(std::span<char> into) override {
        const auto count = from_->read(into);
        came_ += count;
        if (came_ > max_decompressed_bytes) {
            throw InputError{fmt::format(
                "{}: grows beyond {} MiB when decompressed", name_, max_decompressed_bytes >> 20)};
        }
        if (came_ > free_decompressed_bytes && came_ > max_expansion * consumed()) {
            throw InputError{fmt::format("{}: grows more than {}-fold when decompressed, which "
                                         "no trip log does",
                                         name_,
                                         max_expansion)};
        }
        return count;
    }

    std::uint64_t consumed() const override { return from_->consumed(); }

private:
    std::unique_ptr<ByteStream> from_;
    std::string name_;
    std::uint64_t came_ = 0;
};

std::string first_bytes(ByteStream& stream, std::size_t count) {
    std::string head(count, '\0');
    std::size_t have = 0;
    while (have < count) {
        const auto more = stream.read(std::span{head}.subspan(have));
        if (more == 0) {
            break;
        }
        have += more;
    }
    head.resize(have);
    return head;
}

} // namespace

std::unique_ptr<ByteStream> bounded(std::unique_ptr<ByteStream> from, const std::string& name) {
    return std::make_unique<Bounded>(std::move(from), name);
}

std::unique_ptr<ByteStream> decompressed(std::unique_ptr<ByteStream> from,
                                         const std::string& name) {
    constexpr std::string_view gzip_magic = "\x1f\x8b";         // RFC 1952, 2.3.1
    constexpr std::string_view zstd_magic = "\x28\xb5\x2f\xfd"; // RFC 8878, 3.1.1
    const auto head = first_bytes(*from, zstd_magic.size());
    auto whole = std::make_unique<PrefixedStream>(head, std::move(from));
    if (head.starts_with(gzip_magic)) {
        return bounded(std::make_unique<Gunzipped>(std::move(whole), name), name);
    }
    if (head == zstd_magic) {
        return bounded(std::make_unique<Unzstded>(std::move(whole), name), name);
    }
    return whole;
}

} // namespace macadam
