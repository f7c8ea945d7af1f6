// Vrui.cfg: sections of tags and values, one environment per section of "section Vrui". Patch files, which Vrui
// reads with -mergeConfig, change the configuration read before them: their tags replace, `+=` adds to a list.

#include "viewer/displays/import.h"
#include "viewer/displays/import_common.h"
#include "viewer/displays/text_tree.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <set>

namespace viewer {
namespace {

struct VruiContext {
    Display display;
    std::vector<std::string> files; ///< names, by TextNode::file
    ImportLog log;
    gi::dvec3 right{1, 0, 0}, up{0, 0, 1}, forward{0, 1, 0};
    double metres = 0.0254; ///< per unit of length

    gi::dvec3 direction(gi::dvec3 v) const { return {glm::dot(v, right), glm::dot(v, up), -glm::dot(v, forward)}; }
    gi::dvec3 place(gi::dvec3 v) const { return metres * direction(v); }
    gi::InputError error(TextNode const& at, std::string const& problem, std::string const& why,
                         std::string const& suggestion) const
    {
        return {{name_of(at), at.line, at.column}, problem, why, suggestion};
    }
    std::string const& name_of(TextNode const& at) const { return files[std::size_t(at.file)]; }
    std::string where(TextNode const& at) const { return fmt::format("{}:{}", name_of(at), at.line); }
    void lose_others(TextNode const& section, std::set<std::string> const& known)
    {
        for (TextNode const& tag : section.children)
            if (!known.contains(tag.key))
                log.lose(fmt::format("Vrui {} of a screen, window or viewer: not imported", tag.key.substr(0, 64)),
                         1, where(tag));
    }
};

/// Lines with their continuations; brackets and commas are dropped from values, quotes kept together.
TextNode read_sections(std::string const& text, std::string const& file)
{
    std::vector<TextNode> open{{"", {}, {}, 1, 1}};
    int line = 0;
    for (std::size_t at = 0; at < text.size();) {
        std::string logical;
        int const first = line + 1;
        for (bool more = true; more && at < text.size();) {
            std::size_t const end = std::min(text.find('\n', at), text.size());
            std::string part = text.substr(at, end - at);
            if (!part.empty() && part.back() == '\r') part.pop_back();
            at = end + 1;
            ++line;
            more = !part.empty() && part.back() == '\\';
            if (more) part.back() = ' ';
            logical += part;
        }
        std::vector<TextToken> tokens;
        for (TextToken& token : tokens_of(logical, "(),{};=", file))
            if (token.is_quoted || std::string("(),{};=").find(token.text) == std::string::npos) {
                token.line = first;
                tokens.push_back(std::move(token));
            }
        if (tokens.empty()) continue;
        TextToken const& key = tokens[0];
        if (key.text == "section") {
            if (tokens.size() < 2)
                throw gi::InputError({file, first, key.column}, "a section without a name",
                                     "it is found by its name", "section NAME");
            if (open.size() > std::size_t(kDeepestBlock))
                throw gi::InputError({file, first, key.column}, "sections nest too deeply", "100 levels are read",
                                     "check for a missing endsection");
            open.push_back({tokens[1].text, {}, {}, first, key.column});
        } else if (key.text == "endsection") {
            if (open.size() < 2)
                throw gi::InputError({file, first, key.column}, "an endsection too many", "nothing is open",
                                     "remove it");
            TextNode done = std::move(open.back());
            open.pop_back();
            open.back().children.push_back(std::move(done));
        } else {
            open.back().children.push_back({key.text, {tokens.begin() + 1, tokens.end()}, {}, first, key.column});
        }
    }
    if (open.size() > 1)
        throw gi::InputError({file, open.back().line, open.back().column},
                             "section '" + open.back().key.substr(0, 64) + "' has no end", "it is not closed",
                             "end it with endsection");
    return std::move(open.front());
}

void set_file(TextNode& node, int file)
{
    node.file = file;
    for (TextNode& child : node.children) set_file(child, file);
}

/// Puts the tags of `change` in place of those of `base`; nested sections are merged by name.
void merge(TextNode& base, TextNode const& change)
{
    auto const is_list_addition = [](TextNode const& tag) {
        return !tag.values.empty() && !tag.values[0].is_quoted && tag.values[0].text == "+";
    };
    for (TextNode const& tag : change.children) {
        TextNode* old = nullptr;
        for (TextNode& child : base.children)
            if (child.key == tag.key) old = &child;
        if (!old) {
            base.children.push_back(tag);
        } else if (!tag.children.empty()) {
            merge(*old, tag);
        } else if (is_list_addition(tag)) {
            old->values.insert(old->values.end(), tag.values.begin() + 1, tag.values.end());
        } else {
            old->values = tag.values;
            old->file = tag.file;
            old->line = tag.line;
            old->column = tag.column;
        }
    }
}

/// True if the file changes settings that it does not define, and so is a patch of another file.
bool is_patch(TextNode const& environment)
{
    bool const has_nodes =
        std::any_of(environment.children.begin(), environment.children.end(),
                    [](TextNode const& t) { return t.key.starts_with("node") && t.key.ends_with("WindowNames"); });
    if (!environment.find("windowNames") && !has_nodes) return true;
    for (char const* list : {"screenNames", "windowNames", "viewerNames"}) {
        TextNode const* const names = environment.find(list);
        if (!names) continue;
        if (!names->values.empty() && names->values[0].text == "+") return true;
        for (TextToken const& name : names->values)
            if (!environment.find(name.text)) return true;
    }
    return false;
}

std::vector<std::string> names_in(TextNode const& environment, std::string const& tag)
{
    std::vector<std::string> out;
    if (TextNode const* const node = environment.find(tag))
        for (TextToken const& token : node->values)
            if (token.is_quoted || token.text != "+") out.push_back(token.text);
    return out;
}

TextNode const& section_of(TextNode const& environment, std::string const& name, char const* of,
                           VruiContext const& c)
{
    TextNode const* const node = environment.find(name);
    if (!node)
        throw c.error(environment, fmt::format("there is no section '{}'", name.substr(0, 64)),
                      fmt::format("{} names it", of), "is it in another file? give that one with --base");
    return *node;
}

gi::dvec3 needed_point(TextNode const& section, char const* tag, VruiContext const& c)
{
    TextNode const* const node = section.find(tag);
    if (!node) throw c.error(section, std::string(tag) + " is missing", "the wall is not defined", "add it");
    return point_of(*node, c.name_of(*node));
}

double number_in(TextNode const& section, char const* tag, double otherwise, VruiContext const& c)
{
    TextNode const* const node = section.find(tag);
    return node ? numbers_of(*node, 1, c.name_of(*node))[0] : otherwise;
}

gi::dvec3 unit(gi::dvec3 v, TextNode const& at, VruiContext const& c)
{
    if (!(glm::length(v) > 1e-9)) throw c.error(at, "a direction is zero", "it points nowhere", "give another");
    return glm::normalize(v);
}

struct VruiMotion {
    gi::dquat turn{1, 0, 0, 0};
    gi::dvec3 shift{0};

