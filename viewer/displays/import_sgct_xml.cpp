// SGCT 1 and 2, XML: <Cluster><Node><Window><Viewport>. Names of elements and attributes changed over the years;
// all that its example files have are read.

#include "viewer/displays/import_common.h"
#include "viewer/displays/sgct_config.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <set>
#include <tinyxml2.h>

namespace viewer {
namespace {

using tinyxml2::XMLElement;

struct SgctXml {
    std::string file;
    ImportLog log;

    gi::TextLocation at(XMLElement const& e) const { return {file, e.GetLineNum(), 0}; }
    void lose(XMLElement const& e, std::string const& what) const
    {
        log.lose("SGCT " + what.substr(0, 64) + ": not imported", 1, text_at(at(e)));
    }
    void lose_others(XMLElement const& e, std::set<std::string> const& attributes,
                     std::set<std::string> const& children) const
    {
        for (auto const* a = e.FirstAttribute(); a; a = a->Next())
            if (!attributes.contains(a->Name())) lose(e, std::string(e.Name()) + "." + a->Name());
        for (XMLElement const* c = e.FirstChildElement(); c; c = c->NextSiblingElement())
            if (!children.contains(c->Name())) lose(*c, std::string(e.Name()) + " <" + c->Name() + ">");
    }
    double number(XMLElement const& e, char const* name) const
    {
        double value = 0;
        if (e.QueryDoubleAttribute(name, &value) != tinyxml2::XML_SUCCESS || !(std::abs(value) < 1e12))
            throw gi::InputError(at(e), fmt::format("{} of <{}> is missing or no number", name, e.Name()),
                                 "SGCT requires it", fmt::format("{}=\"1.0\"", name));
        return value;
    }
    double number_or(XMLElement const& e, std::initializer_list<char const*> names, double otherwise) const
    {
        for (char const* name : names)
            if (e.Attribute(name)) return number(e, name);
        return otherwise;
    }
    bool flag(XMLElement const& e, std::initializer_list<char const*> names, bool otherwise = false) const
    {
        for (char const* name : names)
            if (char const* value = e.Attribute(name)) return std::strcmp(value, "true") == 0 || value[0] == '1';
        return otherwise;
    }
    gi::dvec3 point(XMLElement const& e) const { return {number(e, "x"), number(e, "y"), number(e, "z")}; }
};

std::string word(XMLElement const& e, char const* name)
{
    char const* const value = e.Attribute(name);
    return value ? value : "";
}

WallCorners xml_plane(XMLElement const& e, SgctXml const& x)
{
    std::vector<gi::dvec3> corners;
    for (XMLElement const* p = e.FirstChildElement("Pos"); p; p = p->NextSiblingElement("Pos"))
        corners.push_back(x.point(*p));
    if (corners.size() != 3)
        throw gi::InputError(x.at(e), fmt::format("<{}> has {} corners", e.Name(), corners.size()),
                             "a plane has its lower left, upper left and upper right corner",
                             "write three <Pos/>");
    return {corners[0], corners[0] + corners[2] - corners[1], corners[1]};
}

WallCorners xml_planar(XMLElement const& e, SgctXml const& x)
{
    x.lose_others(e, {}, {"FOV", "Orientation", "Offset"});
    XMLElement const *const fov = e.FirstChildElement("FOV"), *const turn = e.FirstChildElement("Orientation"),
                            *const offset = e.FirstChildElement("Offset");
    if (!fov)
        throw gi::InputError(x.at(e), "<FOV> is missing", "SGCT requires it",
                             "<FOV down=\"25\" left=\"35\" right=\"35\" up=\"25\"/>");
    double const across = x.number_or(*fov, {"hFov", "hfov"}, 0) / 2,
                 upward = x.number_or(*fov, {"vFov", "vfov"}, 0) / 2;
    SgctPlanar p{x.number_or(*fov, {"left"}, across),
                 x.number_or(*fov, {"right"}, across),
                 x.number_or(*fov, {"up"}, upward),
                 x.number_or(*fov, {"down"}, upward),
                 x.number_or(*fov, {"distance"}, 10),
                 {1, 0, 0, 0},
                 gi::dvec3{0}};
    if (turn)
        p.turn = sgct_turn(x.number_or(*turn, {"heading", "yaw", "azimuth"}, -x.number_or(*turn, {"y"}, 0)),
                           x.number_or(*turn, {"pitch", "elevation", "x"}, 0),
                           x.number_or(*turn, {"roll", "bank"}, -x.number_or(*turn, {"z"}, 0)));
    if (offset) p.offset_m = x.point(*offset);
    return corners_of(p);
}

/// None if the element is no projection.
std::optional<SgctProjection> xml_projection(XMLElement const& e, SgctXml const& x)
{
    std::string const kind = e.Name();
    SgctProjection p;
    p.name = kind;
    p.at = x.at(e);
    p.kind = SgctProjectionKind::plane;
    if (kind == "Projectionplane" || kind == "Viewplane") {
        p.corners = xml_plane(e, x);
    } else if (kind == "PlanarProjection") {
        p.corners = xml_planar(e, x);
    } else if (kind == "FisheyeProjection" || kind == "Fisheye") {
        x.lose_others(e, {"fov", "tilt", "diameter", "keepAspectRatio"}, {"Crop", "Offset"});
        p.kind = SgctProjectionKind::fisheye;
        p.fov_deg = x.number_or(e, {"fov"}, p.fov_deg);
        p.tilt_deg = x.number_or(e, {"tilt"}, p.tilt_deg);
        p.diameter_m = x.number_or(e, {"diameter"}, p.diameter_m);
        p.keeps_aspect = x.flag(e, {"keepAspectRatio"}, true);
        if (XMLElement const* offset = e.FirstChildElement("Offset")) p.offset = x.point(*offset);
        if (XMLElement const* crop = e.FirstChildElement("Crop")) {
            std::size_t i = 0;
            for (char const* side : {"left", "right", "bottom", "top"})
                p.crop[i++] = std::clamp(x.number_or(*crop, {side}, 0), 0.0, 0.499);
        }
    } else if (kind == "CylindricalProjection") {
        x.lose_others(e, {"rotation", "heightOffset", "radius"}, {});
        p.kind = SgctProjectionKind::cylindrical;
        p.rotation_deg = x.number_or(e, {"rotation"}, 0);
        p.height_offset = x.number_or(e, {"heightOffset"}, 0);
        p.radius_m = x.number_or(e, {"radius"}, p.radius_m);
    } else if (kind == "EquirectangularProjection") {
        x.lose_others(e, {}, {});
        p.kind = SgctProjectionKind::equirectangular;
    } else if (kind == "SphericalMirrorProjection") {
        x.lose_others(e, {"tilt"}, {"Geometry"});
        p.kind = SgctProjectionKind::spherical_mirror;
        p.tilt_deg = x.number_or(e, {"tilt"}, 0);
        XMLElement const* const geometry = e.FirstChildElement("Geometry");
        if (!geometry)
            throw gi::InputError(x.at(e), "<Geometry> is missing", "it names the meshes of the mirror",
                                 "<Geometry bottom=\"...\" left=\"...\" right=\"...\" top=\"...\"/>");
        std::size_t i = 0;
        for (char const* face : {"bottom", "left", "right", "top"}) p.meshes[i++] = word(*geometry, face);
    } else if (kind.ends_with("Projection")) {
        p.kind = SgctProjectionKind::other;
    } else
        return {};
    return p;
}

SgctViewport xml_viewport(XMLElement const& e, SgctXml const& x)
{
    SgctViewport v;
    v.at = x.at(e);
    x.lose_others(e, {"eye", "mesh", "user"},
                  {"Pos", "Size", "Projectionplane", "Viewplane", "PlanarProjection", "FisheyeProjection",
                   "CylindricalProjection", "EquirectangularProjection", "SphericalMirrorProjection",
                   "SpoutOutputProjection", "CubemapProjection", "TextureMappedProjection"});
    std::string const eye = word(e, "eye");
    v.eye = eye == "left" ? Eye::left : eye == "right" ? Eye::right : Eye::middle;
    v.mesh = word(e, "mesh");
    if (e.Attribute("user")) v.user = word(e, "user");
    if (XMLElement const* pos = e.FirstChildElement("Pos")) {
        v.x = x.number(*pos, "x");
        v.y = x.number(*pos, "y");
    }
    if (XMLElement const* size = e.FirstChildElement("Size")) {
        v.width = x.number(*size, "x");
        v.height = x.number(*size, "y");
    }
    for (XMLElement const* c = e.FirstChildElement(); c; c = c->NextSiblingElement())
        if (auto const p = xml_projection(*c, x)) v.projection = *p;
    return v;
}

SgctWindow xml_window(XMLElement const& e, SgctXml const& x)
{
    SgctWindow w;
    w.at = x.at(e);
    x.lose_others(e, {"fullScreen", "fullscreen", "name", "border", "decorated", "monitor", "mpcdi"},
                  {"Stereo", "Size", "Pos", "Res", "Viewport", "Fisheye"});
    w.window.name = e.Attribute("name") ? word(e, "name") : "window";
    w.window.fullscreen = x.flag(e, {"fullScreen", "fullscreen"});
    w.window.borders = x.flag(e, {"border", "decorated"}, true);
    if (e.Attribute("monitor")) w.window.monitor = int(std::clamp(x.number(e, "monitor"), -1.0, 255.0));
    auto const pixels = [&](XMLElement const& of, char const* name) {
        return int(std::clamp(x.number(of, name), -1e6, 1e6));
    };
    if (XMLElement const* size = e.FirstChildElement("Size")) {
        w.window.width_px = pixels(*size, "x");
        w.window.height_px = pixels(*size, "y");
    } else {
        w.window.width_px = 1920;
        w.window.height_px = 1080;
        x.log.lose("windows whose size the file does not tell, taken as 1920 x 1080", 1, text_at(w.at));
    }
    if (XMLElement const* pos = e.FirstChildElement("Pos")) {
        w.window.x_px = pixels(*pos, "x");
        w.window.y_px = pixels(*pos, "y");
    }
    if (XMLElement const* stereo = e.FirstChildElement("Stereo")) w.stereo = word(*stereo, "type");
    w.picture_aspect = double(w.window.width_px) / std::max(1, w.window.height_px);
    if (XMLElement const* res = e.FirstChildElement("Res")) {
        w.picture_aspect = x.number(*res, "x") / std::max(1.0, x.number(*res, "y"));
        lose_resolution(w, pixels(*res, "x"), pixels(*res, "y"), x.at(*res), x.log);
    }
    for (XMLElement const* v = e.FirstChildElement("Viewport"); v; v = v->NextSiblingElement("Viewport"))
        w.viewports.push_back(xml_viewport(*v, x));
    if (e.Attribute("mpcdi"))
        x.log.lose("SGCT windows with MPCDI, which is not supported, skipped", 1, text_at(w.at));
    if (XMLElement const* fisheye = e.FirstChildElement("Fisheye")) {
        if (w.viewports.empty()) w.viewports.push_back({});
        for (SgctViewport& v : w.viewports) v.projection = *xml_projection(*fisheye, x);
    }
    return w;
}

void xml_scene(XMLElement const& e, SgctConfig& config, SgctXml const& x)
{
    x.lose_others(e, {}, {"Offset", "Orientation", "Scale"});
    XMLElement const *const offset = e.FirstChildElement("Offset"),
                            *const turn = e.FirstChildElement("Orientation"),
                            *const scale = e.FirstChildElement("Scale");
    double const yaw = turn ? x.number_or(*turn, {"yaw", "heading", "azimuth"}, 0) : 0;
    double const pitch = turn ? x.number_or(*turn, {"pitch", "elevation", "w"}, 0) : 0;
    config.world =
        world_of_scene(offset ? x.point(*offset) : gi::dvec3{0}, yaw, pitch,
                       turn ? x.number_or(*turn, {"roll", "bank"}, 0) : 0, scale ? x.number(*scale, "value") : 1);
    if (!config.world)
        x.log.lose("SGCT scene that is tilted or scaled: not imported, only offsets and yaw are", 1,
                   text_at(x.at(e)));
}

} // namespace

Display parse_sgct_xml(std::string const& text, std::string const& name, ImportLog log)
{
    tinyxml2::XMLDocument document;
    if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
        throw gi::InputError({name, document.ErrorLineNum(), 0}, "this is not XML",
                             tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID()), "check the brackets");
    XMLElement const* const root = document.FirstChildElement("Cluster");
    if (!root)
        throw gi::InputError(
            {name, 1, 1}, "there is no element <Cluster>", "configurations of SGCT have one",
            "of XML files, those of SGCT (<Cluster>) and MPCDI (<MPCDI>) are read; calibration programs such as "
            "domeprojection's export MPCDI");
    SgctXml const x{name, log};
    SgctConfig config;
    lose_address(word(*root, "masterAddress"), text_at(x.at(*root)), x.log);
    x.lose_others(*root, {"masterAddress", "externalControlPort"}, {"Node", "User", "Scene"});
    for (XMLElement const* e = root->FirstChildElement(); e; e = e->NextSiblingElement()) {
        std::string const kind = e->Name();
        if (kind == "User") {
            x.lose_others(*e, {"eyeSeparation", "name"}, {"Pos"});
            SgctUser user;
            user.at = x.at(*e);
            user.name = e->Attribute("name") ? word(*e, "name") : "default";
            user.eyes_m = x.number_or(*e, {"eyeSeparation"}, user.eyes_m);
            if (XMLElement const* pos = e->FirstChildElement("Pos")) user.position_m = x.point(*pos);
            config.users.push_back(user);
        } else if (kind == "Scene") {
            xml_scene(*e, config, x);
        } else if (kind == "Node") {
            x.lose_others(*e, {"address", "ip", "port", "syncPort", "dataTransferPort", "swapLock"}, {"Window"});
            for (char const* address : {"address", "ip"})
                lose_address(word(*e, address), text_at(x.at(*e)), x.log);
            config.nodes.emplace_back();
            for (XMLElement const* w = e->FirstChildElement("Window"); w; w = w->NextSiblingElement("Window")) {
                config.nodes.back().push_back(xml_window(*w, x));
                DisplayWindow& window = config.nodes.back().back().window;
                if (x.flag(*e, {"swapLock"})) window.swap_group = window.swap_barrier = 1;
            }
        }
    }
    return display_of(config, name, log);
}

} // namespace viewer
