// VESA MPCDI: read_mpcdi() of calibration.h.

#include "gi/core/text.h"
#include "viewer/displays/calibration.h"
#include "viewer/displays/check.h"
#include "viewer/displays/import_common.h"

#include <array>
#include <fmt/format.h>
#include <optional>
#include <set>
#include <strings.h>
#include <tinyxml2.h>

namespace viewer {
namespace {

using tinyxml2::XMLElement;

constexpr std::size_t kMostXml = std::size_t(1) << 20, kMostMapMember = std::size_t(1) << 30;
constexpr double kAssumedDistance_m = 3, kAssumedHeight_m = 2;

/// Names differ in case between the versions of the standard: xResolution, Xresolution; fileSet, fileset.
bool is_called(char const* name, char const* wanted) { return strcasecmp(name, wanted) == 0; }

XMLElement const* mpcdi_child(XMLElement const& e, char const* name)
{
    for (XMLElement const* c = e.FirstChildElement(); c; c = c->NextSiblingElement())
        if (is_called(c->Name(), name)) return c;
    return nullptr;
}

struct MpcdiReader {
    std::string file;
    CalibrationFiles const& files;
    ImportLog const& log;
    std::string profile;
    XMLElement const* root = nullptr;

    gi::TextLocation at(XMLElement const& e) const { return {file, e.GetLineNum(), 0}; }
    std::string where(XMLElement const& e) const { return fmt::format("{}:{}", file, e.GetLineNum()); }
    void lose(XMLElement const& e, std::string const& what) const
    {
        log.lose("MPCDI " + what.substr(0, 96) + ": not imported", 1, where(e));
    }
    void lose_others(XMLElement const& e, std::initializer_list<char const*> known) const
    {
        auto const is_known = [&](char const* name) {
            return std::ranges::any_of(known, [&](char const* k) { return is_called(name, k); });
        };
        for (auto const* a = e.FirstAttribute(); a; a = a->Next())
            if (!is_known(a->Name())) lose(e, std::string(e.Name()) + "." + a->Name());
        for (XMLElement const* c = e.FirstChildElement(); c; c = c->NextSiblingElement())
            if (!is_known(c->Name())) lose(*c, std::string(e.Name()) + " <" + c->Name() + ">");
    }
    std::optional<std::string> attribute(XMLElement const& e, char const* name) const
    {
        for (auto const* a = e.FirstAttribute(); a; a = a->Next())
            if (is_called(a->Name(), name)) return a->Value();
        return {};
    }
    double number_in(XMLElement const& e, std::string const& what, std::optional<std::string> const& text) const
    {
        std::string plain = text.value_or("");
        std::erase_if(plain, [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '+'; });
        auto const value = gi::parse_finite(plain, 1e9);
        if (!value)
            throw gi::InputError(at(e),
                                 text ? fmt::format("{} of <{}> is '{}'", what, e.Name(), text->substr(0, 64))
                                      : fmt::format("{} of <{}> is missing", what, e.Name()),
                                 "a number is needed", "export the calibration again");
        return *value;
    }
    double number(XMLElement const& e, char const* name) const { return number_in(e, name, attribute(e, name)); }
    double child_number(XMLElement const& e, char const* name) const
    {
        XMLElement const* const c = mpcdi_child(e, name);
        char const* const text = c ? c->GetText() : nullptr;
        return number_in(c ? *c : e, name, text ? std::optional<std::string>(text) : std::nullopt);
    }
    std::string child_text(XMLElement const& e, char const* name) const
    {
        XMLElement const* const c = mpcdi_child(e, name);
        char const* const text = c ? c->GetText() : nullptr;
        std::string plain = text ? text : "";
        std::erase_if(plain, [](char ch) { return ch == '\n' || ch == '\r' || ch == '\t'; });
        plain.erase(0, plain.find_first_not_of(' '));
        plain.erase(plain.find_last_not_of(' ') + 1);
        return plain;
    }
    glm::ivec2 resolution(XMLElement const& e) const
    {
        glm::dvec2 const px{number(e, "xResolution"), number(e, "yResolution")};
        for (int k = 0; k < 2; ++k)
            if (!(px[k] >= 2 && px[k] <= kLargestWindow_px) || px[k] != std::floor(px[k]))
                throw gi::InputError(at(e), fmt::format("a resolution of {:g} x {:g}", px.x, px.y),
                                     fmt::format("projectors have 2 to {} pixels a side", kLargestWindow_px),
                                     "export the calibration again");
        return glm::ivec2(px);
    }
    /// The bytes of the file that an element names.
    std::vector<unsigned char> bytes_of(XMLElement const& e, std::string& path) const
    {
        path = child_text(e, "path");
        if (path.empty() && !e.FirstChildElement() && e.GetText()) path = e.GetText();
        if (path.empty())
            throw gi::InputError(at(e), fmt::format("<{}> names no file", e.Name()), "it has no <path>",
                                 "<path>left.pfm</path>");
        return files.read(path, kMostMapMember, at(e));
    }
};

/// From the coordinates of a calibration to the room's.
struct MpcdiAxes {
    glm::dmat3 room_from_file{1};
    gi::dvec3 position{0}; ///< of the projector, in the room
    bool has_position = false;
};

MpcdiAxes axes_of(XMLElement const& region, MpcdiReader const& r)
{
    MpcdiAxes axes;
    XMLElement const* const frame = mpcdi_child(region, "coordinateFrame");
    if (!frame) return axes;
    auto const vector = [&](std::string const& name) {
        return gi::dvec3{r.child_number(*frame, (name + "x").c_str()),
                         r.child_number(*frame, (name + "y").c_str()),
                         r.child_number(*frame, (name + "z").c_str())};
    };
    gi::dvec3 const right = vector("pitch"), down = vector("yaw"), forward = vector("roll");
    glm::dmat3 const rows = glm::transpose(glm::dmat3(right, -down, -forward));
    if (glm::length(right) + glm::length(down) + glm::length(forward) > 0) { // all 0: not stated
        glm::dmat3 const product = glm::transpose(rows) * rows;
        for (int k = 0; k < 3; ++k)
            if (!(glm::length(product[k] - glm::dmat3(1)[k]) < 1e-3) || !(glm::determinant(rows) > 0))
                throw gi::InputError(r.at(*frame), "axes of a coordinateFrame that are not at right angles",
                                     "yaw points down, pitch to the right and roll forward, each of length 1",
                                     "export the calibration again");
        axes.room_from_file = rows;
    }
    axes.position = axes.room_from_file * vector("pos");
    axes.has_position = true;
    r.lose_others(*frame, {"posx", "posy", "posz", "yawx", "yawy", "yawz", "pitchx", "pitchy", "pitchz", "rollx",
                           "rolly", "rollz"});
    return axes;
}

WallCorners frustum_wall(XMLElement const& frustum, gi::dvec3 eye, MpcdiReader const& r)
{
    r.lose_others(frustum, {"yaw", "pitch", "roll", "leftAngle", "rightAngle", "downAngle", "upAngle"});
    auto const radians = [&](char const* name) { return glm::radians(r.child_number(frustum, name)); };
    gi::dquat const turn = glm::angleAxis(-radians("yaw"), gi::dvec3{0, 1, 0}) *
                           glm::angleAxis(radians("pitch"), gi::dvec3{1, 0, 0}) *
                           glm::angleAxis(-radians("roll"), gi::dvec3{0, 0, 1});
    double const left = radians("leftAngle"), right = radians("rightAngle"), down = radians("downAngle"),
                 up = radians("upAngle"), most = glm::radians(89.9);
    if (!(left < right && down < up) || std::max({-left, right, -down, up}) > most)
        throw gi::InputError(r.at(frustum), "a frustum without area, or of 180 degrees",
                             "left is less than right, down less than up, each within 89.9 degrees",
                             "export the calibration again");
    auto const corner = [&](double x, double y) {
        return eye + turn * (kAssumedDistance_m * gi::dvec3{std::tan(x), std::tan(y), -1});
    };
    return {corner(left, down), corner(right, down), corner(left, up)};
}

/// Length of a geometricUnit, m; 0 for positions in a picture.
double unit_m(XMLElement const& warp, MpcdiReader const& r)
{
    std::string const unit = r.child_text(warp, "geometricUnit");
    if (unit.empty() || is_called(unit.c_str(), "2d")) return 0;
    for (auto const& [name, metres] : {std::pair{"mm", 1e-3},
                                       {"cm", 1e-2},
                                       {"dm", 0.1},
                                       {"m", 1.0},
                                       {"in", 0.0254},
                                       {"ft", 0.3048},
                                       {"yd", 0.9144}})
        if (is_called(unit.c_str(), name)) return metres;
    XMLElement const* const e = mpcdi_child(warp, "geometricUnit");
    throw gi::InputError(r.at(*e), "a geometricUnit '" + unit.substr(0, 64) + "'", "the unit is unknown",
                         "there are: 2d, mm, cm, dm, m, in, ft, yd");
}

std::string const& valid_profile(std::string const& profile, XMLElement const& root, MpcdiReader const& r)
{
    static constexpr std::array kProfiles{"2d", "3d", "a3", "sl"};
    for (char const* known : kProfiles)
        if (profile == known) return profile;
    throw gi::InputError(r.at(root),
                         profile.empty() ? "the profile is missing" : "a profile '" + profile.substr(0, 64) + "'",
                         "it says what the files mean", "there are: 2d, 3d, a3, sl");
}

std::optional<LightMap> light_of(XMLElement const* e, std::string const& what, double usual_gamma,
                                 std::string const& region, MpcdiReader const& r)
{
    if (!e) return {};
    r.lose_others(*e, {"path", "componentDepth", "bitDepth", "gammaEmbedded"}); // depths are those of the file
    LightMap map;
    map.gamma = usual_gamma;
    if (mpcdi_child(*e, "gammaEmbedded"))
        map.gamma = r.child_number(*e, "gammaEmbedded");
    else
        r.log.lose(fmt::format("MPCDI {} without gammaEmbedded: taken as {:g}", e->Name(), usual_gamma), 1,
                   r.where(*e));
    if (!(map.gamma >= 0.1 && map.gamma <= 10))
        throw gi::InputError(r.at(*e), fmt::format("gammaEmbedded of {:g}", map.gamma), "light is value^gamma",
                             "2.2 is usual, 1 is linear");
    std::string path;
    auto bytes = r.bytes_of(*e, path);
    map.light.map = std::make_shared<PixelMap const>(parse_light(bytes, map.gamma, r.files.full_name(path)));
    std::string const ending = gi::lower_extension(path);
    map.light.file =
        r.log.keep_file(region.substr(0, 64) + "_" + what + (ending.empty() ? ".png" : ending), std::move(bytes));
    return map;
}

MapFile positions_of(XMLElement const& e, std::string const& what, std::string const& region, MpcdiReader const& r)
{
    std::string path;
    auto bytes = r.bytes_of(e, path);
    auto map = std::make_shared<PixelMap const>(parse_picture_positions(bytes, r.files.full_name(path)));
    return {r.log.keep_file(region.substr(0, 64) + "_" + what, std::move(bytes)), std::move(map)};
}

/// The eye for which points were measured.
gi::dvec3 eye_of_points(XMLElement const& warp, MpcdiReader const& r)
{
    constexpr double kHead_m = 1.7;
    std::string const origin = r.child_text(warp, "originOf3DData");
    if (is_called(origin.c_str(), "idealEyePoint")) return gi::dvec3{0};
    if (is_called(origin.c_str(), "floorCenter")) {
        r.log.lose("MPCDI originOf3DData floorCenter: the head is taken as 1.7 m above it", 1, r.where(warp));
        return {0, kHead_m, 0};
    }
    r.log.lose("MPCDI originOf3DData " + (origin.empty() ? "missing" : origin.substr(0, 64)) +
                   ": the head is taken as at the origin",
               1, r.where(warp));
    return gi::dvec3{0};
}

void read_points(CalibratedProjector& p, XMLElement const& warp, double metres, MpcdiAxes const& axes,
                 MpcdiReader const& r)
{
    Surface s;
    s.type = SurfaceType::points;
    s.unit_m = metres;
    s.place = placement_of({gi::dvec3{0}, glm::quat_cast(axes.room_from_file)});
    std::string path;
    auto bytes = r.bytes_of(warp, path);
    s.points.map = std::make_shared<PixelMap const>(parse_points(bytes, metres, r.files.full_name(path)));
    s.points.file = r.log.keep_file(p.wall.name.substr(0, 64) + "_points.pfm", std::move(bytes));
    p.wall.surface = std::move(s);
    p.eye_m = eye_of_points(warp, r);
}

/// A part of a flat picture that has no place: profile 2d.
WallCorners flat_part(XMLElement const& region, XMLElement const& buffer, glm::ivec2 region_px,
                      MpcdiReader const& r)
{
    glm::dvec2 const from{r.number(region, "x"), r.number(region, "y")},
        size{r.number(region, "xsize"), r.number(region, "ysize")};
    if (!(from.x >= 0 && from.y >= 0 && size.x > 0 && size.y > 0 && from.x + size.x <= 1 + 1e-6 &&
          from.y + size.y <= 1 + 1e-6))
        throw gi::InputError(r.at(region), "a region that is no part of its buffer", "x, y and sizes are 0 to 1",
                             "export the calibration again");
    glm::dvec2 px = glm::dvec2(region_px) / size;
    if (r.attribute(buffer, "xResolution")) px = r.resolution(buffer);
    double const height = kAssumedHeight_m, width = height * px.x / px.y;
    auto const corner = [&](double u, double v) { // from the upper left
        return gi::dvec3{(u - 0.5) * width, (0.5 - v) * height, -kAssumedDistance_m};
    };
    return {corner(from.x, from.y + size.y), corner(from.x + size.x, from.y + size.y), corner(from.x, from.y)};
}

void read_place_of(CalibratedProjector& p, XMLElement const& region, XMLElement const& buffer,
                   XMLElement const* warp, XMLElement const* distortion, MpcdiReader const& r)
{
    MpcdiAxes const axes = axes_of(region, r);
    double const metres = warp ? unit_m(*warp, r) : 0;
    bool const has_points = r.profile == "a3" || r.profile == "sl";
    if (warp && has_points && metres == 0)
        throw gi::InputError(r.at(*warp), "a geometryWarpFile without a geometricUnit",
                             "profile " + r.profile + " has points in a unit of length",
                             "<geometricUnit>mm</geometricUnit>");
    if (warp && metres > 0) {
        if (distortion) r.lose(*distortion, "distortionMap beside points, which include the lens");
        return read_points(p, *warp, metres, axes, r);
    }
    if (r.profile == "a3")
        throw gi::InputError(r.at(region), "region '" + p.wall.name.substr(0, 64) + "' has no geometryWarpFile",
                             "profile a3 says by it which point each pixel lights",
                             "export the calibration again");
    if (r.profile == "2d") {
        p.wall.corners = flat_part(region, buffer, p.size_px, r);
        r.log.lose("MPCDI profile 2d does not say where the picture is: taken as 2 m high, 3 m before the head", 1,
                   r.where(region));
    } else {
        XMLElement const* const frustum = mpcdi_child(region, "frustum");
        if (!frustum)
            throw gi::InputError(r.at(region), "region '" + p.wall.name.substr(0, 64) + "' has no frustum",
                                 "profile " + r.profile + " says by it where it looks",
                                 "export the calibration again");
        p.eye_m = axes.position;
        p.wall.corners = frustum_wall(*frustum, p.eye_m, r);
        r.log.lose("MPCDI frusta do not say how far away the screen is: taken as 3 m", 1, r.where(*frustum));
    }
    if (warp && distortion) r.lose(*distortion, "distortionMap beside a geometryWarpFile");
    if (warp)
        p.wall.warp_map = positions_of(*warp, "positions.pfm", p.wall.name, r);
    else if (distortion)
        p.wall.warp_map = positions_of(*distortion, "distortion.pfm", p.wall.name, r);
}

/// The files of a region: below <files> of the root, or of the region.
XMLElement const* files_of_region(XMLElement const& region, std::string const& id, MpcdiReader const& r)
{
    for (XMLElement const* const of : {r.root, &region}) {
        XMLElement const* const all = mpcdi_child(*of, "files");
        for (XMLElement const* set = (all ? all : of)->FirstChildElement(); set; set = set->NextSiblingElement())
            if (is_called(set->Name(), "fileset") && r.attribute(*set, "region").value_or(id) == id) return set;
    }
    return nullptr;
}

CalibratedProjector read_region(XMLElement const& region, XMLElement const& buffer, MpcdiReader const& r)
{
    r.lose_others(region, {"id", "xResolution", "yResolution", "x", "y", "xsize", "ysize", "frustum",
                           "coordinateFrame", "files", "fileset", "extensionSet"});
    CalibratedProjector p;
    p.at = r.at(region);
    p.wall.name = r.attribute(region, "id").value_or("");
    if (p.wall.name.empty())
        throw gi::InputError(p.at, "a region without an id", "its files are found by it",
                             "export the calibration again");
    p.size_px = r.resolution(region);
    XMLElement const* const set = files_of_region(region, p.wall.name, r);
    auto const file = [&](char const* name) { return set ? mpcdi_child(*set, name) : nullptr; };
    XMLElement const *const warp = file("geometryWarpFile"), *const alpha = file("alphaMap"),
                            *const beta = file("betaMap");
    if (set) r.lose_others(*set, {"region", "geometryWarpFile", "alphaMap", "betaMap", "distortionMap"});
    if (warp) {
        r.lose_others(*warp, {"path", "interpolation", "geometricUnit", "originOf3DData", "componentDepth"});
        std::string const way = r.child_text(*warp, "interpolation");
        if (!way.empty() && !is_called(way.c_str(), "linear"))
            r.log.lose("MPCDI interpolation " + way.substr(0, 64) + ": taken as linear", 1, r.where(*warp));
    } else if (r.profile != "sl")
        r.log.lose("MPCDI regions without a geometryWarpFile: taken as not warped", 1, r.where(region));
    read_place_of(p, region, buffer, warp, file("distortionMap"), r);
    p.wall.blend_picture = light_of(alpha, "blend", 1, p.wall.name, r);
    p.wall.black_level_picture =
        light_of(beta, "black_level", p.wall.blend_picture ? p.wall.blend_picture->gamma : 1, p.wall.name, r);
    return p;
}

} // namespace

std::vector<CalibratedProjector> read_mpcdi(std::string const& xml, std::string const& name,
                                            CalibrationFiles const& files, ImportLog const& log,
                                            std::string const& only)
{
    tinyxml2::XMLDocument document;
    if (document.Parse(xml.data(), xml.size()) != tinyxml2::XML_SUCCESS)
        throw gi::InputError({name, document.ErrorLineNum(), 0}, "this is not XML",
                             tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID()), "check the brackets");
    XMLElement const* const root = document.RootElement();
    if (!root || !is_called(root->Name(), "MPCDI"))
        throw gi::InputError({name, 1, 1}, "there is no element <MPCDI>", "calibrations of MPCDI have one",
                             "is this a file of MPCDI?");
    MpcdiReader r{name, files, log, {}, root};
    r.profile = valid_profile(r.attribute(*root, "profile").value_or(""), *root, r);
    std::string const version = r.attribute(*root, "version").value_or("");
    if (version != "1.0" && version != "2.0")
        log.lose("MPCDI version '" + version.substr(0, 64) + "': read as 2.0", 1, r.where(*root));
    r.lose_others(*root, {"profile", "version", "level", "geometry", "color", "date", "display", "files"});
    XMLElement const* const display = mpcdi_child(*root, "display");
    std::vector<CalibratedProjector> projectors;
    std::set<std::string> ids;
    for (XMLElement const* b = display ? display->FirstChildElement() : nullptr; b; b = b->NextSiblingElement()) {
        if (!is_called(b->Name(), "buffer")) {
            r.lose(*b, std::string("<") + b->Name() + ">");
            continue;
        }
        r.lose_others(*b, {"id", "xResolution", "yResolution", "region"});
        for (XMLElement const* e = b->FirstChildElement(); e; e = e->NextSiblingElement()) {
            if (!is_called(e->Name(), "region")) continue;
            if (!only.empty() && r.attribute(*e, "id").value_or("") != only) continue;
            if (projectors.size() == kMostWalls)
                throw gi::InputError(r.at(*e), fmt::format("more than {} regions", kMostWalls),
                                     "no room has so many", "is it one display?");
            projectors.push_back(read_region(*e, *b, r));
            if (!ids.insert(projectors.back().wall.name).second)
                throw gi::InputError(r.at(*e), "two regions '" + projectors.back().wall.name.substr(0, 64) + "'",
                                     "files belong to a region by its id", "rename one");
        }
    }
    return projectors;
}

std::string mpcdi_text(CalibrationFiles const& archive, std::filesystem::path const& file, std::string& name)
{
    name = (file / "mpcdi.xml").string();
    auto const bytes = archive.read("mpcdi.xml", kMostXml, {file.string(), 0, 0});
    return {bytes.begin(), bytes.end()};
}

} // namespace viewer
