// Reader of YAML scene files: models, environment, background, lights, cameras, material overrides. Schema:
// data/scene.schema.json.

#include "gi/core/file.h"
#include "gi/core/yaml.h"
#include "gi/scene/generate/generate.h"
#include "gi/scene/load/assimp_trial.h"
#include "gi/scene/load/load.h"
#include "gi/scene/load/rotation_value.h"
#include "gi/scene/load/scene_file_keys.h"
#include "gi/scene/load/scene_file_parts.h"
#include "gi/scene/model/sky.h"

#include <algorithm>
#include <fmt/format.h>
#include <fnmatch.h>
#include <glm/gtc/matrix_transform.hpp>

namespace gi {
namespace {

namespace fs = std::filesystem;

constexpr int kDeepestInclusion = 8; ///< maximum nesting of scene files that include scene files
constexpr int kMostModels = 10000;   ///< of a file and all files that it includes

thread_local int t_depth = 0;  ///< nesting depth of the current file, 0 = the first
thread_local int t_models = 0; ///< number of models so far, over all nested files

struct DepthGuard {
    DepthGuard()
    {
        if (t_depth++ == 0) t_models = 0;
    }
    ~DepthGuard() { --t_depth; }
    DepthGuard(DepthGuard const&) = delete;
    DepthGuard& operator=(DepthGuard const&) = delete;
};

class SceneFileReader {
public:
    SceneFileReader(Yaml const& root, fs::path const& folder, Report& report)
        : root_(root), folder_(folder), report_(report)
    {
    }

    Scene read()
    {
        check_keys(root_, "scene");
        if (root_.has("models")) {
            std::vector<Yaml> const models = root_.at("models").items();
            AssimpTrials const trials(files_of(models), AssimpFaces::merged);
            for (Yaml const& item : models) add_model(item);
        }
        if (root_.has("environment")) set_environment(root_.at("environment"));
        if (root_.has("background")) scene_.background = read_background(root_.at("background"));
        if (root_.has("lights"))
            for (Yaml const& item : root_.at("lights").items()) add_scene_file_light(item, scene_);
        if (root_.has("cameras")) add_cameras(root_.at("cameras"));
        if (root_.has("materials"))
            for (Yaml const& item : root_.at("materials").items()) override_material(item);
        return std::move(scene_);
    }

private:
    struct Model {
        std::string name;
        std::size_t first_material, end_material;
    };

    fs::path find_file(Yaml const& at, std::string const& suggestion) const
    {
        if (folder_.empty())
            throw at.error("no files may be read here", "the scene comes from memory", "use generate");
        fs::path const file = folder_ / at.text(); // just the text if it is an absolute path
        std::error_code error;
        if (fs::status(file, error).type() == fs::file_type::not_found)
            throw at.error("cannot read '" + file.string() + "'", "there is no such file", suggestion);
        return file;
    }

    /// Throws unless the kind exists and supports all given keys.
    static void check_kind(Yaml const& g, std::string const& kind)
    {
        auto const known = keys_of_generated().find(kind);
        if (known == keys_of_generated().end())
            throw g.at("kind").error("there is no built-in scene '" + kind.substr(0, 64) + "'",
                                     "it cannot be generated",
                                     "choose atrium, cornell, mirror, ring, avatar, boxes or sphere");
        for (std::string const& key : g.keys())
            if (!known->second.contains(key))
                throw g.at(key).error(kind + " has no key '" + key + "'", "it would be ignored", "remove it");
    }

