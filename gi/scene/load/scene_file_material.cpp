#include "gi/scene/load/scene_file_keys.h"
#include "gi/scene/load/scene_file_parts.h"

namespace gi {

void change_material(Yaml const& o, Material& m)
{
    auto const number = [&](char const* key, float& to, double low, double high) {
        if (o.has(key)) to = float(o.at(key).number(low, high));
    };
    if (o.has("base_color")) m.base_color = vec3(o.at("base_color").vector_or_number(0, 1));
    if (o.has("emission")) m.emission = vec3(o.at("emission").vector_or_number(0, 1e12));
    number("roughness", m.roughness, 0, 1);
    number("metallic", m.metallic, 0, 1);
    number("specular", m.specular, 0, 1);
    number("ior", m.ior, 1, 100);
    number("transmission", m.transmission, 0, 1);
    if (o.has("alpha")) {
        m.alpha = float(o.at("alpha").number(0, 1));
        if (m.alpha < 1 && m.alpha_mode == AlphaMode::opaque) m.alpha_mode = AlphaMode::blend;
    }
    if (o.has("double_sided")) m.double_sided = o.at("double_sided").boolean();
    if (o.has("thin")) m.thin = o.at("thin").boolean();
    if (o.has("attenuation")) {
        Yaml const a = o.at("attenuation");
        check_keys(a, "attenuation");
        m.absorption =
            absorption(vec3(a.at("color").vector_or_number(0, 1)), a.at("distance_m").number(1e-9, 1e9));
    }
    if (o.has("phong")) {
        Yaml const p = o.at("phong");
        check_keys(p, "phong");
        m.model = MaterialModel::phong;
        if (p.has("specular")) m.phong_specular = vec3(p.at("specular").vector_or_number(0, 1));
        if (p.has("exponent")) m.phong_exponent = float(p.at("exponent").number(0, 1e6));
    }
    if (m.model == MaterialModel::phong && max_component(m.base_color + m.phong_specular) > 1)
        throw o.error("base_color and phong specular add up to more than 1", "the surface would create light",
                      "make one of them darker");
}

} // namespace gi
