#pragma once

#include "render/text/font_source.hpp"

#include <cstdint>
#include <filesystem>
#include <vector>

struct FT_LibraryRec_;
struct FT_FaceRec_;
struct hb_font_t;

namespace macadam {

/// Set of fonts for text: a fixed list of files of known packages, so that a picture is the same on
/// every machine that has them. Noto Sans comes first; characters that it lacks come from Noto's
/// font for the script, then from Noto's symbols. Fonts are opened on first use.
class FontSet {
public:
    /// \param folder  /usr/share/fonts, with the layout of Debian's packages
    /// \throws InputError  if Noto Sans is missing.
    explicit FontSet(std::filesystem::path folder);
    ~FontSet();
    FontSet(const FontSet&) = delete;
    FontSet& operator=(const FontSet&) = delete;

    /// Returns the candidate fonts for a script, the best first.
    ///
    /// \param script  four letters of ISO 15924 as a number, as in HarfBuzz
    std::vector<int> fonts_for(std::uint32_t script, bool bold);

    /// Returns the candidate fonts for symbols that belong to no script.
    static std::vector<int> symbol_fonts();

    /// \throws InputError  naming the package, if the font's file is missing.
    bool has(int font, char32_t character);

    FontSource source(int font) const;

    /// Returns a font at a size, valid until the next call for that font. \throws InputError
    /// likewise.
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
    std::vector<Open> open_; ///< by font number
};

/// Returns the load flags for horizontal text: hinting in height only, so that strokes are crisp
/// and letter spacing is the same at any size.
std::int32_t level_load_flags();

} // namespace macadam
