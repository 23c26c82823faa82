#include "storage/trips/rawlog/rawlog_objects.hpp"

#include "estimator/common/error.hpp"
#include "storage/text/text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>

namespace macadam {

namespace {

constexpr std::size_t first_block = 128 << 10;    // grows for larger objects
constexpr std::size_t longest_object = 256 << 20; // images and point clouds are smaller

bool is_text(std::string_view bytes) {
    return std::ranges::all_of(bytes, [](char c) {
        return (c >= ' ' && c <= '~') || c == '\n' || c == '\r' || c == '\t';
    });
}

[[noreturn]] void refuse_end(std::string_view within) {
    throw InputError{fmt::format("the file ends within {}", within)};
}

} // namespace

RawlogObjects::RawlogObjects(std::unique_ptr<ByteStream> bytes, std::string name)
    : bytes_{std::move(bytes)}, name_{std::move(name)}, block_(first_block) {}

std::string RawlogObjects::where() const {
    return fmt::format(
        "{}: object {} at byte {}", name_, std::max<std::size_t>(number_, 1), offset_);
}

std::optional<RawlogObject> RawlogObjects::next() {
    drop(std::exchange(taken_, 0));
    ++number_;
    try {
        leave_frames();
        auto begin = head();
        while (begin && begin->kind == RawlogClass::frame) {
            enter_frame(*begin);
            leave_frames();
            begin = head();
        }
        if (!begin) {
            if (left_in_frame_) {
                refuse_end("a CSensoryFrame");
            }
            return std::nullopt;
        }
        const auto object = object_at(*begin);
        taken_ = object.bytes.size();
        if (left_in_frame_) {
            --*left_in_frame_;
        }
        return object;
    } catch (const InputError& error) {
        if (offset_ == 0 && rest().empty() && !ended_) {
            throw; // the compressed file is broken, not the rawlog
        }
        const auto other = offset_ == 0 ? kind_of_file() : "";
        throw InputError{other.empty()
                             ? fmt::format("{}: {}", where(), error.what())
                             : fmt::format("{}: is {}, expected an MRPT rawlog", name_, other)};
    }
}

void RawlogObjects::fill() {
    std::copy(block_.begin() + static_cast<std::ptrdiff_t>(first_),
              block_.begin() + static_cast<std::ptrdiff_t>(last_),
              block_.begin());
    last_ -= std::exchange(first_, 0);
    if (last_ == block_.size()) {
        if (block_.size() >= longest_object) {
            throw InputError{fmt::format("the object is longer than {} MiB", longest_object >> 20)};
        }
        block_.resize(2 * block_.size());
    }
    const auto count = bytes_->read(std::span{block_}.subspan(last_));
    last_ += count;
    ended_ = count == 0;
}

void RawlogObjects::drop(std::size_t count) {
    first_ += count;
    offset_ += count;
}

/// Header of the next object; `std::nullopt` at the end of the file.
std::optional<RawlogHead> RawlogObjects::head() {
    for (;;) {
        if (auto found = rawlog_head(rest())) {
            return found;
        }
        if (ended_ && rest().empty() && offset_ > 0) {
            return std::nullopt;
        }
        if (ended_) {
            refuse_end("the name of a class");
        }
        fill();
    }
}

void RawlogObjects::enter_frame(const RawlogHead& head) {
    if (left_in_frame_) {
        throw InputError{"a frame in a frame"};
    }
    for (;;) {
        if (const auto frame = rawlog_frame(head, rest())) {
            drop(frame->size);
            left_in_frame_ = frame->count;
            return;
        }
        if (ended_) {
            refuse_end(head.name);
        }
        fill();
    }
}

/// Reads the end flags of frames whose observations were all returned.
void RawlogObjects::leave_frames() {
    while (left_in_frame_ == 0U) {
        while (rest().empty()) {
            if (ended_) {
                refuse_end("a CSensoryFrame");
            }
            fill();
        }
        if (rest().front() != rawlog_end_flag) {
            throw InputError{fmt::format("{}, expected the end of a CSensoryFrame ('\\x88')",
                                         in_quotes(rest().substr(0, 1)))};
        }
        drop(1);
        left_in_frame_.reset();
    }
}

RawlogObject RawlogObjects::object_at(const RawlogHead& head) {
    while (head.kind != RawlogClass::other) {
        if (const auto size = rawlog_size(head, rest())) {
            if (*size == 0) {
                break;
            }
            return {head.kind, head.name, rest().substr(0, *size)};
        }
        if (ended_) {
            refuse_end(head.name);
        }
        fill();
    }
    const auto size = size_to_next();
    return {RawlogClass::other, head.name, rest().substr(0, size)};
}

/// Tests whether the object would include the end flag of its frame.
bool RawlogObjects::closes_frame(std::string_view object) const {
    return left_in_frame_ == 1U && object.ends_with("\x88\x88");
}

/// Size up to the start of the next object after an end flag, or to the end of the file.
std::size_t RawlogObjects::size_to_next() {
    for (std::size_t from = 1;;) {
        const auto bytes = rest();
        const auto flag = std::min(bytes.find(rawlog_end_flag, from), bytes.size());
        if (flag == bytes.size()) {
            if (ended_) {
                refuse_end("an object of another class");
            }
            from = flag;
            fill();
            continue;
        }
        const auto size = flag + 1;
        const auto begins = begins_observation(bytes.substr(size));
        if (begins.value_or(ended_ && size == bytes.size())) {
            return closes_frame(bytes.substr(0, size)) ? size - 1 : size;
        }
        if (begins || ended_) {
            from = size;
        } else {
            from = flag; // tested again when more bytes are available
            fill();
        }
    }
}

/// Describes a file that does not begin like a rawlog, if its format is known.
std::string RawlogObjects::kind_of_file() const {
    using Row = std::pair<std::string_view, std::string_view>;
    static constexpr std::array<Row, 8> magics{{{"\x89PNG", "a picture (PNG)"},
                                                {"\xff\xd8\xff", "a picture (JPEG)"},
                                                {"PK\x03\x04", "a zip archive"},
                                                {"SQLite format 3", "a SQLite database"},
                                                {"%PDF", "a PDF document"},
                                                {"\x1f\x8b", "gzip within gzip"},
                                                {"\x7f"
                                                 "ELF",
                                                 "a program"},
                                                {"# macadam-trip", "a trip log (*.trip.csv)"}}};
    const auto bytes = rest().substr(0, 512);
    if (bytes.empty()) {
        return "empty";
    }
    for (const auto& [magic, kind] : magics) {
        if (bytes.starts_with(magic)) {
            return std::string{kind};
        }
    }
    if (bytes.substr(0, 32).find("OSMHeader") != std::string_view::npos) {
        return "an OpenStreetMap file (.osm.pbf)";
    }
    return is_text(bytes) ? fmt::format("text ({})", in_quotes(bytes.substr(0, bytes.find('\n'))))
                          : "";
}

} // namespace macadam
