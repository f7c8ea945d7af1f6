#include "gi/scene/load/gltf/gltf_parts.h"

#include "gi/scene/load/gltf/gltf_accessor.h"

#include <algorithm>
#include <fmt/format.h>

namespace gi {
namespace {

bool finite(std::vector<double> const& v)
{
    return std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); });
}

class NodeReader {
public:
    NodeReader(GltfDocument& d, std::vector<GltfMesh> const& meshes, Scene& scene, Report& report)
        : d_(d), meshes_(meshes), scene_(scene), report_(report), place_(d.model.nodes.size(), -1)
    {
    }

    std::vector<std::int32_t> read()
    {
        check_graph();
        auto const& scenes = d_.model.scenes;
        int const shown = d_.model.defaultScene >= 0 ? d_.model.defaultScene : 0;
        std::vector<int> roots;
        if (!scenes.empty()) {
            if (std::size_t(shown) >= scenes.size())
                throw d_.error(fmt::format("scene {} does not exist", shown), "it is the default scene");
            roots = scenes[std::size_t(shown)].nodes;
            for (int const r : roots)
                if (!exists(r)) throw d_.error(fmt::format("node {} does not exist", r), "the scene lists it");
        }
        for (int const r : roots) {
            if (has_parent_[std::size_t(r)])
                report_.lose("scene roots that have a parent, used without it", 1, fmt::format("node {}", r));
            add_tree(r, true);
        }
        for (std::size_t i = 0; i < place_.size(); ++i)
            if (!has_parent_[i]) add_tree(int(i), scenes.empty());
        read_skins();
        return place_;
    }

private:
    bool exists(int node) const { return node >= 0 && std::size_t(node) < d_.model.nodes.size(); }

    /// Checks that every node has at most one parent and that there is no loop.
    void check_graph()
    {
        auto const& nodes = d_.model.nodes;
        has_parent_.assign(nodes.size(), false);
        for (std::size_t i = 0; i < nodes.size(); ++i)
            for (int const child : nodes[i].children) {
                if (!exists(child))
                    throw d_.error(fmt::format("node {} does not exist", child),
                                   fmt::format("it is a child of node {}", i));
                if (has_parent_[std::size_t(child)])
                    throw d_.error(fmt::format("node {} has two parents", child), "the node graph must be a tree");
                has_parent_[std::size_t(child)] = true;
            }
        std::size_t reached = 0;
        std::vector<int> stack;
        for (std::size_t i = 0; i < nodes.size(); ++i)
            if (!has_parent_[i]) stack.push_back(int(i));
        for (; !stack.empty(); ++reached) {
            auto const& children = nodes[std::size_t(stack.back())].children;
            stack.pop_back();
            stack.insert(stack.end(), children.begin(), children.end());
        }
        if (reached != nodes.size())
            throw d_.error("its nodes form a loop",
                           fmt::format("{} of {} have no root", nodes.size() - reached, nodes.size()));
    }

    void add_tree(int root, bool shown)
    {
        struct Visit {
            int node;
            std::int32_t parent;
            bool visible;
        };
        std::vector<Visit> stack{{root, -1, true}};
        while (!stack.empty()) {
            Visit const v = stack.back();
            stack.pop_back();
            if (place_[std::size_t(v.node)] >= 0)
                continue; // the scene lists this root twice, or also below another root
            place_[std::size_t(v.node)] = std::int32_t(scene_.nodes.size());
            tinygltf::Node const& source = d_.model.nodes[std::size_t(v.node)];
            bool const visible = v.visible && is_visible(source);
            scene_.nodes.push_back(make_node(source, v.node, v.parent, shown, visible));
            for (auto it = source.children.rbegin(); it != source.children.rend(); ++it)
                stack.push_back({*it, place_[std::size_t(v.node)], visible});
        }
    }

