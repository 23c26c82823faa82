#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Signal of a CAN message: value = factor * raw + offset.
struct DbcSignal {
    std::string name;
    std::uint16_t start_bit = 0; ///< of the least significant bit (Intel), else of the most
    std::uint16_t bit_count = 1; ///< 1 to 64
    bool is_little_endian = true;
    bool is_signed = false;
    enum class Kind : std::uint8_t { integer, float32, float64 } kind = Kind::integer;
    double factor = 1;
    double offset = 0;
    std::string unit; ///< bytes of the file: "km/h", "\xb0/s"

    bool is_multiplexor = false;
    std::string multiplexor; ///< signal that says whether this one is in a frame; "": always is
    /// Values of the multiplexor at which it is, from first to second.
    std::vector<std::pair<std::uint64_t, std::uint64_t>> at;
};

struct DbcMessage {
    std::uint32_t id = 0; ///< 11 or 29 bits
    bool is_extended = false;
    std::string name;
    std::vector<DbcSignal> signals;

    const DbcSignal* signal(std::string_view signal_name) const; ///< null: none
};

/// Description of the messages of a CAN bus.
struct Dbc {
    std::vector<DbcMessage> messages;
};

/// Signal found by its name.
struct DbcChoice {
    std::size_t message; ///< index in Dbc::messages
    std::size_t signal;  ///< index in its signals
};

/// Finds "MESSAGE.SIGNAL", or "SIGNAL" if only one message has it.
///
/// \param words  why there is none, for messages: "one of ..."
std::optional<DbcChoice> find_signal(const Dbc& dbc, std::string_view name, std::string& words);

/// Parses a DBC file: BO_, SG_ with multiplexing, SIG_VALTYPE_ and SG_MUL_VAL_; other statements
/// are skipped.
///
/// Source: Vector Informatik, "DBC File Format Documentation", version 1.0.5 (2010).
///
/// \throws InputError  "file:line: ..." for a signal or message that cannot be parsed or does not
///                     fit a frame of 64 bytes, for more than 100,000 signals, and if there is
///                     none.
Dbc read_dbc(const std::filesystem::path& file);

/// "MESSAGE.SIGNAL [UNIT]" of all signals.
std::vector<std::string> signal_names(const Dbc& dbc);

/// Value of a signal in the data of a frame; `std::nullopt` if the frame is too short, or carries
/// other signals there (multiplexing).
std::optional<double> signal_value(const DbcMessage& message,
                                   const DbcSignal& signal,
                                   std::span<const std::uint8_t> data);

} // namespace macadam
