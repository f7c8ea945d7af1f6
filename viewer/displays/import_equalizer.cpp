// Equalizer 1.x and the compounds of 0.x. Walls come from segments of canvases, from canvases (a segment shows the
// part given by its viewport), from views of the canvas's first layout, and from compounds with a channel.
// `projection` becomes a wall `distance` before its origin, as Equalizer's server sees it
// (FrustumData::applyProjection). Segments and compounds for one eye pass become walls for that eye.

#include "gi/core/text.h"
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

/// x, y, width, height from below. Equalizer interprets whole numbers as pixels.
struct Area {
    double x = 0, y = 0, width = 1, height = 1;
    bool in_pixels = false;
};

/// A view of a layout.
struct LayoutView {
    Area area;
    bool is_stereo = false;
    int user = 0;
    TextNode const* node = nullptr;
};

struct EyePasses {
    bool left = true, right = true, cyclop = true;
};

/// Settings of a compound for a segment that it draws. Canvas, segment and layout by name or index.
struct SegmentUse {
    std::string canvas = "0", segment = "0", layout;
    EyePasses eyes{};
    StereoMode stereo = StereoMode::off; ///< off = not stated
};

struct EqualizerContext {
    Display display;
    std::string file;
    ImportLog log;
    std::map<std::string, Channel> channels;
    std::vector<int> rank_of_window;
    std::vector<bool> has_quad_buffer; ///< of each window: not forbidden by its hints
    std::vector<bool> wants_stereo;    ///< of each window: asked for by its hints
    std::vector<std::string> layout_names;
    std::vector<std::vector<LayoutView>> layouts;
    std::map<std::string, std::string> globals;
    StereoMode stereo = StereoMode::off; ///< of compounds and segments that state none; off = as their window can
    std::vector<SegmentUse> uses;

