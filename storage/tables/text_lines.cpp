#include "storage/tables/text_lines.hpp"

#include "estimator/common/error.hpp"
#include "storage/text/text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <span>
#include <utility>

namespace macadam {

namespace {

constexpr std::size_t longest_line = 1 << 20;
constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

} // namespace

TextLines::TextLines(std::unique_ptr<ByteStream> bytes, std::string name)
    : bytes_{std::move(bytes)}, name_{std::move(name)}, block_(longest_line) {}

std::optional<std::string_view> TextLines::next() {
    for (;;) {
        const std::string_view rest{block_.data() + first_, last_ - first_};
        if (const auto size = rest.find('\n'); size != std::string_view::npos) {
            return taken(size, 1);
        }
        if (ended_) {
            return rest.empty() ? std::nullopt : std::optional{taken(rest.size(), 0)};
        }
        fill();
    }
}

std::string TextLines::where() const {
    return fmt::format("{}:{}", name_, std::max<std::size_t>(number_, 1));
}

void TextLines::fill() {
    std::copy(block_.begin() + static_cast<std::ptrdiff_t>(first_),
              block_.begin() + static_cast<std::ptrdiff_t>(last_),
              block_.begin());
    last_ -= std::exchange(first_, 0);
    if (last_ == block_.size()) {
        ++number_;
        throw InputError{fmt::format("{}: {}, expected lines shorter than {} bytes",
                                     where(),
                                     in_quotes({block_.data(), block_.size()}),
                                     longest_line)};
    }
    const auto count = bytes_->read(std::span{block_}.subspan(last_));
    const std::string_view added{block_.data() + last_, count};
    has_nul_ = has_nul_ || added.find('\0') != std::string_view::npos;
    last_ += count;
    ended_ = count == 0;
}

std::string_view TextLines::taken(std::size_t size, std::size_t skip) {
    std::string_view line{block_.data() + first_, size};
    first_ += size + skip;
    ++number_;
    if (number_ == 1 && line.starts_with(byte_order_mark)) {
        line.remove_prefix(byte_order_mark.size());
    }
    if (line.ends_with('\r')) {
        line.remove_suffix(1);
    }
    if (has_nul_ && line.find('\0') != std::string_view::npos) {
        throw InputError{fmt::format("{}: {}, expected text", where(), in_quotes(line))};
    }
    return line;
}

} // namespace macadam
