#pragma once

#include "storage/sqlite/sqlite.hpp"

#include <map>
#include <string>

namespace macadam {

/// Statement cache of a database: each statement is compiled once and reused. Destroy it before the
/// database.
class StatementCache {
public:
    /// Borrowed statement, which is reset when it is returned. A statement left in the middle of
    /// its rows would keep its read snapshot open.
    class CachedStatement {
    public:
        CachedStatement(StatementCache& keeper, std::string sql);
        CachedStatement(const CachedStatement&) = delete;
        CachedStatement& operator=(const CachedStatement&) = delete;
        ~CachedStatement();

        Statement& operator*() { return statement_; }
        Statement* operator->() { return &statement_; }

    private:
        StatementCache* keeper_;
        std::string sql_;
        Statement statement_;
    };

    explicit StatementCache(Database& database) : database_{&database} {}

private:
    /// Returns a cached statement, or a new one if it is missing or in use.
    Statement taken(const std::string& sql);

    Database* database_;
    std::map<std::string, Statement> idle_; ///< by their SQL text
};

} // namespace macadam
