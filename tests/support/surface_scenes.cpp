#include "tests/support/surface_scenes.h"

#include "tests/support/scenes.h"

#include <glm/gtc/matrix_transform.hpp>

namespace gi::test {
namespace {

/// Random bytes of a texture, the same everywhere.
struct Texels {
    std::uint32_t state;
    std::uint8_t next()
    {
        state = state * 1664525u + 1013904223u;
        return std::uint8_t(state >> 24);
    }
};

int add_texture(Scene& scene, unsigned width, unsigned height, Texture like, bool is_normal_map = false)
{
    Texels random{std::uint32_t(7 * width + 13 * height + scene.textures.textures.size())};
    like.first = scene.textures.texels.size();
    like.width = width;
    like.height = height;
    for (unsigned i = 0; i < width * height; ++i) {
        Rgba8 t{random.next(), random.next(), random.next(), random.next()};
        if (is_normal_map) t = {std::uint8_t(88 + t.r / 3), std::uint8_t(88 + t.g / 3), 220, 255};
        scene.textures.texels.push_back(t);
    }
    scene.textures.textures.push_back(like);
    return int(scene.textures.textures.size()) - 1;
}

int textured(Scene& scene, Material m, TextureRef Material::*map, int texture)
{
    (m.*map).texture = texture;
    return add_material(scene, m);
}

struct PanelKind {
    vec2 low{0, 0}, high{1, 1}; ///< texture coordinates of its corners
    bool tangents = false, colors = false, turned = false, alphas = false;
};

/// A square of 0.9 m in the plane z = 0 that looks to +z, or from behind if turned.
void add_panel(Scene& scene, vec2 corner, int material, PanelKind const& kind = {})
{
    Mesh mesh;
    mesh.material = material;
    vec3 const at{corner, 0}, u{0.9f, 0, 0}, v{0, 0.9f, 0};
    mesh.positions = {at, at + u, at + u + v, at + v};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    if (kind.turned)
        for (uvec3& t : mesh.triangles) std::swap(t.y, t.z);
    vec2 const l = kind.low, h = kind.high;
    mesh.uv0 = {{l.x, h.y}, h, {h.x, l.y}, l};
    for (vec2 const c : mesh.uv0) mesh.uv1.push_back({0.3f + 1.4f * c.y, 0.8f * c.x - 0.2f});
    if (kind.tangents) {
        mesh.normals.assign(4, vec3{0, 0, 1});
        mesh.tangents.assign(4, vec4{0.8f, 0.6f, 0, -1});
    }
    if (kind.alphas) mesh.alphas = {0.1f, 1, 0.9f, 0.2f};
    if (kind.colors) mesh.colors = {{1, 0.2f, 0.3f}, {0.1f, 0.9f, 0.4f}, {0.5f, 0.5f, 1}, vec3{0.05f}};
    Node node;
    node.meshes = {int(scene.meshes.size())};
    scene.meshes.push_back(std::move(mesh));
    scene.nodes.push_back(node);
}

/// A ball of radius 1 with texture coordinates, normals and tangents as asked for.
int add_ball_mesh(Scene& scene, int material, bool normals, bool tangents, bool colors)
{
    constexpr int kAround = 24, kUp = 12;
    Mesh mesh;
    mesh.material = material;
    for (int j = 0; j <= kUp; ++j)
        for (int i = 0; i <= kAround; ++i) {
            float const phi = 2 * kPi * float(i) / kAround, theta = kPi * float(j) / kUp;
            vec3 const p{std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi)};
            mesh.positions.push_back(p);
            mesh.uv0.push_back({4 * float(i) / kAround, 2 * float(j) / kUp});
            if (normals) mesh.normals.push_back(p);
            if (tangents) mesh.tangents.push_back({std::cos(phi), 0, -std::sin(phi), 1});
            if (colors) mesh.colors.push_back(0.5f + 0.5f * p);
        }
    for (unsigned j = 0; j < kUp; ++j)
        for (unsigned i = 0; i < kAround; ++i) {
            unsigned const a = j * (kAround + 1) + i, b = a + kAround + 1;
            if (j > 0) mesh.triangles.push_back({a, b, a + 1});
            if (j + 1 < kUp) mesh.triangles.push_back({a + 1, b, b + 1});
        }
    scene.meshes.push_back(std::move(mesh));
    return int(scene.meshes.size()) - 1;
}

int add_node(Scene& scene, int mesh, dvec3 at, dvec3 scale, dquat const& turn = {1, 0, 0, 0})
{
    Node node;
    node.meshes = {mesh};
    node.translation = at;
    node.scale = scale;
    node.rotation = turn;
    scene.nodes.push_back(node);
    return int(scene.nodes.size()) - 1;
}

void add_floor(Scene& scene, float y, int material)
{
    add_quad(scene, {-6, y, 6}, {12, 0, 0}, {0, 0, -12}, material);
}

void add_camera(Scene& scene, dvec3 from, dvec3 at, double yfov_deg)
{
    Node node;
    node.camera = int(scene.cameras.size());
    node.matrix = look_at(from, at, yfov_deg).world_from_camera;
    Camera camera;
    camera.yfov_rad = glm::radians(yfov_deg);
    scene.cameras.push_back(camera);
    scene.nodes.push_back(node);
}

} // namespace

