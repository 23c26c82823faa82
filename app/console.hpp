#pragma once

#include "estimator/common/progress.hpp"

#include <cstddef>
#include <string>
#include <string_view>

namespace macadam {

/// How a command speaks to people: talk and progress on standard error, never on standard output,
/// which holds results alone.
class Console {
public:
    /// \param quiet  only warnings and errors.
    explicit Console(bool quiet);

    void say(std::string_view line) const;  ///< left out when quiet
    void warn(std::string_view line) const; ///< "macadam: warning: ..."

    /// A bar on a terminal, nothing elsewhere or when quiet. It goes when it is full.
    Progress progress(std::string label) const;

private:
    bool quiet_;
    bool terminal_;
};

/// "1 trip", "2 trips".
std::string counted(std::size_t count, std::string_view one);

/// Results go out through here.
/// \throws InputError  if standard output cannot take them (a full disk, a closed file).
void print(std::string_view text);

/// The same for results that people read, such as tables: what names in them would do to a terminal
/// is spelled out (app/printable.hpp).
void print_words(std::string_view text);

void flush_results();

} // namespace macadam
