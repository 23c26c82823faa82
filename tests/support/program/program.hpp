#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace macadam::testing {

/// What a run of the program left behind.
struct Run {
    int exit_status; ///< 128 + n if signal n ended it
    std::string out;
    std::string err;
};

/// Runs the built program with the words after its name.
/// \param max_file_bytes  what a file may grow to before writing fails, as a full disk does; 0 =
/// any.
Run run_macadam(const std::vector<std::string>& words, std::size_t max_file_bytes = 0);

/// A limit of the system, as setrlimit() takes it; 0: none.
struct Limit {
    int resource = 0;
    std::size_t most = 0;
};

Run run_macadam_limited(const std::vector<std::string>& words, const Limit& limit);

/// Standard output goes to this file instead of Run::out.
Run run_macadam_into(const std::filesystem::path& out, const std::vector<std::string>& words);

/// The program gets the signal as soon as it has written `words_before` to standard output (or has
/// ended).
Run run_macadam_signalled(const std::vector<std::string>& words,
                          const std::string& words_before,
                          int signal);

/// The same as soon as `is_time`.
Run run_macadam_signalled(const std::vector<std::string>& words,
                          const std::function<bool()>& is_time,
                          int signal);

/// An empty folder of the running test's own.
std::filesystem::path fresh_folder();

std::string read_file(const std::filesystem::path& file);
void write_file(const std::filesystem::path& file, const std::string& text);

} // namespace macadam::testing
