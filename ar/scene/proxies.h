#pragma once
// Proxies: real objects modelled in the session file itself, in metres in the world of the markers. They receive
// shadows and light of virtual objects, occlude them, and are visible in their reflections.

#include "ar/camera/pose.h"
#include "gi/core/math.h"

#include <filesystem>
#include <optional>
#include <string>
#include <variant>

namespace ar {

/// A scene file in the world.
struct PlacedScene {
    std::filesystem::path scene; ///< empty = nothing
    gi::dvec3 at_m{0};
    double turn_deg = 0; ///< about the vertical, counter-clockwise seen from above
    double scale = 1;
};
gi::dmat4 placement(PlacedScene const& placed);

enum class AlbedoFrom {
    number,          ///< `albedo`
    texture,         ///< `texture`
    materials,       ///< from the mesh's own file
    estimate,        ///< one colour, estimated from the camera's frames
    estimate_texture ///< a texture of `texels`, estimated from the camera's frames
};

/// Linear values, 0 to 1.
struct ProxySurface {
    AlbedoFrom from = AlbedoFrom::number;
    gi::dvec3 albedo{0.5};
    std::filesystem::path texture;                    ///< sRGB picture, over texture coordinates 0 to 1
    int texels = 256;                                 ///< longer side, for estimate_texture
    double roughness = 1, metallic = 0, specular = 0; ///< as in glTF; metallic 1 and roughness 0 is a mirror
};

/// A parallelogram that faces edge_u x edge_v. Texture coordinates as printed: the corner is the lower left.
struct ProxyPlane {
    gi::dvec3 corner_m{0}, edge_u_m{0}, edge_v_m{0};
};
/// Box around its centre. Its texture has three faces in each of two rows: +x -x +y, -y +z -z.
struct ProxyBox {
    gi::dvec3 size_m{0};
    gi::RigidPose world_from_box;
};
struct ProxyMesh {
    PlacedScene placed;
};
/// A depth map (along the camera's axis), and the camera of the corresponding picture.
struct ProxyDepth {
    std::filesystem::path file;   ///< EXR, or PNG of 16 bits
    std::filesystem::path camera; ///< calibration; of the map's size, or of the same shape
    gi::RigidPose world_from_camera; ///< camera's axes as everywhere in ar: x right, y down, z ahead
    double metres_per_unit = 0;   ///< 0 = 1 for EXR, 0.001 for PNG
    double jump = 0.05;           ///< relative to depth: triangles across larger differences are left out
    int step_px = 4;              ///< between vertices
};

struct Proxy {
    std::string name; ///< unique
    ProxySurface surface;
    std::variant<ProxyPlane, ProxyBox, ProxyMesh, ProxyDepth> shape;
};

} // namespace ar
