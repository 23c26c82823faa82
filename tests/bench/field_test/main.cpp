// The field test of the paper, with simulated roads and a simulated car: 230.8 km with its shares
// of smooth and rough road, every method over the same drive.

#include "tables.hpp"

#include <atomic>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <thread>

namespace macadam::field_test {
namespace {

constexpr double short_share = 0.1;

std::vector<Reading> readings_of(const std::vector<LanePlan>& plans) {
    std::vector<std::vector<Reading>> by_lane(plans.size());
    std::atomic<std::size_t> next = 0;
    const auto work = [&] {
        for (std::size_t i = next++; i < plans.size(); i = next++) {
            by_lane[i] = readings_on(plans[i]);
            std::fprintf(stderr, "\rlane %zu of %zu ", i + 1, plans.size());
        }
    };
    {
        std::vector<std::jthread> threads;
        for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i) {
            threads.emplace_back(work);
        }
    }
    std::fputc('\n', stderr);
    std::vector<Reading> all;
    for (const auto& lane : by_lane) {
        all.insert(all.end(), lane.begin(), lane.end());
    }
    return all;
}

void write(const std::filesystem::path& file, const std::string& text) {
    std::ofstream out{file};
    out << text;
    if (!out.flush()) {
        throw std::runtime_error{file.string() + ": cannot be written"};
    }
}

void field_test(const std::filesystem::path& folder, double share) {
    const auto test = fitted(readings_of(plan_of(share)));
    std::filesystem::create_directories(folder);
    write(folder / "field-test-histograms.svg", histograms_svg(test));
    write(folder / "field-test-scatter.svg", scatter_svg(test));
    const auto tables = tables_of(test, share);
    write(folder / "field-test.md", tables);
    std::fputs(tables.c_str(), stdout);
}

} // namespace
} // namespace macadam::field_test

int main(int argc, char** argv) {
    const bool brief = argc == 3 && std::strcmp(argv[2], "--short") == 0;
    if (argc != 2 && !brief) {
        std::fputs("usage: field_test FOLDER [--short]\n", stderr);
        return 2;
    }
    try {
        macadam::field_test::field_test(argv[1], brief ? macadam::field_test::short_share : 1);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "field_test: %s\n", error.what());
        return 1;
    }
}