    Scene generate(Yaml const& g) const
    {
        check_keys(g, "generate");
        if (!g.has("kind")) throw g.error("generate has no kind", "it does not name a scene", "kind: atrium");
        std::string const kind = g.at("kind").text();
        check_kind(g, kind);
        auto const triangles = [&] {
            // Limits the size of scenes in text from memory, which may be untrusted.
            return g.has("triangles")
                       ? std::uint32_t(g.at("triangles").integer(12, folder_.empty() ? 10000 : 100'000'000))
                       : 20000u;
        };
        std::uint64_t const seed =
            g.has("seed") ? std::uint64_t(g.at("seed").integer(0, std::int64_t(1) << 53)) : 0;
        if (kind == "boxes") return generate_boxes(triangles(), seed);
        if (kind == "sphere") return generate_sphere(triangles(), seed);
        if (kind == "cornell") return generate_cornell();
        if (kind == "mirror") return generate_mirror();
        if (kind == "ring") return generate_ring();
        if (kind == "avatar") return generate_avatar();
        AtriumOptions o;
        double const most = folder_.empty() ? 1 : 50;
        if (g.has("bays")) o.bays = int(g.at("bays").integer(1, folder_.empty() ? 5 : 100));
        if (g.has("detail")) o.detail = g.at("detail").number(0.1, most);
        if (g.has("figure")) o.figure = g.at("figure").boolean();
        if (g.has("sun_elevation")) o.sun_elevation_deg = g.at("sun_elevation").number(0, 90);
        if (g.has("sun_azimuth")) o.sun_azimuth_deg = g.at("sun_azimuth").number(-360, 360);
        return generate_atrium(o);
    }

    /// The model files that Assimp will probably read; add_model reports what is wrong with them.
    std::vector<fs::path> files_of(std::vector<Yaml> const& models) const
    {
        std::vector<fs::path> files;
        for (Yaml const& m : models)
            if (!folder_.empty() && m.is_map() && m.has("file") && m.at("file").is_text())
                if (fs::path const file = folder_ / m.at("file").text(); is_read_by_assimp(file))
                    files.push_back(file);
        return files;
    }

    void add_model(Yaml const& m)
    {
        check_keys(m, "model");
        if (++t_models > kMostModels)
            throw m.error(fmt::format("more than {} models", kMostModels),
                          "models of included scene files count, too", "join them into one model file");
        if (m.has("file") == m.has("generate"))
            throw m.error("a model needs either file or generate", "it has both or neither", "keep one");
        Scene part;
        std::string name;
        if (m.has("file")) {
            fs::path const file = find_model(m.at("file"));
            part = load_scene(file.string(), report_);
            name = file.stem().string();
        } else {
            part = generate(m.at("generate"));
            name = part.name;
        }
        if (m.has("name")) name = m.at("name").text();
        if (m.has("animation")) choose_animation(m.at("animation"), part);
        if (m.has("skinning"))
            for (Skin& skin : part.skins) skin.method = skinning_method(m.at("skinning"));

        name_default_material(part);
        if (part.environment && scene_.environment)
            report_.lose("environment maps replaced by an earlier one", 1, "model '" + name + "'");

        dmat4 transform(1);
        if (m.has("translate")) transform = glm::translate(transform, m.at("translate").vector());
        if (m.has("rotate")) transform *= read_rotation(m.at("rotate"));
        if (m.has("scale")) transform = glm::scale(transform, m.at("scale").vector_or_number(-1e9, 1e9));
        std::size_t const first = scene_.materials.size();
        append(scene_, std::move(part), name, transform);
        models_.push_back({name, first, scene_.materials.size()});
    }

    fs::path find_model(Yaml const& at) const
    {
        bool const is_built_in = keys_of_generated().contains(at.text());
        fs::path const file = find_file(
            at, is_built_in ? "write generate: {kind: " + at.text() + "} instead of file" : "check the path");
        std::string const extension = lower_extension(file);
        bool const is_scene_file = extension == ".yaml" || extension == ".yml";
        if (is_scene_file && t_depth == kDeepestInclusion)
            throw at.error("'" + file.string() + "' is not loaded",
                           fmt::format("scene files include each other {} deep", kDeepestInclusion),
                           "break the loop");
        return file;
    }

    /// Gives meshes without a material an explicit default one, so that overrides can match it.
    static void name_default_material(Scene& part)
    {
        auto const material = std::int32_t(part.materials.size());
        bool used = false;
        for (Mesh& mesh : part.meshes)
            if (mesh.material < 0) {
                mesh.material = material;
                used = true;
            }
        if (!used) return;
        part.materials.push_back({});
        part.material_names.push_back("default");
    }

