#include "storage/profiles/length_unit.hpp"
#include "storage/profiles/profile_rows.hpp"

#include "estimator/common/error.hpp"
#include "storage/files/byte_stream.hpp"
#include "storage/profiles/erd_header.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <utility>

namespace macadam {

namespace {

/// Names of quantities other than elevation that profilers measure in units of length.
constexpr std::array no_elevations{"dist", "stat", "rut", "mpd", "mtd", "text"};

bool names_no_elevation(std::string_view name) {
    std::string lower{name};
    std::ranges::transform(
        lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return std::ranges::any_of(no_elevations,
                               [&](std::string_view word) { return lower.starts_with(word); });
}

/// Channel with the elevation of a track.
struct Elevation {
    std::size_t channel;
    double metres; ///< per unit of the channel
};

std::vector<Elevation> elevations_of(const ErdHeader& header, const std::string& file) {
    std::vector<Elevation> elevations;
    std::vector<std::string> units;
    for (std::size_t i = 0; i < header.channels.size(); ++i) {
        const auto& [name, unit, gain] = header.channels[i];
        const auto metres = metres_in(unit);
        if (metres && !names_no_elevation(name)) {
            const bool counts = header.numbers == ErdNumbers::int16;
            elevations.push_back({i, *metres * (counts ? gain : 1)});
        }
        units.push_back(in_quotes(unit));
    }
    if (elevations.empty()) {
        throw InputError{fmt::format("{}: no channel is an elevation: UNITSNAM has {}, expected {}",
                                     file,
                                     fmt::join(units, " "),
                                     length_units)};
    }
    return elevations;
}

/// Tests whether only the name at `index` begins with that letter.
bool alone_with(const std::vector<std::string>& names, std::size_t index, char letter) {
    const auto begins = [&](const std::string& name) {
        return !name.empty() && std::tolower(static_cast<unsigned char>(name.front())) == letter;
    };
    return begins(names[index]) && std::ranges::count_if(names, begins) == 1;
}

/// Names the tracks "left" and "right" if exactly one name begins with L and one with R ("LElev.",
/// "RElev."), or if two channels are unnamed; otherwise by the names in the file.
std::vector<std::string> track_names(const ErdHeader& header,
                                     const std::vector<Elevation>& elevations) {
    std::vector<std::string> names;
    names.reserve(elevations.size());
    for (const auto& elevation : elevations) {
        names.push_back(header.channels[elevation.channel].name);
    }
    if (names.size() == 1) {
        return {names.front().empty() ? "profile" : names.front()};
    }
    if (names == std::vector<std::string>{"", ""}) {
        return {"left", "right"};
    }
    auto labels = names;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (alone_with(names, i, 'l')) {
            labels[i] = "left";
        } else if (alone_with(names, i, 'r')) {
            labels[i] = "right";
        } else if (names[i].empty() || std::ranges::count(names, names[i]) > 1) {
            labels[i] = fmt::format("track_{}", i + 1);
        }
    }
    return labels;
}

/// Reads samples in sequence: one number per channel.
class Samples {
public:
    Samples() = default;
    Samples(const Samples&) = delete;
    Samples& operator=(const Samples&) = delete;
    virtual ~Samples() = default;

    /// Returns the next sample, valid until the next call; empty at the end.
    virtual std::span<const double> next() = 0;
};

std::vector<double> free_numbers(std::string_view line) {
    constexpr std::string_view between = " \t,;";
    std::vector<double> numbers;
    for (;;) {
        line.remove_prefix(std::min(line.find_first_not_of(between), line.size()));
        if (line.empty()) {
            return numbers;
        }
        const auto word = line.substr(0, line.find_first_of(between));
        const auto number = fortran_number(word);
        if (!number) {
            return {};
        }
        numbers.push_back(*number);
        line.remove_prefix(word.size());
    }
}

std::vector<double> fixed_numbers(std::string_view line, const std::vector<FixedField>& fields) {
    std::vector<double> numbers;
    for (const auto& [from, width, decimals] : fields) {
        const auto cell = trimmed(line.substr(std::min(from, line.size()), width));
        if (cell.empty()) {
            return numbers;
        }
        const auto number = fortran_number(cell, decimals);
        if (!number) {
            return {};
        }
        numbers.push_back(*number);
    }
    return numbers;
}

/// Numbers in the lines after END, with any count per line.
class TextSamples final : public Samples {
public:
    TextSamples(TextLines lines, std::size_t channels, std::vector<FixedField> format)
        : lines_{std::move(lines)}, channels_{channels}, format_{std::move(format)} {}

    std::span<const double> next() override {
        numbers_.erase(numbers_.begin(),
                       numbers_.begin() + static_cast<std::ptrdiff_t>(std::exchange(used_, 0)));
        while (numbers_.size() < channels_) {
            const auto line = lines_.next();
            if (!line || trimmed(*line).starts_with(end_of_dos_text)) {
                if (!numbers_.empty()) {
                    throw InputError{fmt::format("{}: ends within a sample: {} of {} numbers",
                                                 lines_.where(),
                                                 numbers_.size(),
                                                 channels_)};
                }
                return {};
            }
            const auto more = numbers_of(*line);
            numbers_.insert(numbers_.end(), more.begin(), more.end());
        }
        used_ = channels_;
        return std::span{numbers_}.first(channels_);
    }

private:
    static constexpr char end_of_dos_text = '\x1a';

