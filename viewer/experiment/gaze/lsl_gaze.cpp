#include "viewer/experiment/gaze/lsl_gaze.h"

#include "gi/core/error.h"
#include "viewer/experiment/lsl_library.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fmt/format.h>

namespace viewer {
namespace {

constexpr double kPatience_s = 5, kClockAge_s = 5;

bool has(std::string const& label, char const* word) { return label.find(word) != std::string::npos; }

class LslGaze : public GazeSource {
public:
    LslGaze(std::shared_ptr<LslLibrary const> lsl, std::string const& name) : lsl_(std::move(lsl))
    {
        LslLibrary::Info found[1]{};
        bool const by_name = !name.empty();
        if (lsl_->resolve_byprop(found, 1, by_name ? "name" : "type", by_name ? name.c_str() : "Gaze", 1,
                                 kPatience_s) < 1)
            throw gi::InputError(by_name ? "no stream of gaze named '" + name + "'" : "no stream of type Gaze",
                                 fmt::format("none was announced within {:g} s", kPatience_s),
                                 "start the eye tracker's LSL program, or name another one: --gaze lsl:NAME");
        inlet_ = lsl_->create_inlet(found[0], kBuffered_s, 0, 1);
        lsl_->destroy_streaminfo(found[0]);
        std::int32_t error = 0;
        LslLibrary::Info const info = lsl_->get_fullinfo(inlet_, kPatience_s, &error);
        if (info == nullptr || error != 0) fail("it does not describe itself");
        name_ = lsl_->get_name(info);
        rate_hz_ = lsl_->get_nominal_srate(info);
        count_ = lsl_->get_channel_count(info);
        std::vector<std::string> labels, units;
        LslLibrary::Xml at = lsl_->child(lsl_->child(lsl_->get_desc(info), "channels"), "channel");
        for (; !lsl_->empty(at); at = lsl_->next_sibling_n(at, "channel")) {
            labels.emplace_back(lsl_->child_value_n(at, "label"));
            units.emplace_back(lsl_->child_value_n(at, "unit"));
        }
        lsl_->destroy_streaminfo(info);
        auto const channels = gaze_channels(labels, units);
        if (!channels || int(labels.size()) != count_) {
            std::string list;
            for (std::string const& l : labels) list += (list.empty() ? "" : ", ") + l;
            fail(fmt::format("its {} channels are named: {}", count_, list.empty() ? "nothing" : list));
        }
        channels_ = *channels;
        lsl_->open_stream(inlet_, kPatience_s, &error);
        if (error != 0) fail("it cannot be opened");
        offset_s_ = -lsl_->clock_offset_s();
        correct_clock(kPatience_s);
    }
    ~LslGaze() override
    {
        if (inlet_ != nullptr) lsl_->destroy_inlet(inlet_);
    }
    LslGaze(LslGaze const&) = delete;
    LslGaze& operator=(LslGaze const&) = delete;

    std::vector<study::GazeSample> take(GazePlace const& place, double now_s) override
    {
        if (now_s > corrected_s_ + kClockAge_s) {
            correct_clock(0);
            corrected_s_ = now_s;
        }
        std::vector<study::GazeSample> samples;
        std::vector<double> values(static_cast<std::size_t>(count_));
        std::int32_t error = 0;
        while (true) {
            double const time_s = lsl_->pull_sample_d(inlet_, values.data(), count_, 0, &error);
            if (time_s == 0 || error != 0) return samples;
            double const here_s = time_s + correction_s_ + offset_s_;
            if (here_s <= last_s_) continue; // a clock that was corrected must not run backwards
            last_s_ = here_s;
            samples.push_back(gaze_sample(channels_, values, here_s, place));
        }
    }

    std::vector<std::pair<std::string, std::string>> about() const override
    {
        return {{"gaze_source", "lsl: " + name_},
                {"gaze_rate_hz", rate_hz_ > 0 ? fmt::format("{:g}", rate_hz_) : "irregular"},
                {"gaze_clock_correction_s", fmt::format("{:.6f}", correction_s_)}};
    }

private:
    static constexpr int kBuffered_s = 30;

