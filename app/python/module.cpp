#include "app/capture/result_capture.hpp"
#include "app/cli/commands.hpp"
#include "app/database/lock_wait_messages.hpp"
#include "app/pipeline/vehicle_lookup.hpp"
#include "app/profile/iri_options.hpp"
#include "app/python/drive_simulation.hpp"
#include "app/python/interruptible.hpp"

#include "estimator/common/error.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/profiles/profile_reader.hpp"

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace py = pybind11;

namespace macadam {
namespace {

using Words = std::vector<std::string>;

/// Makes an array of a list, whose memory the array takes over.
template <typename T>
py::array array_of(std::vector<T> values) {
    auto kept = std::make_unique<std::vector<T>>(std::move(values));
    const auto* const data = kept->data();
    const auto size = static_cast<py::ssize_t>(kept->size());
    const py::capsule owner{kept.release(), [](void* list) {
                                delete static_cast<std::vector<T>*>(
                                    list); // NOLINT(*-owning-memory)
                            }};
    return py::array_t<T>{size, data, owner};
}

/// Makes an array of Python objects, one for each text.
/// \param object  returns the object of a known text
template <typename ToObject>
py::array objects_of(const CapturedColumn& column, const ToObject& object) {
    py::array array{py::dtype{"O"}, static_cast<py::ssize_t>(column.texts.size())};
    auto** const items = static_cast<PyObject**>(array.mutable_data());
    for (std::size_t i = 0; i < column.texts.size(); ++i) {
        py::object item = py::none{};
        if (column.is_known[i]) {
            item = object(column.texts[i]);
        }
        Py_XDECREF(items[i]);
        items[i] = item.release().ptr();
    }
    return array;
}

/// Masks unknown values, if there are any.
py::array masked(py::array array, const std::vector<bool>& is_known) {
    if (std::ranges::find(is_known, false) == is_known.end()) {
        return array;
    }
    py::array_t<bool> mask{static_cast<py::ssize_t>(is_known.size())};
    for (std::size_t i = 0; i < is_known.size(); ++i) {
        mask.mutable_at(i) = !is_known[i];
    }
    return py::module_::import("numpy.ma").attr("MaskedArray")(array, mask);
}

py::array array_of(CapturedColumn column) {
    switch (column.type.kind) {
    case ColumnType::Kind::real:
        return array_of(std::move(column.reals));
    case ColumnType::Kind::integer:
        return masked(array_of(std::move(column.integers)), column.is_known);
    case ColumnType::Kind::truth:
        return masked(array_of(std::move(column.integers)).attr("astype")("bool"), column.is_known);
    case ColumnType::Kind::day:
        return objects_of(column, [](const std::string& day) { return py::str{day}; })
            .attr("astype")("datetime64[D]"); // None becomes NaT
    case ColumnType::Kind::raw: {
        const auto parse = py::module_::import("json").attr("loads");
        return objects_of(column, [&](const std::string& json) { return parse(json); });
    }
    case ColumnType::Kind::text:
        break;
    }
    return objects_of(column, [](const std::string& text) { return py::str{text}; });
}

/// Returns (columns, units, features): arrays by name, units by name, GeoJSON of rows.
py::object tuple_of(std::optional<CapturedTable> table) {
    if (!table) {
        return py::none{};
    }
    py::dict arrays;
    py::dict units;
    for (auto& column : table->columns) {
        const py::str name{column.name};
        if (!column.type.unit.empty()) {
            units[name] = py::str{std::string{column.type.unit}};
        }
        arrays[name] = array_of(std::move(column));
    }
    return py::make_tuple(arrays, units, table->features);
}

/// Returns (table or None, text, messages) of a command.
py::tuple run_command(const std::string& name, Words words, bool with_features) {
    const auto* const command = command_named(name);
    if (command == nullptr) {
        throw UsageError{refusal_of_command(name)};
    }
    CapturedResult result;
    run_interruptibly([&](const std::stop_token& stop) {
        ResultCapture capture{with_features};
        const auto options = options_of(*command);
        command->run(Arguments{options, command->operands, std::move(words)},
                     Console{Verbosity::quiet, stop});
        result = capture.take();
    });
    py::list messages;
    for (const auto& [is_warning, message] : result.messages) {
        messages.append(py::make_tuple(is_warning, message));
    }
    return py::make_tuple(tuple_of(std::move(result.table)), result.text, messages);
}

using Elevations = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::vector<double> numbers_in(const std::string& name, const Elevations& array) {
    if (array.ndim() != 1) {
        throw InputError{fmt::format(
            "{}: has {} dimensions, expected one value per station", name, array.ndim())};
    }
    return {array.data(), array.data() + array.size()};
}

/// \param stations  None: stations are multiples of step_m
std::shared_ptr<const MeasuredProfile>
profile_in(const std::vector<std::pair<std::string, Elevations>>& tracks,
           const std::optional<Elevations>& stations,
           std::optional<double> step_m) {
    auto profile = std::make_shared<MeasuredProfile>();
    for (const auto& [name, array] : tracks) {
        profile->tracks.push_back({name, numbers_in(name, array)});
    }
    const auto points = profile->tracks.front().elevation_m.size();
    if (stations) {
        profile->station_m = numbers_in("station_m", *stations);
    } else {
        profile->even_step_m = step_m;
        for (std::size_t i = 0; i < points; ++i) {
            profile->station_m.push_back(static_cast<double>(i) * step_m.value_or(0));
        }
    }
    for (const auto& [name, elevation_m] : profile->tracks) {
        if (elevation_m.size() != profile->station_m.size()) {
            throw InputError{fmt::format("{}: has {} values, expected {}, one for each station",
                                         name,
                                         elevation_m.size(),
                                         profile->station_m.size())};
        }
    }
    return profile;
}

using NamedColumn = std::pair<std::string, std::vector<double>>;

/// Columns of a report of IRI, in the order of the program's CSV, and the method.
struct IriColumns {
    IriMethod method;
    std::vector<NamedColumn> columns;
    std::vector<bool> lead_in;
};

IriColumns columns_of(const IriReport& report, double scale) {
    IriColumns result{.method = report.method, .columns = {}, .lead_in = report.lead_in};
    const auto& borders_m = report.borders_m;
    result.columns.emplace_back("from_m", std::vector(borders_m.begin(), borders_m.end() - 1));
    result.columns.emplace_back("to_m", std::vector(borders_m.begin() + 1, borders_m.end()));
    const auto add = [&](std::string name, std::vector<double> iri) {
        std::ranges::for_each(iri, [&](double& value) { value *= scale; });
        result.columns.emplace_back(std::move(name), std::move(iri));
    };
    for (const auto& channel : report.channels) {
        add("iri_" + channel.name, channel.pieces);
    }
    for (const auto* const mean : {&report.mri, &report.hri}) {
        if (*mean) {
            add((*mean)->name, (*mean)->pieces);
        }
    }
    return result;
}

IriColumns moving_columns(const IriOptions& options, double scale) {
    IriColumns result;
    const auto begin = [&](const MovingHead& head) {
        result.method = head.method;
        result.columns.emplace_back("at_m", std::vector<double>{});
        for (const auto& track : head.tracks) {
            result.columns.emplace_back("iri_" + track, std::vector<double>{});
        }
        if (head.has_mri) {
            result.columns.emplace_back("mri", std::vector<double>{});
        }
    };
    moving_iri(options.question, *options.base_m, begin, [&](const MovingIri& moving) {
        auto column = result.columns.begin();
        (column++)->second.push_back(moving.at_m);
        for (const double iri : moving.iri) {
            (column++)->second.push_back(scale * iri);
        }
        if (moving.mri) {
            column->second.push_back(scale * *moving.mri);
        }
        result.lead_in.push_back(moving.lead_in);
    });
    return result;
}

/// Returns (columns, units, method) of the IRI of a profile file, or of one in memory.
py::tuple iri(Words words,
              const std::vector<std::pair<std::string, Elevations>>& tracks,
              const std::optional<Elevations>& stations) {
    const auto option_table = options_of(iri_command);
    auto options = parse_iri({option_table, iri_command.operands, std::move(words)});
    if (!tracks.empty()) {
        options.question.measured = profile_in(tracks, stations, options.question.step_m);
    }
    const double scale = options.words.in_per_mi ? in_per_mi_of_mm_per_m : 1;
    IriColumns result;
    run_interruptibly([&](const std::stop_token&) {
        result = options.base_m
                     ? moving_columns(options, scale)
                     : columns_of(iri_of_pieces(options.question, options.length_m), scale);
    });
    py::dict arrays;
    py::dict units;
    for (auto& [name, values] : result.columns) {
        const py::str key{name};
        units[key] = name.ends_with("_m") ? "m" : options.words.in_per_mi ? "in/mi" : "mm/m";
        arrays[key] = array_of(std::move(values));
    }
    arrays["lead_in"] =
        array_of(std::vector<std::int64_t>(result.lead_in.begin(), result.lead_in.end()))
            .attr("astype")("bool");
    py::dict method;
    method["method"] = result.method.even_step_m ? "sampled" : "exact";
    method["step_m"] = result.method.even_step_m;
    method["envelope_samples"] = result.method.envelope_samples;
    return py::make_tuple(arrays, units, method);
}

using Numbers = std::map<std::string, double>;

DriveConfig drive_config(const Numbers& numbers) {
    DriveConfig config{.speed_mps = numbers.at("speed_mps"),
                       .imu = {},
                       .friction_n = numbers.at("friction_n"),
                       .seed = static_cast<std::uint64_t>(numbers.at("seed"))};
    config.imu.rate_hz = numbers.at("rate_hz");
    config.imu.noise_mps2 = numbers.at("noise_mps2");
    config.imu.noise_radps = numbers.at("noise_radps");
    return config;
}

/// Returns (columns, units) of a simulated drive, as of a trip log.
/// \param words    --vehicle of `trace`
/// \param numbers  of DriveConfig, by their names
py::tuple simulate(Words words,
                   const std::string& profile,
                   const std::vector<std::pair<std::string, Elevations>>& tracks,
                   const std::optional<Elevations>& stations,
                   std::optional<double> step_m,
                   const Numbers& numbers) {
    const auto config = drive_config(numbers);
    constexpr std::array vehicle_options{vehicle_option, vehicles_option, vehicle_id_option};
    const auto vehicle = VehicleChoice{Arguments{vehicle_options, {}, std::move(words)}}.for_all();
    const auto road = tracks.empty()
                          ? std::make_shared<const MeasuredProfile>(read_profile(profile, step_m))
                          : profile_in(tracks, stations, step_m);
    ImuReadings readings;
    run_interruptibly([&](const std::stop_token&) {
        readings = simulate_drive(*road, vehicle.value().vehicle, config);
    });
    const auto count = readings.t_s.size();
    py::dict arrays;
    py::dict units;
    const auto add = [&](const char* name, const char* unit, std::vector<double> values) {
        arrays[name] = array_of(std::move(values));
        units[name] = unit;
    };
    add("t_s", "s", std::move(readings.t_s));
    const auto add_axes = [&](const std::array<const char*, 3>& names,
                              const char* unit,
                              const std::vector<std::array<float, 3>>& samples) {
        for (std::size_t axis = 0; axis < names.size(); ++axis) {
            std::vector<double> values;
            values.reserve(count);
            for (const auto& sample : samples) {
                values.push_back(sample[axis]);
            }
            add(names[axis], unit, std::move(values));
        }
    };
    add_axes({"acc_x_mps2", "acc_y_mps2", "acc_z_mps2"}, "m/s2", readings.acc_mps2);
    add_axes({"gyro_x_radps", "gyro_y_radps", "gyro_z_radps"}, "rad/s", readings.gyro_radps);
    add("speed_mps", "m/s", std::vector(count, config.speed_mps));
    return py::make_tuple(arrays, units);
}

/// \throws InputError  if a file is no road database that can be read.
void check_database(const std::string& path) {
    run_interruptibly([&](const std::stop_token& stop) {
        opened_reader(path, Console{Verbosity::quiet, stop});
    });
}

} // namespace
} // namespace macadam

PYBIND11_MODULE(_macadam, module) {
    module.doc() = "The engines of Macadam; use the package macadam.";
    const auto error = py::exception<void>{module, "Error"};
    const auto value_error = py::reinterpret_borrow<py::object>(PyExc_ValueError);
    py::register_exception<macadam::InputError>(module, "InputError", error);
    py::register_exception<macadam::UsageError>(
        module, "UsageError", py::make_tuple(error, value_error));
    module.attr("__version__") = MACADAM_VERSION;
    module.def("run_command",
               macadam::run_command,
               py::arg("name"),
               py::arg("words"),
               py::arg("with_features") = false);
    module.def("simulate",
               macadam::simulate,
               py::arg("words"),
               py::arg("profile"),
               py::arg("tracks"),
               py::arg("stations"),
               py::arg("step_m"),
               py::arg("numbers"));
    module.def("check_database", macadam::check_database, py::arg("path"));
    module.def("iri",
               macadam::iri,
               py::arg("words"),
               py::arg("tracks") = py::list{},
               py::arg("stations") = py::none{});
}
