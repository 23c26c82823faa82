#include "storage/sqlite/statement_cache.hpp"

#include <new>
#include <utility>

namespace macadam {

StatementCache::CachedStatement::CachedStatement(StatementCache& keeper, std::string sql)
    : keeper_{&keeper}, sql_{std::move(sql)}, statement_{keeper.taken(sql_)} {}

StatementCache::CachedStatement::~CachedStatement() {
    statement_.reset();
    try {
        keeper_->idle_.insert_or_assign(std::move(sql_), std::move(statement_));
    } catch (const std::bad_alloc&) { // it is then compiled again
    }
}

Statement StatementCache::taken(const std::string& sql) {
    auto idle = idle_.extract(sql);
    return idle.empty() ? database_->prepare(sql) : std::move(idle.mapped());
}

} // namespace macadam
