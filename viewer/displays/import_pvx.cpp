// ParaView's display configuration (vtkDisplayConfiguration): one Machine element per process,
// in <pvx> or in its <Process Type="server"> (otherwise the last Process), as ParaView chooses. Walls have
// LowerLeft, LowerRight and UpperRight; files from before version 5 have UpperLeft instead of UpperRight.
// Viewers are distinguished by ViewerId.

#include "viewer/displays/import.h"
#include "viewer/displays/import_common.h"

#include <charconv>
#include <cstring>
#include <fmt/format.h>
#include <set>
#include <tinyxml2.h>

namespace viewer {
namespace {

using tinyxml2::XMLElement;

struct PvxContext {
    Display display;
    std::string file;
    ImportLog log;
    std::vector<double> eyes_m; ///< of each viewer

    gi::InputError error(XMLElement const& at, std::string const& problem, std::string const& why,
                         std::string const& suggestion) const
    {
        return {{file, at.GetLineNum(), 0}, problem, why, suggestion};
    }
};

bool parse_number(char const*& at, double& value)
{
    while (*at == ' ' || *at == '\t' || *at == '\n' || *at == '\r') ++at;
    if (*at == '+') ++at;
    auto const [end, failure] = std::from_chars(at, at + std::strlen(at), value);
    at = end;
    return failure == std::errc{};
}

gi::dvec3 point(XMLElement const& e, char const* name, PvxContext const& c)
{
    char const* at = e.Attribute(name);
    gi::dvec3 v{0};
    bool good = at != nullptr;
    for (int i = 0; i < 3 && good; ++i) good = parse_number(at, v[i]);
    if (good) good = std::string(at).find_first_not_of(" \t\n\r") == std::string::npos;
    if (!good) {
        char const* const text = e.Attribute(name);
        throw c.error(e,
                      text ? fmt::format("{}=\"{}\" of a Machine is not three numbers", name,
                                         std::string(text).substr(0, 64))
                           : fmt::format("a Machine has no {}", name),
                      "a corner is a point", fmt::format("{}=\"-1 -1 -1\"", name));
    }
    return v;
}

std::string attribute(XMLElement const& e, char const* name)
{
    char const* const value = e.Attribute(name);
    return value ? value : "";
}

std::string where(XMLElement const& e, PvxContext const& c)
{
    return fmt::format("{}:{}", c.file, e.GetLineNum());
}

void lose_others(XMLElement const& e, std::set<std::string> const& known, PvxContext const& c)
{
    for (auto const* a = e.FirstAttribute(); a; a = a->Next())
        if (!known.contains(a->Name()))
            c.log.lose(fmt::format("ParaView {}.{}: not imported", std::string(e.Name()).substr(0, 64),
                                   std::string(a->Name()).substr(0, 64)),
                       1, where(e, c));
}

void lose(XMLElement const& e, PvxContext const& c)
{
    c.log.lose("ParaView <" + std::string(e.Name()).substr(0, 64) + ">: not imported", 1, where(e, c));
}

void read_stereo(std::string const& name, Wall& wall, XMLElement const& e, PvxContext const& c)
{
    if (name.empty() || name == "None") return;
    for (auto const& [theirs, mode] : {std::pair{"Crystal Eyes", StereoMode::quad_buffer},
                                       {"Anaglyph", StereoMode::anaglyph_red_cyan},
                                       {"Red-Blue", StereoMode::anaglyph_red_cyan},
                                       {"Interlaced", StereoMode::rows},
                                       {"Dresden", StereoMode::columns},
                                       {"Checkerboard", StereoMode::checkerboard},
                                       {"SplitViewportHorizontal", StereoMode::side_by_side}})
        if (name == theirs) {
            wall.stereo = mode;
            return;
        }
    if (name == "Left") wall.eye = Eye::left;
    if (name == "Right") wall.eye = Eye::right;
    if (wall.eye == Eye::middle)
        c.log.lose("ParaView stereo type '" + name.substr(0, 64) + "': shown without stereo", 1, where(e, c));
}

bool is_true(char const* value) { return value && std::strchr("1tTyY", value[0]) && value[0]; }

/// "640x360+60+1200"
bool read_geometry(std::string const& text, DisplayWindow& window)
{
    int width = 0, height = 0, x = 0, y = 0, used = 0;
    if (std::sscanf(text.c_str(), "%6dx%6d%n", &width, &height, &used) != 2) return false;
    if (used < int(text.size()) && std::sscanf(text.c_str() + used, "%7d%7d", &x, &y) != 2) return false;
    window.width_px = width;
    window.height_px = height;
    window.x_px = x;
    window.y_px = y;
    return true;
}

int viewer_of(XMLElement const& m, PvxContext const& c)
{
    char const* const text = m.Attribute("ViewerId");
    if (!text) return 0;
    int id = -1;
    auto const [end, failure] = std::from_chars(text, text + std::strlen(text), id);
    if (failure != std::errc{} || *end != 0 || id < 0 || id > 99)
        throw c.error(m, fmt::format("ViewerId=\"{}\"", std::string(text).substr(0, 64)),
                      "viewers count from 0 to 99", "ViewerId=\"0\"");
    return id;
}

void read_machine(XMLElement const& m, int rank, bool is_fullscreen, bool has_borders, PvxContext& c)
{
    lose_others(m,
                {"Name", "Geometry", "FullScreen", "ShowBorders", "LowerLeft", "LowerRight", "UpperLeft",
                 "UpperRight", "StereoType", "ViewerId"},
                c);
    std::string const name = attribute(m, "Name");
    if (!m.Attribute("LowerLeft")) {
        c.log.lose("ParaView machine '" + name.substr(0, 64) + "' has no corners (a plain window there), skipped",
                   1, where(m, c));
        return;
    }
    DisplayWindow window;
    window.name = free_name(c.display.windows, name.empty() ? "machine" : name);
    window.fullscreen = m.Attribute("FullScreen") ? is_true(m.Attribute("FullScreen")) : is_fullscreen;
    window.borders = m.Attribute("ShowBorders") ? is_true(m.Attribute("ShowBorders")) : has_borders;
    if (!m.Attribute("Geometry")) {
        window.width_px = 1920;
        window.height_px = 1080;
        c.log.lose("windows whose size the file does not tell, taken as 1920 x 1080", 1, where(m, c));
    } else if (!read_geometry(attribute(m, "Geometry"), window))
        throw c.error(m, "Geometry '" + attribute(m, "Geometry").substr(0, 64) + "' is no place of a window",
                      "it gives no size of the window", "Geometry=\"640x360+60+1200\"");
    Wall wall;
    wall.name = free_name(c.display.walls, window.name);
    gi::dvec3 const ll = point(m, "LowerLeft", c), lr = point(m, "LowerRight", c);
    wall.corners = {ll, lr,
                    m.Attribute("UpperLeft") ? point(m, "UpperLeft", c) : ll + point(m, "UpperRight", c) - lr};
    if (m.Attribute("UpperLeft") && m.Attribute("UpperRight") &&
        glm::length(point(m, "UpperRight", c) - lr + ll - wall.corners.upper_left) > 1e-3)
        c.log.lose("ParaView UpperRight that makes no rectangle with the three other corners: not imported", 1,
                   where(m, c));
    if (auto const fault = find_fault(wall.corners))
        throw c.error(m, "machine '" + name.substr(0, 64) + "': " + fault->problem, fault->why, fault->suggestion);
    wall.window = int(c.display.windows.size());
    read_stereo(attribute(m, "StereoType"), wall, m, c);
    wall.rank = rank;
    wall.user = viewer_of(m, c);
    c.display.windows.push_back(window);
    c.display.walls.push_back(wall);
}

double eyes_of(XMLElement const& e, char const* attribute, PvxContext const& c)
{
    char const* at = e.Attribute(attribute);
    double metres = 0;
    if (!at || !parse_number(at, metres))
        throw c.error(e, std::string(e.Name()) + " has no value of " + attribute, "a number is needed",
                      std::string(attribute) + "=\"0.065\"");
    return imported_eyes(metres, where(e, c), c.log);
}

/// Element with the machines: the first Process of Type "server", otherwise the last one, otherwise the root.
XMLElement const& chosen(XMLElement const& root, PvxContext const& c)
{
    XMLElement const* process = nullptr;
    for (XMLElement const* p = root.FirstChildElement("Process"); p; p = p->NextSiblingElement("Process")) {
        process = p;
        if (attribute(*p, "Type") == "server") break;
    }
    if (!process) return root;
    for (XMLElement const* p = root.FirstChildElement(); p; p = p->NextSiblingElement()) {
        if (p == process) continue;
        if (std::strcmp(p->Name(), "Process") != 0 || p->FirstChildElement())
            c.log.lose("ParaView <" + std::string(p->Name()).substr(0, 64) +
                           "> beside the chosen Process: not imported",
                       1, where(*p, c));
    }
    return *process;
}

/// The value of <name Value=""/> or <Option Name="name" Value=""/> in the element.
char const* setting(XMLElement const& of, char const* name)
{
    for (XMLElement const* e = of.FirstChildElement(); e; e = e->NextSiblingElement())
        if (std::strcmp(e->Name(), name) == 0 ||
            (std::strcmp(e->Name(), "Option") == 0 && attribute(*e, "Name") == name))
            return e->Attribute("Value");
    return nullptr;
}

/// Distances of the eyes of the viewers that have their own.
void read_viewers(XMLElement const& viewers, PvxContext& c)
{
    for (XMLElement const* v = viewers.FirstChildElement(); v; v = v->NextSiblingElement()) {
        int id = -1;
        if (v->QueryIntAttribute("Id", &id) != tinyxml2::XML_SUCCESS || id < 0 || id >= int(c.eyes_m.size())) {
            c.log.lose("ParaView viewers without a machine: not imported", 1, where(*v, c));
            continue;
        }
        lose_others(*v, {"Id", "EyeSeparation"}, c);
        if (v->Attribute("EyeSeparation")) c.eyes_m[std::size_t(id)] = eyes_of(*v, "EyeSeparation", c);
    }
}

void add_users(XMLElement const& at, PvxContext& c)
{
    std::set<int> used;
    for (Wall const& wall : c.display.walls) used.insert(wall.user);
    for (int id = 0; id < int(c.eyes_m.size()); ++id) {
        if (!used.contains(id) && !c.display.walls.empty())
            throw c.error(at, fmt::format("no Machine has ViewerId=\"{}\"", id),
                          "they are 0 to the number of viewers - 1", "count them from 0");
        User user;
        user.name = c.eyes_m.size() == 1 ? "viewer" : fmt::format("viewer {}", id);
        user.interpupillary_m = c.eyes_m[std::size_t(id)];
        c.display.users.push_back(user);
    }
}

void read_settings(XMLElement const& e, PvxContext& c)
{
    std::string const kind = e.Name(), option = kind == "Option" ? attribute(e, "Name") : kind;
    if (kind == "UseOffAxisProjection") {
        if (!is_true(e.Attribute("Value")))
            c.log.lose("ParaView UseOffAxisProjection off: walls are drawn for the eyes all the same", 1,
                       where(e, c));
    } else if (option != "FullScreen" && option != "ShowBorders" && kind != "EyeSeparation" &&
               kind != "IndependentViewers")
        lose(e, c);
}

} // namespace

Display parse_pvx(std::string const& text, std::string const& name, ImportLog log)
{
    tinyxml2::XMLDocument document;
    if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
        throw gi::InputError({name, document.ErrorLineNum(), 0}, "this is not XML",
                             tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID()), "check the brackets");
    XMLElement const* const root = document.FirstChildElement("pvx");
    PvxContext c{{}, name, log, {}};
    if (!root)
        throw gi::InputError({name, 1, 1}, "there is no element <pvx>", "configurations of ParaView have one",
                             "is this a file of ParaView?");
    constexpr double kTheirEyes_m = 0.065;
    XMLElement const& process = chosen(*root, c);
    bool const is_fullscreen = is_true(setting(process, "FullScreen"));
    bool const has_borders = is_true(setting(process, "ShowBorders"));
    int rank = 0, viewers = 1;
    for (XMLElement const* e = process.FirstChildElement(); e; e = e->NextSiblingElement())
        if (std::strcmp(e->Name(), "Machine") == 0) {
            read_machine(*e, rank++, is_fullscreen, has_borders, c);
            viewers = std::max(viewers, viewer_of(*e, c) + 1);
        } else
            read_settings(*e, c);
    double eyes_m = kTheirEyes_m;
    if (XMLElement const* e = process.FirstChildElement("EyeSeparation"))
        eyes_m = eyes_of(*e, "Value", c);
    else
        log.lose("no EyeSeparation in the file: taken as ParaView's 0.065 m", 1, where(process, c));
    c.eyes_m.assign(std::size_t(viewers), eyes_m);
    if (XMLElement const* e = process.FirstChildElement("IndependentViewers")) read_viewers(*e, c);
    add_users(process, c);
    log.lose("ParaView does not say where the untracked head is: taken as the origin of the room", 1, name);
    return finished(std::move(c.display), name, log);
}

} // namespace viewer
