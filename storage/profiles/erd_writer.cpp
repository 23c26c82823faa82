#include "storage/profiles/erd_writer.hpp"

#include "estimator/common/error.hpp"
#include "storage/atomic/atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <string_view>

namespace macadam {

namespace {

constexpr int field_width = 8; // of names and units in the header
constexpr int number_width = 15;
constexpr int decimals = 4;       // of millimetres: a tenth of the resolution of the best profilers
constexpr double highest_m = 1e4; // higher than any road; keeps the numbers separated

std::string short_name(std::string_view name) {
    if (name == "left") {
        return "LElev.";
    }
    if (name == "right") {
        return "RElev.";
    }
    return std::string{name.substr(0, field_width)};
}

/// Replaces line breaks of a title, which other programs cut at 80 characters.
std::string one_line(std::string text) {
    std::ranges::replace_if(
        text, [](unsigned char c) { return c < 0x20; }, ' ');
    return text;
}

std::string header_of(const ErdProfile& profile) {
    const auto channels = profile.channels.size();
    const auto samples = profile.channels.front().elevation_m.size();
    std::string names;
    std::string units;
    for (const auto& channel : profile.channels) {
        names += fmt::format("{:<{}}", short_name(channel.name), field_width);
        units += fmt::format("{:<{}}", "mm", field_width);
    }
    std::string text = "ERDFILEV2.00\n";
    // A text file has no records and no bytes per record; 5 marks it as text.
    text += fmt::format("{}, {}, -1, 1, 5, {}, -1\n", channels, samples, profile.step_m);
    if (!profile.title.empty()) {
        text += fmt::format("TITLE   {}\n", one_line(profile.title));
    }
    for (const auto& remark : profile.remarks) {
        text += fmt::format("HISTORY {}\n", one_line(remark));
    }
    text += fmt::format("SHORTNAM{}\nUNITSNAM{}\n", names, units);
    text += "XLABEL  Distance\nXUNITS  m\n";
    if (profile.start_m != 0) {
        text += fmt::format("XSTART  {}\n", profile.start_m);
    }
    text += fmt::format("FORMAT  ({}F{}.{})\nEND\n", channels, number_width, decimals);
    return text;
}

void check(const std::filesystem::path& file, const ErdProfile& profile) {
    assert(!profile.channels.empty() && profile.step_m > 0);
    for (const auto& channel : profile.channels) {
        const auto bad = std::ranges::find_if_not(
            channel.elevation_m, [](double z) { return std::abs(z) <= highest_m; });
        if (bad != channel.elevation_m.end()) {
            throw InputError{fmt::format("{}: elevation {} of {} is '{}', expected at most {} m",
                                         file.string(),
                                         bad - channel.elevation_m.begin() + 1,
                                         channel.name,
                                         *bad,
                                         highest_m)};
        }
    }
}

} // namespace

void write_erd(const std::filesystem::path& file, const ErdProfile& profile) {
    check(file, profile);
    AtomicFile out{file};
    out.write(header_of(profile));
    const auto samples = profile.channels.front().elevation_m.size();
    std::string text;
    for (std::size_t i = 0; i < samples; ++i) {
        for (const auto& channel : profile.channels) {
            fmt::format_to(std::back_inserter(text),
                           "{:{}.{}f}",
                           1000 * channel.elevation_m[i],
                           number_width,
                           decimals);
        }
        text += '\n';
        constexpr std::size_t block = 1 << 16;
        if (text.size() > block || i + 1 == samples) {
            out.write(text);
            text.clear();
        }
    }
    out.commit();
}

} // namespace macadam