Scene material_panels(bool lit)
{
    Scene s;
    using M = Material;
    int const color = add_texture(s, 6, 5, {.srgb = true}),
              mirrored = add_texture(s, 4, 4, {.wrap_u = Wrap::mirror, .wrap_v = Wrap::mirror, .srgb = true}),
              clamped = add_texture(s, 5, 7, {.wrap_u = Wrap::clamp, .wrap_v = Wrap::clamp, .srgb = true}),
              mixed = add_texture(s, 4, 3, {.wrap_u = Wrap::clamp, .wrap_v = Wrap::mirror, .srgb = true}),
              nearest = add_texture(s, 8, 8, {.nearest = true, .srgb = true}), data = add_texture(s, 5, 4, {}),
              normals = add_texture(s, 5, 5, {}, true);
    M matt = lambert(vec3{0.9f}), coated;
    coated.roughness = 0.5f;
    coated.base_color = {0.3f, 0.5f, 0.7f};
    std::vector<std::pair<int, PanelKind>> panels;
    auto const add = [&](M const& m, TextureRef M::*map, int texture, PanelKind kind = {}) {
        panels.push_back({textured(s, m, map, texture), kind});
    };
    add(matt, &M::base_color_map, color, {{-0.4f, 0}, {1.3f, 1.6f}});
    add(matt, &M::base_color_map, mirrored, {{-1.5f, -0.5f}, {1.8f, 2}});
    add(matt, &M::base_color_map, clamped, {{-0.5f, -0.3f}, {1.4f, 1.5f}});
    add(matt, &M::base_color_map, mixed, {{-1.5f, -1.3f}, {1.4f, 2.5f}});
    add(matt, &M::base_color_map, nearest, {{-0.3f, 0.2f}, {1.1f, 1.4f}});
    add(matt, &M::base_color_map, data);
    M transformed = matt;
    transformed.base_color_map = {-1, 0, {0.8f, 0.7f}, {-0.6f, 0.9f}, {0.3f, -0.2f}};
    add(transformed, &M::base_color_map, color);
    M second = matt;
    second.base_color_map.uv_set = 1;
    add(second, &M::base_color_map, color);
    add(matt, &M::base_color_map, color, {{0, 0}, {1, 1}, false, true});
    M mask = matt;
    mask.alpha_mode = AlphaMode::mask;
    mask.alpha_cutoff = 0.4f;
    add(mask, &M::base_color_map, nearest);
    if (!lit) { // their shadows have long outlines
        add(mask, &M::base_color_map, nearest, {.alphas = true});
        add(mask, &M::emissive_map, color, {.alphas = true});
    }
    M rough_metal = coated;
    rough_metal.metallic = 0.9f;
    rough_metal.roughness = 1;
    add(rough_metal, &M::metallic_roughness_map, data);
    M tinted = coated;
    tinted.specular_color = {1, 0.6f, 0.2f};
    tinted.specular_map.texture = data;
    add(tinted, &M::specular_color_map, color);
    M clear = coated;
    clear.transmission = 0.4f;
    if (!lit)
        add(clear, &M::transmission_map, data); // where there are panes, OpenGL leaves lamps to pictures of light
    M phong;
    phong.model = MaterialModel::phong;
    phong.base_color = {0.4f, 0.3f, 0.2f};
    phong.phong_specular = vec3{0.2f};
    phong.phong_exponent = 20;
    add(phong, &M::base_color_map, color);
    M lamp = lambert(vec3{0.2f});
    lamp.double_sided = false;
    lamp.emission = {0.9f, 0.5f, 0.08f};
    add(lamp, &M::emissive_map, color);
    add(lamp, &M::emissive_map, color, {{0, 0}, {1, 1}, false, false, true});
    M both = lamp;
    both.double_sided = true;
    both.emission = {0.02f, 0.2f, 0.8f};
    add(both, &M::emissive_map, color, {{0, 0}, {1, 1}, false, false, true});
    add(matt, &M::normal_map, normals);
    add(coated, &M::normal_map, normals, {{0, 0}, {1, 1}, true});
    M half = coated;
    half.normal_scale = 0.5f;
    half.normal_map.uv_set = 1;
    add(half, &M::normal_map, normals);
    add(coated, &M::normal_map, normals, {{1, 0}, {0, 1}}); // coordinates turned over
    add(coated, &M::normal_map, normals, {{0, 0}, {1, 1}, false, false, true});
    M gold;
    gold.metallic = 1;
    gold.roughness = 0.3f;
    gold.base_color = {1, 0.75f, 0.3f};
    gold.normal_map.texture = normals;
    add(gold, &M::metallic_roughness_map, data);
    M dark = coated;
    dark.base_color = {0.004f, 0.006f, 0.002f};
    dark.specular = 0.1f;
    add(dark, &M::base_color_map, color);
    constexpr unsigned kColumns = 6;
    for (unsigned k = 0; k < panels.size(); ++k)
        add_panel(s, {float(k % kColumns) - 3, float(k / kColumns) - 2}, panels[k].first, panels[k].second);
    add_floor(s, -2.2f, add_material(s, lambert({0.5f, 0.45f, 0.4f})));
    add_box(s, {-3, -2.2f, 0.6f}, {-2.6f, -0.5f, 1}, add_material(s, coated), false);
    add_camera(s, {0.3, 0.4, 4.6}, {0, -0.1, 0}, 55);
    if (!lit) return s;
    Light sun, bulb, spot;
    sun.type = LightType::directional;
    sun.direction = glm::normalize(vec3{0.5f, -0.8f, -1});
    sun.intensity = vec3{0.5f};
    bulb.position = {-1.8f, 0.2f, 1.7f};
    bulb.intensity = {1, 0.8f, 0.6f};
    bulb.range = 6;
    spot.type = LightType::spot;
    spot.position = {2, 1, 2.5f};
    spot.direction = glm::normalize(vec3{-0.3f, -0.4f, -1});
    spot.intensity = vec3{3};
    spot.cos_inner = 0.95f;
    for (Light const& l : {sun, bulb, spot}) add_light(s, l);
    return s;
}

