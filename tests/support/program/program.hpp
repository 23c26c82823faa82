#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace macadam::testing {

/// Result of a run of the program.
struct Run {
    int exit_status; ///< 128 + n if signal n ended it
    std::string out;
    std::string err;
};

/// Runs the built program with the words after its name.
/// \param max_file_bytes  file size at which writing fails, as on a full disk; 0 = no limit
Run run_macadam(const std::vector<std::string>& words, std::size_t max_file_bytes = 0);

/// System limit, as in setrlimit(); 0: none.
struct Limit {
    int resource = 0;
    std::size_t most = 0;
};

Run run_macadam_limited(const std::vector<std::string>& words, const Limit& limit);

/// Runs the program with standard output in this file instead of Run::out.
Run run_macadam_into(const std::filesystem::path& out, const std::vector<std::string>& words);

/// Runs the program and sends it the signal as soon as it has written `words_before` to standard
/// output (or has ended).
Run run_macadam_signalled(const std::vector<std::string>& words,
                          const std::string& words_before,
                          int signal);

/// Runs the program and sends it the signal as soon as `is_time` returns true.
Run run_macadam_signalled(const std::vector<std::string>& words,
                          const std::function<bool()>& is_time,
                          int signal);

/// Creates an empty folder for the running test.
std::filesystem::path fresh_folder();

std::string read_file(const std::filesystem::path& file);
void write_file(const std::filesystem::path& file, const std::string& text);

} // namespace macadam::testing
