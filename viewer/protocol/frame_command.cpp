#include "viewer/protocol/frame_command.h"

#include "gi/core/error.h"
#include "viewer/protocol/bytes.h"
#include "viewer/protocol/json_text.h"

#include <array>
#include <fmt/format.h>

namespace viewer {
namespace {

/// The second version has a light scale, the third also a surface scale, the fourth also margins; the fifth is of
/// only_light. They are written only where these are not 1, and not 0.
constexpr std::uint8_t kVersion = 5;

gi::dmat4 const kIdentity{1};
std::array<double, 7> constexpr kNoPose{0, 0, 0, 0, 0, 0, 1};

std::span<double const, 16> numbers_of(gi::dmat4 const& m) { return std::span<double const, 16>(&m[0][0], 16); }

void put(ByteWriter& to, std::optional<RoomPose> const& pose)
{
    if (!pose) return;
    gi::dvec3 const& p = pose->position;
    gi::dquat const& q = pose->rotation;
    to.put_numbers(std::array{p.x, p.y, p.z, q.x, q.y, q.z, q.w}, kNoPose);
}

RoomPose get_pose(ByteReader& from)
{
    std::array<double, 7> v;
    from.numbers(v, kNoPose);
    return {{v[0], v[1], v[2]}, {v[6], v[3], v[4], v[5]}};
}

gi::dmat4 get_matrix(ByteReader& from)
{
    gi::dmat4 m;
    from.numbers(std::span<double>(&m[0][0], 16), numbers_of(kIdentity));
    return m;
}

std::array<double, 5> scalars_of(gi::Camera const& c)
{
    return {c.yfov_rad, c.ymag_m, c.aspect, c.aperture_radius_m, c.focus_distance_m};
}

void put(ByteWriter& to, gi::Camera const& c)
{
    to.put_text(c.name);
    to.put_byte(std::uint8_t((c.orthographic ? 1 : 0) + (c.off_axis ? 2 : 0)));
    if (c.off_axis)
        for (double const v : {c.off_axis->left, c.off_axis->right, c.off_axis->bottom, c.off_axis->top})
            to.put_number(v);
    to.put_numbers(scalars_of(c), scalars_of({}));
    to.put_numbers(numbers_of(c.world_from_camera), numbers_of(kIdentity));
}

gi::Camera get_camera(ByteReader& from)
{
    gi::Camera c;
    c.name = from.text(CommandLimits::name_bytes);
    std::uint8_t const flags = from.byte();
    if (flags > 3) throw BadBytes("a camera has an unknown kind");
    c.orthographic = (flags & 1) != 0;
    if ((flags & 2) != 0) {
        c.off_axis.emplace();
        for (double* const v : {&c.off_axis->left, &c.off_axis->right, &c.off_axis->bottom, &c.off_axis->top})
            *v = from.number();
    }
    std::array<double, 5> v;
    from.numbers(v, scalars_of({}));
    c.yfov_rad = v[0];
    c.ymag_m = v[1];
    c.aspect = v[2];
    c.aperture_radius_m = v[3];
    c.focus_distance_m = v[4];
    c.world_from_camera = get_matrix(from);
    return c;
}

// As text, because nlohmann's CBOR reader recurses: deeply nested bytes could exhaust the stack.
std::string text_of(Change const& c)
{
    try {
        std::string text = c.value.dump();
        if (text.size() <= CommandLimits::value_bytes) return text;
    } catch (nlohmann::json::exception const& e) {
        throw gi::InputError("the value of '" + c.key + "' cannot be written", e.what(), "use UTF-8");
    }
    throw gi::InputError("the value of '" + c.key + "' is too long",
                         fmt::format("at most {} bytes", CommandLimits::value_bytes), "set it in parts");
}

Change get_change(ByteReader& from)
{
    Change c;
    c.key = from.text(CommandLimits::name_bytes);
    c.value = parse_json(from.text(CommandLimits::value_bytes), CommandLimits::value_depth);
    return c;
}

// A byte with a bit per tracked body and one bit if another user follows; then the poses. Older versions, without
// feet and further users, never set those bits.
constexpr std::size_t kBodies = kBodyMembers.size();

void put(ByteWriter& to, Tracked const& t, bool another)
{
    unsigned which = another ? 1u << kBodies : 0;
    for (std::size_t b = 0; b < kBodies; ++b)
        if (t.*kBodyMembers[b]) which |= 1u << b;
    to.put_byte(std::uint8_t(which));
    for (auto const body : kBodyMembers) put(to, t.*body);
}

Tracked get_tracked(ByteReader& from, bool& another)
{
    unsigned const which = from.byte();
    if (which >> (kBodies + 1) != 0) throw BadBytes("an unknown body is tracked");
    another = which >> kBodies != 0;
    Tracked t;
    for (std::size_t b = 0; b < kBodies; ++b)
        if ((which >> b & 1) != 0) t.*kBodyMembers[b] = get_pose(from);
    return t;
}

FrameCommand get_order(ByteReader& from)
{
    int const version = from.byte();
    if (version < 1 || version > kVersion)
        throw BadBytes(fmt::format("they are of version {}, only 1 to {} are known", version, kVersion));
    FrameCommand o;
    o.frame = from.count(~std::uint64_t(0));
    for (double* const t : {&o.pose_s, &o.display_s, &o.scene_s}) *t = from.number();
    o.paths = int(from.count(CommandLimits::paths));
    if (version > 1) o.light_scale = from.number();
    if (version > 2) o.surface_scale = from.number();
    o.only_light = version > 4;
    o.world_from_room = get_matrix(from);
    bool others = false;
    o.tracked = get_tracked(from, others);
    while (others) {
        if (o.others.size() == CommandLimits::users) throw BadBytes("too many users are tracked");
        o.others.push_back(get_tracked(from, others));
    }
    auto const changes = from.count(CommandLimits::changes);
    for (std::uint64_t i = 0; i < changes; ++i) o.changes.push_back(get_change(from));
    auto const views = from.count(CommandLimits::views);
    for (std::uint64_t i = 0; i < views; ++i) {
        ViewCommand v;
        v.name = from.text(CommandLimits::name_bytes);
        v.camera = get_camera(from);
        v.width = int(from.count(CommandLimits::size_px));
        v.height = int(from.count(CommandLimits::size_px));
        v.partner = int(from.count(CommandLimits::views)) - 1;
        if (version > 3) v.margin_x = int(from.count(CommandLimits::size_px));
        if (version > 3) v.margin_y = int(from.count(CommandLimits::size_px));
        o.views.push_back(std::move(v));
    }
    if (from.left() > 0) throw BadBytes(fmt::format("{} bytes follow it", from.left()));
    return o;
}

} // namespace

std::vector<std::uint8_t> to_bytes(FrameCommand const& o)
{
    check_command(o);
    ByteWriter to;
    bool const margins = o.only_light ||
                         std::ranges::any_of(o.views,
                                             [](ViewCommand const&v) { return v.margin_x > 0 || v.margin_y > 0; }),
               small_surfaces = margins || o.surface_scale != 1,
               small_light = small_surfaces || o.light_scale != 1;
    to.put_byte(o.only_light ? kVersion : margins ? 4 : small_surfaces ? 3 : small_light ? 2 : 1);
    to.put_count(o.frame);
    for (double const t : {o.pose_s, o.display_s, o.scene_s}) to.put_number(t);
    to.put_count(std::uint64_t(o.paths));
    if (small_light) to.put_number(o.light_scale);
    if (small_surfaces) to.put_number(o.surface_scale);
    to.put_numbers(numbers_of(o.world_from_room), numbers_of(kIdentity));
    put(to, o.tracked, !o.others.empty());
    for (Tracked const& t : o.others) put(to, t, &t != &o.others.back());
    to.put_count(o.changes.size());
    for (Change const& c : o.changes) {
        to.put_text(c.key);
        to.put_text(text_of(c));
    }
    to.put_count(o.views.size());
    for (ViewCommand const& v : o.views) {
        to.put_text(v.name);
        put(to, v.camera);
        to.put_count(std::uint64_t(v.width));
        to.put_count(std::uint64_t(v.height));
        to.put_count(std::uint64_t(v.partner + 1));
        if (!margins) continue;
        to.put_count(std::uint64_t(v.margin_x));
        to.put_count(std::uint64_t(v.margin_y));
    }
    if (to.bytes().size() > CommandLimits::bytes)
        throw gi::InputError(
            "a frame command is too long",
            fmt::format("it has {} bytes, the limit is {}", to.bytes().size(), CommandLimits::bytes),
            "spread its changes over several frames");
    return to.take();
}

FrameCommand command_from_bytes(std::span<std::uint8_t const> bytes)
{
    try {
        if (bytes.size() > CommandLimits::bytes) throw BadBytes("they are too many");
        ByteReader from(bytes);
        FrameCommand command = get_order(from);
        check_command(command);
        return command;
    } catch (BadBytes const& e) {
        throw gi::InputError(fmt::format("{} bytes are no frame command", bytes.size()), e.what(),
                             "use the same version of the program on both sides");
    }
}

} // namespace viewer
