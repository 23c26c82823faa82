#include "storage/trips/foreign/text_decoding.hpp"

#include "estimator/common/error.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <vector>

namespace macadam {

namespace {

constexpr std::size_t block = 64 << 10;
constexpr std::uint32_t replacement = 0xFFFD;

void append_utf8(std::uint32_t letter, std::string& text) {
    const auto more = [&](unsigned shift) {
        text += static_cast<char>(0x80U | ((letter >> shift) & 0x3FU));
    };
    if (letter < 0x80) {
        text += static_cast<char>(letter);
    } else if (letter < 0x800) {
        text += static_cast<char>(0xC0U | (letter >> 6U));
        more(0);
    } else if (letter < 0x10000) {
        text += static_cast<char>(0xE0U | (letter >> 12U));
        more(6);
        more(0);
    } else {
        text += static_cast<char>(0xF0U | (letter >> 18U));
        more(12);
        more(6);
        more(0);
    }
}

/// Converts UTF-16 to UTF-8; blocks may be split at any byte.
class Utf16Decoder {
public:
    std::string operator()(std::string_view bytes) {
        std::string text;
        for (const char byte : bytes) {
            const auto value = static_cast<std::uint32_t>(static_cast<unsigned char>(byte));
            if (!has_low_) {
                low_ = value;
            } else {
                take(low_ | (value << 8U), text);
            }
            has_low_ = !has_low_;
        }
        return text;
    }

private:
    void take(std::uint32_t unit, std::string& text) {
        const bool second = unit >= 0xDC00 && unit < 0xE000;
        if (first_ != 0 && second) {
            append_utf8(0x10000 + ((first_ - 0xD800) << 10U) + (unit - 0xDC00), text);
            first_ = 0;
            return;
        }
        if (first_ != 0) {
            append_utf8(replacement, text);
        }
        first_ = unit >= 0xD800 && unit < 0xDC00 ? unit : 0;
        if (first_ == 0) {
            append_utf8(second ? replacement : unit, text);
        }
    }

    std::uint32_t low_ = 0;
    std::uint32_t first_ = 0; ///< high surrogate that awaits its low surrogate
    bool has_low_ = false;
};

class DecodedBytes final : public ByteStream {
public:
    DecodedBytes(std::unique_ptr<ByteStream> from, TextEncoding encoding, std::string name)
        : from_{std::move(from)}, encoding_{encoding}, name_{std::move(name)} {}

    std::size_t read(std::span<char> into) override {
        while (next_ == ready_.size() && !ended_) {
            fill();
        }
        const auto count = std::min(into.size(), ready_.size() - next_);
        std::copy_n(ready_.begin() + static_cast<std::ptrdiff_t>(next_), count, into.begin());
        next_ += count;
        return count;
    }

    std::uint64_t consumed() const override { return from_->consumed(); }

private:
    void fill() {
        std::vector<char> buffer(block);
        std::size_t count = from_->read(buffer);
        while (!begun_ && count == 1) { // the byte order mark may be split
            const auto more = from_->read(std::span{buffer}.subspan(1));
            if (more == 0) {
                break;
            }
            count += more;
        }
        ended_ = count == 0;
        const std::string_view bytes{buffer.data(), count};
        if (!begun_) {
            begin_with(bytes);
        }
        ready_ = encoding_ == TextEncoding::utf16le  ? decode_(bytes)
                 : encoding_ == TextEncoding::latin1 ? utf8_of_latin1(bytes)
                                                     : std::string{bytes};
        next_ = 0;
    }

    void begin_with(std::string_view bytes) {
        begun_ = true;
        if (bytes.starts_with("\xfe\xff")) {
            throw InputError{fmt::format(
                "{}: is UTF-16 with the high byte first, expected UTF-8 or UTF-16LE", name_)};
        }
        encoding_ = bytes.starts_with("\xff\xfe") ? TextEncoding::utf16le : encoding_;
    }

    std::unique_ptr<ByteStream> from_;
    TextEncoding encoding_;
    std::string name_;
    Utf16Decoder decode_;
    std::string ready_;
    std::size_t next_ = 0;
    bool begun_ = false;
    bool ended_ = false;
};

} // namespace

std::string utf8_of_latin1(std::string_view text) {
    std::string utf8;
    for (const char letter : text) {
        append_utf8(static_cast<unsigned char>(letter), utf8);
    }
    return utf8;
}

std::unique_ptr<ByteStream>
decoded(std::unique_ptr<ByteStream> from, TextEncoding encoding, const std::string& name) {
    return std::make_unique<DecodedBytes>(std::move(from), encoding, name);
}

} // namespace macadam
