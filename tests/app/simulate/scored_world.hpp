#pragma once

#include "support/program/program.hpp"

#include <map>
#include <random>
#include <string>
#include <vector>

namespace macadam::testing {

/// Uniform values that are the same with every standard library.
class Uniform {
public:
    explicit Uniform(unsigned seed) : random_{seed} {}
    double in(double low, double high) {
        return low + (high - low) * static_cast<double>(random_()) / 4294967296.0;
    }

private:
    std::mt19937 random_;
};

/// Runs the program, which must succeed.
Run ran(const std::vector<std::string>& words);

/// Error of a map against the truth of its simulation; relative to the mean truth.
struct Score {
    double bias, rmse_100m, coverage;
    int segments;
};

/// All of it, and by band of the true IRI ("0-1", "1-2", "2-4", "4-").
struct Scores {
    Score all;
    std::map<std::string, Score> by_level;
};

Scores score_of(const std::string& store, const std::string& truth);

void print(const char* name, const Scores& scores);

} // namespace macadam::testing
