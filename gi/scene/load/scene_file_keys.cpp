#include "gi/scene/load/scene_file_keys.h"

namespace gi {

std::map<std::string, std::set<std::string>> const& scene_file_keys()
{
    static std::map<std::string, std::set<std::string>> const keys{
        {"scene", {"models", "environment", "background", "lights", "cameras", "materials"}},
        {"model", {"name", "file", "generate", "translate", "rotate", "scale", "animation", "skinning"}},
        {"generate", {"kind", "bays", "detail", "figure", "sun_elevation", "sun_azimuth", "triangles", "seed"}},
        {"rotation", {"axis", "degrees"}},
        {"animation", {"clip", "offset", "speed", "loop", "weight"}},
        {"environment", {"file", "color", "sky", "rotate", "scale"}},
        {"sky", {"turbidity", "sun_elevation", "sun_azimuth", "sun", "ground_albedo", "size"}},
        {"point_light", {"type", "position", "intensity", "range"}},
        {"spot_light", {"type", "position", "direction", "target", "intensity", "range", "cone"}},
        {"directional_light", {"type", "direction", "intensity"}},
        {"rectangle_light", {"type", "position", "u", "v", "size", "direction", "target", "radiance"}},
        {"camera", {"name", "from", "at", "fov", "height", "aperture_radius", "focus_distance"}},
        {"material",
         {"match", "model", "base_color", "roughness", "metallic", "specular", "ior", "transmission", "emission",
          "alpha", "double_sided", "thin", "attenuation", "phong"}},
        {"attenuation", {"color", "distance_m"}},
        {"phong", {"specular", "exponent"}},
    };
    return keys;
}

std::map<std::string, std::set<std::string>> const& keys_of_generated()
{
    static std::map<std::string, std::set<std::string>> const keys{
        {"atrium", {"kind", "bays", "detail", "figure", "sun_elevation", "sun_azimuth"}},
        {"avatar", {"kind"}},
        {"boxes", {"kind", "triangles", "seed"}},
        {"cornell", {"kind"}},
        {"mirror", {"kind"}},
        {"ring", {"kind"}},
        {"sphere", {"kind", "triangles", "seed"}},
    };
    return keys;
}

} // namespace gi
