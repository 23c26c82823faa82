#include "app/profile/iri_output.hpp"

#include "app/cli/console.hpp"
#include "estimator/iri/localised_roughness.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <vector>

namespace macadam {
namespace {

double scale_of(const IriWords& words) {
    return words.in_per_mi ? in_per_mi_of_mm_per_m : 1;
}

JsonNumber value(double iri, const IriWords& words) {
    return {scale_of(words) * iri, 6};
}

void add_method(JsonObject& object, const IriMethod& method, const IriWords& words) {
    const auto& samples = method.envelope_samples;
    object.add("unit", std::string{words.in_per_mi ? "in/mi" : "mm/m"})
        .add("method", std::string{method.even_step_m ? "sampled" : "exact"})
        .add("step_m", json_number(method.even_step_m, 6))
        .add("envelope_samples",
             samples ? JsonValue{static_cast<std::int64_t>(*samples)} : JsonValue{nullptr});
}

std::string
json_of(const IriReport::Channel& channel, const IriReport& report, const IriWords& words) {
    std::vector<std::string> segments;
    for (std::size_t i = 0; i < channel.pieces.size(); ++i) {
        JsonObject segment;
        segment.add("from_m", JsonNumber{report.borders_m[i], 3})
            .add("to_m", JsonNumber{report.borders_m[i + 1], 3})
            .add("iri", value(channel.pieces[i], words))
            .add("lead_in", bool{report.lead_in[i]});
        if (report.mri) {
            segment.add("mri", value(report.mri->pieces[i], words))
                .add("hri", value(report.hri->pieces[i], words));
        }
        segments.push_back(segment.text());
    }
    JsonObject object;
    object.add("name", channel.name)
        .add("iri", value(channel.whole, words))
        .add("segments", JsonRaw{json_array(segments)});
    return object.text();
}

std::string json_of(const IriReport& report, const IriWords& words) {
    std::vector<std::string> channels;
    for (const auto& channel : report.channels) {
        channels.push_back(json_of(channel, report, words));
    }
    const auto whole = [&](const std::optional<IriReport::Channel>& channel) {
        return channel ? JsonValue{value(channel->whole, words)} : JsonValue{nullptr};
    };
    JsonObject object;
    object.add("channels", JsonRaw{json_array(channels)})
        .add("mri", whole(report.mri))
        .add("hri", whole(report.hri));
    add_method(object, report.method, words);
    return object.text() + "\n";
}

std::string csv_of(const IriReport& report, const IriWords& words) {
    const double scale = scale_of(words);
    std::string csv = "from_m,to_m";
    for (const auto& channel : report.channels) {
        csv += fmt::format(",iri_{}", channel.name);
    }
    csv += report.mri ? ",mri,hri,lead_in\n" : ",lead_in\n";
    for (std::size_t i = 0; i + 1 < report.borders_m.size(); ++i) {
        csv += fmt::format("{:.3f},{:.3f}", report.borders_m[i], report.borders_m[i + 1]);
        for (const auto& channel : report.channels) {
            csv += fmt::format(",{:.4f}", scale * channel.pieces[i]);
        }
        if (report.mri) {
            csv += fmt::format(
                ",{:.4f},{:.4f}", scale * report.mri->pieces[i], scale * report.hri->pieces[i]);
        }
        csv += report.lead_in[i] ? ",yes\n" : ",no\n";
    }
    return csv;
}

/// Formats the members before the list, with its '['.
std::string json_begin(const MovingHead& head,
                       std::optional<double> threshold,
                       const IriWords& words,
                       const char* list) {
    JsonObject object;
    object.add("channels", JsonRaw{json_string_array(head.tracks)})
        .add("base_m", JsonNumber{head.base_m, 6});
    if (threshold) {
        object.add("threshold", JsonNumber{*threshold, 6});
    }
    add_method(object, head.method, words);
    auto text = object.text();
    text.pop_back();
    return text + fmt::format(",\"{}\":[", list);
}

/// Prints rows of CSV, or objects of a JSON list.
class Rows {
public:
    explicit Rows(const IriWords& words) : words_{words} {}

