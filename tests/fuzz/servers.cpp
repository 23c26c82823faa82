#include "fuzz/rules.hpp"
#include "fuzz/targets.hpp"

#include "storage/postgres/ewkb.hpp"
#include "storage/store/server/drive_body.hpp"

#include <algorithm>

namespace macadam::fuzz {

Answer server_drive(std::string_view input) {
    return may_refuse([&] {
        constexpr std::uint32_t segments = 25;
        const auto passes = passes_in_body(input, segments);
        expect(std::ranges::all_of(passes, [](const auto& pass) { return pass.offset < segments; }),
               "passes lie in their chunk");
        expect(passes_in_body(body_of(passes), segments).size() == passes.size(),
               "packed passes can be unpacked");
    });
}

Answer server_line(std::string_view input) {
    const auto line = line_of_ewkb(input);
    expect(line.empty() || ewkb_of(line) == input, "a line survives writing");
    return line.empty() ? Answer::refused : Answer::accepted;
}

} // namespace macadam::fuzz
