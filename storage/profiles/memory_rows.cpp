#include "storage/profiles/profile_rows.hpp"

#include "estimator/common/error.hpp"
#include "storage/profiles/profile_reader.hpp"

#include <fmt/format.h>

#include <cmath>

namespace macadam {
namespace {

class MemoryRows final : public ProfileRows {
public:
    explicit MemoryRows(const MeasuredProfile& profile)
        : profile_{profile}, row_(profile.tracks.size() + 1) {
        head_.step_m = profile.even_step_m;
        for (const auto& track : profile.tracks) {
            head_.tracks.push_back(track.name);
        }
    }

    const ProfileHead& head() const override { return head_; }

    std::span<const double> next() override {
        if (index_ == profile_.station_m.size()) {
            return {};
        }
        row_.front() = profile_.station_m[index_];
        for (std::size_t i = 0; i < profile_.tracks.size(); ++i) {
            const auto& [name, elevation_m] = profile_.tracks[i];
            row_[i + 1] = elevation_m[index_];
            if (!std::isfinite(row_[i + 1])) {
                throw InputError{fmt::format("{}: value {} is {}, expected an elevation in metres",
                                             name,
                                             index_ + 1,
                                             row_[i + 1])};
            }
        }
        ++index_;
        return row_;
    }

private:
    const MeasuredProfile& profile_;
    ProfileHead head_;
    std::vector<double> row_;
    std::size_t index_ = 0;
};

} // namespace

std::unique_ptr<ProfileRows> rows_of_profile(const MeasuredProfile& profile) {
    return std::make_unique<MemoryRows>(profile);
}

} // namespace macadam