    gi::dvec3 operator()(gi::dvec3 p) const { return shift + turn * p; }
};

/// "translate (x, y, z) * rotate (x, y, z), degrees", the last first.
VruiMotion motion_of(TextNode const& node, VruiContext const& c)
{
    VruiMotion m;
    auto const& v = node.values;
    auto const at = [&](std::size_t i) {
        if (i >= v.size())
            throw c.error(node, "the transformation ends too early", "numbers are missing", "complete it");
        return number_of(v[i], c.name_of(node));
    };
    for (std::size_t i = 0; i < v.size();) {
        if (v[i].text == "*") {
            ++i;
        } else if (v[i].text == "translate") {
            m.shift += m.turn * gi::dvec3{at(i + 1), at(i + 2), at(i + 3)};
            i += 4;
        } else if (v[i].text == "rotate") {
            m.turn =
                m.turn * glm::angleAxis(glm::radians(at(i + 4)), unit({at(i + 1), at(i + 2), at(i + 3)}, node, c));
            i += 5;
        } else
            throw c.error(node, "'" + v[i].text.substr(0, 64) + "' in a transformation", "it is no motion",
                          "translate (x, y, z) and rotate (x, y, z), degrees");
    }
    return m;
}

/// None for screens that are not fixed rectangles.
std::optional<WallCorners> read_screen(TextNode const& s, VruiContext& c)
{
    char const* odd = s.text("deviceMounted") == "true" ? "carried by a device"
                      : s.text("offAxis") == "true"     ? "with a homography"
                                                        : nullptr;
    if (odd) {
        c.log.lose(fmt::format("Vrui screens {} skipped: only fixed rectangles are imported", odd), 1, c.where(s));
        return {};
    }
    c.lose_others(s, {"name", "deviceMounted", "offAxis", "origin", "horizontalAxis", "verticalAxis", "width",
                      "height", "rotateCenter", "rotateAxis", "rotateAngle", "transform", "preTransform"});
    gi::dvec3 const across = unit(needed_point(s, "horizontalAxis", c), s, c);
    gi::dvec3 upward = unit(needed_point(s, "verticalAxis", c), s, c);
    // Vrui makes the second axis orthogonal to the first.
    upward = unit(upward - glm::dot(upward, across) * across, s, c);
    gi::dvec3 const origin = needed_point(s, "origin", c);
    double const width = number_in(s, "width", 0, c), height = number_in(s, "height", 0, c);
    gi::dvec3 corners[3] = {origin, origin + width * across, origin + height * upward};
    if (double const angle = number_in(s, "rotateAngle", 0, c); angle != 0) {
        TextNode const *const center = s.find("rotateCenter"), *const axis = s.find("rotateAxis");
        gi::dvec3 const about = center ? point_of(*center, c.name_of(*center)) : gi::dvec3{0};
        gi::dquat const turn = glm::angleAxis(
            glm::radians(angle), unit(axis ? point_of(*axis, c.name_of(*axis)) : gi::dvec3{1, 0, 0}, s, c));
        for (gi::dvec3& p : corners) p = about + turn * (p - about);
    }
    for (char const* tag : {"transform", "preTransform"})
        if (TextNode const* node = s.find(tag)) {
            VruiMotion const motion = motion_of(*node, c);
            for (gi::dvec3& p : corners) p = motion(p);
        }
    return WallCorners{c.place(corners[0]), c.place(corners[1]), c.place(corners[2])};
}

User read_viewer(TextNode const& s, VruiContext& c)
{
    static std::set<std::string> const kLights{
        "headLightEnabled",    "headLightPosition",     "headLightDirection",  "headLightColor",
        "headLightSpotCutoff", "headLightSpotExponent", "headLightAttenuation"};
    std::set<std::string> known{"name",          "headTracked",     "headDevice",      "headDeviceTransformation",
                                "viewDirection", "monoEyePosition", "leftEyePosition", "rightEyePosition"};
    known.insert(kLights.begin(), kLights.end());
    c.lose_others(s, known);
    bool const has_lamp =
        std::any_of(kLights.begin(), kLights.end(), [&](std::string const& k) { return s.find(k); });
    if (has_lamp && s.text("headLightEnabled", "true") != "false")
        c.log.lose("Vrui lamps at the head: not imported, scenes have their own light", 1, c.where(s));
    User user;
    user.name = s.key;
    VruiMotion head;
    if (TextNode const* t = s.find("headDeviceTransformation")) head = motion_of(*t, c);
    user.head.translation_m = c.place(head.shift);
    if (s.text("headTracked") == "true")
        c.log.lose("Vrui device daemons are not supported trackers: the head rests until a tracker is added", 1,
                   c.where(s));
    TextNode const *const left = s.find("leftEyePosition"), *const right = s.find("rightEyePosition");
    if (!left || !right) {
        c.log.lose("interpupillary distance not in the file: 0.063 m assumed", 1, c.where(s));
        return user;
    }
    gi::dvec3 const l = c.place(head.turn * point_of(*left, c.name_of(*left))),
                    r = c.place(head.turn * point_of(*right, c.name_of(*right)));
    place_eyes(user, l, r, c.where(s) + ", viewer '" + s.key + "'", c.log);
    gi::dquat const resting = pose_of(user.head).rotation;
    if (TextNode const* mono = s.find("monoEyePosition"))
        if (glm::length(c.place(head.turn * point_of(*mono, c.name_of(*mono))) - 0.5 * (l + r)) > 1e-6)
            c.log.lose("eyes of pictures without stereo that are not midway between the two: taken as midway", 1,
                       c.where(*mono));
    if (TextNode const* view = s.find("viewDirection")) {
        gi::dvec3 const ahead = c.direction(head.turn * unit(point_of(*view, c.name_of(*view)), *view, c));
        if (glm::length(ahead - resting * gi::dvec3{0, 0, -1}) > 1e-3)
            c.log.lose("Vrui view directions that are not straight ahead of the eyes: not imported", 1,
                       c.where(*view));
    }
    if (glm::length(user.eye_offset_m) > 1) { // control windows put the eyes metres behind a fixed place
        user.head.translation_m += (l + r) * 0.5;
        user.eye_offset_m = gi::dvec3{0};
    }
    return user;
}

/// A stereo mode, and where it puts the left eye.
struct VruiStereo {
    StereoMode mode = StereoMode::off;
    bool swap_eyes = false;
};

/// Rectangle of a viewport, px from the window's lower left corner.
std::optional<PixelRectangle> viewport_in(TextNode const& s, char const* tag, VruiContext const& c)
{
    TextNode const* const node = s.find(tag);
    if (!node) return {};
    auto const v = numbers_of(*node, 4, c.name_of(*node));
    for (double const x : v)
        if (std::abs(x) > 1e6) throw c.error(*node, "a viewport is too large", "no window is", "check it");
    return PixelRectangle{int(v[0]), int(v[1]), int(v[2]), int(v[3])};
}

VruiStereo split_stereo(TextNode const& s, DisplayWindow const& w, VruiContext& c)
{
    auto const left = viewport_in(s, "leftViewportPos", c), right = viewport_in(s, "rightViewportPos", c);
    PixelRectangle const west{0, 0, w.width_px / 2, w.height_px},
        east{w.width_px / 2, 0, w.width_px / 2, w.height_px}, lower{0, 0, w.width_px, w.height_px / 2},
        upper{0, w.height_px / 2, w.width_px, w.height_px / 2};
    PixelRectangle const l = left.value_or(west), r = right.value_or(east);
    if (l == west && r == east) return {StereoMode::side_by_side, false};
    if (l == east && r == west) return {StereoMode::side_by_side, true};
    if (l == upper && r == lower) return {StereoMode::top_bottom, false};
    if (l == lower && r == upper) return {StereoMode::top_bottom, true};
    c.log.lose("Vrui SplitViewportStereo whose viewports are not the halves of the window: shown side by side", 1,
               c.where(s));
    return {StereoMode::side_by_side, false};
}

/// The pattern has the eyes of the pixels of two rows, the lower one first.
VruiStereo interleaved_stereo(TextNode const& s, DisplayWindow const& w, VruiContext& c)
{
    bool const is_old = s.text("windowType") == "InterlacedViewportStereo"; // rows only
    std::string const pattern = s.text("interleavePattern", is_old ? "LLRR" : "LRRL");
    bool const is_even = w.height_px % 2 == 0; // then the upper row of the pattern is our row 0
    // Its stipple has the first pixel in the highest bit, Vrui sets the lowest one: columns are exchanged.
    if (pattern == "LLRR") return {StereoMode::rows, is_even};
    if (pattern == "RRLL") return {StereoMode::rows, !is_even};
    if (pattern == "LRLR") return {StereoMode::columns, true};
    if (pattern == "RLRL") return {StereoMode::columns, false};
    if (pattern == "LRRL") return {StereoMode::checkerboard, !is_even};
    if (pattern == "RLLR") return {StereoMode::checkerboard, is_even};
    c.log.lose("Vrui interleavePattern " + pattern.substr(0, 64) + ": shown without stereo", 1, c.where(s));
    return {};
}

VruiStereo stereo_of(TextNode const& window, DisplayWindow const& w, VruiContext& c)
{
    std::string const type = window.text("windowType", "Mono");
    if (type == "Mono") return {};
    if (type == "QuadbufferStereo") return {StereoMode::quad_buffer, false};
    if (type == "AnaglyphicStereo") return {StereoMode::anaglyph_red_cyan, false};
    if (type == "SplitViewportStereo") return split_stereo(window, w, c);
    if (type == "InterlacedViewportStereo" || type == "InterleavedViewportStereo")
        return interleaved_stereo(window, w, c);
    c.log.lose("Vrui windowType " + type.substr(0, 64) + ": shown without stereo", 1, c.where(window));
    return {};
}

DisplayWindow window_of(TextNode const& s, std::string const& name, VruiContext& c)
{
    DisplayWindow window;
    window.name = free_name(c.display.windows, name);
    window.fullscreen = s.text("windowFullscreen") == "true";
    window.borders = s.text("decorate", s.text("decorated", "true")) != "false";
    TextNode const *const pos = s.find("windowPos"), *const size = s.find("windowSize");
    std::vector<double> v{0, 0, 1920, 1080};
    if (size) {
        auto const px = numbers_of(*size, 2, c.name_of(*size));
        v[2] = px[0];
        v[3] = px[1];
    }
    if (pos) v = numbers_of(*pos, 4, c.name_of(*pos));
    if (!pos && !size)
        c.log.lose("windows whose size the file does not tell, taken as 1920 x 1080", 1, c.where(s));
    for (double const x : v)
        if (std::abs(x) > 1e6)
            throw c.error(pos ? *pos : *size, "a window is a million pixels away", "no desktop is", "check it");
    window.x_px = int(v[0]);
    window.y_px = int(v[1]);
    window.width_px = int(v[2]);
    window.height_px = int(v[3]);
    return window;
}

int user_of(TextNode const& environment, std::string const& viewer, VruiContext& c)
{
    for (std::size_t u = 0; u < c.display.users.size(); ++u)
        if (c.display.users[u].name == viewer) return int(u);
    c.display.users.push_back(read_viewer(section_of(environment, viewer, "viewerName", c), c));
    return int(c.display.users.size()) - 1;
}

void read_window(TextNode const& environment, std::string const& name, int rank, VruiContext& c)
{
    TextNode const& s = section_of(environment, name, "the list of windows", c);
    c.lose_others(s, {"display", "windowPos", "windowSize", "windowFullscreen", "windowType", "screenName",
                      "viewerName", "decorate", "decorated", "leftViewportPos", "rightViewportPos",
                      "interleavePattern", "leftScreenName", "rightScreenName"});
    if (std::string const x = s.text("display"); !x.empty() && x != ":0" && x != ":0.0")
        c.log.lose("Vrui displays of windows: not imported, windows open on the display of their process", 1,
                   c.where(s) + ": " + x.substr(0, 64));
    if (s.text("windowType") == "CompositorClient") {
        c.log.lose("Vrui windows of a headset's compositor skipped: use --hmd", 1, c.where(s));
        return;
    }
    DisplayWindow const window = window_of(s, name, c);
    struct Part {
        char const* screen;
        char const* viewport;
        Eye eye;
    };
    bool const is_split = s.find("leftScreenName") || s.find("rightScreenName");
    std::vector<Part> parts{{"screenName", nullptr, Eye::middle}};
    if (is_split)
        parts = {{"leftScreenName", "leftViewportPos", Eye::left},
                 {"rightScreenName", "rightViewportPos", Eye::right}};
    bool has_window = false;
    for (Part const& part : parts) {
        std::string const screen = s.text(part.screen);
        auto const corners = read_screen(section_of(environment, screen, part.screen, c), c);
        if (!corners) continue;
        Wall wall;
        wall.name = free_name(c.display.walls, screen);
        wall.corners = *corners;
        wall.rank = rank;
        wall.eye = part.eye;
        if (part.eye == Eye::middle) {
            VruiStereo const stereo = stereo_of(s, window, c);
            wall.stereo = stereo.mode;
            wall.swap_eyes = stereo.swap_eyes;
        } else {
            int const half = window.width_px / 2;
            PixelRectangle const r =
                viewport_in(s, part.viewport, c)
                    .value_or(PixelRectangle{part.eye == Eye::left ? 0 : half, 0, half, window.height_px});
            wall.viewport = {LengthUnit::px, double(r.x), double(window.height_px - r.y - r.height),
                             double(r.width), double(r.height)};
        }
        wall.user = user_of(environment, s.text("viewerName"), c);
        wall.window = int(c.display.windows.size()) - (has_window ? 1 : 0);
        if (!has_window) c.display.windows.push_back(window);
        has_window = true;
        c.display.walls.push_back(wall);
    }
}

/// "unit (Inch, 1.0)" of an environment's definition.
void read_unit(TextNode const& definition, VruiContext& c)
{
    TextNode const* const node = definition.find("unit");
    if (!node || node->values.empty()) return;
    std::string const name = node->values[0].text;
    double const scale = node->values.size() > 1 ? number_of(node->values[1], c.name_of(*node)) : 1;
    for (auto const& [known, metres] : {std::pair{"Inch", 0.0254},
                                        {"Foot", 0.3048},
                                        {"Yard", 0.9144},
                                        {"Meter", 1.0},
                                        {"Centimeter", 0.01},
                                        {"Millimeter", 0.001}})
        if (name == known && scale > 1e-6 && scale < 1e6) {
            c.metres = metres * scale;
            return;
        }
    throw c.error(*node, "a length unit of '" + name.substr(0, 64) + "'", "it is unknown or out of range",
                  "Inch, Foot, Yard, Meter, Centimeter or Millimeter");
}

void read_units(TextNode const& environment, VruiContext& c)
{
    TextNode const *const metre = environment.find("meterScale"), *const inch = environment.find("inchScale");
    double const scale = metre  ? numbers_of(*metre, 1, c.name_of(*metre))[0]
                         : inch ? numbers_of(*inch, 1, c.name_of(*inch))[0]
                                : 1;
    if (!(scale > 1e-6 && scale < 1e6))
        throw c.error(environment, "the length unit is not positive, or out of range",
                      "inchScale and meterScale give the number of units", "inchScale 1.0");
    c.metres = (metre ? 1 : 0.0254) / scale;
    TextNode const* const definition = environment.find("environmentDefinition")
                                           ? environment.find(environment.text("environmentDefinition"))
                                           : nullptr;
    if (definition) read_unit(*definition, c);
    for (TextNode const* from : {&environment, definition}) {
        if (!from) continue;
        bool const is_new = from == definition;
        if (TextNode const* f = from->find(is_new ? "forward" : "forwardDirection"))
            c.forward = unit(point_of(*f, c.name_of(*f)), *f, c);
        if (TextNode const* u = from->find(is_new ? "up" : "upDirection"))
            c.up = unit(point_of(*u, c.name_of(*u)), *u, c);
    }
    c.right = unit(glm::cross(c.forward, c.up), environment, c);
    c.up = glm::cross(c.right, c.forward);
}

} // namespace

Display parse_vrui(std::vector<VruiText> const& files, std::string const& section, ImportLog log)
{
    std::string const& name = files.back().name; // a patch is named in messages; its base is checked alone first
    TextNode file;
    for (VruiText const& f : files) {
        TextNode part = read_sections(f.text, f.name);
        set_file(part, int(&f - files.data()));
        if (!part.find("Vrui"))
            throw gi::InputError({f.name, 1, 1}, "there is no section Vrui",
                                 "displays are in one; device, avatar and server files have none",
                                 "import the Vrui.cfg of the installation");
        if (file.children.empty())
            file = std::move(part);
        else
            merge(file, part);
    }
    TextNode const* const vrui = file.find("Vrui");
    TextNode const* environment = nullptr;
    std::string others;
    int other_count = 0;
    for (TextNode const& child : vrui->children) {
        bool const is_wanted = section.empty() ? child.find("screenNames") != nullptr : child.key == section;
        if (is_wanted && !environment) {
            environment = &child;
        } else if (!child.children.empty()) {
            others += (other_count++ ? ", " : "") + child.key.substr(0, 64);
        }
    }
    VruiContext c{{}, {}, log};
    for (VruiText const& f : files) c.files.push_back(f.name);
    bool const is_incomplete = !environment || is_patch(*environment);
    if (is_incomplete && files.size() == 1 && (section.empty() || environment)) {
        TextNode const& at = environment ? *environment : *vrui;
        throw c.error(at,
                      environment ? "environment '" + environment->key.substr(0, 64) +
                                        "' names screens, windows or viewers that this file does not have"
                                  : "no environment of this file has screens: it is a patch of a configuration",
                      "Vrui reads it on top of its Vrui.cfg (-mergeConfig)" +
                          (others.empty() ? "" : "; it changes " + others),
                      "give that file with --base, and the environment with --section");
    }
    if (environment && is_incomplete)
        throw c.error(
            *environment, "environment '" + environment->key.substr(0, 64) + "' of the patch stays incomplete",
            files.front().name + " does not complete it", "it has: " + (others.empty() ? "none" : others));
    if (!environment)
        throw c.error(*vrui,
                      section.empty() ? "no environment has screenNames"
                                      : "there is no environment '" + section + "'",
                      "the environment lists the walls", "there are: " + (others.empty() ? "none" : others));
    if (other_count)
        log.lose("Vrui environments other than the one imported", std::uint64_t(other_count),
                 others.substr(0, 500));
    read_units(*environment, c);
    std::set<std::string> used{"screenNames", "viewerNames",      "windowNames", "inchScale",
                               "meterScale",  "forwardDirection", "upDirection", "environmentDefinition"};
    if (environment->find("environmentDefinition")) used.insert(environment->text("environmentDefinition"));
    auto const read_windows = [&](std::string const& tag, int rank) {
        used.insert(tag);
        for (std::string const& window : names_in(*environment, tag)) {
            read_window(*environment, window, rank, c);
            TextNode const& s = section_of(*environment, window, "the list of windows", c);
            used.insert({window, s.text("screenName"), s.text("leftScreenName"), s.text("rightScreenName")});
        }
    };
    read_windows("windowNames", 0);
    for (TextNode const& tag : environment->children)
        if (int node = 0, length = 0; std::sscanf(tag.key.c_str(), "node%4dWindowNames%n", &node, &length) == 1 &&
                                      length == int(tag.key.size()) && node >= 0)
            read_windows(tag.key, node);
    for (User const& user : c.display.users) used.insert(user.name);
    for (TextNode const& tag : environment->children)
        if (!used.contains(tag.key))
            log.lose("Vrui settings that are not about walls, windows and viewers: not imported", 1,
                     tag.key.substr(0, 64) + ", " + c.where(tag));
    return finished(std::move(c.display), name, log);
}

Display parse_vrui(std::string const& text, std::string const& name, std::string const& section, ImportLog log)
{
    return parse_vrui({{text, name}}, section, log);
}

} // namespace viewer
