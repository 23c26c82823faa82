#include "app/manual/bash_completion.hpp"
#include "app/manual/fish_completion.hpp"
#include "app/manual/man_page.hpp"
#include "app/manual/zsh_completion.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>

namespace {

void write(const std::filesystem::path& file, const std::string& text) {
    std::filesystem::create_directories(file.parent_path());
    std::ofstream out{file, std::ios::binary};
    out.exceptions(std::ios::failbit | std::ios::badbit);
    out << text;
    out.flush();
}

} // namespace

/// `macadam_manual DIR` writes the manual pages and the completions of all shells as they are
/// installed under share/. A tool of the build; it is not installed.
int main(int argc, char** argv) {
    if (argc != 2) {
        fmt::print(stderr, "usage: macadam_manual DIR\n");
        return 2;
    }
    try {
        const std::filesystem::path folder{argv[1]};
        write(folder / "man/man1/macadam.1", macadam::man_page_of_all(MACADAM_VERSION));
        for (const auto& command : macadam::commands()) {
            write(folder / fmt::format("man/man1/macadam-{}.1", command.name),
                  macadam::man_page_of(command, MACADAM_VERSION));
        }
        write(folder / "bash-completion/completions/macadam", macadam::bash_completion());
        write(folder / "zsh/vendor-completions/_macadam", macadam::zsh_completion());
        write(folder / "fish/vendor_completions.d/macadam.fish", macadam::fish_completion());
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "macadam_manual: {}\n", error.what());
        return 1;
    }
}
