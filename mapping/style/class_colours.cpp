#include "mapping/style/class_colours.hpp"

#include <algorithm>
#include <array>

namespace macadam {
namespace {

constexpr std::array<std::uint32_t, 3> three_colours{0x2c7bb6, 0xfee090, 0xd7191c};
constexpr std::array<std::uint32_t, 5> five_colours{
    0x2c7bb6, 0xabd9e9, 0xffffbf, 0xfdae61, 0xd7191c};

} // namespace

std::uint32_t class_rgb(std::size_t index, std::size_t count) {
    return count <= three_colours.size() ? three_colours[index]
                                         : five_colours[std::min(index, five_colours.size() - 1)];
}

} // namespace macadam
