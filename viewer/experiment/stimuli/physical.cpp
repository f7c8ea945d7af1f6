#include "viewer/experiment/stimuli/physical.h"

#include "gi/core/error.h"
#include "study/display/geometry.h"

#include <cmath>
#include <fmt/format.h>

namespace viewer {
namespace {

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

} // namespace

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
                fmt::format("a stimulus of {:g} x {:g} {}", s.size->x, s.size->y, name_of(s.size->unit)),
                fmt::format("it would have {:.0f} x {:.0f} px, the screen has {} x {}", px.x, px.y,
                            model->screen->width_px, model->screen->height_px),
                "make it smaller, or sit closer");
    }
    if (s.place && model != nullptr && model->screen) {
        glm::dvec2 const screen(model->screen->width_px, model->screen->height_px);
        glm::dvec2 const size = s.size ? in_px(*s.size, model, true) : glm::dvec2(0);
        glm::dvec2 const beyond = glm::abs(in_px(*s.place, model, false)) + 0.5 * (size - screen);
        double const most = std::max(beyond.x, beyond.y);
        if (most > 0.5)
            throw gi::InputError(
                fmt::format("a stimulus at {:g} {:g} {}", s.place->x, s.place->y, name_of(s.place->unit)),
                fmt::format("it would end {:.0f} px beyond the edge of the screen's {} x {} px", most,
                            model->screen->width_px, model->screen->height_px),
                "make it smaller, or move it to the centre");
    }
}

void check_physical(std::string const& key, std::string const& text, ShownOn const& shown_on)
{
    PhysicalStimulus s;
    set_physical(s, key, text);
    if (shown_on.has_own_views)
        throw gi::InputError(key + " of a stimulus on walls or in a headset",
                             "sizes, places and luminances are those of a picture in a window",
                             "leave it out, or run in a window");
    check_physical(s, shown_on.model);
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
    glm::ivec2 const end = corner + size, last = corner_px + size_px;
    if (corner.x < corner_px.x || corner.y < corner_px.y || end.x > last.x || end.y > last.y)
        throw gi::InputError(
            fmt::format("a stimulus of {} x {} px at ({}, {})", size.x, size.y, corner.x, corner.y),
            fmt::format("its place in the window has {} x {} px at ({}, {})", size_px.x, size_px.y, corner_px.x,
                        corner_px.y),
            "make it smaller, move it, or use a larger window");
    return {corner, size};
}

} // namespace viewer