    /// False hides the node and all below it, but no cameras (KHR_node_visibility).
    static bool is_visible(tinygltf::Node const& source)
    {
        auto const it = source.extensions.find("KHR_node_visibility");
        if (it == source.extensions.end() || !it->second.IsObject() || !it->second.Has("visible")) return true;
        tinygltf::Value const& visible = it->second.Get("visible");
        return !visible.IsBool() || visible.Get<bool>();
    }

    Node make_node(tinygltf::Node const& source, int index, std::int32_t parent, bool shown, bool visible)
    {
        Node node;
        node.name = source.name.empty() ? fmt::format("node {}", index) : source.name;
        std::string const where = "node '" + node.name + "'";
        node.parent = parent;
        if (!finite(source.matrix) || !finite(source.translation) || !finite(source.rotation) ||
            !finite(source.scale))
            throw d_.error(where + " has no finite transform", "nothing can be placed with it");
        if (source.matrix.size() == 16) {
            dmat4 m;
            for (std::size_t i = 0; i < 16; ++i) m[int(i / 4)][int(i % 4)] = source.matrix[i];
            node.matrix = m;
        }
        if (source.translation.size() == 3)
            node.translation = {source.translation[0], source.translation[1], source.translation[2]};
        if (source.scale.size() == 3) node.scale = {source.scale[0], source.scale[1], source.scale[2]};
        if (source.rotation.size() == 4) {
            dquat const q{source.rotation[3], source.rotation[0], source.rotation[1], source.rotation[2]};
            double const length = glm::length(q);
            if (!(length > 0)) throw d_.error(where + " has no rotation", "its quaternion is zero");
            if (std::abs(length - 1) > 1e-3) report_.lose("rotations that are not unit, normalised", 1, where);
            node.rotation = q / length;
        }
        if (!shown) return node;
        if (source.camera >= 0) attach_camera(source.camera, node);
        if (!visible) return node;
        if (source.mesh >= 0) attach_mesh(source, node, where);
        if (auto const it = source.extensions.find("KHR_lights_punctual"); it != source.extensions.end())
            if (it->second.IsObject() && it->second.Has("light") && it->second.Get("light").IsInt())
                attach_light(it->second.Get("light").GetNumberAsInt(), node, where);
        return node;
    }

    void attach_mesh(tinygltf::Node const& source, Node& node, std::string const& where)
    {
        if (std::size_t(source.mesh) >= meshes_.size())
            throw d_.error(fmt::format("mesh {} does not exist", source.mesh), where + " uses it");
        GltfMesh const& mesh = meshes_[std::size_t(source.mesh)];
        node.meshes = mesh.meshes;
        node.morph_weights = mesh.weights;
        for (std::size_t i = 0; i < std::min(node.morph_weights.size(), source.weights.size()); ++i)
            node.morph_weights[i] = float(source.weights[i]);
        if (source.skin < 0) return;
        if (std::size_t(source.skin) >= d_.model.skins.size())
            throw d_.error(fmt::format("skin {} does not exist", source.skin), where + " uses it");
        if (d_.model.skins[std::size_t(source.skin)].joints.size() < mesh.joints)
            throw d_.error(fmt::format("a joint of {} is out of range", where),
                           fmt::format("its mesh uses joint {} of {}", mesh.joints - 1,
                                       d_.model.skins[std::size_t(source.skin)].joints.size()));
        node.skin = source.skin;
    }

    void attach_camera(int index, Node& node)
    {
        if (std::size_t(index) >= d_.model.cameras.size())
            throw d_.error(fmt::format("camera {} does not exist", index), "node '" + node.name + "' uses it");
        tinygltf::Camera const& source = d_.model.cameras[std::size_t(index)];
        Camera camera;
        camera.name = node.name;
        camera.orthographic = source.type == "orthographic";
        auto const bad = [&](std::string const& why) {
            return d_.error("camera '" + node.name + "' is not valid", why);
        };
        if (camera.orthographic) {
            camera.ymag_m = std::abs(source.orthographic.ymag);
            if (!(camera.ymag_m > 0) || !std::isfinite(camera.ymag_m)) throw bad("its height is zero");
            double const aspect = std::abs(source.orthographic.xmag) / camera.ymag_m;
            if (aspect > 0 && std::isfinite(aspect)) camera.aspect = aspect;
        } else {
            camera.yfov_rad = source.perspective.yfov;
            if (!(camera.yfov_rad > 0) || !(camera.yfov_rad < glm::pi<double>()))
                throw bad("its field of view is not between 0 and pi");
            if (source.perspective.aspectRatio > 0 && std::isfinite(source.perspective.aspectRatio))
                camera.aspect = source.perspective.aspectRatio;
        }
        node.camera = std::int32_t(scene_.cameras.size());
        scene_.cameras.push_back(camera);
    }

