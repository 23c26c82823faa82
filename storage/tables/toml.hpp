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

/// What a number of a settings file may be.
struct TomlRange {
    bool (*holds)(double);
    const char* words; ///< "a number above 0"
};

inline constexpr TomlRange any_number{[](double) { return true; }, "a number"};
inline constexpr TomlRange positive_number{[](double x) { return x > 0; }, "a number above 0"};
inline constexpr TomlRange not_negative_number{[](double x) { return x >= 0; },
                                               "a number of 0 or more"};

/// One table of a settings file. It remembers where things stand, so that every refusal says
/// "file:line: key is '...', expected ...". A cheap handle: copies share the file.
///
/// number, text and their like expect the key to be there (`has`); whoever asks for a key that may
/// be missing uses the `maybe_` forms.
class TomlTable {
public:
    struct Node;
    explicit TomlTable(std::shared_ptr<const Node> node);

    bool has(std::string_view key) const;
    std::vector<std::string> keys() const; ///< in the order of the alphabet

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

    bool is_text(std::string_view key) const;
    bool is_number(std::string_view key) const;

    std::optional<TomlTable> table(std::string_view key) const; ///< [key]; nothing: not there
    std::vector<TomlTable> tables(std::string_view key) const;  ///< [[key]]; empty: not there

    /// "file:line" of a key, or of the table where there is no such key.
    std::string where(std::string_view key) const;

    /// \throws InputError  naming the first key that is not among these.
    void expect_only(std::span<const std::string_view> known) const;

    [[noreturn]] void refuse_unknown(std::string_view key, std::string_view expected) const;
    [[noreturn]] void miss(std::string_view key) const;
    [[noreturn]] void refuse(std::string_view key, std::string_view expected) const;

private:
    std::shared_ptr<const Node> node_;
};

/// The top table of a TOML file of at most 1 MiB.
///
/// \param what  what the file should be, for messages: "a vehicle".
///
/// \throws InputError  "file:line: ..." if it cannot be read or is no TOML.
TomlTable read_toml(const std::filesystem::path& file, std::string_view what);

/// The same of text; `name` stands for the file in messages.
TomlTable parse_toml(std::string_view text, const std::string& name);

} // namespace macadam
