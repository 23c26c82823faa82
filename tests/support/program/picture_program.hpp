#pragma once

#include "storage/store/road_store.hpp"
#include "support/program/program.hpp"
#include "support/program/road_program.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace macadam::testing {

/// Test of `macadam render` on the roads of RoadProgram, with a folder for its output.
class PictureProgram : public RoadProgram {
protected:
    void SetUp() override {
        RoadProgram::SetUp();
        RoadStore::open(store_).visit(
            {}, [&](const SegmentRecord& record) { measured_.push_back(record); });
        std::filesystem::create_directory(folder_ / "out");
    }

    std::string out(const std::string& name) const { return (folder_ / "out" / name).string(); }

    macadam::testing::Run render(std::vector<std::string> words, std::size_t max_bytes = 0) const {
        words.insert(words.begin(), {"render", store_});
        return run_macadam(words, max_bytes);
    }

    std::vector<SegmentRecord> measured_;
};

} // namespace macadam::testing
