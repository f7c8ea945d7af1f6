// Camera paths in YAML; see data/camera_path.yaml for an example.

#include "gi/core/file.h"
#include "gi/core/yaml.h"
#include "gi/scene/load/load.h"
#include "gi/scene/load/rotation_value.h"

#include <fmt/format.h>

namespace gi {
namespace {

CameraKey read_key(Yaml const& k)
{
    k.only_keys({"time_s", "from", "at", "rotation", "fov"});
    for (char const* needed : {"time_s", "from"})
        if (!k.has(needed))
            throw k.error(fmt::format("a key has no {}", needed), "every key needs a time and a position",
                          "write - {time_s: 0, from: [0, 1, 4], at: [0, 1, 0]}");
    if (k.has("at") == k.has("rotation"))
        throw k.error("a key needs either at or rotation", "it has both or neither", "keep one");
    CameraKey key;
    key.time_s = k.at("time_s").number(-1e9, 1e9);
    key.from = k.at("from").vector(-1e12, 1e12);
    if (k.has("fov")) key.fov_rad = glm::radians(k.at("fov").number(0.001, 179));
    if (k.has("rotation")) {
        key.rotation = glm::normalize(glm::quat_cast(read_rotation(k.at("rotation"))));
        return key;
    }
    key.at = k.at("at").vector(-1e12, 1e12);
    if (key.from == *key.at)
        throw k.error("a key looks at its own position", "it has no direction", "move one of them");
    key.rotation = glm::normalize(glm::quat_cast(look_at(key.from, *key.at, 45).world_from_camera));
    return key;
}

} // namespace

CameraPath parse_camera_path(std::string const& text, std::string const& name)
{
    Yaml const root = Yaml::parse(text, name, "path");
    root.only_keys({"keys"});
    if (!root.has("keys"))
        throw root.error("the camera path has no keys", "it needs at least one", "start with keys:");
    CameraPath path;
    for (Yaml const& item : root.at("keys").items()) {
        CameraKey const key = read_key(item);
        if (!path.keys.empty()) {
            CameraKey const& before = path.keys.back();
            if (!(key.time_s > before.time_s))
                throw item.at("time_s").error(
                    fmt::format("a key at {} s comes after one at {} s", key.time_s, before.time_s),
                    "keys must be in increasing time", "move or change it");
            if (key.fov_rad.has_value() != before.fov_rad.has_value())
                throw item.error("some keys have a fov and some have none", "the view would jump between them",
                                 "give all of them one, or none and --fov");
        }
        path.keys.push_back(key);
    }
    if (path.keys.empty())
        throw root.at("keys").error("the camera path has no keys", "it needs at least one", "add one");
    return path;
}

CameraPath load_camera_path(std::filesystem::path const& file)
{
    auto const bytes = read_bytes(file, std::size_t(1) << 24);
    return parse_camera_path({bytes.begin(), bytes.end()}, file.string());
}

} // namespace gi
