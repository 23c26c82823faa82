#include "traced_program.hpp"

#include "shell.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <regex>
#include <sstream>

#include <sys/wait.h>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;

/// Data of the system that any program may read, and none of which a map can choose.
constexpr std::array system_data{"/lib/",
                                 "/lib64/",
                                 "/usr/lib/",
                                 "/usr/local/lib/",
                                 "/usr/share/fonts",
                                 "/usr/local/share/fonts",
                                 "/usr/share/fontconfig/",
                                 "/var/cache/fontconfig",
                                 "/etc/fonts/",
                                 "/etc/ld.so.",
                                 "/usr/share/proj",
                                 "/usr/share/gdal",
                                 "/usr/share/locale",
                                 "/usr/share/drirc.d", // OSMesa
                                 "/etc/drirc",
                                 "/usr/share/libdrm/",
                                 "/etc/ssl/openssl.cnf",
                                 "/etc/localtime",
                                 "/usr/share/zoneinfo",
                                 "/etc/nsswitch.conf", // the user's home, of fontconfig
                                 "/etc/passwd",
                                 "/proc/",
                                 "/sys/fs/cgroup",
                                 "/sys/kernel/mm/",
                                 "/sys/devices/system/cpu",
                                 "/sys/devices/system/node",
                                 "/dev/null",
                                 "/dev/urandom",
                                 "/dev/random"};

std::string in_quotes(const std::string& word) {
    return "'" + std::regex_replace(word, std::regex{"'"}, "'\\''") + "'";
}

/// Nobody answers there, and nobody is bothered.
const std::string& without_network() {
    static const std::string words = [] {
        for (const std::string namespaces : {"unshare -n ", "unshare -rn "}) {
            if (std::system((namespaces + "true 2>/dev/null").c_str()) == 0) {
                return namespaces;
            }
        }
        return std::string{};
    }();
    return words;
}

class Watch {
public:
    Watch(fs::path program,
          const fs::path& folder,
          const std::vector<fs::path>& inputs,
          Traced& traced)
        : program_{std::move(program)}, traced_{traced} {
        allowed_.push_back(folder.string());
        allowed_.push_back(fs::canonical(program_.parent_path()).string());
        allowed_.push_back(fs::canonical(program_.parent_path() / "lib").string());
        for (const auto& input : inputs) {
            allowed_.push_back(input.string());
        }
        for (const auto* const data : system_data) {
            allowed_.emplace_back(data);
        }
    }

    void see(const std::string& line) {
        static const std::regex opening{
            R"re(\b(?:open|openat|openat2|creat)\((?:(?:AT_FDCWD|\d+)<([^>]*)>, )?"([^"]*)")re"};
        static const std::regex starting{R"re(\bexecve(?:at)?\((?:[^"]*)"([^"]*)")re"};
        static const std::regex calling{R"re(\bsocket\((AF_\w+))re"};
        std::smatch found;
        if (std::regex_search(line, found, opening)) {
            ++traced_.files_opened;
            judge(fs::path{found[1].str()} / found[2].str(), line);
        } else if (std::regex_search(line, found, starting)) {
            if (found[1] != program_.string() && found[1] != "/proc/self/exe") {
                traced_.breaches.push_back(line);
            }
        } else if (std::regex_search(line, found, calling)) {
            if (found[1] != "AF_UNIX") {
                traced_.breaches.push_back(line);
            }
        }
    }

private:
    void judge(const fs::path& file, const std::string& line) {
        const auto path = file.lexically_normal().string();
        if (std::ranges::none_of(allowed_,
                                 [&](const auto& start) { return path.starts_with(start); })) {
            traced_.breaches.push_back(line);
        }
    }

    fs::path program_;
    std::vector<std::string> allowed_;
    Traced& traced_;
};

} // namespace

Traced run_traced(const fs::path& program,
                  const std::vector<std::string>& words,
                  const fs::path& folder,
                  const std::vector<fs::path>& inputs) {
    const auto log = folder / "strace.txt";
    const auto home = folder / "home";
    fs::create_directories(home);
    const auto* const sanitizer = std::getenv("ASAN_OPTIONS");
    std::string command =
        "cd " + in_quotes(folder.string()) + " && HOME=" + in_quotes(home.string()) +
        " TMPDIR=" + in_quotes(folder.string()) + " ASAN_OPTIONS=" +
        in_quotes(std::string{sanitizer == nullptr ? "" : sanitizer} + ":detect_leaks=0") +
        " timeout 100 " + without_network() +
        "strace -f --seccomp-bpf -y -s 4096 -e signal=none -e "
        "trace=open,openat,openat2,creat,execve,execveat,socket -o " +
        in_quotes(log.string()) + " " + in_quotes(program.string());
    for (const auto& word : words) {
        command += " " + in_quotes(word);
    }
    const auto out = folder / "said.txt";
    const int status = std::system((command + " >" + in_quotes(out.string()) + " 2>&1").c_str());
    Traced traced{
        WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), content_of(out), {}};
    Watch watch{program, folder, inputs, traced};
    std::istringstream lines{content_of(log)};
    for (std::string line; std::getline(lines, line);) {
        watch.see(line);
    }
    EXPECT_GT(traced.files_opened, 5U) << "strace saw nothing: " << traced.said;
    fs::remove(log);
    fs::remove(out);
    return traced;
}

} // namespace macadam::testing
