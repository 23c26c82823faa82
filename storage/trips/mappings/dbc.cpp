#include "storage/trips/mappings/dbc.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/exact_number.hpp"
#include "storage/files/decompress.hpp"
#include "storage/tables/text_lines.hpp"
#include "storage/text/spelling.hpp"
#include "storage/text/text.hpp"
#include "storage/trips/mappings/dbc_tokens.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <utility>

namespace macadam {
namespace {

constexpr std::uint64_t frame_bits = 512; // CAN FD: 64 bytes
constexpr std::size_t max_signals = 100'000;
constexpr std::uint32_t extended_flag = 0x80000000U;
constexpr std::uint32_t extended_mask = 0x1FFFFFFFU;
constexpr int max_nesting = 8; // of multiplexors

/// Takes "m3", "M" or "m3M" behind the name of a signal.
void take_multiplexing(std::string_view word, DbcSignal& signal, const DbcTokens& tokens) {
    if (word.ends_with('M')) {
        signal.is_multiplexor = true;
        word.remove_suffix(1);
    }
    if (word.empty()) {
        return;
    }
    const auto value = exact_number<std::uint64_t>(word.substr(1));
    if (!word.starts_with('m') || !value) {
        tokens.refuse("M, m and a number, or ':' behind the signal's name");
    }
    signal.at = {{*value, *value}};
}

DbcSignal signal_of(DbcTokens& tokens) {
    DbcSignal signal;
    signal.name = tokens.name("the name of a signal");
    take_multiplexing(tokens.word(), signal, tokens);
    tokens.expect(':');
    signal.start_bit = static_cast<std::uint16_t>(tokens.whole(0, frame_bits - 1));
    tokens.expect('|');
    signal.bit_count = static_cast<std::uint16_t>(tokens.whole(1, 64));
    tokens.expect('@');
    const auto order = tokens.word();
    if (order.size() != 2 || (order[0] != '0' && order[0] != '1') ||
        (order[1] != '+' && order[1] != '-')) {
        tokens.refuse("byte order 0 or 1 and sign + or - behind '@'");
    }
    signal.is_little_endian = order[0] == '1';
    signal.is_signed = order[1] == '-';
    tokens.expect('(');
    signal.factor = tokens.number();
    tokens.expect(',');
    signal.offset = tokens.number();
    tokens.expect(')');
    if (tokens.has('[')) {
        tokens.number();
        tokens.expect('|');
        tokens.number();
        tokens.expect(']');
    }
    signal.unit = tokens.quoted();
    return signal;
}

std::uint32_t id_of(DbcTokens& tokens) {
    return static_cast<std::uint32_t>(tokens.whole(0, 0xFFFFFFFFU));
}

/// Reads the statements of a DBC file.
class DbcParser {
public:
    explicit DbcParser(const std::filesystem::path& file)
        : name_{file.string()}, lines_{decompressed(file_bytes(file), file.string()),
                                       file.string()} {}

    Dbc parse() {
        while (const auto line = lines_.next()) {
            const bool in_text = in_text_;
            count_quotes(*line);
            if (!in_text) {
                statement(trimmed(*line));
            }
        }
        if (signals_ == 0) {
            throw InputError{fmt::format("{}: describes no signal, expected a DBC file with lines "
                                         "'BO_ ...' and 'SG_ ...'",
                                         name_)};
        }
        complete();
        return std::move(dbc_);
    }

private:
    /// Texts of comments may go over several lines, and say anything.
    void count_quotes(std::string_view line) {
        for (std::size_t i = 0; i < line.size(); ++i) {
            if (line[i] == '"' && (!in_text_ || i == 0 || line[i - 1] != '\\')) {
                in_text_ = !in_text_;
            }
        }
    }

