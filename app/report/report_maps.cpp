#include "app/report/report_maps.hpp"

#include "app/render/change_map.hpp"
#include "estimator/common/error.hpp"
#include "render/canvas/palette_png.hpp"

#include <algorithm>
#include <utility>

namespace macadam {
namespace {

/// Sizes of the pictures.
struct PictureSizes {
    int map_width_px;
    double map_px_per_inch; ///< as the page shows it: so large are its letters
    double max_map_shape;   ///< height / width
    int stretch_width_px;
    double stretch_px_per_inch; ///< likewise
    double stretch_shape;       ///< height / width
};
// A screen has 96 px per inch and shows maps at half their size, sections at two thirds; sheets of
// A4 have a map over their whole width, and sections over half of it.
constexpr PictureSizes on_screen{1400, 192, 1.1, 480, 144, 0.75};
constexpr PictureSizes on_paper{2125, 300, 0.65, 1010, 300, 0.54};
constexpr double min_map_shape = 0.3; // height / width
constexpr int map_band_px = 400;      // rows drawn at once: beside a million roads there is no room

constexpr double min_margin_m = 60;   // around a section: the next side streets
constexpr double margin_share = 0.25; // share of its extent

const PictureSizes& sizes_for(PictureUse use) {
    return use == PictureUse::paper ? on_paper : on_screen;
}

/// Returns a map's size, whose height is what a box needs within the limits of a page.
PictureSize map_size(const GeoBox& box, PictureUse use) {
    const double middle_deg = (box.south_deg + box.north_deg) / 2;
    const double width_m = distance_m({middle_deg, box.west_deg}, {middle_deg, box.east_deg});
    const double height_m =
        distance_m({box.south_deg, box.west_deg}, {box.north_deg, box.west_deg});
    const auto& sizes = sizes_for(use);
    const double shape =
        std::clamp(height_m / std::max(width_m, 1.0), min_map_shape, sizes.max_map_shape);
    return {.width_px = sizes.map_width_px,
            .height_px = static_cast<int>(sizes.map_width_px * shape),
            .band_px = map_band_px,
            .px_per_inch = sizes.map_px_per_inch};
}

PictureSize stretch_size(PictureUse use) {
    const auto& sizes = sizes_for(use);
    return {.width_px = sizes.stretch_width_px,
            .height_px = static_cast<int>(sizes.stretch_width_px * sizes.stretch_shape),
            .px_per_inch = sizes.stretch_px_per_inch};
}

GeoBox box_around(const WorstSection& stretch) {
    GeoBox box;
    for (const auto& point : stretch.line) {
        box = including(box, point);
    }
    const double extent_m =
        distance_m({box.south_deg, box.west_deg}, {box.north_deg, box.east_deg});
    return grown(box, std::max(min_margin_m, margin_share * extent_m));
}

/// Returns a box with what a picture of another shape shows beside it.
GeoBox around(const GeoBox& box) {
    return grown(box, distance_m({box.south_deg, box.west_deg}, {box.north_deg, box.east_deg}));
}

MapStyle unadorned(MapStyle style) {
    style.legend = false; // on the page
    return style;
}

} // namespace

MapStyle in_theme(MapStyle style, MapStyle::Theme theme) {
    const auto is_dark = [](MapStyle::Theme of) { return of == MapStyle::Theme::dark; };
    if (is_dark(style.theme) != is_dark(theme)) {
        style.colours = {};
    }
    style.theme = theme;
    return style;
}

ReportPictures::ReportPictures(const MapStyle& style,
                               PictureUse use,
                               const Progress& progress,
                               std::size_t count)
    : style_{unadorned(style)}, use_{use}, progress_{progress}, count_{count} {}

ReportPicture ReportPictures::draw(ReportScene map, const PictureSize& size, bool is_of_changes) {
    if (progress_.stop.stop_requested()) {
        throw InputError{"stopped before the report was complete"};
    }
    progress_(++drawn_, count_);
    const auto png = [&](MapStyle::Theme theme) {
        auto style = in_theme(style_, theme);
        if (is_of_changes) {
            style.classes = &change_classes();
            style.own_ramp = change_colours(theme == MapStyle::Theme::dark);
        }
        // Moved to and fro: a second copy of a large map would not fit.
        auto lines = std::move(map.scene.lines);
        MapPlan plan{std::move(map.scene), style, size};
        plan.set_background(std::move(map.background));
        plan.set_roads(std::move(lines));
        const auto image = image_of(plan);
        auto bytes = use_ == PictureUse::screen ? encode_palette_png(image) : encode_png(image);
        map.background = std::move(plan).background();
        map.scene = std::move(plan).scene();
        return bytes;
    };
    using enum MapStyle::Theme;
    ReportPicture picture{{}, {}, size.width_px, size.height_px};
    picture.light_png = png(use_ == PictureUse::paper ? print : light);
    if (use_ == PictureUse::screen) {
        picture.dark_png = png(dark);
    }
    return picture;
}

ReportPicture ReportPictures::map(ReportScene map, bool is_of_changes) {
    const auto size = map_size(map.scene.box, use_);
    return draw(std::move(map), size, is_of_changes);
}

ReportPicture ReportPictures::stretch(MapScene scene, bool is_of_changes) {
    ReportScene map;
    map.scene = std::move(scene);
    return draw(std::move(map), stretch_size(use_), is_of_changes);
}

double ReportPictures::map_width_m(const MapScene& scene) const {
    MapScene empty;
    empty.box = scene.box;
    empty.scale_bar = scene.scale_bar;
    return MapPlan{std::move(empty), style_, map_size(scene.box, use_)}.ground_width_m();
}

ReportScene whole_scene(const StoreReader& store,
                        const MapStyle& style,
                        PictureUse use,
                        const SegmentFilter& filter,
                        const LoadLines& lines) {
    // A picture of maximum height shows at least as much as lower ones of the same box.
    const auto& sizes = sizes_for(use);
    const PictureSize size{.width_px = sizes.map_width_px,
                           .height_px = static_cast<int>(sizes.map_width_px * sizes.max_map_shape),
                           .px_per_inch = sizes.map_px_per_inch};
    auto plan = load_map(store, {.filter = filter, .style = unadorned(style), .size = size}, lines);
    ReportScene map;
    map.background = std::move(plan).background();
    map.scene = std::move(plan).scene();
    map.scene.subtitle.clear();    // on the page
    map.scene.attribution.clear(); // likewise
    map.scene.scale_bar = false;   // likewise, in letters as large as all others on a phone
    return map;
}

MapScene
quiet_scene(const StoreReader& store, const WorstSection& stretch, const ClassTable& classes) {
    MapScene scene;
    scene.scale_bar = false; // too small to read on a phone; the page states the length
    scene.box = box_around(stretch);
    scene.lines = map_lines(store, around(scene.box), classes);
    for (auto& line : scene.lines) {
        line.iri_class = -1;
        line.name.clear(); // too small to read; the text beside states the road
    }
    return scene;
}

MapScene stretch_scene(const StoreReader& store,
                       const WorstSection& stretch,
                       const std::vector<MeasuredSegment>& measured,
                       const ClassTable& classes) {
    MapScene scene;
    scene.scale_bar = false; // too small to read on a phone; the page states the length
    scene.box = box_around(stretch);
    scene.lines = map_lines(store, around(scene.box), classes);
    constexpr int side_street = 5; // a thin line, beside which the section is a wide one
    for (auto& line : scene.lines) {
        line.rank = side_street;
    }
    SegmentFilter of_stretch;
    of_stretch.with_state_only = false;
    of_stretch.ranges.emplace();
    for (const auto i : stretch.records) {
        const auto& key = measured[i].key;
        of_stretch.ranges->push_back({key.way_id, key.forward, key.index, key.index + 1});
    }
    auto next = stretch.records.begin();
    store.visit(of_stretch, [&](const SegmentRecord& record) {
        MapLine line;
        line.rank = subject_rank;
        line.name = record.name;
        line.line = record.segment.line;
        line.iri_class =
            static_cast<int>(class_index(classes, rated_length(measured[*next++]).iri));
        scene.lines.push_back(std::move(line));
    });
    return scene;
}

} // namespace macadam