Scene mirrored_balls()
{
    Scene s;
    using M = Material;
    int const color = add_texture(s, 6, 5, {.srgb = true}), normals = add_texture(s, 5, 5, {}, true);
    M bumpy = lambert(vec3{0.8f});
    bumpy.base_color_map.texture = color;
    int const plain = add_material(s, bumpy), bumps = textured(s, bumpy, &M::normal_map, normals);
    M shining = lambert({0.3f, 0.2f, 0.1f});
    shining.double_sided = false;
    shining.emission = {0.5f, 0.3f, 0.1f};
    int const one_sided = textured(s, shining, &M::emissive_map, color);
    std::vector<int> const meshes{
        add_ball_mesh(s, bumps, true, true, false), add_ball_mesh(s, bumps, true, false, true),
        add_ball_mesh(s, bumps, false, false, false), add_ball_mesh(s, plain, true, false, false),
        add_ball_mesh(s, one_sided, true, false, true)};
    std::vector<dvec3> const scales{{0.4, 0.4, 0.4}, {-0.4, 0.3, 0.4}, {0.4, -0.3, -0.4}, {-0.3, -0.4, -0.35}};
    for (std::size_t m = 0; m < meshes.size(); ++m)
        for (std::size_t k = 0; k < scales.size(); ++k)
            add_node(s, meshes[m], dvec3(double(m) - 2, double(k) - 1.5, 0), scales[k],
                     glm::angleAxis(0.7 * double(k + m), glm::normalize(dvec3(1, 2, 0.5))));
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        dmat4 shear = glm::translate(dmat4(1), dvec3(double(m) - 2, -2.5, 0));
        shear[0] = {0.3, 0.1, 0, 0};
        shear[1] = {0.2, -0.4, 0.1, 0};
        shear[2] = {0, 0.1, 0.35, 0};
        s.nodes[std::size_t(add_node(s, meshes[m], dvec3(0), dvec3(1)))].matrix = shear;
    }
    add_camera(s, {0.6, 0.3, 5}, {0, -0.4, 0}, 50);
    return s;
}