    void statement(std::string_view line) {
        DbcTokens tokens{line, lines_.where()};
        const auto keyword = tokens.word();
        if (tokens.at_end()) { // of the list of keywords at its top
            return;
        }
        if (keyword == "BO_") {
            begin_message(tokens);
        } else if (keyword == "SG_") {
            if (dbc_.messages.empty()) {
                tokens.refuse("a message (BO_) before its first signal");
            }
            if (++signals_ > max_signals) {
                tokens.refuse(fmt::format("at most {} signals", max_signals));
            }
            dbc_.messages.back().signals.push_back(signal_of(tokens));
        } else if (keyword == "SIG_VALTYPE_") {
            auto* const signal = named_signal(tokens);
            tokens.has(':');
            const auto kind = tokens.whole(0, 2);
            if (signal != nullptr) {
                signal->kind = static_cast<DbcSignal::Kind>(kind);
            }
        } else if (keyword == "SG_MUL_VAL_") {
            take_ranges(tokens);
        }
    }

    void begin_message(DbcTokens& tokens) {
        const auto id = id_of(tokens);
        const bool is_extended = (id & extended_flag) != 0;
        DbcMessage message{.id = is_extended ? id & extended_mask : id,
                           .is_extended = is_extended,
                           .name = tokens.name("the name of a message"),
                           .signals = {}};
        dbc_.messages.push_back(std::move(message));
    }

    DbcSignal* named_signal(DbcTokens& tokens) {
        const auto id = id_of(tokens);
        const auto name = tokens.name("the name of a signal");
        const bool is_extended = (id & extended_flag) != 0;
        for (auto& message : dbc_.messages) {
            if (message.is_extended == is_extended &&
                message.id == (is_extended ? id & extended_mask : id)) {
                const auto found = std::ranges::find(message.signals, name, &DbcSignal::name);
                return found == message.signals.end() ? nullptr : &*found;
            }
        }
        return nullptr;
    }

    /// SG_MUL_VAL_ id signal multiplexor 1-3, 7-7;
    void take_ranges(DbcTokens& tokens) {
        auto* const signal = named_signal(tokens);
        const auto multiplexor = tokens.name("the name of a multiplexor");
        std::vector<std::pair<std::uint64_t, std::uint64_t>> at;
        do {
            const auto range = tokens.word();
            const auto dash = range.find('-');
            const auto low = parse_number(range.substr(0, dash));
            const auto high = dash == std::string_view::npos ? std::nullopt
                                                             : parse_number(range.substr(dash + 1));
            constexpr double most = 9e15; // whole in a double
            if (!low || !high || !(*low >= 0 && *low <= *high && *high <= most)) {
                tokens.refuse("ranges such as 1-3");
            }
            at.emplace_back(static_cast<std::uint64_t>(*low), static_cast<std::uint64_t>(*high));
        } while (tokens.has(','));
        if (signal != nullptr) {
            signal->multiplexor = multiplexor;
            signal->at = std::move(at);
        }
    }

    /// Names the multiplexors, and checks what floats need.
    void complete() {
        for (auto& message : dbc_.messages) {
            std::string plain; // the one multiplexor that always is in a frame
            for (const auto& signal : message.signals) {
                plain = signal.is_multiplexor && signal.at.empty() ? signal.name : plain;
            }
            for (auto& signal : message.signals) {
                if (!signal.at.empty() && signal.multiplexor.empty()) {
                    signal.multiplexor = plain;
                }
                const int bits = signal.kind == DbcSignal::Kind::float32   ? 32
                                 : signal.kind == DbcSignal::Kind::float64 ? 64
                                                                           : signal.bit_count;
                if (signal.bit_count != bits) {
                    throw InputError{fmt::format("{}: signal '{}' is a float of {} bits, expected "
                                                 "{}",
                                                 name_,
                                                 signal.name,
                                                 signal.bit_count,
                                                 bits)};
                }
            }
        }
    }

