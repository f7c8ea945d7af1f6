#include "viewer/protocol/recording/export_csv.h"

#include "gi/core/file.h"
#include "viewer/protocol/json_text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>

namespace viewer {
namespace {

struct CsvColumn {
    std::string name, meaning;
};

struct Place {
    gi::dvec3 position;
    gi::dquat rotation;
    double scale = 1;
};

Place place_of(gi::dmat4 const& m)
{
    glm::dmat3 axes(m);
    double const scale = std::cbrt(std::abs(glm::determinant(axes)));
    for (int i = 0; i < 3; ++i) axes[i] = glm::normalize(axes[i]);
    return {gi::dvec3(m[3]), glm::normalize(glm::quat_cast(axes)), scale};
}

void add_place(std::vector<CsvColumn>& to, std::string const& prefix, std::string const& meaning)
{
    for (char const* axis : {"x", "y", "z"}) to.push_back({prefix + axis + "_m", meaning + ": position, m"});
    for (char const* part : {"qx", "qy", "qz", "qw"})
        to.push_back({prefix + part, meaning + ": rotation, unit quaternion"});
}

struct Most {
    std::size_t others = 0, views = 0;
};

std::vector<CsvColumn> columns(Most const& most)
{
    std::vector<CsvColumn> c{{"frame", "number of the frame"},
                             {"pose_s", "s, when the poses were measured; the session's clock starts at 0"},
                             {"display_s", "s, expected display time of the frame"},
                             {"scene_s", "s, time of the scene's animations"},
                             {"paths", "paths per pixel of the pictures of light"},
                             {"light_scale", "side of the pictures of light over that of the views"},
                             {"surface_scale", "side of the pictures of surfaces over that of the views"},
                             {"only_light", "1 = surfaces were drawn by OpenGL, the picture is of light alone; else 0"},
                             {"pixel_hash", "XXH64 of the pixels, hexadecimal; empty = not recorded"},
                             {"swap_s", "s, when the frame was shown; empty = not measured"},
                             {"render_ms", "ms of rendering; empty = not measured"},
                             {"changes", "values set since the previous frame, JSON: [[key, value], ...]"}};
    add_place(c, "room_", "the room in the world");
    c.push_back({"room_scale", "m of the world per m of the room"});
    for (char const* body : kBodyNames)
        add_place(c, std::string(body) + "_", std::string(body) + " in the room (empty = not tracked)");
    for (std::size_t u = 2; u < most.others + 2; ++u)
        for (char const* body : kBodyNames)
            add_place(c, fmt::format("user{}_{}_", u, body),
                      fmt::format("user {}: {} in the room (empty = not tracked)", u, body));
    for (std::size_t i = 0; i < most.views; ++i) {
        std::string const view = fmt::format("view{}_", i), of = fmt::format("view {}", i);
        c.push_back({view + "name", of + ": name"});
        c.push_back({view + "width_px", of + ": pixels"});
        c.push_back({view + "height_px", of + ": pixels"});
        for (char const* side : {"x", "y"})
            c.push_back({view + "margin_" + side + "_px", of + ": pixels asked for beyond each edge"});
        add_place(c, view, of + ", pose of its camera in the world; the camera looks along -Z");
        c.push_back({view + "projection", of + ": perspective or orthographic"});
        for (char const* edge : {"left", "right", "bottom", "top"})
            c.push_back({view + edge, of + ": edge, tangent of the angle to the axis; orthographic: m"});
    }
    return c;
}

std::string quoted(std::string const& text)
{
    if (text.find_first_of(",\"\r\n#") == std::string::npos) return text;
    std::string out = "\"";
    for (char const ch : text) out += ch == '"' ? std::string("\"\"") : std::string(1, ch);
    return out + "\"";
}

class Row {
public:
    void add(std::string const& text) { text_ += (text_.empty() ? "" : ",") + quoted(text); }
    void add(double v) { add(fmt::format("{}", v)); }
    void add_empty(int count) { text_.append(std::size_t(count), ','); }
    void add(gi::dvec3 const& p, gi::dquat const& q)
    {
        for (double const v : {p.x, p.y, p.z, q.x, q.y, q.z, q.w}) add(v);
    }
    std::string const& text() const { return text_; }

private:
    std::string text_;
};

void add_view(Row& row, ViewCommand const& v)
{
    gi::Camera const& c = v.camera;
    row.add(v.name);
    row.add(v.width);
    row.add(v.height);
    row.add(v.margin_x);
    row.add(v.margin_y);
    Place const place = place_of(c.world_from_camera);
    row.add(place.position, place.rotation);
    row.add(std::string(c.orthographic ? "orthographic" : "perspective"));
    gi::ViewTangents const edges = gi::view_edges(c, v.width, v.height);
    for (double const e : {edges.left, edges.right, edges.bottom, edges.top}) row.add(e);
}

void add_tracked(Row& row, Tracked const& tracked)
{
    for (auto const body : kBodyMembers)
        if (auto const& pose = tracked.*body)
            row.add(pose->position, pose->rotation);
        else
            row.add_empty(7);
}

std::string row_of(RecordedFrame const& f, Most const& most)
{
    FrameCommand const& o = f.command;
    Row row;
    row.add(std::to_string(o.frame));
    for (double const t : {o.pose_s, o.display_s, o.scene_s}) row.add(t);
    row.add(o.paths);
    row.add(o.light_scale);
    row.add(o.surface_scale);
    row.add(int(o.only_light));
    row.add(f.pixel_hash ? fmt::format("{:016x}", *f.pixel_hash) : "");
    row.add(f.times ? fmt::format("{}", f.times->swap_s) : "");
    row.add(f.times ? fmt::format("{}", f.times->render_ms) : "");
    nlohmann::ordered_json changes = nlohmann::ordered_json::array();
    for (Change const& c : o.changes) changes.push_back({c.key, c.value});
    row.add(json_line(changes));
    Place const room = place_of(o.world_from_room);
    row.add(room.position, room.rotation);
    row.add(room.scale);
    add_tracked(row, o.tracked);
    for (std::size_t i = 0; i < most.others; ++i) add_tracked(row, i < o.others.size() ? o.others[i] : Tracked{});
    for (ViewCommand const& v : o.views) add_view(row, v);
    row.add_empty(int(most.views - o.views.size()) * 17);
    return row.text();
}

} // namespace

RecordingEnd export_csv(RecordingReader& recording, std::filesystem::path const& file)
{
    Most most;
    recording.rewind();
    while (auto const frame = recording.next())
        most = {std::max(most.others, frame->command.others.size()),
                std::max(most.views, frame->command.views.size())};
    recording.rewind();

    gi::write_by_rename(file, [&](std::filesystem::path const& temporary) {
        std::ofstream out(temporary, std::ios::binary);
        out.exceptions(std::ios::failbit | std::ios::badbit);
        RecordingHeader const& h = recording.header();
        nlohmann::ordered_json const about{
            {"recording", recording.name()},  {"program", h.program}, {"scene", h.scene},
            {"command_line", h.command_line}, {"created", h.created}, {"settings", h.settings}};
        for (auto const& [key, value] : about.items()) out << "# " << key << ": " << json_line(value) << "\n";
        std::string names;
        for (CsvColumn const& c : columns(most)) {
            out << "# " << c.name << " - " << c.meaning << "\n";
            names += (names.empty() ? "" : ",") + c.name;
        }
        out << names << "\n";
        while (auto const frame = recording.next()) out << row_of(*frame, most) << "\n";
        out.flush();
    });
    return recording.end();
}

} // namespace viewer