Scene sky_balls()
{
    Scene s;
    EnvironmentMap map;
    map.width = 16;
    map.height = 8;
    Texels random{5};
    for (unsigned i = 0; i < map.width * map.height; ++i)
        map.radiance.push_back(vec3{float(random.next()), float(random.next()), float(random.next())} / 200.0f);
    map.rotation_rad = 2.3f;
    map.scale = {0.9f, 0.7f, 0.5f};
    s.environment = map;
    add_sphere(s, {-1, 0, 0}, 0.7f, 3, add_material(s, lambert({0.6f, 0.5f, 0.3f})), true);
    Material metal;
    metal.metallic = 1;
    metal.roughness = 0.2f;
    add_sphere(s, {1, 0, -0.4f}, 0.8f, 3, add_material(s, metal), true);
    add_sphere(s, {0.1f, 0.4f, 1}, 0.3f, 3, add_material(s, glass(1.5f, false)), true);
    add_quad(s, {0.2f, -0.7f, 1.2f}, {0.8f, 0, 0.2f}, {0, 1, 0}, add_material(s, glass(1.5f, true)));
    add_quad(s, {-3, -0.8f, 2}, {6, 0, 0}, {0, 0, -4}, add_material(s, mirror({0.9f, 0.8f, 0.7f})));
    add_camera(s, {0.3, 0.8, 4}, {0, 0.1, 0}, 60);
    return s;
}

