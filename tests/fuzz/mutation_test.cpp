// 4,000 spoilt inputs for every reader, made of seeds that it accepts: each is read or refused in
// words, within 25 s and 2 GB. The ordinary tests try fewer where an input takes long.

#include "mutation.hpp"
#include "target_files.hpp"
#include "target_table.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <sys/resource.h>

namespace macadam::fuzz {
namespace {

constexpr int all_mutations = 4000; // of one reader

struct Slice {
    Target target;
    int number;
};

void PrintTo(const Slice& slice, std::ostream* out) {
    *out << slice.target.name << ' ' << slice.number;
}

std::vector<Slice> slices() {
    std::vector<Slice> all;
    for (const auto& target : targets()) {
        for (int number = 0; number < target.slices; ++number) {
            all.push_back({target, number});
        }
    }
    return all;
}

std::vector<std::string> seed_contents(std::string_view target) {
    std::vector<std::string> contents;
    for (auto& seed : seeds_of(target)) {
        contents.push_back(std::move(seed.content));
    }
    return contents;
}

double peak_mb() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// An input where it is found if its run ends the program, or its test fails.
class KeptInput {
public:
    KeptInput(const std::string& input, const Slice& slice, int number)
        : file_{::testing::TempDir() + "macadam_mutation_" + std::string{slice.target.name} + "_" +
                std::to_string(slice.number) + "_" + std::to_string(number)} {
        std::ofstream{file_, std::ios::binary} << input;
    }
    KeptInput(const KeptInput&) = delete;
    KeptInput& operator=(const KeptInput&) = delete;
    ~KeptInput() {
        if (!is_to_stay_) {
            std::filesystem::remove(file_);
        }
    }

    /// \returns where it stays.
    const std::string& keep() {
        is_to_stay_ = true;
        return file_;
    }

private:
    std::string file_;
    bool is_to_stay_ = false;
};

class Mutations : public ::testing::TestWithParam<Slice> {};

TEST_P(Mutations, AreReadOrRefused) {
    constexpr std::chrono::seconds longest{25};
    constexpr double max_mb = 2048;
    const auto& slice = GetParam();
    const bool try_all = std::getenv("MACADAM_TEST_ALL") != nullptr;
    const int count =
        (try_all ? all_mutations : slice.target.usual_mutations) / slice.target.slices;
    Mutation mutation{seed_contents(slice.target.name),
                      words_of(slice.target.name),
                      static_cast<std::uint64_t>(slice.number)};
    int accepted = 0;
    for (int i = 0; i < count; ++i) {
        const auto input = mutation.next();
        KeptInput kept{input, slice, i};
        const auto begin = std::chrono::steady_clock::now();
        try {
            accepted += slice.target.run(input) == Answer::accepted ? 1 : 0;
        } catch (const std::exception& error) {
            ADD_FAILURE() << error.what() << ": " << kept.keep();
        }
        EXPECT_LT(std::chrono::steady_clock::now() - begin, longest) << kept.keep();
    }
    EXPECT_LT(peak_mb(), max_mb);
    RecordProperty("accepted", accepted);
}

INSTANTIATE_TEST_SUITE_P(Readers, Mutations, ::testing::ValuesIn(slices()), [](const auto& each) {
    return std::string{each.param.target.name} + "_" + std::to_string(each.param.number);
});

} // namespace
} // namespace macadam::fuzz