    [[noreturn]] void fail(std::string const& why)
    {
        if (inlet_ != nullptr) lsl_->destroy_inlet(std::exchange(inlet_, nullptr));
        throw gi::InputError("the stream of gaze cannot be used", why,
                             "its channels need labels such as gaze_x and gaze_y, and units (px or normalized)");
    }
    /// The other machine's clock. @param patience_s  0 = the last known one
    void correct_clock(double patience_s)
    {
        std::int32_t error = 0;
        double const c = lsl_->time_correction(inlet_, patience_s, &error);
        if (error == 0) correction_s_ = c;
    }

    std::shared_ptr<LslLibrary const> lsl_;
    void* inlet_ = nullptr;
    std::string name_;
    int count_ = 0;
    double rate_hz_ = 0, offset_s_ = 0, correction_s_ = 0, corrected_s_ = 0, last_s_ = -1e300;
    GazeChannels channels_;
};

} // namespace

std::optional<GazeChannels> gaze_channels(std::vector<std::string> labels, std::vector<std::string> const& units)
{
    GazeChannels c;
    bool x_is_px = false;
    for (int i = 0; i < int(labels.size()); ++i) {
        std::string& l = labels[std::size_t(i)];
        std::transform(l.begin(), l.end(), l.begin(), [](unsigned char ch) { return char(std::tolower(ch)); });
        std::string unit = i < int(units.size()) ? units[std::size_t(i)] : "";
        std::transform(unit.begin(), unit.end(), unit.begin(),
                       [](unsigned char ch) { return char(std::tolower(ch)); });
        bool const is_3d = has(l, "origin") || has(l, "user_coordinate") || l.ends_with("_z");
        if (has(l, "pupil") && (has(l, "diam") || has(l, "size") || l == "pupil")) {
            if (c.pupil < 0) c.pupil = i;
        } else if (has(l, "valid") || has(l, "confidence")) {
            if (c.valid < 0) c.valid = i;
        } else if (!is_3d && (l == "x" || l.ends_with("_x") || l.ends_with(" x") || l.ends_with("area_0") ||
                              l == "gaze.x" || l == "gazex")) {
            (c.x < 0 ? c.x : c.other_x) = i;
            x_is_px = unit == "px" || unit == "pixel" || unit == "pixels";
        } else if (!is_3d && (l == "y" || l.ends_with("_y") || l.ends_with(" y") || l.ends_with("area_1") ||
                              l == "gaze.y" || l == "gazey")) {
            (c.y < 0 ? c.y : c.other_y) = i;
        }
    }
    if (c.x < 0 || c.y < 0) return {};
    if (c.other_x < 0 || c.other_y < 0) c.other_x = c.other_y = -1;
    c.is_normalised = !x_is_px;
    return c;
}

study::GazeSample gaze_sample(GazeChannels const& c, std::vector<double> const& values, double time_s,
                              GazePlace const& place)
{
    auto const value = [&](int channel) { return channel < 0 ? NAN : values[std::size_t(channel)]; };
    double x = value(c.x), y = value(c.y);
    double const other_x = value(c.other_x), other_y = value(c.other_y);
    bool const one = std::isfinite(x) && std::isfinite(y),
               other = std::isfinite(other_x) && std::isfinite(other_y);
    if (other) {
        x = one ? 0.5 * (x + other_x) : other_x;
        y = one ? 0.5 * (y + other_y) : other_y;
    }
    study::GazeSample s;
    s.time_s = time_s;
    s.is_valid = (one || other) && (c.valid < 0 || value(c.valid) > 0);
    s.pupil_mm = value(c.pupil);
    if (!s.is_valid) return s;
    bool const has_monitor = place.monitor_px.x > 0;
    glm::dvec2 const whole(has_monitor ? place.monitor_px : place.window_px);
    glm::dvec2 const corner(has_monitor ? place.window_corner_px - place.monitor_corner_px : glm::ivec2(0));
    glm::dvec2 const px = c.is_normalised ? glm::dvec2(x, y) * whole : glm::dvec2(x, y);
    s.x_px = px.x - corner.x - 0.5 * place.window_px.x;
    s.y_px = px.y - corner.y - 0.5 * place.window_px.y;
    return s;
}

std::unique_ptr<GazeSource> open_lsl_gaze(std::string const& name)
{
    auto lsl = LslLibrary::open();
    if (!lsl)
        throw gi::InputError("gaze from a Lab Streaming Layer stream", "liblsl is not installed",
                             "install it (pip install pylsl brings it), and name its file by PYLSL_LIB");
    return std::make_unique<LslGaze>(std::move(lsl), name);
}

} // namespace viewer
