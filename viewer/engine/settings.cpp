#include "viewer/engine/settings.h"

#include "gi/core/edit_distance.h"
#include "gi/core/error.h"
#include "gi/core/text.h"
#include "gi/filter/filter_names.h"
#include "gi/methods/registry.h"
#include "viewer/displays/stereo_mode.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>

namespace viewer {
namespace {

using Json = nlohmann::json;

std::vector<std::string> method_names_or_none()
{
    std::vector<std::string> names = gi::method_names();
    names.insert(names.begin(), "");
    return names;
}

std::vector<std::string> stereo_names()
{
    std::vector<std::string> names;
    for (StereoMode const mode : kStereoModes) names.emplace_back(name_of(mode));
    return names;
}

template <class T>
SettingKey own(char const* names, gi::OptionValues values, char const* meaning, T Settings::*member)
{
    return {gi::make_option<Settings>(
                names, std::move(values), meaning, [member](auto& s) -> auto& { return s.*member; }),
            ""};
}

/// An option of renders as a setting.
SettingKey of_renders(gi::RenderOption const& o)
{
    return {{o, [&o](Settings& s, auto const& text, auto const& given) { o.set(s.render, text, given); },
             [&o](Settings const& s) { return o.get(s.render); }},
            o.group,
            o.restarts,
            &o};
}

std::vector<SettingKey> make_keys()
{
    using S = Settings;
    std::vector<SettingKey> keys{own("method", gi::method_names(), "method of light transport", &S::method),
                                 own("compare", method_names_or_none(),
                                     "second method to compare with; shown beside the first, empty = none",
                                     &S::compare)};
    keys[0].restarts = true;
    keys[1].group = "Comparison";
    for (SettingKey& k : keys) { // also the methods of earlier versions
        k.set = [member = &k == &keys[0] ? &S::method : &S::compare](S& s, std::string const& text,
                                                                     std::string const&) {
            if (!text.empty() || member == &S::method) gi::find_method(text); // throws
            s.*member = text;
        };
    }
    for (gi::RenderOption const& o : gi::render_options())
        if (o.live) keys.push_back(of_renders(o));
    auto const add = [&](char const* group, std::initializer_list<SettingKey> more) {
        for (SettingKey const& k : more) keys.emplace_back(k).group = group;
    };
    add("Time against error",
        {own("updated-axes,followed", {0, 64},
             "stored axes per bounce updated each frame for dynamic geometry, 0 = all; set by the schedule auto",
             &S::updated_axes),
         own("reuse", {1, 256},
             "frames that light is averaged over, 1 = none; temporal reuse, up to 8 times as many where light "
             "does "
             "not change",
             &S::reuse),
         own("denoise", gi::filter_names(), "filter that removes noise", &S::denoise),
         own("first-surfaces", {},
             "surfaces at full size while things move; textures and what mirrors show too, and only light at a "
             "smaller one",
             &S::first_surfaces),
         own("share-eyes", {}, "each eye may reuse light of the other", &S::share_eyes)});
    add("Exposure",
        {own("exposure", {-32, 32}, "exposure, stops", &S::exposure_ev),
         own("auto-exposure", {"off", "on", "hold"},
             "exposure follows what is shown: off, on, or held as it is now", &S::auto_exposure),
         own("tone", {"srgb", "filmic"}, "tone curve", &S::tone),
         own("headlight", {}, "headlight; a white light at the eye, for scenes where no lamp was meant",
             &S::headlight)});
    add("Time against error",
        {own("rate", {0.1, 1000}, "target frame rate, Hz", &S::rate_hz),
         own("paths", {0, 65536}, "paths per pixel and frame, 0 = as the rate allows", &S::paths),
         own("scale", {0, 1}, "size of the picture, 0 = as the rate allows; its side relative to the window's",
             &S::scale)});
    add("Motion", {own("play", {}, "animation clips run", &S::play),
                   own("speed", {-100, 100}, "playback speed of animation clips, 1 = real time", &S::speed)});
    add("Stereo", {own("eye-distance", {0, 1}, "distance between the pupils, m", &S::eye_distance_m),
                   own("stereo", stereo_names(), "how a window shows two eyes' pictures", &S::stereo),
                   own("swap-eyes", {}, "exchange the left and right eye", &S::swap_eyes)});
    add("Comparison",
        {own("view", {"picture", "split", "flicker", "difference"}, "how two methods are shown", &S::view),
         own("split", {0, 1}, "position of the split, as a share of the picture's width", &S::split)});
    add("Time against error",
        {own("predict", {}, "render for the moment of being seen; by the motion so far", &S::predict),
         own("reproject", {}, "move the last picture along with the head; reproject it to the current head pose",
             &S::reproject),
         own("draw_surfaces", {},
             "draw surfaces for the newest pose; with the light of the last picture (windows of this program do "
             "unless told otherwise)",
             &S::draw_surfaces),
         own("refine", {}, "keep adding paths while nothing moves", &S::refine)});
    add("Panel", {own("panel", {}, "show the panel", &S::panel),
                  own("font-scale", {0.5, 4},
                      "size of letters in the panel and of messages, 1 = usual on this monitor", &S::font_scale)});
    return keys;
}

/// Keys that only viewers used for what is an option of renders now.
constexpr std::pair<std::string_view, std::string_view> kFormer[]{{"resolution", "hit_buffer"},
                                                                  {"share_endings", "radiance_cache"}};

SettingKey const* find(std::string_view key)
{
    for (auto const& [before, now] : kFormer)
        if (key == before) key = now;
    for (SettingKey const& k : setting_keys())
        if (k.is_called(key)) return &k;
    return nullptr;
}

SettingKey const& known(std::string const& key)
{
    if (SettingKey const* const k = find(key)) return *k;
    std::vector<std::string> all;
    for (SettingKey const& k : setting_keys())
        if (k.is_offered()) all.push_back(k.key);
    throw gi::InputError("there is no setting '" + key + "'", "its key is unknown",
                         gi::suggest(key, all, "lightwell info --settings has the list"));
}

std::string dumped(Json const& value) { return value.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json value_of(SettingKey const& k, Settings const& s)
{
    std::string const text = k.get(s);
    if (k.type == gi::OptionType::word) return text;
    return k.type == gi::OptionType::number ? Json(gi::parse_finite(text).value_or(0)) : Json::parse(text);
}

} // namespace

std::string current_key(std::string const& key)
{
    SettingKey const* const k = find(key);
    return k != nullptr ? k->key : key;
}

std::span<SettingKey const> setting_keys()
{
    static std::vector<SettingKey> const keys = make_keys();
    return keys;
}

std::string label_of(SettingKey const& key)
{
    constexpr std::size_t kMost = 48, kUnit = 4;
    std::string text = key.meaning;
    std::string const first = text.substr(0, text.find_first_of(",:"));
    if (std::ranges::any_of(gi::methods(), [&](gi::Method const& m) { return m.name == first; }))
        text = text.substr(text.find(": ") + 2); // "vpl_ao, vpl_dao: m"
    for (char const* const end : {"; ", ": ", "("}) text = text.substr(0, text.find(end));
    bool const is_unit = text.size() < kUnit; // "m; where ..."
    auto const goes_on = [&](char const* word) { return text.starts_with(word); };
    bool const is_value = std::ranges::find(key.words, text) != key.words.end(); // "stored: one set of axes; ..."
    if (is_unit || is_value || text.size() > kMost || goes_on("of ") || goes_on("from ") || goes_on("along ")) {
        std::string name = key.key;
        std::ranges::replace(name, '_', ' ');
        text = is_unit ? name + ", " + text : name;
    }
    while (!text.empty() && text.back() == ' ') text.pop_back();
    if (!text.empty()) text[0] = char(std::toupper(static_cast<unsigned char>(text[0])));
    return text;
}

bool is_setting(std::string const& key) { return find(key) != nullptr; }

bool restarts_methods(std::string const& key) { return known(key).restarts; }

MadeFor made_for(std::string const& program)
{
    return program.starts_with("lightwell 0.1.") ? MadeFor::version_0_1 : MadeFor::this_version;
}

Settings first_settings(MadeFor made_for)
{
    Settings s;
    if (made_for == MadeFor::version_0_1) s.method = gi::kDefaultMethodOf01;
    return s;
}

Change current(Change change, MadeFor made_for)
{
    bool const is_method = change.key == "method" || change.key == "compare";
    if (made_for == MadeFor::version_0_1 && is_method && change.value.is_string())
        change.value = std::string(gi::method_of_0_1(change.value.get<std::string>()));
    return change;
}

void check_offered(Settings const& settings, std::string const& key)
{
    SettingKey const* const k = find(key);
    if (k == nullptr || k->is_offered() || k->option->read_by(settings.method)) return;
    throw gi::InputError(fmt::format("'{}' with method {}", key, settings.method),
                         "only files of earlier versions have it", "give " + k->option->replaced_by);
}

void set(Settings& settings, Change const& change)
{
    SettingKey const& k = known(change.key);
    Json value = change.value;
    if (k.key == "radiance_cache" && value.is_boolean()) value = value.get<bool>() ? "auto" : "off"; // formerly
    k.set(settings, value.is_string() ? value.get<std::string>() : dumped(value),
          fmt::format("'{}' = {}", change.key, dumped(change.value)));
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

Json get(Settings const& settings, std::string const& key) { return value_of(known(key), settings); }

Json all_settings(Settings const& settings)
{
    Json all = Json::object();
    for (SettingKey const& k : setting_keys())
        if (k.is_offered() || k.get(settings) != k.get(Settings{})) all[k.key] = value_of(k, settings);
    return all;
}

std::vector<Change> differences(Settings const& before, Settings const& now)
{
    std::vector<Change> changes;
    for (SettingKey const& k : setting_keys())
        if (k.get(before) != k.get(now)) changes.push_back({k.key, value_of(k, now)});
    return changes;
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