    /// Parses a line. Separated numbers are read as they are, like in the program published with
    /// the standard; the format is used to split adjacent numbers.
    std::vector<double> numbers_of(std::string_view line) const {
        auto numbers = free_numbers(line);
        if (!format_.empty()) {
            if (auto fixed = fixed_numbers(line, format_); fixed.size() > numbers.size()) {
                numbers = std::move(fixed);
            }
        }
        if (numbers.empty() && !trimmed(line).empty()) {
            throw InputError{
                fmt::format("{}: {}, expected numbers", lines_.where(), in_quotes(line))};
        }
        return numbers;
    }

    TextLines lines_;
    std::size_t channels_;
    std::vector<FixedField> format_;
    std::vector<double> numbers_;
    std::size_t used_ = 0;
};

/// Little-endian binary numbers, sample by sample.
class BinarySamples final : public Samples {
public:
    BinarySamples(const std::filesystem::path& file, std::size_t channels, ErdNumbers numbers)
        : name_{file.string()}, bytes_{file_bytes(file)}, numbers_{numbers},
          buffer_(channels * (numbers == ErdNumbers::int16 ? 2 : 4)), sample_(channels) {}

    std::span<const double> next() override {
        std::size_t filled = 0;
        while (filled < buffer_.size()) {
            const auto count = bytes_->read(std::span{buffer_}.subspan(filled));
            if (count == 0) {
                return {}; // the last record may be padded
            }
            filled += count;
        }
        for (std::size_t i = 0; i < sample_.size(); ++i) {
            sample_[i] = number(i);
            if (!std::isfinite(sample_[i])) {
                throw InputError{fmt::format("{}: sample {} is '{}', expected finite numbers",
                                             name_,
                                             count_ + 1,
                                             sample_[i])};
            }
        }
        ++count_;
        return sample_;
    }

private:
    double number(std::size_t index) const {
        const std::size_t width = numbers_ == ErdNumbers::int16 ? 2 : 4;
        std::uint32_t bits = 0;
        for (std::size_t i = 0; i < width; ++i) {
            const auto byte = static_cast<unsigned char>(buffer_[index * width + i]);
            bits |= std::uint32_t{byte} << (8 * i);
        }
        return numbers_ == ErdNumbers::int16 ? static_cast<double>(static_cast<std::int16_t>(bits))
                                             : static_cast<double>(std::bit_cast<float>(bits));
    }

    std::string name_;
    std::unique_ptr<ByteStream> bytes_;
    ErdNumbers numbers_;
    std::vector<char> buffer_;
    std::vector<double> sample_;
    std::size_t count_ = 0;
};

std::unique_ptr<Samples>
samples_of(const std::filesystem::path& file, TextLines lines, const ErdHeader& header) {
    if (header.numbers == ErdNumbers::text) {
        return std::make_unique<TextSamples>(
            std::move(lines), header.channels.size(), header.format);
    }
    auto beside = file;
    beside.replace_extension(".bin");
    return std::make_unique<BinarySamples>(beside, header.channels.size(), header.numbers);
}

class ErdRows final : public ProfileRows {
public:
    ErdRows(const std::filesystem::path& file, std::optional<double> step_m)
        : name_{file.string()} {
        TextLines lines{file_bytes(file), name_};
        const auto header = read_erd_header(lines);
        elevations_ = elevations_of(header, name_);
        announced_ = header.samples;
        start_m_ = header.start_m;
        head_ = {.tracks = track_names(header, elevations_),
                 .step_m = step_m ? step_m : header.step_m};
        if (!head_.step_m) {
            throw InputError{fmt::format("{}: has no step in a unit of length, expected XUNITS "
                                         "{} or the option --step",
                                         name_,
                                         length_units)};
        }
        samples_ = samples_of(file, std::move(lines), header);
        row_.resize(1 + elevations_.size());
    }

    const ProfileHead& head() const override { return head_; }

    std::span<const double> next() override {
        if (count_ == announced_) {
            return {};
        }
        const auto sample = samples_->next();
        if (sample.empty()) {
            if (announced_) {
                throw InputError{fmt::format("{}: has {} samples, expected the {} of its header",
                                             name_,
                                             count_,
                                             *announced_)};
            }
            return {};
        }
        row_.front() = start_m_ + static_cast<double>(count_) * *head_.step_m;
        for (std::size_t i = 0; i < elevations_.size(); ++i) {
            row_[i + 1] = elevations_[i].metres * sample[elevations_[i].channel];
        }
        ++count_;
        return row_;
    }

private:
    std::string name_;
    ProfileHead head_;
    std::vector<Elevation> elevations_;
    std::optional<std::size_t> announced_;
    double start_m_ = 0;
    std::unique_ptr<Samples> samples_;
    std::vector<double> row_;
    std::size_t count_ = 0;
};

} // namespace

std::unique_ptr<ProfileRows> open_erd_profile(const std::filesystem::path& file,
                                              std::optional<double> step_m) {
    return std::make_unique<ErdRows>(file, step_m);
}

} // namespace macadam