Scene moving_parts()
{
    Scene s;
    int const color = add_texture(s, 6, 5, {.srgb = true}), normals = add_texture(s, 5, 5, {}, true);
    Material bumpy = lambert({0.8f, 0.6f, 0.5f});
    bumpy.normal_map.texture = normals;
    int const bumps = textured(s, bumpy, &Material::base_color_map, color);
    add_floor(s, -1, add_material(s, lambert({0.4f, 0.5f, 0.4f})));
    Animation clip;
    clip.duration_s = 1;
    auto const animate = [&](int node, ChannelPath path, std::vector<float> values) {
        clip.channels.push_back({node, path, Interpolation::linear, {0, 1}, std::move(values)});
    };
    // A bar of two joints.
    Mesh bar;
    bar.material = bumps;
    for (unsigned i = 0; i <= 8; ++i)
        for (unsigned j = 0; j < 2; ++j) {
            float const y = 0.2f * float(i), bend = std::clamp(2 * y - 1, 0.0f, 1.0f);
            bar.positions.push_back({0.5f * float(j) - 0.25f, y, 0});
            bar.normals.push_back({0, 0, 1});
            bar.uv0.push_back({float(j), y});
            bar.joints.push_back({0, 1, 0, 0});
            bar.weights.push_back({1 - bend, bend, 0, 0});
            if (i < 8 && j == 0) {
                bar.triangles.push_back({2 * i, 2 * i + 1, 2 * i + 2});
                bar.triangles.push_back({2 * i + 1, 2 * i + 3, 2 * i + 2});
            }
        }
    s.meshes.push_back(std::move(bar));
    int const skinned = add_node(s, 0, dvec3(0), dvec3(1));
    s.meshes.back().material = bumps;
    s.nodes[std::size_t(skinned)].meshes = {int(s.meshes.size()) - 1};
    Node root, joint;
    root.translation = {-1.4, -1, 0.4};
    joint.translation = {0, 0.8, 0};
    joint.parent = int(s.nodes.size());
    s.nodes.push_back(root);
    s.nodes.push_back(joint);
    s.skins = {
        {{joint.parent, joint.parent + 1}, {glm::mat4(1), glm::translate(glm::mat4(1), vec3{0, -0.8f, 0})}}};
    s.nodes[std::size_t(skinned)].skin = 0;
    animate(joint.parent + 1, ChannelPath::rotation, {0, 0, 0, 1, 0.5f, 0, 0.5f, 0.7071f});
    // A panel that swells.
    Mesh panel;
    panel.material = bumps;
    MorphTarget swollen;
    for (unsigned j = 0; j <= 8; ++j)
        for (unsigned i = 0; i <= 8; ++i) {
            vec2 const at{float(i) / 8, float(j) / 8};
            panel.positions.push_back({at, 0});
            panel.normals.push_back({0, 0, 1});
            panel.uv0.push_back(at);
            float const r = std::exp(-8 * glm::dot(at - 0.5f, at - 0.5f));
            swollen.positions.push_back({0, 0, 0.6f * r});
            swollen.normals.push_back({9.6f * r * (at - 0.5f), 0});
            if (i == 8 || j == 8) continue;
            unsigned const a = 9 * j + i;
            panel.triangles.push_back({a, a + 1, a + 10});
            panel.triangles.push_back({a, a + 10, a + 9});
        }
    panel.morph_targets = {swollen};
    s.meshes.push_back(std::move(panel));
    int const morphing = add_node(s, int(s.meshes.size()) - 1, dvec3(-0.8, -0.6, 0), dvec3(1));
    s.nodes[std::size_t(morphing)].morph_weights = {0};
    animate(morphing, ChannelPath::morph_weights, {0, 1});
    // A ball that turns, and one that turns inside out; one shines.
    Material shining = lambert({0.5f, 0.4f, 0.3f});
    shining.double_sided = false;
    shining.emission = {0.1f, 0.2f, 0.4f};
    int const turning = add_node(s, add_ball_mesh(s, bumps, true, true, false), dvec3(0.8, -0.4, 0.2),
                                 dvec3(-0.4, 0.5, 0.4)),
              inside_out =
                  add_node(s, add_ball_mesh(s, bumps, true, false, true), dvec3(1.7, -0.4, 0), dvec3(0.4)),
              lamp = add_node(s, add_ball_mesh(s, add_material(s, shining), true, false, false),
                              dvec3(1.2, 0.7, 0), dvec3(0.3));
    animate(turning, ChannelPath::rotation, {0, 0, 0, 1, 0, 0.7071f, 0, 0.7071f});
    animate(inside_out, ChannelPath::scale, {0.4f, 0.4f, 0.4f, -0.4f, 0.4f, 0.4f});
    animate(lamp, ChannelPath::translation, {1.2f, 0.7f, 0, 0.2f, 0.9f, 0.3f});
    s.animations.push_back(std::move(clip));
    s.playbacks.push_back({.animation = 0, .loop = false});
    add_camera(s, {0.4, 0.4, 3.6}, {0.1, -0.2, 0}, 55);
    return s;
}

Scene blended_panels()
{
    Scene s;
    int const color = add_texture(s, 6, 5, {.srgb = true});
    for (float const alpha : {0.3f, 0.6f, 0.8f}) {
        Material pane = lambert({1, alpha, 0.4f});
        pane.alpha = alpha == 0.6f ? 0.8f : alpha; // 0.75 of it is in its vertices
        pane.alpha_mode = AlphaMode::blend;
        if (alpha > 0.7f) pane.emission = vec3{0.2f};
        add_material(s, pane);
    }
    add_quad(s, {-1, -0.8f, 0.8f}, {1.2f, 0, 0}, {0, 1.2f, 0}, 0);
    add_quad(s, {-0.4f, -0.4f, 0.2f}, {1.2f, 0, 0.2f}, {0, 1, 0}, 1);
    s.meshes.back().alphas.assign(4, 0.75f);
    add_quad(s, {-0.1f, -0.6f, 1.2f}, {0, 1.1f, 0}, {1, 0, 0}, 2);
    int const matt = textured(s, lambert(vec3{0.9f}), &Material::base_color_map, color);
    add_panel(s, {-0.9f, -0.9f}, matt);
    add_panel(s, {0, -0.9f}, matt, {{0, 0}, {2, 1}});
    add_panel(s, {-0.9f, 0}, matt);
    add_floor(s, -1, add_material(s, lambert({0.4f, 0.5f, 0.4f})));
    add_camera(s, {0.2, 0.3, 3.4}, {0, -0.1, 0}, 50);
    return s;
}

Scene placed(Scene scene, dmat4 const& transform)
{
    Scene whole;
    append(whole, std::move(scene), "all", transform);
    return whole;
}

} // namespace gi::test