    void begin(const std::string& csv_header, const std::string& json_begin) const {
        print(words_.json ? json_begin : csv_header);
    }
    void row(const std::string& csv_or_json) {
        if (words_.json && any_) {
            print(",\n");
        }
        any_ = true;
        print(csv_or_json);
    }
    void end() const {
        if (words_.json) {
            print("]}\n");
        }
    }

private:
    IriWords words_;
    bool any_ = false;
};

std::string row_of(const MovingIri& moving, const IriWords& words) {
    if (words.json) {
        std::vector<std::string> iri;
        for (const double one : moving.iri) {
            iri.push_back(fmt::format("{:.6f}", scale_of(words) * one));
        }
        JsonObject object;
        object.add("at_m", JsonNumber{moving.at_m, 3})
            .add("iri", JsonRaw{json_array(iri)})
            .add("mri", moving.mri ? JsonValue{value(*moving.mri, words)} : JsonValue{nullptr})
            .add("lead_in", moving.lead_in);
        return object.text();
    }
    auto csv = fmt::format("{:.3f}", moving.at_m);
    for (const double one : moving.iri) {
        csv += fmt::format(",{:.4f}", scale_of(words) * one);
    }
    if (moving.mri) {
        csv += fmt::format(",{:.4f}", scale_of(words) * *moving.mri);
    }
    return csv + (moving.lead_in ? ",yes\n" : ",no\n");
}

void print_points(const IriQuestion& question, double base_m, const IriWords& words) {
    Rows rows{words};
    const auto begin = [&](const MovingHead& head) {
        std::string header = "at_m";
        for (const auto& track : head.tracks) {
            header += fmt::format(",iri_{}", track);
        }
        rows.begin(header + (head.has_mri ? ",mri,lead_in\n" : ",lead_in\n"),
                   json_begin(head, {}, words, "points"));
    };
    moving_iri(
        question, base_m, begin, [&](const MovingIri& moving) { rows.row(row_of(moving, words)); });
    rows.end();
}

std::string row_of(const std::string& channel, const RoughInterval& place, const IriWords& words) {
    const double scale = scale_of(words);
    if (words.json) {
        JsonObject object;
        object.add("channel", channel)
            .add("from_m", JsonNumber{place.from_m, 3})
            .add("to_m", JsonNumber{place.to_m, 3})
            .add("peak", JsonNumber{scale * place.peak, 6})
            .add("peak_at_m", JsonNumber{place.peak_at_m, 3});
        return object.text();
    }
    return fmt::format("{},{:.3f},{:.3f},{:.4f},{:.3f}\n",
                       channel,
                       place.from_m,
                       place.to_m,
                       scale * place.peak,
                       place.peak_at_m);
}

/// Search on each track and, last, on the mean of left and right.
struct Search {
    std::vector<std::string> names;
    std::vector<RoughIntervalFinder> places;
};

void print_places(const IriQuestion& question,
                  double base_m,
                  double threshold,
                  const IriWords& words) {
    Rows rows{words};
    Search search;
    const auto tell = [&](std::size_t channel, const std::optional<RoughInterval>& place) {
        if (place) {
            rows.row(row_of(search.names[channel], *place, words));
        }
    };
    const auto begin = [&](const MovingHead& head) {
        search.names = head.tracks;
        if (head.has_mri) {
            search.names.emplace_back("mri");
        }
        search.places.assign(search.names.size(), RoughIntervalFinder{threshold / scale_of(words)});
        rows.begin("channel,from_m,to_m,peak,peak_at_m\n",
                   json_begin(head, threshold, words, "places"));
    };
    moving_iri(question, base_m, begin, [&](const MovingIri& moving) {
        for (std::size_t i = 0; i < search.places.size(); ++i) {
            const double iri = i < moving.iri.size() ? moving.iri[i] : moving.mri.value_or(0);
            tell(i, search.places[i].push(moving.at_m, iri));
        }
    });
    for (std::size_t i = 0; i < search.places.size(); ++i) {
        tell(i, search.places[i].finish());
    }
    rows.end();
}

} // namespace

std::string text_of(const IriReport& report, const IriWords& words) {
    return words.json ? json_of(report, words) : csv_of(report, words);
}

void print_moving_iri(const IriQuestion& question,
                      double base_m,
                      std::optional<double> threshold,
                      const IriWords& words) {
    if (threshold) {
        print_places(question, base_m, *threshold, words);
    } else {
        print_points(question, base_m, words);
    }
}

} // namespace macadam
