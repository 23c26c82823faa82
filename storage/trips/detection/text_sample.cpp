#include "storage/trips/detection/text_sample.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/utf8.hpp"
#include "storage/tables/text_lines.hpp"
#include "storage/trips/foreign/text_decoding.hpp"
#include "storage/trips/source/trip_contents.hpp"

#include <algorithm>
#include <utility>

namespace macadam {
namespace {

constexpr std::size_t max_bytes = 4 << 20;
constexpr std::size_t max_lines = 40'000;

std::string first_bytes(ByteStream& bytes) {
    std::string text(max_bytes, '\0');
    std::size_t size = 0;
    while (size < text.size()) {
        const auto count = bytes.read({text.data() + size, text.size() - size});
        if (count == 0) {
            break;
        }
        size += count;
    }
    text.resize(size);
    return text;
}

/// Tests for UTF-16 with the low byte first and without a mark: ASCII has a zero in every second
/// byte.
bool is_unmarked_utf16(std::string_view bytes) {
    constexpr std::size_t looked_at = 512;
    const auto size = std::min(bytes.size(), looked_at) / 2 * 2;
    std::size_t ascii = 0;
    for (std::size_t i = 0; i < size; i += 2) {
        ascii += bytes[i] != '\0' && bytes[i + 1] == '\0' ? 1U : 0U;
    }
    return size >= 16 && ascii * 10 >= size / 2 * 9;
}

/// Tests whether most letters beyond ASCII are no UTF-8; then the lines are taken for ISO 8859-1.
bool is_latin1(const std::vector<std::string>& lines) {
    std::size_t letters = 0;
    std::size_t stray_bytes = 0;
    for (std::string_view line : lines) {
        while (!line.empty()) {
            const auto length = utf8_length(line);
            letters += length > 1 ? 1U : 0U;
            stray_bytes += length == 0 ? 1U : 0U;
            line.remove_prefix(std::max<std::size_t>(1, length));
        }
    }
    return stray_bytes > letters;
}

} // namespace

std::optional<TextSample> read_text_sample(ByteStream& bytes, const std::string& name) {
    TripContents contents;
    contents.files.push_back({"", first_bytes(bytes), ""});
    const auto& text = contents.files.front().bytes;
    const bool is_cut = text.size() == max_bytes;
    TextSample sample;
    if (is_unmarked_utf16(text)) {
        sample.encoding = TextEncoding::utf16le;
    }
    const auto kept = std::make_shared<const TripContents>(std::move(contents));
    try {
        TextLines lines{decoded(bytes_of(kept, ""), sample.encoding, name), name};
        for (auto line = lines.next(); line && sample.lines.size() < max_lines;) {
            sample.lines.emplace_back(*line);
            line = lines.next();
        }
    } catch (const InputError&) { // a NUL byte, or a line without end
        return std::nullopt;
    }
    if (is_cut && sample.lines.size() < max_lines && !sample.lines.empty()) {
        sample.lines.pop_back();
    }
    if (is_latin1(sample.lines)) {
        sample.encoding = TextEncoding::latin1;
        std::ranges::transform(sample.lines, sample.lines.begin(), utf8_of_latin1);
    }
    return sample;
}

} // namespace macadam