    static SkinningMethod skinning_method(Yaml const& s)
    {
        std::string const method = s.text();
        if (method == "linear") return SkinningMethod::linear;
        if (method == "dual_quaternion") return SkinningMethod::dual_quaternion;
        throw s.error("there is no skinning '" + method.substr(0, 64) + "'", "the method is unknown",
                      "choose linear or dual_quaternion");
    }

    static Background read_background(Yaml const& b)
    {
        if (b.is_list()) return {BackgroundKind::color, vec3(b.vector(0, 1e9))};
        std::string const kind = b.text();
        if (kind == "map") return {};
        if (kind == "transparent") return {BackgroundKind::transparent, vec3{0}};
        throw b.error("there is no background '" + kind.substr(0, 64) + "'", "the kind is unknown",
                      "choose map, transparent or a colour: [0.1, 0.2, 0.3]");
    }

    EnvironmentMap make_sky(Yaml const& s) const
    {
        check_keys(s, "sky");
        SkyOptions o;
        if (s.has("turbidity")) o.turbidity = s.at("turbidity").number(2, 10);
        if (s.has("sun_elevation")) o.sun_elevation_deg = s.at("sun_elevation").number(0, 90);
        if (s.has("sun_azimuth")) o.sun_azimuth_deg = s.at("sun_azimuth").number(-360, 360);
        if (s.has("sun")) o.sun = s.at("sun").boolean();
        if (s.has("ground_albedo")) o.ground_albedo = vec3(s.at("ground_albedo").vector_or_number(0, 1));
        if (s.has("size")) {
            auto const size = s.at("size").items();
            if (size.size() != 2)
                throw s.at("size").error("a size needs two numbers", "width and height, texels",
                                         "size: [1024, 512]");
            // Limits the size of skies in text from memory, which may be untrusted.
            o.width = std::uint32_t(size[0].integer(8, folder_.empty() ? 128 : 32768));
            o.height = std::uint32_t(size[1].integer(4, folder_.empty() ? 64 : 16384));
        } else if (folder_.empty()) {
            o.width = 128;
            o.height = 64;
        }
        return sky_map(o);
    }

    void set_environment(Yaml const& e)
    {
        check_keys(e, "environment");
        if (int(e.has("file")) + int(e.has("color")) + int(e.has("sky")) != 1)
            throw e.error("an environment needs either file, color or sky", "it has several or none", "keep one");
        EnvironmentMap map;
        if (e.has("file")) {
            fs::path const file = find_file(e.at("file"), "check the path");
            map = load_environment(file, report_);
            scene_.files.push_back(file.string());
        } else if (e.has("sky")) {
            map = make_sky(e.at("sky"));
        } else {
            map.width = 4;
            map.height = 2;
            map.radiance.assign(8, vec3(e.at("color").vector_or_number(0, 1e9)));
        }
        if (scene_.environment) report_.lose("environment maps replaced by that of the scene file");
        if (e.has("rotate")) map.rotation_rad = float(glm::radians(e.at("rotate").number(-1e6, 1e6)));
        if (e.has("scale")) map.scale = vec3(e.at("scale").vector_or_number(0, 1e9));
        scene_.environment = std::move(map);
    }

    static void add_lens(Yaml const& c, Camera& camera)
    {
        if (c.has("aperture_radius")) camera.aperture_radius_m = c.at("aperture_radius").number(0, kWidestLens_m);
        if (c.has("focus_distance")) {
            camera.focus_distance_m = c.at("focus_distance").number(kNearestFocus_m, kFarthestFocus_m);
            if (!c.has("aperture_radius"))
                throw c.error("a camera has only focus_distance", "without a lens everything is in focus",
                              "add aperture_radius, m");
        } else if (camera.aperture_radius_m > 0) {
            camera.focus_distance_m = glm::length(c.at("at").vector() - c.at("from").vector());
        }
        try {
            check_lens(camera);
        } catch (InputError const& e) {
            throw c.error("the camera's lens is not valid", e.what(), "change aperture_radius or focus_distance");
        }
    }

