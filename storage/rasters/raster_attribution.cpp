#include "storage/rasters/raster_attribution.hpp"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <gdal_priv.h>

#include <algorithm>
#include <string_view>

namespace macadam {
namespace {

/// What is no UTF-8 is of older pictures, which mostly say "©" in Latin 1.
std::string as_utf8(const char* text) {
    if (CPLIsUTF8(text, -1) != 0) {
        return text;
    }
    char* const recoded = CPLRecode(text, CPL_ENC_ISO8859_1, CPL_ENC_UTF8);
    std::string utf8 = recoded;
    CPLFree(recoded);
    return utf8;
}

/// MBTiles have it in HTML, for the corner of a web page.
std::string without_markup(std::string_view html) {
    std::string text;
    bool inside = false;
    for (const char c : html) {
        inside = inside ? c != '>' : c == '<';
        if (!inside && c != '>') {
            text += c;
        }
    }
    constexpr std::string_view sign = "&copy;";
    for (auto at = text.find(sign); at != std::string::npos; at = text.find(sign)) {
        text.replace(at, sign.size(), "©");
    }
    char* const plain = CPLUnescapeString(text.c_str(), nullptr, CPLES_XML);
    text = plain;
    CPLFree(plain);
    return text;
}

std::string on_one_line(std::string text) {
    std::ranges::replace_if(
        text, [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
    const auto first = text.find_first_not_of(' ');
    return first == std::string::npos ? ""
                                      : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

} // namespace

std::string attribution_of(GDALDataset& raster) {
    const auto named = [&](const char* key) {
        const char* const text = raster.GetMetadataItem(key);
        return text == nullptr ? std::string{} : as_utf8(text);
    };
    auto owner = on_one_line(without_markup(named("attribution"))); // of MBTiles
    for (const char* const key : {"TIFFTAG_COPYRIGHT", "Copyright", "EXIF_Copyright"}) {
        if (owner.empty()) {
            owner = on_one_line(named(key));
        }
    }
    return owner;
}

} // namespace macadam
