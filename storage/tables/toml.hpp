#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Range of values that a number in a settings file may have.
struct TomlRange {
    bool (*holds)(double);
    const char* words; ///< for messages: "a number above 0"
};

inline constexpr TomlRange any_number{[](double) { return true; }, "a number"};
inline constexpr TomlRange positive_number{[](double x) { return x > 0; }, "a number above 0"};
inline constexpr TomlRange not_negative_number{[](double x) { return x >= 0; },
                                               "a number of 0 or more"};

/// Table of a settings file. It knows the line of each key, so that every error message reads
/// "file:line: key is '...', expected ...". It is a cheap handle: copies share the file.
///
/// number(), text() and the like require that the key exists (see `has`); use the `maybe_`
/// functions for optional keys.
class TomlTable {
public:
    struct Node;
    explicit TomlTable(std::shared_ptr<const Node> node);

    bool has(std::string_view key) const;
    std::vector<std::string> keys() const; ///< in alphabetical order

    double number(std::string_view key, const TomlRange& range = any_number) const;
    std::int64_t integer(std::string_view key, std::int64_t low, std::int64_t high) const;
    bool flag(std::string_view key) const;
    std::string text(std::string_view key) const; ///< not empty
    std::string text_or_empty(std::string_view key) const;
    std::vector<double> numbers(std::string_view key, const TomlRange& range = any_number) const;
    std::vector<std::string> texts(std::string_view key) const;

    std::optional<double> maybe_number(std::string_view key,
                                       const TomlRange& range = any_number) const;
    std::optional<std::string> maybe_text(std::string_view key) const;
    std::optional<bool> maybe_flag(std::string_view key) const;

    bool is_table(std::string_view key) const;
    bool is_text(std::string_view key) const;
    bool is_number(std::string_view key) const;
    bool is_number_array(std::string_view key) const;

    std::optional<TomlTable>
    table(std::string_view key) const; ///< [key]; `std::nullopt` if it is missing
    std::vector<TomlTable> tables(std::string_view key) const; ///< [[key]]; empty if it is missing

    /// "file:line" of a key, or of the table if the key is missing.
    std::string where(std::string_view key) const;

    /// \throws InputError  naming the first key that is not in `known`.
    void expect_only(std::span<const std::string_view> known) const;

    [[noreturn]] void refuse_unknown(std::string_view key, std::string_view expected) const;
    [[noreturn]] void miss(std::string_view key) const;
    [[noreturn]] void refuse(std::string_view key, std::string_view expected) const;

private:
    std::shared_ptr<const Node> node_;
};

/// Reads a TOML file of at most 1 MiB and returns its root table.
///
/// \param what  expected content of the file, for messages: "a vehicle".
///
/// \throws InputError  "file:line: ..." if the file cannot be read or is not TOML.
TomlTable read_toml(const std::filesystem::path& file, std::string_view what);

/// Parses text like read_toml(); `name` stands for the file in messages.
TomlTable parse_toml(std::string_view text, const std::string& name);

} // namespace macadam
