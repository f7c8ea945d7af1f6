#include "viewer/experiment/stimuli/physical.h"

#include "gi/core/error.h"
#include "gi/core/text.h"
#include "study/display/geometry.h"

#include <cmath>
#include <fmt/format.h>

namespace viewer {
namespace {

char const* name_of_unit(StimulusUnit unit)
{
    constexpr char const* kNames[]{"deg", "cm", "px"};
    return kNames[int(unit)];
}

/// Numbers, then perhaps a unit: "4 x 3 deg".
struct Measure {
    std::vector<double> numbers;
    std::string unit;
};
std::optional<Measure> measure_of(std::string const& text)
{
    Measure m;
    std::string_view rest = text;
    while (true) {
        std::string_view const word = gi::take_word(rest);
        if (word.empty()) return m.numbers.empty() ? std::nullopt : std::optional(m);
        if (auto const v = gi::parse_finite(word, 1e6); v && m.unit.empty())
            m.numbers.push_back(*v);
        else if (word == "x" && m.numbers.size() == 1 && m.unit.empty())
            continue;
        else if (m.unit.empty())
            m.unit = word;
        else
            return {};
    }
}

StimulusLength length_of(std::string const& key, std::string const& text, bool is_size)
{
    auto const m = measure_of(text);
    std::string const unit = m && !m->unit.empty() ? m->unit : "deg";
    bool const is_known = unit == "deg" || unit == "cm" || unit == "px";
    std::size_t const wanted = is_size ? 1 : 2;
    if (!m || !is_known || m->numbers.size() < wanted || m->numbers.size() > 2)
        throw gi::InputError(key + ": " + text, "this is no length in deg, cm or px",
                             is_size ? "write size: 4 deg, or size: 4 x 3 deg"
                                     : "write place: -5 2.5 deg (right, up)");
    StimulusLength l{m->numbers[0], m->numbers.back(),
                     unit == "deg"  ? StimulusUnit::deg
                     : unit == "cm" ? StimulusUnit::cm
                                    : StimulusUnit::px};
    double const most = l.unit == StimulusUnit::deg ? (is_size ? 170 : 80) : 1e5;
    double const least = is_size ? 1e-3 : -most;
    if (!(l.x >= least && l.x <= most && l.y >= least && l.y <= most))
        throw gi::InputError(key + ": " + text, fmt::format("lengths are {:g} to {:g} {}", least, most, unit),
                             "correct it");
    return l;
}

glm::dvec2 in_px(StimulusLength const& l, study::DisplayModel const* model, bool is_size)
{
    if (l.unit == StimulusUnit::px) return {l.x, l.y};
    study::ScreenGeometry const& s = *model->screen;
    auto const [across, down] = study::pixels_per_cm(s);
    if (l.unit == StimulusUnit::cm) return {l.x * across, l.y * down};
    return is_size ? glm::dvec2(study::px_of_size(s, l.x, false), study::px_of_size(s, l.y, true))
                   : glm::dvec2(study::px_of_place(s, l.x, false), study::px_of_place(s, l.y, true));
}

/// White with which the mean is reached although bright pixels are clipped: lamps in the picture would darken the
/// rest otherwise. @param white  without clipping
double white_for_mean(gi::Layer const& first, gi::ToneMapSettings const& tone,
                      study::DisplayLuminance const& display, std::shared_ptr<InverseTable const> const& table,
                      double mean_cd_m2, double white)
{
    auto const mean_with = [&](double w) {
        return shown_light(first, tone, display_light(display, table, w), display).mean_cd_m2;
    };
    constexpr double kMost = 1e6;
    constexpr int kSteps = 24; // halvings, of the logarithm
    double high = white;
    while (mean_with(high) < mean_cd_m2 && high < kMost * white) high *= 4;
    if (mean_with(high) < mean_cd_m2)
        throw gi::InputError(fmt::format("a mean luminance of {:g} cd/m2", mean_cd_m2),
                             "too much of the picture is black", "choose a lower one");
    double low = 0.25 * high;
    for (int i = 0; i < kSteps; ++i) {
        double const middle = std::sqrt(low * high);
        (mean_with(middle) < mean_cd_m2 ? low : high) = middle;
    }
    return std::sqrt(low * high);
}

bool is_physical_unit(std::optional<StimulusLength> const& l) { return l && l->unit != StimulusUnit::px; }

} // namespace

bool PhysicalStimulus::needs_screen() const { return is_physical_unit(size) || is_physical_unit(place); }

bool is_physical_setting(std::string const& key)
{
    return key == "size" || key == "place" || key == "luminance" || key == "mean_luminance" ||
           key == "peak_luminance";
}

void set_physical(PhysicalStimulus& s, std::string const& key, std::string const& text)
{
    if (key == "size" || key == "place") {
        (key == "size" ? s.size : s.place) = length_of(key, text, key == "size");
        return;
    }
    auto const m = measure_of(text);
    if (!m || m->numbers.size() != 1 || !(m->unit.empty() || m->unit == "cd/m2"))
        throw gi::InputError(key + ": " + text, "this is no luminance", "write " + key + ": 80 cd/m2");
    if (!(m->numbers[0] > 0))
        throw gi::InputError(key + ": " + text, "luminances are above 0", "write a positive number");
    s.luminance = {key == "luminance"        ? LuminanceOf::white
                   : key == "mean_luminance" ? LuminanceOf::mean
                                             : LuminanceOf::peak,
                   m->numbers[0]};
}

std::string text_of(PhysicalStimulus const& s)
{
    std::string text;
    for (auto const& [name, l] : {std::pair{"size", s.size}, {"place", s.place}})
        if (l) text += fmt::format("{} {} {} {};", name, l->x, l->y, name_of_unit(l->unit));
    if (s.luminance) text += fmt::format("luminance {} {};", int(s.luminance->of), s.luminance->cd_m2);
    return text;
}

void check_physical(PhysicalStimulus const& s, study::DisplayModel const* model)
{
    std::string const give = "name a display model with --display-model (study calibrate writes one)";
    if (s.needs_screen() && (model == nullptr || !model->screen))
        throw gi::InputError("a stimulus with a size or place in deg or cm",
                             model == nullptr ? "there is no display model" : "the display model has no screen",
                             model == nullptr ? give : "measure it: study calibrate --card --distance-cm 57");
    bool const has_deg =
        (s.size && s.size->unit == StimulusUnit::deg) || (s.place && s.place->unit == StimulusUnit::deg);
    if (has_deg && !(model->screen->distance_cm > 0))
        throw gi::InputError("a stimulus with degrees", "the display model has no distance",
                             "measure it: study calibrate --from FILE --distance-cm 57");
    if (s.luminance) {
        if (model == nullptr)
            throw gi::InputError("a stimulus with a luminance", "there is no display model", give);
        if (!model->luminance || !model->luminance->is_absolute)
            throw gi::InputError("a stimulus with a luminance", "the display model has none in cd/m2",
                                 "measure it: study calibrate --luminance readings.csv");
        double const low = model->luminance->black, high = model->luminance->white();
        bool const is_mean_or_peak = s.luminance->of != LuminanceOf::white;
        if (is_mean_or_peak && !(s.luminance->cd_m2 > low && s.luminance->cd_m2 <= high))
            throw gi::InputError(fmt::format("a luminance of {:g} cd/m2", s.luminance->cd_m2),
                                 fmt::format("the display shows {:.3g} to {:.4g} cd/m2", low, high),
                                 "choose one within");
    }
    if (s.size && model != nullptr && model->screen) {
        glm::dvec2 const px = in_px(*s.size, model, true);
        if (px.x > model->screen->width_px || px.y > model->screen->height_px)
            throw gi::InputError(
                fmt::format("a stimulus of {:g} x {:g} {}", s.size->x, s.size->y, name_of_unit(s.size->unit)),
                fmt::format("it would have {:.0f} x {:.0f} px, the screen has {} x {}", px.x, px.y,
                            model->screen->width_px, model->screen->height_px),
                "make it smaller, or sit closer");
    }
}

DisplayLight light_of(PhysicalStimulus const& s, study::DisplayLuminance const& display,
                      std::shared_ptr<InverseTable const> table, gi::Layer const* first,
                      gi::ToneMapSettings const& tone)
{
    std::optional<double> white;
    if (s.luminance && display.is_absolute) {
        white = s.luminance->cd_m2;
        if (s.luminance->of != LuminanceOf::white && first != nullptr) {
            auto const [mean, peak] = mean_and_peak(*first, tone, display);
            double const of = s.luminance->of == LuminanceOf::mean ? mean : peak;
            if (!(of > 0))
                throw gi::InputError(fmt::format("a luminance of {:g} cd/m2", s.luminance->cd_m2),
                                     "the picture is black", "light the scene");
            white = s.luminance->cd_m2 / of;
            if (s.luminance->of == LuminanceOf::mean)
                white = white_for_mean(*first, tone, display, table, s.luminance->cd_m2, *white);
        }
    }
    return display_light(display, std::move(table), white);
}

PlacedPixels placed_within(PhysicalStimulus const& s, study::DisplayModel const* model, glm::ivec2 corner_px,
                           glm::ivec2 size_px)
{
    if (!s.size && !s.place) return {corner_px, size_px};
    check_physical(s, model);
    glm::ivec2 size = size_px;
    if (s.size) size = glm::max(glm::ivec2(1), glm::ivec2(glm::round(in_px(*s.size, model, true))));
    glm::ivec2 corner = corner_px + (size_px - size) / 2;
    if (s.place) {
        glm::dvec2 const from_middle = in_px(*s.place, model, false);
        corner += glm::ivec2(glm::round(glm::dvec2(from_middle.x, -from_middle.y)));
    }
    if (corner.x < 0 || size.x > size_px.x || size.y > size_px.y || corner.y < 0)
        throw gi::InputError(
            fmt::format("a stimulus of {} x {} px at ({}, {})", size.x, size.y, corner.x, corner.y),
            fmt::format("its place in the window has {} x {} px at ({}, {})", size_px.x, size_px.y, corner_px.x,
                        corner_px.y),
            "make it smaller, move it, or use a larger window");
    return {corner, size};
}

} // namespace viewer
