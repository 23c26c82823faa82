#pragma once

#include "render/text/font_source.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

struct FT_LibraryRec_;
struct FT_FaceRec_;
struct hb_font_t;

namespace macadam {

/// The fonts that text is set in: a fixed list of files of known packages, so that a picture is the
/// same on every machine that has them. DejaVu Sans comes first; what it lacks comes from Noto's
/// font for the script, then from Noto's symbols. Each is opened when it is first needed.
class FontSet {
public:
    /// \param folder  /usr/share/fonts, laid out as Debian's packages lay it out
    /// \throws InputError  if DejaVu Sans is not there.
    explicit FontSet(std::filesystem::path folder);
    ~FontSet();
    FontSet(const FontSet&) = delete;
    FontSet& operator=(const FontSet&) = delete;

    /// The fonts to try for a script, the best first.
    ///
    /// \param script  four letters of ISO 15924 as a number, as HarfBuzz has them
    std::vector<int> fonts_for(std::uint32_t script, bool bold);

    /// The fonts to try for signs that belong to no script.
    static std::vector<int> symbol_fonts();

    /// \throws InputError  naming the package, if the font's file is not there.
    bool has(int font, char32_t character);

    FontSource source(int font) const;

    /// A font at a size, until the next call for it. \throws InputError  likewise.
    FT_FaceRec_* face(int font, double size_px);
    hb_font_t* shaper(int font, double size_px);

private:
    struct Open {
        FT_FaceRec_* face = nullptr;
        hb_font_t* shaper = nullptr;
        long size = 0; ///< 1/64 px
    };
    Open& opened(int font);
    Open& sized(int font, double size_px);

    std::filesystem::path folder_;
    FT_LibraryRec_* library_ = nullptr;
    std::vector<Open> open_; ///< by number of the font
};

/// How glyphs are fitted to pixels where text stands level: in height only, so that strokes are
/// crisp and letters keep their distances at any size.
std::int32_t level_load_flags();

} // namespace macadam
