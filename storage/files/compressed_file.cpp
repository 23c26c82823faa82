#include "storage/files/compressed_file.hpp"

#include <zlib.h>
#include <zstd.h>

#include <new>
#include <vector>

namespace macadam {

class CompressedFile::Encoder {
public:
    Encoder() = default;
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;
    virtual ~Encoder() = default;

    /// \param last  ends the stream and writes its trailer.
    virtual void encode(std::string_view bytes, bool last, AtomicFile& to) = 0;
};

namespace {

constexpr std::size_t output_block = 256 << 10;

class Gzip final : public CompressedFile::Encoder {
public:
    explicit Gzip(int level) : block_(output_block) {
        constexpr int gzip_header = 15 + 16; // zlib.h: window bits, plus 16 for gzip
        constexpr int usual_memory = 8;
        if (deflateInit2(
                &state_, level, Z_DEFLATED, gzip_header, usual_memory, Z_DEFAULT_STRATEGY) !=
            Z_OK) {
            throw std::bad_alloc{};
        }
    }
    ~Gzip() override { deflateEnd(&state_); }

    void encode(std::string_view bytes, bool last, AtomicFile& to) override {
        constexpr std::size_t most_at_once = 1 << 30; // zlib counts in 32 bits
        for (; bytes.size() > most_at_once; bytes.remove_prefix(most_at_once)) {
            encode(bytes.substr(0, most_at_once), false, to);
        }
        // zlib takes a pointer to non-const, but does not write to it.
        state_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data())); // NOLINT
        state_.avail_in = static_cast<uInt>(bytes.size());
        do {
            state_.next_out = reinterpret_cast<Bytef*>(block_.data()); // NOLINT(*-reinterpret-cast)
            state_.avail_out = static_cast<uInt>(block_.size());
            deflate(&state_, last ? Z_FINISH : Z_NO_FLUSH);
            to.write({block_.data(), block_.size() - state_.avail_out});
        } while (state_.avail_out == 0);
    }

private:
    std::vector<char> block_;
    z_stream state_{};
};

class Zstd final : public CompressedFile::Encoder {
public:
    explicit Zstd(int level) : block_(output_block), state_{ZSTD_createCStream()} {
        if (!state_) {
            throw std::bad_alloc{};
        }
        ZSTD_CCtx_setParameter(state_.get(), ZSTD_c_compressionLevel, level);
        ZSTD_CCtx_setParameter(state_.get(), ZSTD_c_checksumFlag, 1);
    }

    void encode(std::string_view bytes, bool last, AtomicFile& to) override {
        ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
        for (;;) {
            ZSTD_outBuffer out{block_.data(), block_.size(), 0};
            const auto left =
                ZSTD_compressStream2(state_.get(), &out, &in, last ? ZSTD_e_end : ZSTD_e_continue);
            if (ZSTD_isError(left) != 0) {
                throw std::bad_alloc{}; // with valid parameters, only memory can be short
            }
            to.write({block_.data(), out.pos});
            if (last ? left == 0 : in.pos == in.size) {
                return;
            }
        }
    }

private:
    struct Free {
        void operator()(ZSTD_CStream* state) const { ZSTD_freeCStream(state); }
    };

    std::vector<char> block_;
    std::unique_ptr<ZSTD_CStream, Free> state_;
};

std::unique_ptr<CompressedFile::Encoder> encoder(Compression compression, int level) {
    switch (compression) {
    case Compression::gzip:
        return std::make_unique<Gzip>(level);
    case Compression::zstd:
        return std::make_unique<Zstd>(level);
    case Compression::none:
        break;
    }
    return nullptr;
}

} // namespace

Compression compression_of(const std::filesystem::path& file) {
    const auto suffix = file.extension();
    return suffix == ".gz"    ? Compression::gzip
           : suffix == ".zst" ? Compression::zstd
                              : Compression::none;
}

CompressedFile::CompressedFile(const std::filesystem::path& file,
                               Compression compression,
                               int level)
    : file_{file}, encoder_{encoder(compression, level)} {}

CompressedFile::~CompressedFile() = default;

void CompressedFile::write(std::string_view bytes) {
    if (encoder_) {
        encoder_->encode(bytes, false, file_);
    } else {
        file_.write(bytes);
    }
}

void CompressedFile::commit() {
    if (encoder_) {
        encoder_->encode({}, true, file_);
    }
    file_.commit();
}

} // namespace macadam
