// Equalizer 1.x and the compounds of 0.x. Walls come from segments of canvases, from canvases (a segment shows the
// part given by its viewport), and from compounds with a channel; `projection` is converted to a wall as in
// Equalizer.

#include "viewer/displays/import.h"
#include "viewer/displays/import_common.h"
#include "viewer/displays/text_tree.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <set>

namespace viewer {
namespace {

/// Where a channel draws.
struct Channel {
    int window = 0;
    Viewport viewport;
};

struct EqualizerContext {
    Display display;
    std::string file;
    gi::Report& report;
    std::map<std::string, Channel> channels;
    std::vector<int> rank_of_window;
    std::vector<bool> is_stereo_window;
    bool has_stereo_view = false;

    gi::InputError error(TextNode const& at, std::string const& problem, std::string const& why,
                         std::string const& suggestion) const
    {
        return {{file, at.line, at.column}, problem, why, suggestion};
    }
    void lose(std::string const& what, TextNode const& at)
    {
        report.lose(what, 1, fmt::format("{}:{}:{}", file, at.line, at.column));
    }
    void lose_others(TextNode const& node, std::set<std::string> const& known)
    {
        for (TextNode const& child : node.children)
            if (!known.contains(child.key))
                lose(fmt::format("Equalizer {} {}: not imported", node.key.substr(0, 64), child.key.substr(0, 64)),
                     child);
    }
};

/// Parses the nodes up to the closing brace, or to the end at depth 0.
std::vector<TextNode> read_block(std::vector<TextToken> const& tokens, std::size_t& at, int depth,
                                 std::string const& file)
{
    auto const fail = [&](TextToken const& t, std::string const& problem, std::string const& why) {
        return gi::InputError({file, t.line, t.column}, problem, why, "check the brackets");
    };
    std::vector<TextNode> nodes;
    while (at < tokens.size()) {
        TextToken const& key = tokens[at];
        if (key.text == "}" && !key.is_quoted) {
            if (depth == 0) throw fail(key, "a closing brace too many", "nothing is open");
            return nodes;
        }
        if (!key.is_quoted && std::string("{[]()").find(key.text) != std::string::npos)
            throw fail(key, "'" + key.text + "' where a keyword should be", "it follows no keyword");
        TextNode node{key.text, {}, {}, key.line, key.column};
        ++at;
        if (at < tokens.size() && !tokens[at].is_quoted && tokens[at].text == "{") {
            if (depth >= kDeepestBlock) throw fail(key, "blocks nest too deeply", "100 levels are read");
            TextToken const& open = tokens[at++];
            node.children = read_block(tokens, at, depth + 1, file);
            if (at >= tokens.size()) throw fail(open, "a brace is not closed", "the block has no end");
            ++at;
        } else if (at < tokens.size() && !tokens[at].is_quoted &&
                   (tokens[at].text == "[" || tokens[at].text == "(")) {
            TextToken const& open = tokens[at++];
            std::string const close = open.text == "[" ? "]" : ")";
            while (at < tokens.size() && (tokens[at].is_quoted || tokens[at].text != close))
                node.values.push_back(tokens[at++]);
            if (at >= tokens.size()) throw fail(open, "a bracket is not closed", "the list has no end");
            ++at;
        } else if (at < tokens.size() && (tokens[at].is_quoted || tokens[at].text != "}")) {
            node.values.push_back(tokens[at++]);
        }
        nodes.push_back(std::move(node));
    }
    return nodes;
}

/// x, y, width, height from below. Equalizer interprets whole numbers as pixels.
struct Area {
    double x = 0, y = 0, width = 1, height = 1;
    bool in_pixels = false;
};

std::optional<Area> read_area(TextNode const& of, EqualizerContext const& c)
{
    TextNode const* const node = of.find("viewport");
    if (!node) return {};
    auto const v = numbers_of(*node, 4, c.file);
    bool const has_point = std::any_of(node->values.begin(), node->values.end(),
                                       [](TextToken const& t) { return t.text.find('.') != std::string::npos; });
    bool const is_small = std::all_of(v.begin(), v.end(), [](double x) { return x >= 0 && x <= 1; });
    return Area{v[0], v[1], v[2], v[3], !has_point && !is_small};
}

void read_channel(TextNode const& node, int window, EqualizerContext& c)
{
    c.lose_others(node, {"name", "viewport", "attributes"});
    std::string const name = node.text("name");
    if (name.empty()) {
        c.lose("Equalizer channels without a name: nothing can be shown on them", node);
        return;
    }
    DisplayWindow const& w = c.display.windows[std::size_t(window)];
    Area a = read_area(node, c).value_or(Area{});
    if (a.in_pixels)
        a = {a.x / w.width_px, a.y / w.height_px, a.width / w.width_px, a.height / w.height_px, false};
    c.channels[name] = {window, from_below(a.x, a.y, a.width, a.height)};
}

int pixels(double x) { return int(std::lround(std::clamp(x, -1e6, 1e6))); }

void read_window(TextNode const& node, TextNode const& pipe, int rank, EqualizerContext& c)
{
    c.lose_others(node, {"name", "viewport", "channel", "attributes"});
    constexpr int kPipeWidth = 1920, kPipeHeight = 1080;
    DisplayWindow window;
    window.name = free_name(c.display.windows, node.text("name", "window"));
    Area a = read_area(node, c).value_or(Area{});
    double width = kPipeWidth, height = kPipeHeight;
    if (auto const p = read_area(pipe, c); p && p->in_pixels) {
        width = p->width;
        height = p->height;
    } else if (!a.in_pixels)
        c.lose("screens whose size the file does not tell, taken as 1920 x 1080", node);
    if (!a.in_pixels) a = {a.x * width, a.y * height, a.width * width, a.height * height, true};
    window.width_px = pixels(a.width);
    window.height_px = pixels(a.height);
    if (window.width_px < 1 || window.height_px < 1)
        throw c.error(node, "a window without pixels", "nothing could be shown in it",
                      "viewport [ 0 0 1920 1080 ]");
    window.x_px = pixels(a.x);
    window.y_px = pixels(a.y);
    bool is_stereo = false;
    if (TextNode const* attributes = node.find("attributes")) {
        window.fullscreen = attributes->text("hint_fullscreen") == "ON";
        is_stereo = attributes->text("hint_stereo") == "ON";
        c.lose_others(*attributes, {"hint_fullscreen", "hint_stereo"});
    }
    int const index = int(c.display.windows.size());
    c.display.windows.push_back(window);
    c.rank_of_window.push_back(rank);
    c.is_stereo_window.push_back(is_stereo);
    for (TextNode const& child : node.children)
        if (child.key == "channel") read_channel(child, index, c);
}

void read_node(TextNode const& node, int rank, EqualizerContext& c)
{
    c.lose_others(node, {"name", "pipe", "connection", "attributes", "host", "hostname"});
    for (TextNode const& pipe : node.children) {
        if (pipe.key != "pipe") continue;
        c.lose_others(pipe, {"name", "port", "device", "viewport", "window", "attributes"});
        for (TextNode const& window : pipe.children)
            if (window.key == "window") read_window(window, pipe, rank, c);
    }
}

gi::dvec3 corner(TextNode const& wall, char const* key, gi::dvec3 usual, EqualizerContext const& c)
{
    TextNode const* const node = wall.find(key);
    return node ? point_of(*node, c.file) : usual;
}

WallCorners from_projection(TextNode const& p, EqualizerContext const& c)
{
    auto const values = [&](char const* key, std::size_t count, std::vector<double> usual) {
        TextNode const* const node = p.find(key);
        return node ? numbers_of(*node, count, c.file) : usual;
    };
    auto const o = values("origin", 3, {0, 0, 0}), fov = values("fov", 2, {77.3196, 53.1301}),
               hpr = values("hpr", 3, {0, 0, 0});
    double const distance = values("distance", 1, {3})[0];
    auto const half = [&](double degrees) { return std::abs(distance * std::tan(glm::radians(degrees / 2))); };
    double const w = half(fov[0]), h = half(fov[1]);
    double const ch = std::cos(glm::radians(hpr[0])), sh = std::sin(glm::radians(hpr[0]));
    double const cp = std::cos(glm::radians(hpr[1])), sp = std::sin(glm::radians(hpr[1]));
    double const cr = std::cos(glm::radians(hpr[2])), sr = std::sin(glm::radians(hpr[2]));
    // Columns, as in Equalizer's Wall::operator=(Projection); the wall faces the origin along the third.
    gi::dvec3 const x{ch * cr, -ch * sr, -sh};
    gi::dvec3 const y{-sp * sh * cr + cp * sr, sp * sh * sr + cp * cr, -sp * ch};
    gi::dvec3 const z{cp * sh * cr + sp * sr, -cp * sh * sr + sp * cr, cp * ch};
    gi::dvec3 const middle = gi::dvec3{o[0], o[1], o[2]} + distance * z;
    return {middle - w * x - h * y, middle + w * x - h * y, middle - w * x + h * y};
}

/// The wall or projection given by the block itself.
std::optional<WallCorners> stated_wall(TextNode const& node, EqualizerContext& c)
{
    if (TextNode const* wall = node.find("wall")) {
        c.lose_others(*wall, {"bottom_left", "bottom_right", "top_left", "type"});
        if (std::string const type = wall->text("type", "fixed"); type == "HMD") {
            c.lose("Equalizer walls fixed to a head (HMD) skipped", *wall);
            return {};
        }
        return WallCorners{corner(*wall, "bottom_left", {-0.8, -0.5, -1}, c),
                           corner(*wall, "bottom_right", {0.8, -0.5, -1}, c),
                           corner(*wall, "top_left", {-0.8, 0.5, -1}, c)};
    }
    if (TextNode const* p = node.find("projection")) {
        c.lose_others(*p, {"origin", "distance", "fov", "hpr"});
        return from_projection(*p, c);
    }
    return {};
}

WallCorners part_of(WallCorners const& wall, Area const& a)
{
    gi::dvec3 const u = wall.lower_right - wall.lower_left, v = wall.upper_left - wall.lower_left;
    gi::dvec3 const ll = wall.lower_left + a.x * u + a.y * v;
    return {ll, ll + a.width * u, ll + a.height * v};
}

void add_wall(TextNode const& node, WallCorners const& corners, StereoMode stereo, EqualizerContext& c)
{
    std::string const name = node.text("channel");
    auto const channel = c.channels.find(name);
    if (channel == c.channels.end())
        throw c.error(node, "there is no channel '" + name.substr(0, 64) + "'", "a wall needs one to be drawn in",
                      "name the channel of a window");
    Wall wall;
    wall.name = free_name(c.display.walls, node.text("name", name));
    wall.corners = corners;
    wall.window = channel->second.window;
    wall.viewport = channel->second.viewport;
    wall.rank = c.rank_of_window[std::size_t(wall.window)];
    wall.stereo = stereo != StereoMode::off                      ? stereo
                  : c.is_stereo_window[std::size_t(wall.window)] ? StereoMode::quad_buffer
                  : c.has_stereo_view && node.key == "segment"   ? StereoMode::quad_buffer
                                                                 : StereoMode::off;
    c.display.walls.push_back(wall);
}

void read_canvas(TextNode const& canvas, EqualizerContext& c)
{
    c.lose_others(canvas, {"name", "layout", "wall", "projection", "segment"});
    std::optional<WallCorners> const whole = stated_wall(canvas, c);
    for (TextNode const& segment : canvas.children) {
        if (segment.key != "segment") continue;
        c.lose_others(segment, {"name", "channel", "viewport", "wall", "projection"});
        std::optional<WallCorners> corners = stated_wall(segment, c);
        if (!corners && whole && !segment.find("wall"))
            corners = part_of(*whole, read_area(segment, c).value_or(Area{}));
        if (corners)
            add_wall(segment, *corners, StereoMode::off, c);
        else
            c.lose("Equalizer segments without a fixed wall skipped", segment);
    }
}

void read_compound(TextNode const& compound, EqualizerContext& c)
{
    StereoMode stereo = StereoMode::off;
    if (TextNode const* attributes = compound.find("attributes")) {
        std::string const mode = attributes->text("stereo_mode");
        if (mode == "ANAGLYPH") stereo = StereoMode::anaglyph_red_cyan;
        if (mode == "QUAD") stereo = StereoMode::quad_buffer;
        c.lose_others(*attributes, {"stereo_mode"});
    }
    c.lose_others(compound, {"name", "channel", "wall", "projection", "compound", "attributes"});
    if (TextNode const* channel = compound.find("channel"); channel && channel->values.size() == 1)
        if (auto const corners = stated_wall(compound, c)) add_wall(compound, *corners, stereo, c);
    for (TextNode const& child : compound.children)
        if (child.key == "compound") read_compound(child, c);
}

void read_observer(TextNode const& node, double eye_base, EqualizerContext& c)
{
    User user;
    user.name = free_name(c.display.users, node.text("name", "observer"));
    c.lose_others(node, {"name", "eye_left", "eye_right", "eye_cyclop"});
    gi::dvec3 const left = corner(node, "eye_left", {-eye_base / 2, 0, 0}, c);
    gi::dvec3 const right = corner(node, "eye_right", {eye_base / 2, 0, 0}, c);
    user.interpupillary_m = imported_eyes(glm::length(right - left), "observer '" + user.name + "'", c.report);
    user.eye_offset_m = (left + right) * 0.5;
    c.display.users.push_back(user);
}

void read_config(TextNode const& config, double eye_base, EqualizerContext& c)
{
    c.lose_others(config, {"name", "appNode", "node", "observer", "layout", "canvas", "compound", "attributes"});
    if (TextNode const* attributes = config.find("attributes"))
        if (TextNode const* eyes = attributes->find("eye_base")) eye_base = numbers_of(*eyes, 1, c.file)[0];
    int rank = 0;
    for (char const* kind : {"appNode", "node"})
        for (TextNode const& node : config.children)
            if (node.key == kind) read_node(node, rank++, c);
    for (TextNode const& node : config.children) {
        if (node.key == "observer") {
            if (c.display.users.empty())
                read_observer(node, eye_base, c);
            else
                c.lose("Equalizer observers after the first: all walls serve that one", node);
        }
        if (node.key == "layout")
            for (TextNode const& view : node.children)
                if (view.key == "view" && view.text("mode") == "STEREO") c.has_stereo_view = true;
    }
    if (c.display.users.empty()) read_observer({"observer", {}, {}, config.line, config.column}, eye_base, c);
    for (TextNode const& node : config.children) {
        if (node.key == "canvas") read_canvas(node, c);
        if (node.key == "compound") read_compound(node, c);
    }
}

} // namespace

Display parse_equalizer(std::string const& text, std::string const& name, gi::Report& report)
{
    std::vector<TextToken> const tokens = tokens_of(text, "{}[]()", name);
    std::size_t at = 0;
    std::vector<TextNode> const top = read_block(tokens, at, 0, name);
    EqualizerContext c{{}, name, report, {}, {}, {}, false};
    double eye_base = 0.05; // Equalizer's own
    bool has_config = false;
    for (TextNode const& node : top) {
        if (node.key == "global") {
            for (TextNode const& setting : node.children)
                if (setting.key == "EQ_CONFIG_FATTR_EYE_BASE")
                    eye_base = numbers_of(setting, 1, name)[0];
                else
                    c.lose("Equalizer global " + setting.key.substr(0, 64) + ": not imported", setting);
        } else if (node.key == "server") {
            c.lose_others(node, {"config", "connection"});
            for (TextNode const& config : node.children) {
                if (config.key != "config") continue;
                if (has_config) {
                    c.lose("Equalizer configs after the first: not imported", config);
                    continue;
                }
                has_config = true;
                read_config(config, eye_base, c);
            }
        } else {
            c.lose("Equalizer " + node.key.substr(0, 64) + ": not imported", node);
        }
    }
    if (!has_config)
        throw gi::InputError({name, 1, 1}, "there is no config within server { }",
                             "configurations of Equalizer have one", "is this a file of Equalizer?");
    return finished(std::move(c.display), name, report);
}

} // namespace viewer
