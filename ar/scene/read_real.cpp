#include "ar/scene/read_values.h"

#include <algorithm>
#include <fmt/format.h>

namespace ar {
namespace {

using gi::Yaml;

constexpr std::size_t kMostProxies = 10000;
constexpr double kFar_m = 1e4;

class RealReader {
public:
    RealReader(Yaml const& real, std::filesystem::path const& folder) : real_(real), folder_(folder) {}

    RealPlace read()
    {
        real_.only_keys(
            {"scene", "at", "turn_deg", "scale", "albedo", "estimates", "planes", "boxes", "meshes", "depth"});
        out_.estimates = folder_ / (real_.has("estimates") ? real_.at("estimates").text() : "albedo.yaml");
        if (real_.has("scene"))
            static_cast<PlacedScene&>(out_) = read_placed(real_, "scene", folder_);
        else
            for (char const* key : {"at", "turn_deg", "scale", "albedo"})
                if (real_.has(key))
                    throw real_.at(key).error("there is no 'scene'", "the key applies to a scene file",
                                              "add a scene file, or remove the key");
        if (real_.has("albedo")) {
            if (!real_.at("albedo").is_text() || real_.at("albedo").text() != "estimate")
                throw real_.at("albedo").error("not the word estimate",
                                               "the materials of a scene file have colours of their own",
                                               "write albedo: estimate, or leave it out");
            out_.estimate_scene = true;
        }
        read_all("planes", [&](Yaml const& y) { return plane(y); });
        read_all("boxes", [&](Yaml const& y) { return box(y); });
        read_all("meshes", [&](Yaml const& y) { return mesh(y); });
        read_all("depth", [&](Yaml const& y) { return depth(y); });
        if (!real_.has("scene") && out_.proxies.empty())
            throw real_.error("nothing real", "no surface can receive shadows",
                              "add a scene, planes, boxes, meshes or depth; or remove 'real'");
        return std::move(out_);
    }

private:
    static std::set<std::string> with_surface(std::set<std::string> keys)
    {
        keys.insert({"name", "albedo", "texture", "texels", "roughness", "metallic", "specular"});
        return keys;
    }

    template <class Read>
    void read_all(char const* key, Read const& read)
    {
        if (!real_.has(key)) return;
        auto const items = real_.at(key).items();
        if (items.size() > kMostProxies)
            throw real_.at(key).error(fmt::format("{} of them", items.size()),
                                      fmt::format("{} is the most", kMostProxies), "put them into one mesh");
        for (std::size_t i = 0; i < items.size(); ++i) {
            Proxy p = read(items[i]);
            p.name = items[i].has("name") ? items[i].at("name").text() : fmt::format("{}-{}", key, i + 1);
            if (std::any_of(out_.proxies.begin(), out_.proxies.end(),
                            [&](Proxy const& q) { return q.name == p.name; }))
                throw items[i].error("there is another '" + p.name + "'", "estimates refer to proxies by name",
                                     "use unique names");
            out_.proxies.push_back(std::move(p));
        }
    }

    ProxySurface surface(Yaml const& y, AlbedoFrom unsaid) const
    {
        ProxySurface s;
        s.from = unsaid;
        if (y.has("albedo") && y.has("texture"))
            throw y.at("texture").error("albedo is there too", "only one of the two is allowed",
                                        "remove one of the two");
        if (y.has("albedo")) {
            Yaml const a = y.at("albedo");
            s.from = AlbedoFrom::number;
            if (!a.is_text() || a.text() != "estimate")
                s.albedo = a.vector_or_number(0, 1);
            else
                s.from = AlbedoFrom::estimate;
        }
        if (y.has("texture")) {
            std::string const name = y.at("texture").text();
            s.from = name == "estimate" ? AlbedoFrom::estimate_texture : AlbedoFrom::texture;
            if (s.from == AlbedoFrom::texture) s.texture = folder_ / name;
        }
        if (y.has("texels")) {
            if (s.from != AlbedoFrom::estimate_texture)
                throw y.at("texels").error("the texture is not estimated", "texture files have their own size",
                                           "remove the key");
            s.texels = int(y.at("texels").integer(1, 4096));
        }
        if (y.has("roughness")) s.roughness = y.at("roughness").number(0, 1);
        if (y.has("metallic")) s.metallic = y.at("metallic").number(0, 1);
        if (y.has("specular")) s.specular = y.at("specular").number(0, 1);
        bool const is_estimated = s.from == AlbedoFrom::estimate || s.from == AlbedoFrom::estimate_texture;
        if (is_estimated && s.metallic > 0)
            throw y.at("metallic")
                .error("a metal's colour cannot be estimated", "a metal shows reflections, not its albedo",
                       "set its albedo in numbers");
        return s;
    }

