#include "viewer/engine/settings.h"

#include "gi/core/error.h"
#include "gi/filter/filter_names.h"
#include "gi/methods/registry.h"
#include "gi/methods/slhb/settings.h"
#include "viewer/displays/stereo_mode.h"

#include <cstdlib>
#include <fmt/format.h>
#include <functional>

namespace viewer {
namespace {

using Json = nlohmann::json;

/// The value of `c` as a number; throws InputError unless it is within [low, high].
double number(Change const& c, double low, double high)
{
    double const v = c.value.is_number() ? c.value.get<double>() : std::nan("");
    if (!(v >= low && v <= high))
        throw gi::InputError(fmt::format("'{}' = {}", c.key, c.value.dump()),
                             fmt::format("it takes a number from {:g} to {:g}", low, high), "set one of these");
    return v;
}

int whole(Change const& c, int low, int high)
{
    double const v = number(c, low, high);
    if (v != std::floor(v))
        throw gi::InputError(fmt::format("'{}' = {}", c.key, c.value.dump()), "it takes a whole number",
                             fmt::format("set one from {} to {}", low, high));
    return int(v);
}

bool yes(Change const& c)
{
    if (!c.value.is_boolean())
        throw gi::InputError(fmt::format("'{}' = {}", c.key, c.value.dump()), "it takes true or false",
                             "set one of these");
    return c.value.get<bool>();
}

std::string one_of(Change const& c, std::vector<std::string> const& words)
{
    std::string all;
    for (std::string const& w : words) {
        if (c.value.is_string() && c.value.get<std::string>() == w) return w;
        all += (all.empty() ? "" : ", ") + (w.empty() ? "\"\"" : w);
    }
    throw gi::InputError(fmt::format("'{}' = {}", c.key, c.value.dump()), "it is none of the known words",
                         "set one of: " + all);
}

std::string points(Change const& c)
{
    std::string const text = c.value.is_string() ? c.value.get<std::string>() : c.value.dump();
    parse_points(fmt::format("'{}' = {}", c.key, c.value.dump()), text, gi::VirtualLightSettings{}.point_map);
    return text;
}

std::vector<std::string> method_names(bool or_none)
{
    std::vector<std::string> names;
    if (or_none) names.emplace_back();
    for (gi::Method const& m : gi::methods()) names.emplace_back(m.name);
    return names;
}

std::vector<std::string> stereo_names()
{
    std::vector<std::string> names;
    for (StereoMode const mode : kStereoModes) names.emplace_back(name_of(mode));
    return names;
}

struct Entry {
    SettingKey about;
    std::function<void(Settings&, Change const&)> set;
    std::function<Json(Settings const&)> get;
};

template <class Member, class Read>
Entry entry(SettingKey about, Member Settings::*member, Read read)
{
    return {std::move(about), [member, read](Settings& s, Change const& c) { s.*member = read(c); },
            [member](Settings const& s) { return Json(s.*member); }};
}

Entry real(std::string key, std::string what, double Settings::*member, double low, double high)
{
    return entry({std::move(key), SettingType::number, std::move(what), {}, low, high}, member,
                 [=](Change const& c) { return number(c, low, high); });
}

Entry count(std::string key, std::string what, int Settings::*member, int low, int high)
{
    return entry({std::move(key), SettingType::whole_number, std::move(what), {}, double(low), double(high)},
                 member, [=](Change const& c) { return whole(c, low, high); });
}

Entry flag(std::string key, std::string what, bool Settings::*member)
{
    return entry({std::move(key), SettingType::yes_or_no, std::move(what), {}, 0, 1}, member, yes);
}

Entry word(std::string key, std::string what, std::string Settings::*member, std::vector<std::string> words)
{
    return entry({std::move(key), SettingType::word, std::move(what), words, 0, 0}, member,
                 [words](Change const& c) { return one_of(c, words); });
}

std::vector<Entry> const& entries()
{
    static std::vector<Entry> const all{
        word("method", "light transport", &Settings::method, method_names(false)),
        word("compare", "second method, shown beside the first for comparison; empty = none", &Settings::compare,
             method_names(true)),
        word("schedule", "slhb: source of the axes: stored once, streamed per pass, or temporal",
             &Settings::schedule, {"auto", "stored", "streamed", "temporal"}),
        word("directions", "slhb (stored), vpl_slhb: set of directions; empty = chosen by the plan",
             &Settings::directions, {"", "icosahedron:80", "icosahedron:320", "icosahedron:1280"}),
        count("resolution", "slhb, vpl_slhb: texels along a side of a hit buffer, 0 = chosen by the plan",
              &Settings::resolution, 0, 4096),
        count("axes", "slhb, streamed and temporal schedules: axes per pass, 0 = chosen by the plan",
              &Settings::axes, 0, 4096),
        count("updated_axes",
              "slhb: stored axes per bounce updated each frame for dynamic geometry, 0 = all; set by the "
              "schedule auto",
              &Settings::updated_axes, 0, 64),
        count("light_samples", "slhb: light points (light samples with a shadow map), 0 = chosen by the plan",
              &Settings::light_samples, 0, 1024),
        word("device", "slhb: device it runs on; on cuda, paths end at mirrors, glass and narrow lobes (counted)",
             &Settings::device, {"cpu", "cuda"}),
        count("light_paths",
              "methods vpl_*: paths traced from the lights per pass; each surface hit becomes a virtual light",
              &Settings::light_paths, 1, 65536),
        entry({"points",
               SettingType::word,
               "vpl_imperfect: points per imperfect shadow map, or a share of its texels (30%)",
               {"5%", "30%", "100%", "256", "1024", "4096", "16384"},
               0,
               0},
              &Settings::points, points),
        real("ao_radius", "vpl_ao, vpl_dao: radius in which occluders count, m", &Settings::ao_radius_m, 0, 1e6),
        count("bounces", "indirect bounces", &Settings::bounces, 0, 1024),
        count("seed", "seed of the random numbers", &Settings::seed, 0, 1 << 30),
        count("reuse", "frames that temporal reuse averages over, 1 = none", &Settings::reuse, 1, 256),
        word("denoise", "filter that removes noise", &Settings::denoise, gi::filter_names()),
        flag("share_eyes", "each eye may reuse light computed for the other eye", &Settings::share_eyes),
        flag("radiance_cache", "paths may end in the radiance cache while anything moves",
             &Settings::radiance_cache),
        real("exposure", "exposure, stops", &Settings::exposure_ev, -32, 32),
        word("tone", "tone curve", &Settings::tone, {"srgb", "filmic"}),
        real("rate", "target frame rate, Hz", &Settings::rate_hz, 0.1, 1000),
        count("paths", "paths per pixel and frame, 0 = as the frame rate allows", &Settings::paths, 0, 65536),
        real("scale", "side of the picture relative to the window's, 0 = as large as the frame rate allows",
             &Settings::scale, 0, 1),
        flag("play", "animation clips run", &Settings::play),
        real("speed", "playback speed of animation clips, 1 = real time", &Settings::speed, -100, 100),
        real("eye_distance", "distance between the pupils, m", &Settings::eye_distance_m, 0, 1),
        word("stereo", "how the two eyes' pictures are shown in a window", &Settings::stereo, stereo_names()),
        flag("swap_eyes", "exchange the left and right eye", &Settings::swap_eyes),
        word("view", "how two methods are shown", &Settings::view, {"picture", "split", "flicker", "difference"}),
        real("split", "position of the split, as a share of the picture's width", &Settings::split, 0, 1),
        flag("reproject", "reproject the last picture to the current head pose", &Settings::reproject),
        flag("refine", "keep adding paths while nothing moves", &Settings::refine),
        flag("panel", "show the panel", &Settings::panel),
    };
    return all;
}

Entry const* find(std::string const& key)
{
    std::string const now = current_key(key);
    for (Entry const& e : entries())
        if (e.about.key == now) return &e;
    return nullptr;
}

} // namespace

std::string current_key(std::string const& key)
{
    constexpr std::pair<char const*, char const*> kRenamed[]{
        {"lamps", "light_samples"}, {"followed", "updated_axes"}, {"share_endings", "radiance_cache"}};
    for (auto const& [before, now] : kRenamed)
        if (key == before) return now;
    return key;
}

char const* name_of(SettingType type)
{
    constexpr char const* kNames[] = {"word", "number", "whole number", "yes or no"};
    return kNames[int(type)];
}

std::span<SettingKey const> setting_keys()
{
    static std::vector<SettingKey> const keys = [] {
        std::vector<SettingKey> all;
        for (Entry const& e : entries()) all.push_back(e.about);
        return all;
    }();
    return keys;
}

bool is_setting(std::string const& key) { return find(key) != nullptr; }

void set(Settings& settings, Change const& change)
{
    Entry const* const e = find(change.key);
    if (e == nullptr)
        throw gi::InputError("there is no setting '" + change.key + "'", "its key is unknown",
                             "docs/viewer.md has the list");
    e->set(settings, change);
}

Change parse_change(std::string const& text)
{
    std::size_t const at = text.find('=');
    if (at == std::string::npos)
        throw gi::InputError("--set " + text, "a setting needs a key and a value", "write --set exposure=1.5");
    std::string const value = text.substr(at + 1);
    Json const parsed = Json::parse(value, nullptr, false);
    return {text.substr(0, at), parsed.is_discarded() ? Json(value) : parsed};
}

nlohmann::json get(Settings const& settings, std::string const& key)
{
    Entry const* const e = find(key);
    if (e == nullptr)
        throw gi::InputError("there is no setting '" + key + "'", "its key is unknown",
                             "docs/viewer.md has the list");
    return e->get(settings);
}

int parse_points(std::string const& name, std::string const& text, int point_map)
{
    char* end = nullptr;
    double const v = std::strtod(text.c_str(), &end);
    bool const is_share = std::string_view(end) == "%", is_number = *end == 0;
    double const points = std::round(is_share ? v / 100 * point_map * point_map : v);
    if (end == text.c_str() || !(is_share || is_number) || !(points >= 1 && points <= gi::kMostPoints))
        throw gi::InputError(name,
                             fmt::format("it takes 1 to {} points, or a share of the {} texels of a map",
                                         gi::kMostPoints, point_map * point_map),
                             "write 1024, or 30%");
    return int(points);
}

gi::RenderSettings render_settings(Settings const& s, int threads)
{
    gi::RenderSettings r;
    r.bounces = s.bounces;
    r.seed = std::uint64_t(s.seed);
    r.threads = threads;
    r.paths = 1;
    r.slhb.schedule = gi::parse_schedule(s.schedule);
    r.slhb.space = s.device == "cuda" ? gi::Space::device : gi::Space::host;
    r.slhb.directions = s.directions;
    r.slhb.resolution = s.resolution;
    r.slhb.axes = s.axes;
    r.slhb.light_samples = s.light_samples;
    r.vpl.light_paths = s.light_paths;
    r.vpl.points = parse_points("'points'", s.points, r.vpl.point_map);
    r.vpl.ao_radius_m = float(s.ao_radius_m);
    return r;
}

gi::DenoiseSettings denoise_settings(Settings const& s, int threads)
{
    gi::DenoiseSettings d = gi::find_filter(s.denoise);
    d.threads = threads;
    return d;
}

gi::ToneMapSettings tone_settings(Settings const& s)
{
    return {float(s.exposure_ev), s.tone == "filmic" ? gi::ToneCurve::filmic : gi::ToneCurve::srgb};
}

} // namespace viewer
