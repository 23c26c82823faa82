#include "mapping/style/custom_class_table.hpp"

#include <utility>

namespace macadam {

struct OwnClassTable::Kept {
    std::string name, title;
    std::vector<OwnClass> own;
    std::vector<IriClass> classes;
    ClassTable table;
};

OwnClassTable::OwnClassTable(std::string name, std::string title, std::vector<OwnClass> classes) {
    auto kept =
        std::make_shared<Kept>(Kept{std::move(name), std::move(title), std::move(classes), {}, {}});
    for (const auto& own : kept->own) {
        kept->classes.push_back({own.name, own.to_mm_per_m, own.open});
    }
    kept->table = {kept->name, kept->title, kept->classes};
    kept_ = std::move(kept);
}

const ClassTable& OwnClassTable::table() const {
    return kept_->table;
}

} // namespace macadam
