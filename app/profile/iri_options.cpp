#include "app/profile/iri_options.hpp"

#include "app/cli/row_output.hpp"
#include "app/output/units_option.hpp"
#include "estimator/iri/localised_roughness.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace macadam {
namespace {

std::optional<double> length_in(const Arguments& arguments, std::string_view name) {
    const auto length_m = arguments.number(name);
    if (length_m && !(*length_m > 0)) {
        throw UsageError{fmt::format("{} is {}, expected a length over 0 m", name, *length_m)};
    }
    return length_m;
}

/// Parses --continuous; its base is optional.
std::optional<double> base_in(const Arguments& arguments) {
    const auto word = arguments.value("--continuous");
    return word && word->empty() ? std::optional{localised_base_m}
                                 : length_in(arguments, "--continuous");
}

} // namespace

IriOptions parse_iri(const Arguments& arguments) {
    IriOptions options{.question = {.profile = arguments.operand("PROFILE"),
                                    .step_m = length_in(arguments, "--step"),
                                    .from_m = arguments.number("--from-m"),
                                    .to_m = arguments.number("--to-m"),
                                    .envelope = !arguments.flag("--no-envelope")},
                       .length_m = length_in(arguments, "--length"),
                       .base_m = base_in(arguments),
                       .threshold = arguments.number("--threshold"),
                       .output = arguments.value("--output"),
                       .words = {.in_per_mi = parse_units(arguments) == UnitSystem::us,
                                 .json = row_format_of(arguments) == "json"}};
    if (options.threshold && !options.base_m) {
        throw UsageError{"--threshold applies to a moving mean and requires --continuous"};
    }
    if (options.length_m && options.base_m) {
        throw UsageError{"--length and --continuous cannot be combined"};
    }
    constexpr std::array<std::string_view, 3> suffixes{".erd", ".csv", ".json"};
    if (options.output &&
        std::ranges::find(suffixes, options.output->extension().string()) == suffixes.end()) {
        throw UsageError{fmt::format("-o is '{}', expected a name that ends in {}",
                                     options.output->string(),
                                     fmt::join(suffixes, ", "))};
    }
    return options;
}

} // namespace macadam
