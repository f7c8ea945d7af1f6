#include "viewer/bench/pictures_list.h"

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/yaml.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <string_view>

namespace viewer {
namespace {

namespace fs = std::filesystem;

std::string point_text(gi::dvec3 const& p) { return fmt::format("{},{},{}", p.x, p.y, p.z); }

bool fits_file_names(std::string const& name)
{
    constexpr std::size_t kLongest = 64;
    return !name.empty() && name.size() <= kLongest &&
           std::ranges::all_of(name, [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '_'; });
}

bool is_built_in(std::string const& name)
{
    constexpr std::array<std::string_view, 5> kKnown{"atrium", "cornell", "mirror", "ring", "avatar"};
    return std::ranges::find(kKnown, name) != kKnown.end();
}

class ListReader {
public:
    ListReader(fs::path const& folder, RenderOptions const& common) : folder_(folder), common_(common) {}

    ListedScene read(gi::Yaml const& s) const
    {
        s.only_keys({"name", "file", "built_in", "camera", "look_from", "look_at", "fov", "time", "envmap",
                     "envmap_rotate", "envmap_scale", "camera_path"});
        ListedScene scene{"", common_, ""};
        RenderOptions& o = scene.options;
        if (!s.has("name")) throw s.error("a scene has no name", "rows and pictures are named by it", "add name");
        scene.name = s.at("name").text();
        if (!fits_file_names(scene.name))
            throw s.at("name").error("'" + scene.name.substr(0, 64) + "' is no name of a scene",
                                     "it becomes part of file names",
                                     "use letters, digits, '-' and '_', at most 64");
        if (s.has("file") == s.has("built_in"))
            throw s.error("a scene needs either file or built_in", "it has both or none", "keep one");
        o.scene = s.has("file") ? path(s.at("file"), scene) : built_in(s.at("built_in"));
        if (s.has("camera")) o.camera = s.at("camera").text();
        if (s.has("look_from")) o.look_from = point_text(s.at("look_from").vector());
        if (s.has("look_at")) o.look_at = point_text(s.at("look_at").vector());
        if (s.has("camera_path")) o.camera_path = path(s.at("camera_path"), scene);
        if (s.has("fov")) o.fov_deg = s.at("fov").number(0.001, 179);
        if (s.has("time")) o.time_s = s.at("time").number(-1e9, 1e9);
        if (s.has("envmap")) o.environment = path(s.at("envmap"), scene);
        if (s.has("envmap_rotate")) o.environment_rotate_deg = s.at("envmap_rotate").number(-1e6, 1e6);
        if (s.has("envmap_scale")) o.environment_scale = s.at("envmap_scale").number(0, 1e9);
        return scene;
    }

private:
    std::string path(gi::Yaml const& at, ListedScene& scene) const
    {
        fs::path const file = (folder_ / at.text()).lexically_normal();
        std::error_code error;
        if (scene.missing.empty() && !fs::exists(file, error)) scene.missing = file.string();
        return file.string();
    }
    static std::string built_in(gi::Yaml const& at)
    {
        if (is_built_in(at.text())) return at.text();
        throw at.error("there is no built-in scene '" + at.text().substr(0, 64) + "'", "it cannot be generated",
                       "choose atrium, cornell, mirror, ring or avatar");
    }

    fs::path const& folder_;
    RenderOptions const& common_;
};

} // namespace

std::vector<ListedScene> read_scene_list(fs::path const& file, RenderOptions const& common, Listed which)
{
    constexpr std::size_t kMostBytes = std::size_t(1) << 20;
    std::vector<unsigned char> const bytes = gi::read_bytes(file, kMostBytes);
    gi::Yaml const root = gi::Yaml::parse(std::string(bytes.begin(), bytes.end()), file.string(), "list");
    root.only_keys({"scenes", "sequences"});
    std::string const key = which == Listed::scenes ? "scenes" : "sequences";
    if (!root.has(key))
        throw root.error("'" + file.string() + "' has no list '" + key + "'", "nothing would be rendered",
                         "start with " + key + ":");
    fs::path const folder = file.parent_path();
    ListReader const reader(folder, common);
    std::vector<ListedScene> list;
    for (gi::Yaml const& item : root.at(key).items()) {
        list.push_back(reader.read(item));
        if (which == Listed::scenes && item.has("camera_path"))
            throw item.at("camera_path")
                .error("a scene has a camera_path", "scenes are rendered at one moment", "move it to sequences");
        if (std::ranges::count(list, list.back().name, &ListedScene::name) > 1)
            throw item.error("there are two scenes '" + list.back().name + "'",
                             "their rows and pictures would be mixed up", "rename one");
    }
    if (list.empty()) throw root.error("the list '" + key + "' is empty", "nothing would be rendered", "add one");
    return list;
}

std::vector<ListedScene> choose_scenes(std::vector<ListedScene> list, std::vector<std::string> const& names,
                                       RenderOptions const& common)
{
    if (names.empty()) return list;
    std::vector<ListedScene> chosen;
    for (std::string const& name : names) {
        auto const at = std::ranges::find(list, name, &ListedScene::name);
        std::error_code error;
        if (at != list.end()) {
            chosen.push_back(*at);
        } else if (is_built_in(name) || fs::exists(name, error)) {
            chosen.push_back({fs::path(name).stem().string(), common, ""});
            chosen.back().options.scene = name;
        } else {
            std::vector<std::string> known;
            for (ListedScene const& s : list) known.push_back(s.name);
            throw gi::InputError("--scenes '" + name + "' is not known",
                                 "it is not a scene of the list, a file or a built-in scene",
                                 fmt::format("choose from: {}", fmt::join(known, ", ")));
        }
    }
    for (ListedScene const& s : chosen)
        if (std::ranges::count(chosen, s.name, &ListedScene::name) > 1)
            throw gi::InputError("--scenes names two scenes '" + s.name + "'",
                                 "their rows and pictures would be mixed up", "rename a file");
    return chosen;
}

} // namespace viewer
