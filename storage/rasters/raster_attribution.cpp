#include "storage/rasters/raster_attribution.hpp"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <gdal_priv.h>

#include <algorithm>
#include <string_view>

namespace macadam {
namespace {

/// Converts text to UTF-8. Other encodings occur in older pictures, mostly for "©" in Latin 1.
std::string as_utf8(const char* text) {
    if (CPLIsUTF8(text, -1) != 0) {
        return text;
    }
    char* const recoded = CPLRecode(text, CPL_ENC_ISO8859_1, CPL_ENC_UTF8);
    std::string utf8 = recoded;
    CPLFree(recoded);
    return utf8;
}

/// Removes mark-up; MBTiles state their attribution in HTML, for a web page.
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
    auto owner = on_one_line(without_markup(named("attribution"))); // key of MBTiles
    for (const char* const key : {"TIFFTAG_COPYRIGHT", "Copyright", "EXIF_Copyright"}) {
        if (owner.empty()) {
            owner = on_one_line(named(key));
        }
    }
    return owner;
}

} // namespace macadam