    void attach_light(int index, Node& node, std::string const& where)
    {
        if (index < 0 || std::size_t(index) >= d_.model.lights.size())
            throw d_.error(fmt::format("light {} does not exist", index), where + " uses it");
        tinygltf::Light const& source = d_.model.lights[std::size_t(index)];
        Light light;
        if (source.type == "point")
            light.type = LightType::point;
        else if (source.type == "spot")
            light.type = LightType::spot;
        else if (source.type == "directional")
            light.type = LightType::directional;
        else
            throw d_.error("light '" + source.name + "' has an unknown type", "its type is '" + source.type + "'");
        for (int c = 0; c < 3; ++c) {
            double const color = source.color.size() == 3 ? source.color[std::size_t(c)] : 1;
            double const v = color * source.intensity;
            bool const good = v >= 0 && v < 1e30;
            if (!good) report_.lose("light intensities that are negative or not finite, 0", 1, where);
            light.intensity[c] = good ? float(v) : 0.0f;
        }
        light.range = source.range > 0 && source.range < 1e30 ? float(source.range) : 0.0f;
        double const outer = std::clamp(source.spot.outerConeAngle, 0.0, glm::half_pi<double>());
        light.cos_outer = float(std::cos(outer));
        light.cos_inner = float(std::cos(std::clamp(source.spot.innerConeAngle, 0.0, outer)));
        node.light = std::int32_t(scene_.lights.size());
        scene_.lights.push_back(light);
    }

    void read_skins()
    {
        for (std::size_t s = 0; s < d_.model.skins.size(); ++s) {
            tinygltf::Skin const& source = d_.model.skins[s];
            Skin skin;
            for (int const joint : source.joints) {
                if (!exists(joint))
                    throw d_.error(fmt::format("node {} does not exist", joint),
                                   fmt::format("it is a joint of skin {}", s));
                skin.joints.push_back(place_[std::size_t(joint)]);
            }
            skin.inverse_bind.assign(skin.joints.size(), mat4(1));
            if (source.inverseBindMatrices >= 0) {
                GltfArray const matrices = read_floats(d_, source.inverseBindMatrices, 16);
                if (matrices.count < skin.joints.size())
                    throw d_.error(fmt::format("skin {} has too few inverse bind matrices", s),
                                   fmt::format("{} for {} joints", matrices.count, skin.joints.size()));
                if (!std::all_of(matrices.values.begin(), matrices.values.end(),
                                 [](float v) { return std::isfinite(v); }))
                    throw d_.error(fmt::format("skin {} has a matrix that is not finite", s),
                                   "nothing can be placed with it");
                for (std::size_t j = 0; j < skin.joints.size(); ++j)
                    for (std::size_t i = 0; i < 16; ++i)
                        skin.inverse_bind[j][int(i / 4)][int(i % 4)] = matrices.values[16 * j + i];
            }
            scene_.skins.push_back(std::move(skin));
        }
    }

    GltfDocument& d_;
    std::vector<GltfMesh> const& meshes_;
    Scene& scene_;
    Report& report_;
    std::vector<std::int32_t> place_;
    std::vector<bool> has_parent_;
};

} // namespace

std::vector<std::int32_t> read_nodes(GltfDocument& document, std::vector<GltfMesh> const& meshes, Scene& scene,
                                     Report& report)
{
    return NodeReader(document, meshes, scene, report).read();
}

} // namespace gi
