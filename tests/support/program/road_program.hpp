#pragma once

#include "storage/store/road_store.hpp"
#include "support/program/program.hpp"
#include "support/roads/store_world.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace macadam::testing {

/// Test of commands on a database of the small country with the passes of six cars.
class RoadProgram : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fresh_folder();
        store_ = (folder_ / "roads.gpkg").string();
        auto store = new_store(store_);
        import_trips(store, 6);
    }

    /// Runs `macadam COMMAND STORE WORDS...`.
    macadam::testing::Run run(const std::string& command, std::vector<std::string> words) const {
        words.insert(words.begin(), {command, store_});
        return run_macadam(words);
    }

    /// Runs a command that succeeds. \returns its standard output.
    std::string done(const std::string& command, std::vector<std::string> words) const {
        const auto result = run(command, std::move(words));
        EXPECT_EQ(result.exit_status, 0) << result.err;
        return result.out;
    }

    /// Runs a command that refuses its words. \returns what it says.
    std::string refusal(const std::string& command, std::vector<std::string> words) const {
        const auto result = run(command, std::move(words));
        EXPECT_EQ(result.exit_status, 2) << result.err;
        return result.err;
    }

    /// Runs a command with -o NAME in the test's folder. \returns the file.
    std::string file_of(const std::string& command,
                        const std::string& name,
                        std::vector<std::string> words = {}) const {
        const auto file = (folder_ / name).string();
        words.insert(words.end(), {"-o", file});
        done(command, std::move(words));
        return file;
    }

    /// Writes a file into the test's folder.
    std::string file(const std::string& name, const std::string& text) const {
        write_file(folder_ / name, text);
        return (folder_ / name).string();
    }

    std::filesystem::path folder_;
    std::string store_;
};

} // namespace macadam::testing