    Proxy plane(Yaml const& y) const
    {
        y.only_keys(with_surface(
            {"corner_m", "edge_u_m", "edge_v_m", "centre_m", "size_m", "rotation_deg", "rotation_xyzw"}));
        ProxyPlane p;
        if (y.has("corner_m")) {
            for (char const* other : {"centre_m", "size_m", "rotation_deg", "rotation_xyzw"})
                if (y.has(other))
                    throw y.at(other).error("corner_m is there too", "it already defines the plane's position",
                                            "use corner_m and two edges, or centre_m, size_m and a rotation");
            need(y, {"edge_u_m", "edge_v_m"});
            p.corner_m = y.at("corner_m").vector(-kFar_m, kFar_m);
            p.edge_u_m = y.at("edge_u_m").vector(-kFar_m, kFar_m);
            p.edge_v_m = y.at("edge_v_m").vector(-kFar_m, kFar_m);
            if (!(glm::length(glm::cross(p.edge_u_m, p.edge_v_m)) > 1e-12))
                throw y.error("the edges lie in one line", "there is no area between them",
                              "use two edges that start at the corner, in different directions");
        } else {
            need(y, {"centre_m", "size_m"});
            for (char const* other : {"edge_u_m", "edge_v_m"})
                if (y.has(other))
                    throw y.at(other).error("there is no corner_m", "edges start at the corner",
                                            "add corner_m, or use size_m instead of the edges");
            auto const size = y.at("size_m").items();
            if (size.size() != 2)
                throw y.at("size_m").error("not two numbers", "it is a width and a height", "write [0.6, 0.4]");
            glm::dquat const turned = read_pose(y).rotation;
            p.edge_u_m = turned * gi::dvec3(size[0].number(1e-4, kFar_m), 0, 0);
            p.edge_v_m = turned * gi::dvec3(0, size[1].number(1e-4, kFar_m), 0);
            p.corner_m = y.at("centre_m").vector(-kFar_m, kFar_m) - 0.5 * (p.edge_u_m + p.edge_v_m);
        }
        return {"", surface(y, AlbedoFrom::number), p};
    }

    Proxy box(Yaml const& y) const
    {
        y.only_keys(with_surface({"size_m", "position_m", "rotation_deg", "rotation_xyzw"}));
        need(y, {"size_m"});
        ProxyBox b;
        b.size_m = y.at("size_m").vector(1e-4, kFar_m);
        b.world_from_box = read_pose(y);
        return {"", surface(y, AlbedoFrom::number), b};
    }

    Proxy mesh(Yaml const& y) const
    {
        y.only_keys(with_surface({"file", "at", "turn_deg", "scale"}));
        need(y, {"file"});
        ProxySurface s = surface(y, AlbedoFrom::materials);
        for (char const* key : {"roughness", "metallic", "specular"})
            if (s.from == AlbedoFrom::materials && y.has(key))
                throw y.at(key).error("neither albedo nor texture", "the materials of the file stay as they are",
                                      "give an albedo too, or leave it out");
        return {"", s, ProxyMesh{read_placed(y, "file", folder_)}};
    }

    Proxy depth(Yaml const& y) const
    {
        y.only_keys(with_surface({"file", "camera", "position_m", "rotation_deg", "rotation_xyzw",
                                  "metres_per_unit", "jump", "step_px"}));
        need(y, {"file", "camera", "position_m"});
        ProxyDepth d;
        d.file = folder_ / y.at("file").text();
        d.camera = folder_ / y.at("camera").text();
        d.world_from_camera = read_pose(y);
        if (y.has("metres_per_unit")) d.metres_per_unit = y.at("metres_per_unit").number(1e-9, 1e3);
        if (y.has("jump")) d.jump = y.at("jump").number(1e-4, 10);
        if (y.has("step_px")) d.step_px = int(y.at("step_px").integer(1, 256));
        return {"", surface(y, AlbedoFrom::number), d};
    }

    static void need(Yaml const& y, std::vector<char const*> const& keys)
    {
        for (char const* key : keys)
            if (!y.has(key)) throw y.error(fmt::format("no '{}'", key), "it defines position and size", "add it");
    }

    Yaml const& real_;
    std::filesystem::path folder_;
    RealPlace out_;
};

} // namespace

RealPlace read_real(Yaml const& real, std::filesystem::path const& folder)
{
    return RealReader(real, folder).read();
}

} // namespace ar
