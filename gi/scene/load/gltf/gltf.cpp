#include "gi/core/file.h"
#include "gi/scene/load/gltf/gltf_accessor.h"
#include "gi/scene/load/gltf/gltf_parts.h"
#include "gi/scene/load/load.h"

#include <algorithm>
#include <fmt/format.h>

namespace gi {
namespace {

std::optional<ChannelPath> to_path(std::string const& name)
{
    if (name == "translation") return ChannelPath::translation;
    if (name == "rotation") return ChannelPath::rotation;
    if (name == "scale") return ChannelPath::scale;
    if (name == "weights") return ChannelPath::morph_weights;
    return std::nullopt;
}

Interpolation to_interpolation(std::string const& name)
{
    return name == "STEP"          ? Interpolation::step
           : name == "CUBICSPLINE" ? Interpolation::cubic_spline
                                   : Interpolation::linear;
}

/// Reads the keys of one channel. Throws InputError if times do not increase or values are missing.
void read_keys(GltfDocument& d, tinygltf::AnimationSampler const& sampler, std::size_t components,
               AnimationChannel& channel, std::string const& where, Report& report)
{
    if (sampler.interpolation != "LINEAR" && sampler.interpolation != "STEP" &&
        sampler.interpolation != "CUBICSPLINE")
        report.lose("unknown interpolations taken as linear", 1, where);
    channel.interpolation = to_interpolation(sampler.interpolation);
    channel.times_s = read_floats(d, sampler.input, 1).values;
    for (std::size_t i = 0; i < channel.times_s.size(); ++i)
        if (!std::isfinite(channel.times_s[i]) || channel.times_s[i] < 0 ||
            (i > 0 && !(channel.times_s[i] > channel.times_s[i - 1])))
            throw d.error(fmt::format("the times of {} do not increase", where), fmt::format("at key {}", i));
    channel.values = read_floats(d, sampler.output, 0).values;
    std::size_t const per_key = components * (channel.interpolation == Interpolation::cubic_spline ? 3 : 1);
    if (channel.values.size() != channel.times_s.size() * per_key)
        throw d.error(fmt::format("{} has {} values", where, channel.values.size()),
                      fmt::format("{} keys of {} are needed", channel.times_s.size(), per_key));
    for (float const v : channel.values)
        if (!std::isfinite(v))
            throw d.error(where + " has a value that is not finite", "nothing can be placed with it");
}

void read_animations(GltfDocument& d, std::vector<std::int32_t> const& place, Scene& scene, Report& report)
{
    for (std::size_t a = 0; a < d.model.animations.size(); ++a) {
        tinygltf::Animation const& source = d.model.animations[a];
        Animation clip;
        clip.name = source.name.empty() ? fmt::format("clip {}", a) : source.name;
        std::string const where = "clip '" + clip.name + "'";
        for (tinygltf::AnimationChannel const& c : source.channels) {
            auto const path = to_path(c.target_path);
            if (!path || c.target_node < 0) {
                report.lose("animation channels ignored", 1, where + " path '" + c.target_path + "'");
                continue;
            }
            if (std::size_t(c.target_node) >= place.size())
                throw d.error(fmt::format("node {} does not exist", c.target_node), where + " moves it");
            if (c.sampler < 0 || std::size_t(c.sampler) >= source.samplers.size())
                throw d.error(fmt::format("sampler {} does not exist", c.sampler), where + " uses it");
            AnimationChannel channel;
            channel.node = place[std::size_t(c.target_node)];
            channel.path = *path;
            std::size_t const targets = scene.nodes[std::size_t(channel.node)].morph_weights.size();
            if (*path == ChannelPath::morph_weights && targets == 0) {
                report.lose("animation channels ignored", 1,
                            where + " moves weights of a node without morph targets");
                continue;
            }
            std::size_t const components = *path == ChannelPath::rotation        ? 4
                                           : *path == ChannelPath::morph_weights ? targets
                                                                                 : 3;
            read_keys(d, source.samplers[std::size_t(c.sampler)], components, channel, where, report);
            clip.duration_s = std::max(clip.duration_s, double(channel.times_s.back()));
            clip.channels.push_back(std::move(channel));
        }
        scene.animations.push_back(std::move(clip));
    }
    if (!scene.animations.empty()) scene.playbacks = {{0, 0, 1, true}};
}

/// The default material of the specification (sec. 3.9.6), a white rough metal, for meshes that name none.
void add_default_material(Scene& scene)
{
    auto const has_none = [](Mesh const& m) { return m.material < 0; };
    if (std::ranges::none_of(scene.meshes, has_none)) return;
    for (Mesh& m : scene.meshes)
        if (has_none(m)) m.material = std::int32_t(scene.materials.size());
    Material m;
    m.base_color = vec3{1};
    m.metallic = 1;
    scene.materials.push_back(m);
    scene.material_names.emplace_back("default");
}

} // namespace

Scene parse_gltf(unsigned char const* bytes, std::size_t size, std::filesystem::path const& folder,
                 std::string const& name, Report& report)
{
    GltfDocument document = open_gltf({bytes, size}, folder, name, report);
    Scene scene;
    scene.name = name;
    scene.files = document.files;
    read_materials(document, scene, report);
    std::vector<GltfMesh> const meshes = read_meshes(document, scene, report);
    add_default_material(scene);
    std::vector<std::int32_t> const place = read_nodes(document, meshes, scene, report);
    read_animations(document, place, scene, report);
    return scene;
}

Scene load_gltf(std::filesystem::path const& file, Report& report)
{
    std::vector<unsigned char> const bytes = read_bytes(file);
    std::filesystem::path const folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
    Scene scene = parse_gltf(bytes.data(), bytes.size(), folder, file.string(), report);
    scene.files.push_back(file.string());
    return scene;
}

} // namespace gi
