#include "viewer/pictures_list.h"

#include "gi/base/error.h"
#include "gi/base/file.h"
#include "gi/scene/load/yaml_reader.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

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

class ListReader {
public:
    ListReader(fs::path const& folder, RenderOptions const& common) : folder_(folder), common_(common) {}

    ListedScene read(gi::YamlReader const& s) const
    {
        s.only_keys({"name", "file", "built_in", "camera", "look_from", "look_at", "fov", "time", "envmap",
                     "envmap_rotate", "envmap_scale"});
        ListedScene scene{"", common_, ""};
        RenderOptions& o = scene.options;
        if (!s.has("name")) throw s.error("a scene has no name", "rows and pictures are named by it", "add name");
        scene.name = s.at("name").text();
        if (!fits_file_names(scene.name))
            throw s.at("name").error("'" + scene.name.substr(0, 64) + "' is no name of a scene",
                                     "it becomes part of names of files",
                                     "use letters, digits, '-' and '_', at most 64");
        if (s.has("file") == s.has("built_in"))
            throw s.error("a scene needs either file or built_in", "it has both or none", "keep one");
        o.scene = s.has("file") ? path(s.at("file"), scene) : built_in(s.at("built_in"));
        if (s.has("camera")) o.camera = s.at("camera").text();
        if (s.has("look_from")) o.look_from = point_text(s.at("look_from").vector());
        if (s.has("look_at")) o.look_at = point_text(s.at("look_at").vector());
        if (s.has("fov")) o.fov_deg = s.at("fov").number(0.001, 179);
        if (s.has("time")) o.time_s = s.at("time").number(-1e9, 1e9);
        if (s.has("envmap")) o.environment = path(s.at("envmap"), scene);
        if (s.has("envmap_rotate")) o.environment_rotate_deg = s.at("envmap_rotate").number(-1e6, 1e6);
        if (s.has("envmap_scale")) o.environment_scale = s.at("envmap_scale").number(0, 1e9);
        return scene;
    }

private:
    std::string path(gi::YamlReader const& at, ListedScene& scene) const
    {
        fs::path const file = (folder_ / at.text()).lexically_normal();
        std::error_code error;
        if (scene.missing.empty() && !fs::exists(file, error)) scene.missing = file.string();
        return file.string();
    }
    static std::string built_in(gi::YamlReader const& at)
    {
        for (char const* known : {"atrium", "cornell", "mirror", "avatar"})
            if (at.text() == known) return known;
        throw at.error("there is no built-in scene '" + at.text().substr(0, 64) + "'", "it cannot be generated",
                       "choose atrium, cornell, mirror or avatar");
    }

    fs::path const& folder_;
    RenderOptions const& common_;
};

} // namespace

std::vector<ListedScene> read_scene_list(fs::path const& file, RenderOptions const& common)
{
    constexpr std::size_t kMostBytes = std::size_t(1) << 20;
    std::vector<unsigned char> const bytes = gi::read_bytes(file, kMostBytes);
    gi::YamlReader const root =
        gi::YamlReader::parse(std::string(bytes.begin(), bytes.end()), file.string(), "list");
    root.only_keys({"scenes"});
    if (!root.has("scenes"))
        throw root.error("'" + file.string() + "' is no list of scenes", "it has no key scenes",
                         "start with scenes:");
    fs::path const folder = file.parent_path();
    ListReader const reader(folder, common);
    std::vector<ListedScene> list;
    for (gi::YamlReader const& item : root.at("scenes").items()) {
        list.push_back(reader.read(item));
        if (std::ranges::count(list, list.back().name, &ListedScene::name) > 1)
            throw item.error("there are two scenes '" + list.back().name + "'",
                             "their rows and pictures would be mixed up", "rename one");
    }
    if (list.empty()) throw root.error("the list has no scenes", "nothing would be rendered", "add one");
    return list;
}

std::vector<ListedScene> choose_scenes(std::vector<ListedScene> list, std::vector<std::string> const& names)
{
    if (names.empty()) return list;
    std::vector<ListedScene> chosen;
    for (std::string const& name : names) {
        auto const at = std::ranges::find(list, name, &ListedScene::name);
        if (at == list.end()) {
            std::vector<std::string> known;
            for (ListedScene const& s : list) known.push_back(s.name);
            throw gi::InputError("--scenes '" + name + "' is not known", "the list has no such scene",
                                 fmt::format("choose from: {}", fmt::join(known, ", ")));
        }
        chosen.push_back(*at);
    }
    return chosen;
}

} // namespace viewer
