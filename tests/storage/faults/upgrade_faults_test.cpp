// A store of an earlier version that is upgraded on a disk that is full, breaks, cannot sync or
// loses power: it is the old one or the new one.

#include "faulty_disk.hpp"
#include "storage/store/privacy/privacy_key.hpp"
#include "storage/store/upgrade/store_upgrade.hpp"
#include "store_import.hpp"
#include "support/files/files.hpp"
#include "support/roads/old_store.hpp"

#include <gmock/gmock.h>

#include <array>
#include <random>

namespace macadam {
namespace {

namespace fs = std::filesystem;
using testing::Fault;
using testing::FaultyDisk;
using testing::Loss;
using testing::refusal_of;
using testing::test_folder;
using testing::tries;

StoreUpgrade upgrade(const fs::path& file) {
    return upgrade_store(file, {}, [](std::string_view) { return Progress{}; });
}

/// Upgrades what is left, if it is not, and looks whether all is there.
void expect_upgraded(const fs::path& file) {
    const FaultyDisk sound;
    EXPECT_EQ(testing::damage_of(file), "ok");
    const auto done = upgrade(file);
    if (done.from_version == 2) {
        EXPECT_EQ(done.digest, testing::digest_of_version_2);
    }
    auto store = StoreReader::open(file);
    EXPECT_EQ(store.digest(), testing::digest_of_version_2);
    EXPECT_TRUE(store.is_operator());
    EXPECT_EQ(store.usage().cars.front(), store.key()->pseudonym("van-7"));
}

void start_anew(const fs::path& folder) {
    fs::remove_all(folder);
    fs::create_directories(folder);
    testing::put_store_of_version_2(folder, "a.gpkg");
}

class UpgradeFault : public ::testing::TestWithParam<Fault> {};

TEST_P(UpgradeFault, IsNamedAndLeavesTheOldStoreOrTheNewOne) {
    const auto folder = test_folder() / "disk";
    std::size_t refused = 0;
    const auto step = tries(5, 1);
    for (std::size_t number = 1; number <= 2000; number += step) {
        SCOPED_TRACE(number);
        start_anew(folder);
        bool met = false;
        {
            FaultyDisk disk;
            disk.plan({GetParam(), number, number / step % 2 == 0});
            const auto refusal = refusal_of([&] { upgrade(folder / "a.gpkg"); });
            met = disk.has_failed();
            refused += refusal.empty() ? 0 : 1;
            EXPECT_TRUE(refusal.empty() || refusal.find("a.gpkg") != std::string::npos) << refusal;
        }
        if (!met) {
            break;
        }
        expect_upgraded(folder / "a.gpkg");
    }
    EXPECT_GT(refused, 0U);
}

INSTANTIATE_TEST_SUITE_P(Upgrade,
                         UpgradeFault,
                         ::testing::Values(Fault::full, Fault::broken, Fault::no_sync));

TEST(UpgradePowerLoss, LeavesTheOldStoreOrTheNewOne) {
    constexpr std::array losses{Loss::all, Loss::some, Loss::torn};
    const auto folder = test_folder() / "disk";
    start_anew(folder);
    testing::DiskLog log;
    {
        FaultyDisk disk;
        upgrade(folder / "a.gpkg");
        log = disk.log();
    }
    const auto key = *read_key(folder / "a.gpkg.key"); // was synced before the commit
    std::mt19937 random{20261122};
    for (std::size_t image = 0; image < tries(30, 300); ++image) {
        const auto when = random() % (log.operations.size() + 1);
        SCOPED_TRACE(::testing::Message() << "image " << image << ", after operation " << when);
        const auto left = folder / "left";
        fs::remove_all(left);
        fs::create_directories(left);
        write_after_power_loss(
            log, when, losses[image % losses.size()], static_cast<std::uint32_t>(image), left);
        write_key(left / "a.gpkg.key", key);
        expect_upgraded(left / "a.gpkg");
    }
}

} // namespace
} // namespace macadam
