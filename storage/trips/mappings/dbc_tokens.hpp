#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace macadam {

/// Takes tokens off a statement of a DBC file: words and numbers, or single signs.
class DbcTokens {
public:
    /// \param where  "file:line", for messages
    DbcTokens(std::string_view rest, std::string where);

    /// Takes the characters up to the next blank or sign; empty if a sign is next.
    std::string_view word();

    /// Takes a word.
    /// \throws InputError  if there is none.
    std::string name(std::string_view expected);

    /// Tests whether only blanks are left.
    bool at_end() const;

    /// Takes the sign if it is next.
    bool has(char sign);

    /// Takes a sign.
    /// \throws InputError  if another token is next.
    void expect(char sign);

    /// Takes a whole number.
    /// \throws InputError  if it is not within low to high.
    std::uint64_t whole(std::uint64_t low, std::uint64_t high);

    /// Takes a finite number.
    /// \throws InputError  if there is none.
    double number();

    /// Takes a text in double quotes; it ends with the statement at the latest.
    /// \throws InputError  if no quote is next.
    std::string quoted();

    /// Refuses the statement, naming what is left of it.
    [[noreturn]] void refuse(std::string_view expected) const;

private:
    std::string_view rest_;
    std::string where_;
};

} // namespace macadam