    std::string name_;
    TextLines lines_;
    Dbc dbc_;
    std::size_t signals_ = 0;
    bool in_text_ = false;
};

/// Extracts the bits of a signal; `std::nullopt` if the frame is too short.
std::optional<std::uint64_t> raw_bits(const DbcSignal& signal, std::span<const std::uint8_t> data) {
    std::uint64_t raw = 0;
    std::size_t at = signal.start_bit;
    for (std::size_t i = 0; i < signal.bit_count; ++i) {
        if (at / 8 >= data.size()) {
            return std::nullopt;
        }
        const std::uint64_t bit = (data[at / 8] >> (at % 8)) & 1U;
        if (signal.is_little_endian) {
            raw |= bit << i;
            ++at;
        } else { // from the most significant bit down; bits of a byte are numbered from the least
            raw = (raw << 1U) | bit;
            at = at % 8 == 0 ? at + 15 : at - 1;
        }
    }
    return raw;
}

bool is_present(const DbcMessage& message,
                const DbcSignal& signal,
                std::span<const std::uint8_t> data,
                int nesting = 0) {
    if (signal.at.empty()) {
        return true;
    }
    const auto* const multiplexor = message.signal(signal.multiplexor);
    if (multiplexor == nullptr || nesting > max_nesting ||
        !is_present(message, *multiplexor, data, nesting + 1)) {
        return false;
    }
    const auto value = raw_bits(*multiplexor, data);
    return value && std::ranges::any_of(signal.at, [&](const auto& range) {
               return *value >= range.first && *value <= range.second;
           });
}

} // namespace

const DbcSignal* DbcMessage::signal(std::string_view signal_name) const {
    const auto found = std::ranges::find(signals, signal_name, &DbcSignal::name);
    return found == signals.end() ? nullptr : &*found;
}

std::optional<DbcChoice> find_signal(const Dbc& dbc, std::string_view name, std::string& words) {
    std::vector<DbcChoice> found;
    std::vector<std::string> known;
    for (std::size_t i = 0; i < dbc.messages.size(); ++i) {
        const auto& message = dbc.messages[i];
        for (std::size_t j = 0; j < message.signals.size(); ++j) {
            const auto full = message.name + "." + message.signals[j].name;
            if (name == full || name == message.signals[j].name) {
                found.push_back({i, j});
                known.push_back(full);
            }
        }
    }
    if (found.size() == 1) {
        return found.front();
    }
    if (!found.empty()) {
        known.resize(std::min<std::size_t>(known.size(), 5));
        words = fmt::format("one message: {}", fmt::join(known, ", "));
        return std::nullopt;
    }
    for (const auto& message : dbc.messages) {
        for (const auto& signal : message.signals) {
            known.push_back(name.find('.') == std::string_view::npos
                                ? signal.name
                                : message.name + "." + signal.name);
        }
    }
    words = "a signal of the DBC file" + suggestion(name, known);
    return std::nullopt;
}

Dbc read_dbc(const std::filesystem::path& file) {
    return DbcParser{file}.parse();
}

std::vector<std::string> signal_names(const Dbc& dbc) {
    std::vector<std::string> names;
    for (const auto& message : dbc.messages) {
        for (const auto& signal : message.signals) {
            names.push_back(
                fmt::format("{}.{}{}",
                            message.name,
                            signal.name,
                            signal.unit.empty() ? "" : fmt::format(" [{}]", signal.unit)));
        }
    }
    return names;
}

std::optional<double> signal_value(const DbcMessage& message,
                                   const DbcSignal& signal,
                                   std::span<const std::uint8_t> data) {
    const auto raw = is_present(message, signal, data) ? raw_bits(signal, data) : std::nullopt;
    if (!raw) {
        return std::nullopt;
    }
    double value = 0;
    switch (signal.kind) {
    case DbcSignal::Kind::float32:
        value = std::bit_cast<float>(static_cast<std::uint32_t>(*raw));
        break;
    case DbcSignal::Kind::float64:
        value = std::bit_cast<double>(*raw);
        break;
    case DbcSignal::Kind::integer: {
        const auto unused = 64U - signal.bit_count;
        value = signal.is_signed
                    ? static_cast<double>(static_cast<std::int64_t>(*raw << unused) >> unused)
                    : static_cast<double>(*raw);
        break;
    }
    }
    return signal.factor * value + signal.offset;
}

} // namespace macadam
