#include "study/signals/gaze.h"

#include "gi/core/quantile.h"
#include "gi/core/text.h"

#include <algorithm>
#include <fmt/format.h>

namespace study {

void GazeWatch::take(GazeSample const& s)
{
    last_s_ = s.time_s;
    ++samples_;
    bool const is_inside = s.is_valid && deg_between(screen_, {s.x_px, s.y_px}, place_px_) <= within_deg_;
    valid_ += s.is_valid;
    inside_ += is_inside;
    if (is_inside) {
        if (!since_inside_s_) since_inside_s_ = s.time_s;
        since_away_s_.reset();
    } else {
        since_inside_s_.reset();
        if (!since_away_s_) since_away_s_ = s.time_s;
    }
}

GazeSummary summarise(std::vector<GazeSample> const& samples)
{
    GazeSummary sum;
    sum.samples = int(samples.size());
    std::vector<double> steps;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        sum.valid += samples[i].is_valid;
        if (i > 0) steps.push_back(samples[i].time_s - samples[i - 1].time_s);
    }
    if (steps.empty()) return sum;
    double const step = gi::median(steps);
    if (!(step > 0)) return sum;
    sum.rate_hz = 1 / step;
    for (double const s : steps) sum.dropped += s > 1.5 * step ? int(std::lround(s / step)) - 1 : 0;
    return sum;
}

std::vector<GazeSample> read_gaze_csv(std::string const& text, std::string const& file)
{
    std::vector<GazeSample> samples;
    int at[5]{-1, -1, -1, -1, -1};
    constexpr char const* kNames[]{"t_s", "x_px", "y_px", "pupil_mm", "valid"};
    bool has_header = false;
    std::string_view rest = text;
    for (int number = 1; !rest.empty(); ++number) {
        gi::TextLine const line{gi::take_until(rest, '\n'), file, number};
        if (gi::trimmed(line.text).empty() || line.text.front() == '#') continue;
        auto const cells = gi::split_at_commas(line.text);
        if (!has_header) {
            for (int i = 0; i < int(cells.size()); ++i)
                for (int k = 0; k < 5; ++k)
                    if (cells[std::size_t(i)] == kNames[k]) at[k] = i;
            if (at[0] < 0 || at[1] < 0 || at[2] < 0)
                throw line.error(line.text, "no columns t_s, x_px and y_px", "they hold times and places of gaze",
                                 "begin the file with the line: t_s,x_px,y_px,valid");
            has_header = true;
            continue;
        }
        auto const cell = [&](int k) -> std::optional<double> {
            if (at[k] < 0 || at[k] >= int(cells.size())) return {};
            std::string_view const c = cells[std::size_t(at[k])];
            if (c.empty() || c == "nan" || c == "NaN" || c == "n/a") return {};
            auto const v = gi::parse_finite(c);
            if (!v)
                throw line.error(c, fmt::format("'{}' is no number", c),
                                 "it stands in the column " + std::string(kNames[k]),
                                 "write a number, or nothing where there was none");
            return v;
        };
        GazeSample s;
        auto const time = cell(0), x = cell(1), y = cell(2), pupil = cell(3), valid = cell(4);
        if (!time)
            throw line.error(line.text, "a sample without a time", "its place in the session is unknown",
                             "remove it");
        if (!samples.empty() && *time <= samples.back().time_s)
            throw line.error(line.text, fmt::format("the time {:g} s is not after the last one", *time),
                             "samples are in the order of their times", "sort them");
        s.time_s = *time;
        s.is_valid = x && y && valid.value_or(1) != 0;
        s.x_px = x.value_or(0);
        s.y_px = y.value_or(0);
        if (pupil) s.pupil_mm = *pupil;
        samples.push_back(s);
    }
    if (samples.empty())
        throw gi::InputError(gi::TextLocation{file, 0, 0}, "no samples of gaze", "there is nothing to replay",
                             "write lines like 0.01,640,360,1 below t_s,x_px,y_px,valid");
    return samples;
}

} // namespace study