    /// Puts the file's own cameras first, because its author prefers them over those of its models.
    void add_cameras(Yaml const& list)
    {
        std::vector<Node> nodes;
        for (Yaml const& c : list.items()) {
            check_keys(c, "camera");
            for (char const* key : {"name", "from", "at"})
                if (!c.has(key))
                    throw c.error(fmt::format("a camera needs {}", key), "name, from and at are needed",
                                  "name: front, from: [0, 1, 5], at: [0, 1, 0]");
            if (c.has("fov") && c.has("height"))
                throw c.error("a camera has both fov and height", "height makes it orthographic", "keep one");
            Camera camera;
            try {
                camera = look_at(c.at("from").vector(), c.at("at").vector(),
                                 c.has("fov") ? c.at("fov").number(0.001, 179) : 45);
            } catch (InputError const& e) {
                throw c.error("the camera is not valid", e.what(), "change from or at");
            }
            if (c.has("height")) {
                camera.orthographic = true;
                camera.ymag_m = 0.5 * c.at("height").number(1e-9, 1e9);
            }
            camera.name = c.at("name").text();
            add_lens(c, camera);
            Node node;
            node.name = camera.name;
            node.camera = std::int32_t(scene_.cameras.size());
            node.matrix = camera.world_from_camera;
            scene_.cameras.push_back(camera);
            nodes.push_back(std::move(node));
        }
        auto const shift = std::int32_t(nodes.size());
        for (Node& n : scene_.nodes)
            if (n.parent >= 0) n.parent += shift;
        for (Skin& s : scene_.skins)
            for (std::int32_t& j : s.joints) j += shift;
        for (Animation& a : scene_.animations)
            for (AnimationChannel& c : a.channels) c.node += shift;
        scene_.nodes.insert(scene_.nodes.begin(), nodes.begin(), nodes.end());
    }

    void override_material(Yaml const& o)
    {
        check_keys(o, "material");
        if (!o.has("match"))
            throw o.error("an override needs match", "it does not name a material", "match: Wall");
        std::string const pattern = o.at("match").text();
        std::size_t first = 0, end = scene_.materials.size();
        if (o.has("model")) {
            std::string const name = o.at("model").text();
            auto const it =
                std::find_if(models_.begin(), models_.end(), [&](Model const& m) { return m.name == name; });
            if (it == models_.end())
                throw o.at("model").error("there is no model '" + name.substr(0, 64) + "'",
                                          "no model has that name", "check models");
            first = it->first_material;
            end = it->end_material;
        }
        bool found = false;
        for (std::size_t i = first; i < end; ++i)
            if (pattern.size() < 1000 && fnmatch(pattern.c_str(), scene_.material_names[i].c_str(), 0) == 0) {
                change_material(o, scene_.materials[i]);
                found = true;
            }
        if (found) return;
        std::string known;
        for (std::size_t i = first; i < std::min(end, first + 12); ++i)
            known += (known.empty() ? "" : ", ") + scene_.material_names[i];
        throw o.at("match").error("no material matches '" + pattern.substr(0, 64) + "'", "nothing would change",
                                  known.empty() ? "the scene has none" : "some that exist: " + known);
    }
    Yaml const& root_;
    fs::path const& folder_;
    Report& report_;
    Scene scene_;
    std::vector<Model> models_;
};

} // namespace

Scene parse_scene_file(std::string const& text, fs::path const& folder, std::string const& name, Report& report)
{
    DepthGuard const guard;
    Yaml const root = Yaml::parse(text, name, "scene");
    if (!root.is_map())
        throw root.error("'" + name + "' is not a scene file", "it has no keys", "start with models:");
    try {
        Scene scene = SceneFileReader(root, folder, report).read();
        scene.name = name;
        return scene;
    } catch (YAML::Exception const& e) {
        throw InputError({name, e.mark.line + 1, e.mark.column + 1}, "this value is not valid", e.msg,
                         "check it against the schema");
    }
}

Scene load_scene_file(fs::path const& yaml, Report& report)
{
    std::vector<unsigned char> const bytes = read_bytes(yaml, std::size_t(1) << 30);
    fs::path const folder = yaml.has_parent_path() ? yaml.parent_path() : fs::path(".");
    Scene scene = parse_scene_file(std::string(bytes.begin(), bytes.end()), folder, yaml.string(), report);
    scene.files.push_back(yaml.string());
    return scene;
}

} // namespace gi
