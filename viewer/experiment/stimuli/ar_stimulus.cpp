#include "viewer/experiment/stimuli/ar_stimulus.h"

#include "gi/core/file.h"
#include "gi/core/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

namespace viewer {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kPrefix = "ar.";

std::string text_of_file(fs::path const& file)
{
    auto const bytes = gi::read_bytes(file, std::size_t(1) << 20);
    return {bytes.begin(), bytes.end()};
}

void set_at(YAML::Node node, std::string const& key, YAML::Node const& value)
{
    std::size_t const dot = key.find('.');
    std::string const first = key.substr(0, dot);
    if (dot == std::string::npos) {
        node[first] = value;
        return;
    }
    if (!node[first].IsDefined() || !node[first].IsMap()) node[first] = YAML::Node(YAML::NodeType::Map);
    set_at(node[first], key.substr(dot + 1), value);
}

YAML::Node yaml_value_of(std::string const& text)
{
    try {
        return YAML::Load(text);
    } catch (YAML::Exception const&) {
        return YAML::Node(text);
    }
}

std::string with(std::string const& text, study::Patch const& overrides)
{
    YAML::Node root = YAML::Load(text);
    for (auto const& [key, value] : overrides) set_at(root, key, yaml_value_of(value));
    YAML::Emitter out;
    out << root;
    return out.c_str();
}

/// The message without its position, because the merged text exists in no file.
std::string without_place(std::string text, fs::path const& file)
{
    if (!text.starts_with(file.string() + ":")) return text;
    text.erase(0, file.string().size());
    return text.substr(std::min(text.find_first_not_of(":0123456789 "), text.size()));
}

/// Checks all overrides together, because one may need another. Blames the override without which the others are
/// valid, else the first that is invalid alone.
void check_overrides(std::string const& text, ArStimulus const& s)
{
    auto const problem_of = [&](study::Patch const& overrides) -> std::optional<std::string> {
        try {
            ar::parse_session(with(text, overrides), s.session);
        } catch (gi::InputError const& e) {
            return e.what();
        }
        return std::nullopt;
    };
    auto const blame = [&](std::pair<std::string, std::string> const& one, std::string const& problem) {
        std::string const key = std::string(kPrefix) + one.first;
        throw ArSettingError(key, one.second, fmt::format("{}: {}", key, one.second),
                             without_place(problem, s.session),
                             "write a value that is valid in the session's file (docs/ar.md)");
    };
    std::optional<std::string> const together = problem_of(s.overrides);
    if (!together) return;
    for (std::size_t k = 0; k < s.overrides.size(); ++k) {
        study::Patch others = s.overrides;
        others.erase(others.begin() + std::ptrdiff_t(k));
        if (!problem_of(others)) blame(s.overrides[k], *together);
    }
    for (auto const& one : s.overrides)
        if (auto const alone = problem_of({one})) blame(one, *alone);
    blame(s.overrides.back(), *together);
}

template <class Number>
Number number_of(std::string const& key, std::string const& text, char const* what)
{
    auto const n = gi::parse_number<Number>(text);
    if (!n || !(*n >= 0) || !(double(*n) < 1e9))
        throw ArSettingError(key, text, key + ": " + text, std::string("it is not a ") + what, "write 0 or more");
    return *n;
}

ArShow show_of(std::string const& key, std::string const& text)
{
    if (text == "composite") return ArShow::composite;
    if (text == "camera") return ArShow::camera;
    if (text == "truth") return ArShow::truth;
    throw ArSettingError(key, text, key + ": " + text, "there is no such kind of picture",
                         "choose composite, camera or truth");
}

} // namespace

bool is_ar_setting(std::string const& key) { return key == "ar" || key.starts_with(kPrefix); }

ArStimulus ar_stimulus(study::Patch const& patch, fs::path const& folder)
{
    ArStimulus s;
    std::string name;
    for (auto const& [key, value] : patch)
        if (key == "ar") name = value;
    for (auto const& [key, value] : patch)
        if (name.empty() && is_ar_setting(key))
            throw ArSettingError(key, value, key + ": " + value, "there is no setting `ar: SESSION.yaml`",
                                 "name the AR session that it belongs to");
    s.session = folder / name;
    if (!fs::is_regular_file(s.session))
        throw ArSettingError("ar", name, "there is no AR session '" + s.session.string() + "'",
                             "the stimulus needs it", "make one (lightwell ar synthesize), or correct the path");
    s.truth = s.session.parent_path() / "truth";
    for (auto const& [key, value] : patch) {
        if (!key.starts_with(kPrefix)) continue;
        std::string const own = key.substr(kPrefix.size());
        if (own == "frame")
            s.frame = number_of<std::uint64_t>(key, value, "number of a frame");
        else if (own == "from_s")
            s.from_s = number_of<double>(key, value, "time in seconds");
        else if (own == "show")
            s.show = show_of(key, value);
        else if (own == "truth")
            s.truth = s.session.parent_path() / value;
        else if (own == "poses")
            s.poses = s.session.parent_path() / value;
        else
            s.overrides.emplace_back(own, value);
    }
    std::string const text = text_of_file(s.session);
    ar::parse_session(text, s.session); // errors in the file itself are reported with their own position
    check_overrides(text, s);
    s.text = with(text, s.overrides);
    return s;
}

ar::Session session_of(ArStimulus const& s) { return ar::parse_session(s.text, s.session); }

} // namespace viewer
