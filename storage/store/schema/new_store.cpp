#include "storage/store/schema/new_store.hpp"

#include "estimator/common/error.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/geopackage/geopackage.hpp"
#include "storage/geopackage/hidden_tables.hpp"
#include "storage/geopackage/qgis_style.hpp"
#include "storage/store/schema/schema_sql.hpp"

#include <fmt/format.h>

namespace macadam {

void fill_new_store(Database& database,
                    const std::string& class_table_name,
                    PrivacyProfile privacy,
                    const std::function<GeoBox()>& fill) {
    const auto* classes = class_table(class_table_name);
    if (classes == nullptr) {
        throw InputError{fmt::format("class table '{}', expected fhwa or five", class_table_name)};
    }
    Transaction all{database, Transaction::Kind::write};
    make_geopackage(database);
    database.run(store_tables());
    database.run(roughness_layer(privacy));
    add_style_table(database);
    const auto box = fill();
    list_features(database, {"segment", "segment", "Pieces of road, one for each direction", box});
    list_features(database,
                  {"roughness", "roughness", "Roughness (IRI, mm/m) of the segments driven", box});
    index_store_tables(database); // much faster after the rows were inserted
    add_default_style(database, "roughness", {*classes});
    hide_other_tables(database);
    all.commit();
}

void index_store_tables(Database& database) {
    database.run("CREATE UNIQUE INDEX segment_key ON segment(way_id, direction, seq)");
    database.run("CREATE INDEX way_name ON way(name)");
    index_features(database, "segment");
}

} // namespace macadam
