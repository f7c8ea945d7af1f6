#include "gi/scene/model/scene.h"

#include <iterator>

namespace gi {
namespace {

template <class T>
void move_append(std::vector<T>& to, std::vector<T>& from)
{
    if (to.empty())
        to = std::move(from);
    else
        to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

void shift(std::int32_t& index, std::size_t by)
{
    if (index >= 0) index += std::int32_t(by);
}

} // namespace

void append(Scene& scene, Scene part, std::string const& name, dmat4 const& transform)
{
    Node root;
    root.name = name;
    root.matrix = transform;
    auto const root_index = std::int32_t(scene.nodes.size());
    scene.nodes.push_back(std::move(root));
    std::size_t const first_node = scene.nodes.size();

    for (Node& n : part.nodes) {
        n.parent = n.parent >= 0 ? n.parent + std::int32_t(first_node) : root_index;
        for (std::int32_t& m : n.meshes) shift(m, scene.meshes.size());
        shift(n.skin, scene.skins.size());
        shift(n.camera, scene.cameras.size());
        shift(n.light, scene.lights.size());
    }
    for (Mesh& m : part.meshes) shift(m.material, scene.materials.size());
    for (Material& m : part.materials)
        for (TextureRef* t : {&m.base_color_map, &m.metallic_roughness_map, &m.normal_map, &m.emissive_map,
                              &m.specular_map, &m.specular_color_map, &m.transmission_map})
            shift(t->texture, scene.textures.textures.size());
    for (Texture& t : part.textures.textures) t.first += scene.textures.texels.size();
    for (Skin& s : part.skins)
        for (std::int32_t& j : s.joints) shift(j, first_node);
    for (Animation& a : part.animations)
        for (AnimationChannel& c : a.channels) shift(c.node, first_node);
    for (Playback& p : part.playbacks) shift(p.animation, scene.animations.size());

    move_append(scene.nodes, part.nodes);
    move_append(scene.meshes, part.meshes);
    move_append(scene.materials, part.materials);
    move_append(scene.material_names, part.material_names);
    move_append(scene.textures.textures, part.textures.textures);
    move_append(scene.textures.texels, part.textures.texels);
    move_append(scene.skins, part.skins);
    move_append(scene.animations, part.animations);
    move_append(scene.playbacks, part.playbacks);
    move_append(scene.cameras, part.cameras);
    move_append(scene.lights, part.lights);
    move_append(scene.files, part.files);
    if (!scene.environment) scene.environment = std::move(part.environment);
}

} // namespace gi
