#pragma once

#include "estimator/common/error.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace macadam::testing {

/// Creates an empty folder for the running test.
inline std::filesystem::path test_folder() {
    const auto* const test = ::testing::UnitTest::GetInstance()->current_test_info();
    auto folder = std::filesystem::path{::testing::TempDir()} /
                  (std::string{"macadam_"} + test->test_suite_name() + "_" + test->name());
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    return folder;
}

/// Writes a file and creates its parent folders.
inline std::filesystem::path
written(const std::filesystem::path& folder, const std::string& name, std::string_view content) {
    auto file = folder / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream out{file, std::ios::binary};
    out << content;
    return file;
}

/// Returns the message of the InputError that `call` throws; "" if it throws none.
template <typename Call>
std::string refusal_of(Call call) {
    try {
        call();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

} // namespace macadam::testing
