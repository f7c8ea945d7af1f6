// ParaView's display configuration (vtkDisplayConfiguration): one Machine element per process. Walls have
// LowerLeft, LowerRight and UpperRight; files from before version 5 have UpperLeft instead of UpperRight.

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
    gi::Report& report;

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
    if (!good)
        throw c.error(e, fmt::format("{} of a Machine is not three numbers", name), "a corner is a point",
                      fmt::format("{}=\"-1 -1 -1\"", name));
    return v;
}

std::string attribute(XMLElement const& e, char const* name)
{
    char const* const value = e.Attribute(name);
    return value ? value : "";
}

void lose_others(XMLElement const& e, std::set<std::string> const& known, PvxContext& c)
{
    for (auto const* a = e.FirstAttribute(); a; a = a->Next())
        if (!known.contains(a->Name()))
            c.report.lose(fmt::format("ParaView {}.{}: not imported", std::string(e.Name()).substr(0, 64),
                                      std::string(a->Name()).substr(0, 64)),
                          1, fmt::format("{}:{}", c.file, e.GetLineNum()));
}

StereoMode stereo_of(std::string const& name, XMLElement const& e, PvxContext& c)
{
    if (name.empty() || name == "None") return StereoMode::off;
    if (name == "Crystal Eyes") return StereoMode::quad_buffer;
    if (name == "Anaglyph" || name == "Red-Blue") return StereoMode::anaglyph_red_cyan;
    if (name == "Interlaced") return StereoMode::rows;
    if (name == "Checkerboard") return StereoMode::checkerboard;
    if (name == "SplitViewportHorizontal") return StereoMode::side_by_side;
    c.report.lose("ParaView stereo type '" + name.substr(0, 64) + "': shown without stereo", 1,
                  fmt::format("{}:{}", c.file, e.GetLineNum()));
    return StereoMode::off;
}

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

void read_machine(XMLElement const& m, int rank, bool default_fullscreen, PvxContext& c)
{
    lose_others(m,
                {"Name", "Geometry", "FullScreen", "ShowBorders", "LowerLeft", "LowerRight", "UpperLeft",
                 "UpperRight", "StereoType", "ViewerId"},
                c);
    std::string const where = fmt::format("{}:{}", c.file, m.GetLineNum());
    if (!m.Attribute("LowerLeft")) {
        c.report.lose("ParaView machines without corners skipped", 1, where);
        return;
    }
    std::string const name = attribute(m, "Name");
    DisplayWindow window;
    window.name = free_name(c.display.windows, name.empty() ? "machine" : name);
    window.fullscreen = m.Attribute("FullScreen") ? attribute(m, "FullScreen") == "1" : default_fullscreen;
    if (!m.Attribute("Geometry")) {
        window.width_px = 1920;
        window.height_px = 1080;
        c.report.lose("windows whose size the file does not tell, taken as 1920 x 1080", 1, where);
    } else if (!read_geometry(attribute(m, "Geometry"), window))
        throw c.error(m, "Geometry '" + attribute(m, "Geometry").substr(0, 64) + "' is no place of a window",
                      "it gives no size of the window", "Geometry=\"640x360+60+1200\"");
    Wall wall;
    wall.name = free_name(c.display.walls, window.name);
    gi::dvec3 const ll = point(m, "LowerLeft", c), lr = point(m, "LowerRight", c);
    wall.corners = {ll, lr,
                    m.Attribute("UpperLeft") ? point(m, "UpperLeft", c) : ll + point(m, "UpperRight", c) - lr};
    wall.window = int(c.display.windows.size());
    wall.stereo = stereo_of(attribute(m, "StereoType"), m, c);
    wall.rank = rank;
    if (m.Attribute("ViewerId"))
        c.report.lose("ParaView Machine.ViewerId: all walls serve the first user", 1, where);
    c.display.windows.push_back(window);
    c.display.walls.push_back(wall);
}

/// The first value of this name below the element.
char const* setting(XMLElement const& e, char const* name)
{
    XMLElement const* const child = e.FirstChildElement(name);
    return child ? child->Attribute("Value") : nullptr;
}

} // namespace

Display parse_pvx(std::string const& text, std::string const& name, gi::Report& report)
{
    tinyxml2::XMLDocument document;
    if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
        throw gi::InputError({name, document.ErrorLineNum(), 0}, "this is not XML",
                             tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID()), "check the brackets");
    XMLElement const* const root = document.FirstChildElement("pvx");
    PvxContext c{{}, name, report};
    if (!root)
        throw gi::InputError({name, 1, 1}, "there is no element <pvx>", "configurations of ParaView have one",
                             "is this a file of ParaView?");
    User user;
    user.name = "viewer";
    int rank = 0;
    bool has_eyes = false;
    for (XMLElement const* p = root->FirstChildElement(); p; p = p->NextSiblingElement()) {
        if (std::strcmp(p->Name(), "Process") != 0) {
            report.lose("ParaView <" + std::string(p->Name()).substr(0, 64) + ">: not imported", 1, name);
            continue;
        }
        char const* const fullscreen = setting(*p, "FullScreen");
        for (XMLElement const* e = p->FirstChildElement(); e; e = e->NextSiblingElement()) {
            std::string const kind = e->Name();
            if (kind == "Machine") {
                read_machine(*e, rank++, fullscreen && std::strcmp(fullscreen, "1") == 0, c);
            } else if (kind == "EyeSeparation") {
                char const* at = e->Attribute("Value");
                double metres = 0;
                if (!at || !parse_number(at, metres))
                    throw c.error(*e, "EyeSeparation has no value", "a number is needed", "Value=\"0.065\"");
                user.interpupillary_m = imported_eyes(metres, name, report);
                has_eyes = true;
            } else if (kind != "FullScreen" && kind != "ShowBorders") {
                report.lose("ParaView <" + kind.substr(0, 64) + ">: not imported", 1,
                            fmt::format("{}:{}", name, e->GetLineNum()));
            }
        }
    }
    if (!has_eyes) report.lose("no EyeSeparation in the file: taken as 0.063 m", 1, name);
    c.display.users.push_back(user);
    report.lose("ParaView does not say where the untracked head is: taken as the origin of the room", 1, name);
    return finished(std::move(c.display), name, report);
}

} // namespace viewer
