// The session extension is declared only under these names, and is part of Debian's SQLite.
#define SQLITE_ENABLE_SESSION
#define SQLITE_ENABLE_PREUPDATE_HOOK

#include "storage/sqlite/change_recorder.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <utility>

namespace macadam {
namespace {

struct Free {
    void operator()(void* bytes) const { sqlite3_free(bytes); }
};

struct Finalize {
    void operator()(sqlite3_changeset_iter* changes) const { sqlite3changeset_finalize(changes); }
};

std::string text_in(sqlite3_value* value) {
    const auto* text = value == nullptr ? nullptr : sqlite3_value_text(value);
    const auto size = value == nullptr ? 0 : static_cast<std::size_t>(sqlite3_value_bytes(value));
    return text == nullptr ? std::string{} : std::string{text, text + size};
}

} // namespace

void ChangeRecorder::Delete::operator()(sqlite3_session* session) const {
    sqlite3session_delete(session);
}

ChangeRecorder::ChangeRecorder(Database& database) : database_{&database} {
    sqlite3_session* session = nullptr;
    int code = sqlite3session_create(database.handle(), "main", &session);
    session_.reset(session);
    if (code == SQLITE_OK) {
        code = sqlite3session_attach(session, nullptr); // all tables
    }
    if (code != SQLITE_OK) {
        throw InputError{fmt::format("{}: its changes cannot be recorded: {}",
                                     database.file().string(),
                                     sqlite3_errstr(code))};
    }
}

void ChangeRecorder::visit(
    const std::function<void(const std::string& table, const RowKey& key)>& visit) const {
    int size = 0;
    void* bytes = nullptr;
    int code = sqlite3session_changeset(session_.get(), &size, &bytes);
    const std::unique_ptr<void, Free> changeset{bytes};
    sqlite3_changeset_iter* iterator = nullptr;
    if (code == SQLITE_OK) {
        code = sqlite3changeset_start(&iterator, size, bytes);
    }
    const std::unique_ptr<sqlite3_changeset_iter, Finalize> changes{iterator};
    while (code == SQLITE_OK && sqlite3changeset_next(iterator) == SQLITE_ROW) {
        const char* table = nullptr;
        int columns = 0, operation = 0, indirect = 0;
        unsigned char* is_key = nullptr;
        sqlite3changeset_op(iterator, &table, &columns, &operation, &indirect);
        code = sqlite3changeset_pk(iterator, &is_key, nullptr);
        RowKey key;
        for (int column = 0; code == SQLITE_OK && column < columns; ++column) {
            if (is_key[column] != 0) {
                sqlite3_value* value = nullptr;
                code = operation == SQLITE_INSERT ? sqlite3changeset_new(iterator, column, &value)
                                                  : sqlite3changeset_old(iterator, column, &value);
                key.push_back(text_in(value));
            }
        }
        if (code == SQLITE_OK) {
            visit(table, key);
        }
    }
    if (code != SQLITE_OK) {
        throw InputError{fmt::format("{}: its changes cannot be read: {}",
                                     database_->file().string(),
                                     sqlite3_errstr(code))};
    }
}

} // namespace macadam
