#pragma once
// Only for libcamera_source.cpp, the only file that depends on libcamera.

#include "ar/capture/frame_source.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <libcamera/libcamera.h>

namespace ar {

namespace lc = libcamera;

/// Translates Controls to libcamera's, and collects those that cannot be set.
class ControlTranslation {
public:
    explicit ControlTranslation(lc::ControlInfoMap const& known) : known_(known), list(lc::controls::controls) {}

    template <typename T>
    bool has(lc::Control<T> const& control) const
    {
        return known_.find(&control) != known_.end();
    }

    template <typename T>
    void set(lc::Control<T> const& control, T value, char const* name, double unit = 1)
    {
        auto const found = known_.find(&control);
        if (found == known_.end()) return cannot(name, "this camera has no such control");
        if constexpr (!std::is_same_v<T, bool>) {
            lc::ControlInfo const& info = found->second;
            if (!info.min().isNone() && !info.max().isNone()) {
                T const low = info.min().template get<T>(), high = info.max().template get<T>();
                if (low < high && (value < low || value > high)) {
                    cannot(name, fmt::format("{:g} lies outside {:g} to {:g}; the nearest is taken",
                                             double(value) * unit, double(low) * unit, double(high) * unit));
                    value = std::clamp(value, low, high);
                }
            }
        }
        list.set(control, value);
    }
    template <typename T>
    void set_pair(lc::Control<lc::Span<T const, 2>> const& control, std::array<T, 2> const& pair, char const* name)
    {
        if (!has(control)) return cannot(name, "this camera has no such control");
        list.set(control, lc::Span<T const, 2>(pair));
    }
    void cannot(char const* name, std::string const& why)
    {
        problems.push_back(fmt::format("{} cannot be set: {}", name, why));
    }

private:
    lc::ControlInfoMap const& known_;

public:
    lc::ControlList list;
    std::vector<std::string> problems;
};

inline ControlTranslation translated(Controls const& c, lc::ControlInfoMap const& known)
{
    ControlTranslation t(known);
    bool const by_hand = c.exposure_time_s || c.gain;
    if (c.automatic_exposure)
        t.set(lc::controls::AeEnable, *c.automatic_exposure, "automatic exposure");
    else if (by_hand && t.has(lc::controls::AeEnable))
        t.set(lc::controls::AeEnable, false, "automatic exposure");
    if (c.exposure_time_s)
        t.set(lc::controls::ExposureTime, std::int32_t(std::min(1e6 * *c.exposure_time_s + 0.5, 2e9)),
              "the exposure time", 1e-6);
    if (c.gain) t.set(lc::controls::AnalogueGain, float(*c.gain), "the gain");
    if (c.automatic_white_balance)
        t.set(lc::controls::AwbEnable, *c.automatic_white_balance, "automatic white balance");
    else if (c.red_gain && t.has(lc::controls::AwbEnable))
        t.set(lc::controls::AwbEnable, false, "automatic white balance");
    if (c.red_gain && c.blue_gain)
        t.set_pair<float>(lc::controls::ColourGains, {float(*c.red_gain), float(*c.blue_gain)}, "white balance");
    if (c.frame_duration_s) {
        auto const us = std::int64_t(std::min(1e6 * *c.frame_duration_s + 0.5, 1e15));
        t.set_pair<std::int64_t>(lc::controls::FrameDurationLimits, {us, us}, "the frame duration");
    }
    return t;
}

inline std::vector<std::string> names_of_controls(lc::ControlInfoMap const& known)
{
    ControlTranslation const t(known);
    std::vector<std::string> names;
    if (t.has(lc::controls::ExposureTime)) names.push_back("exposure_time");
    if (t.has(lc::controls::AnalogueGain)) names.push_back("gain");
    if (t.has(lc::controls::ColourGains)) names.push_back("white_balance");
    if (t.has(lc::controls::AeEnable) || t.has(lc::controls::AwbEnable)) names.push_back("automatic");
    if (t.has(lc::controls::FrameDurationLimits)) names.push_back("frame_duration");
    return names;
}

} // namespace ar