    gi::InputError error(TextNode const& at, std::string const& problem, std::string const& why,
                         std::string const& suggestion) const
    {
        return {{file, at.line, at.column}, problem, why, suggestion};
    }
    std::string where(TextNode const& at) const { return fmt::format("{}:{}:{}", file, at.line, at.column); }
    void lose(std::string const& what, TextNode const& at) { log.lose(what, 1, where(at)); }
    void lose_connections(TextNode const& of)
    {
        for (TextNode const& connection : of.children)
            if (connection.key == "connection") lose_address(connection.text("hostname"), where(connection), log);
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
    c.lose_others(node, {"name", "viewport"});
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
    TextNode const* const attributes = node.find("attributes");
    auto const hint = [&](char const* own, char const* global) {
        auto const usual = c.globals.find(global);
        std::string const other = usual == c.globals.end() ? "" : usual->second;
        return attributes ? attributes->text(own, other) : other;
    };
    window.fullscreen = hint("hint_fullscreen", "EQ_WINDOW_IATTR_HINT_FULLSCREEN") == "ON";
    window.borders = hint("hint_decoration", "EQ_WINDOW_IATTR_HINT_DECORATION") != "OFF";
    std::string const stereo = hint("hint_stereo", "EQ_WINDOW_IATTR_HINT_STEREO");
    if (attributes) c.lose_others(*attributes, {"hint_fullscreen", "hint_stereo", "hint_decoration"});
    int const index = int(c.display.windows.size());
    c.display.windows.push_back(window);
    c.rank_of_window.push_back(rank);
    c.has_quad_buffer.push_back(stereo != "OFF");
    c.wants_stereo.push_back(stereo == "ON");
    for (TextNode const& child : node.children)
        if (child.key == "channel") read_channel(child, index, c);
}

void read_node(TextNode const& node, int rank, EqualizerContext& c)
{
    c.lose_others(node, {"name", "pipe", "connection", "host", "hostname"});
    for (char const* key : {"host", "hostname"}) lose_address(node.text(key), c.where(node), c.log);
    c.lose_connections(node);
    for (TextNode const& pipe : node.children) {
        if (pipe.key != "pipe") continue;
        c.lose_others(pipe, {"name", "port", "device", "viewport", "window"});
        for (char const* key : {"port", "device"})
            if (pipe.text(key, "0") != "0")
                c.lose(fmt::format("Equalizer pipe {}: not imported, windows open on the display of their process",
                                   key),
                       *pipe.find(key));
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
    double const distance = values("distance", 1, {1})[0];
    auto const half = [&](double degrees) { return std::abs(distance * std::tan(glm::radians(degrees / 2))); };
    double const w = half(fov[0]), h = half(fov[1]);
    auto const about = [](double degrees, gi::dvec3 axis) { return glm::angleAxis(glm::radians(degrees), axis); };
    gi::dquat const turn = about(hpr[0], {0, 1, 0}) * about(hpr[1], {1, 0, 0}) * about(hpr[2], {0, 0, 1});
    auto const corner = [&](double x, double y) {
        return gi::dvec3{o[0], o[1], o[2]} + turn * gi::dvec3{x, y, -distance};
    };
    return {corner(-w, -h), corner(w, -h), corner(-w, h)};
}

/// Of walls and canvases that do not say.
WallCorners const kUsualWall{{-0.8, -0.5, -1}, {0.8, -0.5, -1}, {-0.8, 0.5, -1}};

/// The wall or projection given by the block itself.
std::optional<WallCorners> stated_wall(TextNode const& node, EqualizerContext& c)
{
    if (TextNode const* wall = node.find("wall")) {
        c.lose_others(*wall, {"bottom_left", "bottom_right", "top_left", "type"});
        if (TextNode const* projection = node.find("projection"))
            c.lose("Equalizer projections beside a wall: the wall is taken", *projection);
        if (std::string const type = wall->text("type", "fixed"); type == "HMD") {
            c.lose("Equalizer walls fixed to a head (HMD) skipped", *wall);
            return {};
        }
        return WallCorners{corner(*wall, "bottom_left", kUsualWall.lower_left, c),
                           corner(*wall, "bottom_right", kUsualWall.lower_right, c),
                           corner(*wall, "top_left", kUsualWall.upper_left, c)};
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

EyePasses passes_of(TextNode const& node, EyePasses usual)
{
    TextNode const* const eye = node.find("eye");
    if (!eye) return usual;
    EyePasses passes{false, false, false};
    for (TextToken const& t : eye->values) {
        passes.left |= t.text == "LEFT";
        passes.right |= t.text == "RIGHT";
        passes.cyclop |= t.text == "CYCLOP";
    }
    return passes;
}

void read_swap_barrier(TextNode const& node, int window, EqualizerContext& c)
{
    TextNode const* const barrier = node.find("swapbarrier");
    if (!barrier) return;
    c.lose_others(*barrier, {"name", "NV_group", "NV_barrier"});
    auto const number = [&](char const* key) {
        TextNode const* const value = barrier->find(key);
        return value ? int(std::clamp(numbers_of(*value, 1, c.file)[0], 0.0, 1000.0)) : 0;
    };
    DisplayWindow& w = c.display.windows[std::size_t(window)];
    if (int const group = number("NV_group"); group > 0) {
        w.swap_group = group;
        w.swap_barrier = number("NV_barrier");
    }
}

Channel const& channel_of(TextNode const& node, EqualizerContext const& c)
{
    std::string const name = node.text("channel");
    auto const channel = c.channels.find(name);
    if (channel == c.channels.end())
        throw c.error(node, "there is no channel '" + name.substr(0, 64) + "'", "a wall needs one to be drawn in",
                      "name the channel of a window");
    return channel->second;
}

/// @param part  of the channel, in fractions from below
void add_wall(TextNode const& node, WallCorners const& corners, Area const& part, StereoMode stereo, Eye eye,
              int user, EqualizerContext& c)
{
    Channel const& channel = channel_of(node, c);
    Wall wall;
    wall.name = free_name(c.display.walls, node.text("name", node.text("channel")));
    wall.corners = corners;
    if (auto const fault = find_fault(corners))
        throw c.error(node, "wall '" + wall.name + "': " + fault->problem, fault->why, fault->suggestion);
    wall.window = channel.window;
    Viewport const& v = channel.viewport; // from above
    wall.viewport = {v.unit, v.x + part.x * v.width, v.y + (1 - part.y - part.height) * v.height,
                     part.width * v.width, part.height * v.height};
    wall.rank = c.rank_of_window[std::size_t(wall.window)];
    wall.stereo = stereo;
    if (stereo == StereoMode::off && eye == Eye::middle && !node.find("eye") &&
        c.wants_stereo[std::size_t(wall.window)])
        wall.stereo = StereoMode::quad_buffer;
    wall.eye = eye;
    wall.user = user;
    read_swap_barrier(node, wall.window, c);
    for (Wall const& other : c.display.walls) {
        Viewport const &a = wall.viewport, &b = other.viewport;
        if (other.window == wall.window && a.x < b.x + b.width - 1e-6 && b.x < a.x + a.width - 1e-6 &&
            a.y < b.y + b.height - 1e-6 && b.y < a.y + a.height - 1e-6)
            throw c.error(node, "walls '" + other.name + "' and '" + wall.name + "' overlap in their window",
                          "one would be drawn over the other", "remove one of them");
    }
    c.display.walls.push_back(wall);
}

StereoMode usual_stereo(int window, EqualizerContext const& c)
{
    return c.has_quad_buffer[std::size_t(window)] ? StereoMode::quad_buffer : StereoMode::anaglyph_red_cyan;
}

Area common(Area const& a, Area const& b)
{
    double const x = std::max(a.x, b.x), y = std::max(a.y, b.y);
    return {x, y, std::min(a.x + a.width, b.x + b.width) - x, std::min(a.y + a.height, b.y + b.height) - y};
}

Area relative(Area const& part, Area const& whole)
{
    return {(part.x - whole.x) / whole.width, (part.y - whole.y) / whole.height, part.width / whole.width,
            part.height / whole.height};
}

Area checked_area(TextNode const& node, EqualizerContext const& c)
{
    Area const area = read_area(node, c).value_or(Area{});
    if (!(area.width > 0 && area.height > 0))
        throw c.error(node, "a viewport without an area", "nothing is in it", "viewport [ 0 0 1 1 ]");
    return area;
}

/// The first layout of the canvas, which is the one shown at the start.
std::vector<LayoutView> const* layout_of(TextNode const& canvas, EqualizerContext const& c)
{
    if (c.layouts.empty()) return nullptr;
    std::string const wanted = canvas.text("layout", "0");
    for (std::size_t i = 0; i < c.layouts.size(); ++i)
        if (c.layout_names[i] == wanted) return &c.layouts[i];
    auto const index = gi::parse_finite(wanted);
    return index && *index >= 0 && *index < double(c.layouts.size()) ? &c.layouts[std::size_t(*index)] : nullptr;
}

/// What one segment shows of one view.
void read_segment(TextNode const& segment, TextNode const& canvas, std::optional<WallCorners> const& whole,
                  LayoutView const& view, std::optional<SegmentUse> const& use, EqualizerContext& c)
{
    Area const own = checked_area(segment, c), shown = common(own, view.area);
    if (shown.width < 1e-4 || shown.height < 1e-4) return;
    std::optional<WallCorners> corners;
    if (view.node && (view.node->find("wall") || view.node->find("projection"))) {
        if (auto const wall = stated_wall(*view.node, c)) corners = part_of(*wall, relative(shown, view.area));
    } else if (segment.find("wall") || segment.find("projection")) {
        if (auto const wall = stated_wall(segment, c)) corners = part_of(*wall, relative(shown, own));
    } else if (whole)
        corners = part_of(*whole, shown);
    if (!corners) {
        c.lose("Equalizer segments without a fixed wall skipped", segment);
        return;
    }
    EyePasses eyes = passes_of(segment, {});
    if (use) {
        eyes.left &= use->eyes.left;
        eyes.right &= use->eyes.right;
        eyes.cyclop &= use->eyes.cyclop;
    }
    Channel const& channel = channel_of(segment, c);
    Area const part = relative(shown, own);
    read_swap_barrier(canvas, channel.window, c);
    if (eyes.left != eyes.right) {
        add_wall(segment, *corners, part, StereoMode::off, eyes.left ? Eye::left : Eye::right, view.user, c);
    } else if (eyes.left && view.is_stereo) {
        StereoMode const stated = use && use->stereo != StereoMode::off ? use->stereo : c.stereo;
        add_wall(segment, *corners, part, stated == StereoMode::off ? usual_stereo(channel.window, c) : stated,
                 Eye::middle, view.user, c);
    } else if (eyes.cyclop && !(view.is_stereo && !eyes.left)) {
        add_wall(segment, *corners, part, StereoMode::off, Eye::middle, view.user, c);
    } else
        c.lose("Equalizer segments shown only without stereo (eye CYCLOP) skipped", segment);
}

/// Settings of all compounds together for a segment under the canvas's first layout;
/// none if they do not draw it, so that it is drawn as usual.
std::optional<SegmentUse> use_of(EqualizerContext const& c, TextNode const& canvas, int canvas_index,
                                 TextNode const& segment, int segment_index, std::vector<LayoutView> const* layout)
{
    auto const is = [](std::string const& wanted, std::string const& name, std::size_t index) {
        return wanted == std::to_string(index) || (!name.empty() && wanted == name);
    };
    std::optional<SegmentUse> all;
    for (SegmentUse const& use : c.uses) {
        if (!is(use.canvas, canvas.text("name"), std::size_t(canvas_index)) ||
            !is(use.segment, segment.text("name"), std::size_t(segment_index)))
            continue;
        std::size_t const shown = layout ? std::size_t(layout - c.layouts.data()) : 0;
        if (layout && !use.layout.empty() && !is(use.layout, c.layout_names[shown], shown)) continue;
        if (!all) all = SegmentUse{"", "", "", {false, false, false}, StereoMode::off};
        all->eyes.left |= use.eyes.left;
        all->eyes.right |= use.eyes.right;
        all->eyes.cyclop |= use.eyes.cyclop;
        if (use.stereo != StereoMode::off) all->stereo = use.stereo;
    }
    return all;
}

void read_canvas(TextNode const& canvas, int canvas_index, EqualizerContext& c)
{
    c.lose_others(canvas, {"name", "layout", "segment", "wall", "projection", "swapbarrier"});
    std::optional<WallCorners> whole = stated_wall(canvas, c);
    if (!canvas.find("wall") && !canvas.find("projection")) whole = kUsualWall;
    std::vector<LayoutView> const* const layout = layout_of(canvas, c);
    std::vector<LayoutView> const plain{LayoutView{}};
    bool is_first = true;
    for (TextNode const& child : canvas.children)
        if (child.key == "layout") {
            if (!is_first) c.lose("Equalizer layouts of a canvas after its first, shown on demand there", child);
            is_first = false;
        }
    int index = -1;
    for (TextNode const& segment : canvas.children) {
        if (segment.key != "segment") continue;
        ++index;
        c.lose_others(segment, {"name", "channel", "viewport", "wall", "projection", "eye", "swapbarrier"});
        if (!segment.find("channel")) {
            c.lose("Equalizer segments without a channel skipped", segment);
            continue;
        }
        auto const use = use_of(c, canvas, canvas_index, segment, index, layout);
        for (LayoutView const& view : layout && !layout->empty() ? *layout : plain)
            read_segment(segment, canvas, whole, view, use, c);
    }
}

/// Settings that a compound inherits from enclosing ones.
struct Inherited {
    std::optional<WallCorners> wall;
    StereoMode stereo = StereoMode::off;
    EyePasses eyes;
    bool is_task = false; ///< what is below draws for a channel above
};

/// "channel ( canvas 0 segment 1 layout 0 view 0 )"
bool is_reference(TextNode const& channel) { return channel.values.size() > 1; }

void note_use(TextNode const& channel, Inherited const& here, EqualizerContext& c)
{
    SegmentUse use;
    use.eyes = here.eyes;
    use.stereo = here.stereo;
    for (std::size_t i = 0; i + 1 < channel.values.size(); i += 2)
        for (auto const& [key, value] :
             {std::pair{"canvas", &use.canvas}, {"segment", &use.segment}, {"layout", &use.layout}})
            if (channel.values[i].text == key) *value = channel.values[i + 1].text;
    c.uses.push_back(use);
}

/// @param otherwise  for modes that do not say how one channel shows both eyes
StereoMode stereo_named(std::string const& mode, StereoMode otherwise, TextNode const& at, EqualizerContext& c)
{
    if (mode == "ANAGLYPH") return StereoMode::anaglyph_red_cyan;
    if (mode == "QUAD") return StereoMode::quad_buffer;
    if (mode != "PASSIVE" && mode != "AUTO") // PASSIVE: each eye has channels of its own
        c.lose("Equalizer stereo_mode " + mode.substr(0, 64) + ": not imported", at);
    return otherwise;
}

void read_compound(TextNode const& compound, Inherited around, EqualizerContext& c)
{
    if (TextNode const* attributes = compound.find("attributes")) {
        std::string const mode = attributes->text("stereo_mode");
        if (!mode.empty()) around.stereo = stereo_named(mode, around.stereo, *attributes, c);
        c.lose_others(*attributes, {"stereo_mode"});
    }
    c.lose_others(compound,
                  {"name", "channel", "wall", "projection", "compound", "attributes", "eye", "swapbarrier"});
    TextNode const* const channel = compound.find("channel");
    around.eyes = passes_of(compound, around.eyes);
    if (channel && is_reference(*channel)) {
        note_use(*channel, around, c);
        around.is_task = true;
    }
    if (around.is_task) {
        if (compound.find("wall") || compound.find("projection"))
            c.lose("Equalizer compound wall in place of its segment's: not imported", compound);
    } else if (compound.find("wall") || compound.find("projection"))
        around.wall = stated_wall(compound, c);
    bool const is_destination =
        channel && !around.is_task && channel->values.size() == 1 && !compound.find("outputframe");
    if (is_destination && around.wall) {
        bool const one = around.eyes.left != around.eyes.right;
        if (!one && !around.eyes.left && around.stereo != StereoMode::off)
            c.lose("Equalizer compounds shown only without stereo (eye CYCLOP) skipped", compound);
        else
            add_wall(compound, *around.wall, {}, one ? StereoMode::off : around.stereo,
                     !one               ? Eye::middle
                     : around.eyes.left ? Eye::left
                                        : Eye::right,
                     0, c);
        around.is_task = true;
    }
    for (TextNode const& child : compound.children)
        if (child.key == "compound") read_compound(child, around, c);
}

/// Later fields replace earlier ones, as in Equalizer's loader.
void read_observer(TextNode const& node, double eye_base, EqualizerContext& c)
{
    User user;
    user.name = free_name(c.display.users, node.text("name", "observer"));
    c.lose_others(node, {"name", "eye_base", "eye_left", "eye_right", "eye_cyclop"});
    gi::dvec3 left{-eye_base / 2, 0, 0}, right{eye_base / 2, 0, 0}, cyclop{0};
    for (TextNode const& field : node.children) {
        if (field.key == "eye_left") left = point_of(field, c.file);
        if (field.key == "eye_right") right = point_of(field, c.file);
        if (field.key == "eye_cyclop") cyclop = point_of(field, c.file);
        if (field.key == "eye_base") {
            double const half = numbers_of(field, 1, c.file)[0] / 2;
            left = {-half, 0, 0};
            right = {half, 0, 0};
            cyclop = gi::dvec3{0};
        }
    }
    place_eyes(user, left, right, c.where(node) + ", observer '" + user.name + "'", c.log);
    if (glm::length(cyclop - 0.5 * (left + right)) > 1e-6)
        c.log.lose("eyes of pictures without stereo that are not midway between the two: taken as midway", 1,
                   c.where(node) + fmt::format(", [{:.4g} {:.4g} {:.4g}]", cyclop.x, cyclop.y, cyclop.z));
    c.display.users.push_back(user);
}

void read_layout(TextNode const& layout, EqualizerContext& c)
{
    c.lose_others(layout, {"name", "view"});
    std::vector<LayoutView> views;
    for (TextNode const& view : layout.children) {
        if (view.key != "view") continue;
        c.lose_others(view, {"name", "mode", "viewport", "observer", "wall", "projection"});
        if (TextNode const* mode = view.find("mode");
            mode && view.text("mode") != "STEREO" && view.text("mode") != "MONO")
            c.lose("Equalizer view modes that are neither MONO nor STEREO: taken as MONO", *mode);
        LayoutView v{checked_area(view, c), view.text("mode") == "STEREO", 0, &view};
        if (TextNode const* observer = view.find("observer"); observer && observer->values.size() == 1) {
            std::string const& wanted = observer->values[0].text;
            auto const& users = c.display.users;
            auto const index = gi::parse_finite(wanted);
            bool is_found = index && *index >= 0 && *index < double(users.size());
            if (is_found) v.user = int(*index);
            for (std::size_t u = 0; u < users.size(); ++u)
                if (users[u].name == wanted) {
                    v.user = int(u);
                    is_found = true;
                }
            if (wanted.empty() || wanted == "OFF") {
                is_found = true;
                c.lose("Equalizer views without an observer: drawn for the first one", *observer);
            }
            if (!is_found)
                throw c.error(*observer, "there is no observer '" + wanted.substr(0, 64) + "'",
                              "the view is drawn for its eyes", "give its index or name");
        }
        views.push_back(v);
    }
    c.layout_names.push_back(layout.text("name"));
    c.layouts.push_back(std::move(views));
}

void read_config(TextNode const& config, double eye_base, EqualizerContext& c)
{
    c.lose_others(config, {"name", "appNode", "node", "observer", "layout", "canvas", "compound", "attributes"});
    if (TextNode const* attributes = config.find("attributes")) {
        c.lose_others(*attributes, {"eye_base"});
        if (TextNode const* eyes = attributes->find("eye_base")) eye_base = numbers_of(*eyes, 1, c.file)[0];
    }
    int rank = 0;
    for (char const* kind : {"appNode", "node"})
        for (TextNode const& node : config.children)
            if (node.key == kind) read_node(node, rank++, c);
    for (TextNode const& node : config.children)
        if (node.key == "observer") read_observer(node, eye_base, c);
    if (c.display.users.empty()) read_observer({"observer", {}, {}, config.line, config.column}, eye_base, c);
    for (TextNode const& node : config.children)
        if (node.key == "layout") read_layout(node, c);
    for (TextNode const& node : config.children)
        if (node.key == "compound") read_compound(node, {{}, c.stereo, {}}, c);
    int canvas = 0;
    for (TextNode const& node : config.children)
        if (node.key == "canvas") read_canvas(node, canvas++, c);
}

} // namespace

Display parse_equalizer(std::string const& text, std::string const& name, ImportLog log)
{
    std::vector<TextToken> const tokens = tokens_of(text, "{}[]()", name);
    std::size_t at = 0;
    std::vector<TextNode> const top = read_block(tokens, at, 0, name);
    EqualizerContext c{{}, name, log, {}, {}, {}, {}, {}, {}, {}, StereoMode::off, {}};
    double eye_base = 0.05; // Equalizer's own
    bool has_config = false;
    for (TextNode const& node : top) {
        if (node.key == "global") {
            for (TextNode const& setting : node.children)
                if (setting.key == "EQ_CONFIG_FATTR_EYE_BASE")
                    eye_base = numbers_of(setting, 1, name)[0];
                else if (setting.key == "EQ_WINDOW_IATTR_HINT_FULLSCREEN" ||
                         setting.key == "EQ_WINDOW_IATTR_HINT_DECORATION" ||
                         setting.key == "EQ_WINDOW_IATTR_HINT_STEREO" ||
                         setting.key == "EQ_COMPOUND_IATTR_STEREO_MODE")
                    c.globals[setting.key] = setting.values.empty() ? "" : setting.values[0].text;
                else
                    c.lose("Equalizer global " + setting.key.substr(0, 64) + ": not imported", setting);
            if (auto const mode = c.globals.find("EQ_COMPOUND_IATTR_STEREO_MODE"); mode != c.globals.end())
                c.stereo = stereo_named(mode->second, StereoMode::off, node, c);
        } else if (node.key == "server") {
            c.lose_others(node, {"config", "connection"});
            c.lose_connections(node);
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
    return finished(std::move(c.display), name, log);
}

} // namespace viewer
