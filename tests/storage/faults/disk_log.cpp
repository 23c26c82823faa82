#include "faulty_disk.hpp"

#include <algorithm>
#include <fstream>
#include <optional>
#include <random>

namespace macadam::testing {
namespace {

constexpr std::size_t sector = 512;

using Kind = DiskOperation::Kind;
using Operations = std::vector<DiskOperation>;

void put(std::string& content, std::size_t offset, std::string_view bytes) {
    content.resize(std::max(content.size(), offset + bytes.size()));
    content.replace(offset, bytes.size(), bytes);
}

void apply(std::string& content, const DiskOperation& operation) {
    if (operation.kind == Kind::truncate) {
        content.resize(static_cast<std::size_t>(operation.offset));
    } else if (operation.kind == Kind::write) {
        put(content, static_cast<std::size_t>(operation.offset), operation.bytes);
    }
}

/// Any of the sectors that the write touches, as a whole or not at all.
void apply_torn(std::string& content, const DiskOperation& write, std::mt19937& random) {
    const auto begin = static_cast<std::size_t>(write.offset);
    const auto end = begin + write.bytes.size();
    for (auto from = begin; from < end;) {
        const auto to = std::min(end, (from / sector + 1) * sector);
        if (random() % 2 == 0) {
            put(content, from, std::string_view{write.bytes}.substr(from - begin, to - from));
        }
        from = to;
    }
}

void apply_unsynced(std::string& content,
                    const DiskOperation& operation,
                    Loss loss,
                    std::mt19937& random) {
    if (loss == Loss::torn && operation.kind == Kind::write) {
        apply_torn(content, operation, random);
    } else if (loss != Loss::all && random() % 2 == 0) {
        apply(content, operation);
    }
}

/// How many of the first `count` operations a sync of that kind has made safe.
template <typename IsSync>
std::size_t safe_count(const Operations& operations, std::size_t count, IsSync is_sync) {
    while (count > 0 && !is_sync(operations[count - 1])) {
        --count;
    }
    return count;
}

std::string content_of(
    const DiskLog& log, std::size_t file, std::size_t count, Loss loss, std::mt19937& random) {
    const auto concerns = [&](const DiskOperation& operation) {
        return operation.file == file &&
               (operation.kind == Kind::write || operation.kind == Kind::truncate);
    };
    const auto safe = safe_count(log.operations, count, [&](const DiskOperation& operation) {
        return operation.kind == Kind::sync && operation.file == file;
    });
    auto content = log.at_first[file];
    for (std::size_t i = 0; i < count; ++i) {
        if (const auto& operation = log.operations[i]; !concerns(operation)) {
            continue;
        } else if (i < safe) {
            apply(content, operation);
        } else {
            apply_unsynced(content, operation, loss, random);
        }
    }
    return content;
}

std::map<std::string, std::size_t>
names_after(const DiskLog& log, std::size_t count, Loss loss, std::mt19937& random) {
    const auto safe = safe_count(log.operations, count, [](const DiskOperation& operation) {
        return operation.kind == Kind::sync_folder;
    });
    auto names = log.names;
    for (std::size_t i = 0; i < count; ++i) {
        const auto& operation = log.operations[i];
        const bool links = operation.kind == Kind::link;
        if ((!links && operation.kind != Kind::unlink) ||
            (i >= safe && (loss == Loss::all || random() % 2 == 0))) {
            continue;
        }
        if (links) {
            names[operation.name] = operation.file;
        } else {
            names.erase(operation.name);
        }
    }
    return names;
}

} // namespace

void write_after_power_loss(const DiskLog& log,
                            std::size_t count,
                            Loss loss,
                            std::uint32_t seed,
                            const std::filesystem::path& folder) {
    std::mt19937 random{seed};
    for (const auto& [name, file] : names_after(log, count, loss, random)) {
        std::ofstream out{folder / std::filesystem::path{name}.filename(), std::ios::binary};
        out << content_of(log, file, count, loss, random);
    }
}

} // namespace macadam::testing
