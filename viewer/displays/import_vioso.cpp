// VIOSO's .vwf: read_vioso() of calibration.h.

#include "gi/core/file.h"
#include "viewer/displays/calibration.h"
#include "viewer/displays/check.h"

#include <bit>
#include <cstring>
#include <fmt/format.h>
#include <limits>

namespace viewer {
namespace {

constexpr std::size_t kSetHeader = 16, kLeastHeader = 380, kMostHeader = 1 << 16, kRecord = 16, kBmpHeader = 54;
constexpr double kViosoGamma = 2.2; ///< its factors multiply display-encoded values

enum ViosoFlag : std::uint32_t {
    vioso_packed = 0x1,
    vioso_split = 0x2,
    vioso_boxed = 0x8,
    vioso_3d = 0x40,
};

struct ViosoReader {
    std::span<unsigned char const> bytes;
    std::string name;
    ImportLog const& log;

    gi::InputError error(std::size_t at, std::string const& problem, std::string const& why) const
    {
        return {{name, 0, 0}, problem + fmt::format(" at byte {}", at), why, "export the calibration again"};
    }
    /// Throws where the file ends before `at` + `count`.
    std::span<unsigned char const> part(std::size_t at, std::size_t count) const
    {
        if (at > bytes.size() || count > bytes.size() - at)
            throw error(at, fmt::format("{} bytes are missing", count), "the file ends early");
        return bytes.subspan(at, count);
    }
    std::uint32_t word(std::size_t at) const
    {
        auto const b = part(at, 4);
        return std::uint32_t(b[0]) | std::uint32_t(b[1]) << 8 | std::uint32_t(b[2]) << 16 |
               std::uint32_t(b[3]) << 24;
    }
    float number(std::size_t at) const { return std::bit_cast<float>(word(at)); }
    bool is(std::size_t at, char const* magic) const
    {
        auto const b = part(at, 4);
        return std::memcmp(b.data(), magic, std::strlen(magic)) == 0;
    }
    void lose(CalibratedProjector const& p, std::string const& what) const
    {
        log.lose("VIOSO " + what, 1, name + ", " + p.wall.name);
    }
};

/// Warp records become a PFM: of points in the file's unit, or of positions in a picture.
void read_records(CalibratedProjector& p, std::size_t at, bool has_points, double unit_m, ViosoReader const& r)
{
    PixelMap map{p.size_px.x, p.size_px.y, {}};
    std::size_t const count = std::size_t(map.width) * std::size_t(map.height);
    r.part(at, count * kRecord);
    map.values.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        std::size_t const from = at + i * kRecord;
        glm::vec3 const v{r.number(from), r.number(from + 4), r.number(from + 8)};
        bool const is_valid = has_points ? r.number(from + 12) == 1 : v.z == 1;
        map.values.push_back(is_valid ? v : glm::vec3(std::numeric_limits<float>::quiet_NaN()));
    }
    auto bytes = pfm_bytes(map);
    if (has_points) {
        Surface s;
        s.type = SurfaceType::points;
        s.unit_m = unit_m;
        s.points.map = std::make_shared<PixelMap const>(parse_points(bytes, unit_m, r.name));
        s.points.file = r.log.keep_file(p.wall.name + "_points.pfm", std::move(bytes));
        p.wall.surface = std::move(s);
        return;
    }
    constexpr double kAway_m = 3, kHalf_m = 1;
    double const half = kHalf_m * p.size_px.x / p.size_px.y;
    p.wall.corners = {{-half, -kHalf_m, -kAway_m}, {half, -kHalf_m, -kAway_m}, {-half, kHalf_m, -kAway_m}};
    auto positions = std::make_shared<PixelMap const>(parse_picture_positions(bytes, r.name));
    p.wall.warp_map = {r.log.keep_file(p.wall.name + "_positions.pfm", std::move(bytes)), std::move(positions)};
    r.lose(p,
           "mappings without points do not say where the picture is: taken as 2 m high, of the projector's shape, "
           "3 m before the head");
}

/// @return where the next block begins
std::size_t read_mapping(CalibratedProjector& p, std::size_t at, bool is_wanted, double unit_m,
                         ViosoReader const& r)
{
    std::size_t const header = r.word(at + 4), size = r.word(at + 16);
    std::uint32_t const flags = r.word(at + 8), width = r.word(at + 20), height = r.word(at + 24);
    if (header < kLeastHeader || header > kMostHeader || width < 2 || height < 2 || width > kLargestMap_px ||
        height > kLargestMap_px)
        throw r.error(at, fmt::format("a header of {} bytes, {} x {} pixels", header, width, height),
                      fmt::format("sides have 2 to {} pixels", kLargestMap_px));
    auto const label = r.part(at + 124, 256);
    for (std::size_t i = 0; i < label.size() && label[i] >= ' ' && label[i] < 127; ++i)
        p.wall.name += char(label[i]);
    if (p.wall.name.empty()) p.wall.name = "projector";
    p.wall.name = p.wall.name.substr(0, 64);
    p.size_px = {int(width), int(height)};
    p.at = {r.name, 0, 0};
    if ((flags & vioso_packed) || size != std::size_t(width) * height * kRecord)
        throw r.error(at, fmt::format("{} bytes of '{}'", size, p.wall.name),
                      "compressed and encrypted mappings are not read");
    if (!is_wanted) return at + header + size;
    if (flags & vioso_split) r.lose(p, "parts of a split display: each shown in a window of its own");
    if (flags & vioso_boxed) r.lose(p, "borders of 1 % around the content: not imported");
    for (std::size_t k = 0; k < 3; ++k)
        if (r.number(at + 28 + 4 * k) != 1 || r.number(at + 44 + 4 * k) != 0) {
            r.lose(p, "white and black points: not imported");
            break;
        }
    bool const has_points = flags & vioso_3d;
    read_records(p, at + header, has_points, unit_m, r);
    if (has_points) r.lose(p, fmt::format("does not state its unit: taken as {:g} m", unit_m));
    return at + header + size;
}

/// A bitmap after a mapping: blend first, then black and white. @return where the next block begins
std::size_t read_bitmap(CalibratedProjector& p, std::size_t at, bool is_wanted, int number, ViosoReader const& r)
{
    r.part(at, kBmpHeader);
    std::size_t const offset = r.word(at + 10), width = r.word(at + 18);
    auto const rows = std::bit_cast<std::int32_t>(r.word(at + 22));
    std::size_t const height = rows < 0 ? std::size_t(-std::int64_t(rows)) : std::size_t(rows),
                      bits = r.word(at + 28) & 0xffff;
    if (int(width) != p.size_px.x || int(height) != p.size_px.y || width > kLargestMap_px ||
        (bits != 24 && bits != 32) || offset < kBmpHeader || offset > kMostHeader)
        throw r.error(at, fmt::format("a bitmap of {} x {} pixels of {} bits", width, height, bits),
                      "it has the size of its mapping, and 24 or 32 bits");
    std::size_t const size = std::max<std::size_t>(r.word(at + 2), offset + (width * bits + 31) / 32 * 4 * height);
    auto const bitmap = r.part(at, size);
    if (!is_wanted) return at + size;
    if (number == 0) {
        auto light = std::make_shared<PixelMap const>(parse_light(bitmap, kViosoGamma, r.name));
        p.wall.blend_picture = {
            {r.log.keep_file(p.wall.name + "_blend.bmp", {bitmap.begin(), bitmap.end()}), std::move(light)},
            kViosoGamma};
        r.lose(p, fmt::format("blend factors act on values: taken as those of a gamma of {:g}", kViosoGamma));
    } else
        r.lose(p, number == 1 ? "black level bitmaps, whose formula is not described: not imported"
                              : "further bitmaps: not imported");
    return at + size;
}

} // namespace

std::vector<CalibratedProjector> read_vioso(std::span<unsigned char const> bytes, std::string const& name,
                                            double unit_m, ImportLog const& log, std::optional<std::size_t> only)
{
    ViosoReader const r{bytes, name, log};
    if (bytes.size() < kSetHeader || !r.is(0, "vwf"))
        throw gi::InputError({name, 0, 0}, "this is no file of VIOSO", "its first bytes are not vwf",
                             "export the calibration as .vwf");
    std::vector<CalibratedProjector> projectors;
    std::size_t at = r.is(0, "vwf1") ? r.word(8) : 0;
    if (r.is(0, "vwf1") && at < kSetHeader)
        throw r.error(8, "a first block within the header", "blocks follow it");
    int bitmaps = 0;
    auto const is_wanted = [&] { return !only || projectors.size() == *only + 1; };
    while (at < bytes.size()) {
        if (r.is(at, "vwf0") || r.is(at, "vwf2")) {
            if (projectors.size() == kMostWalls)
                throw r.error(at, fmt::format("more than {} mappings", kMostWalls), "no room has so many");
            CalibratedProjector& p = projectors.emplace_back();
            at = read_mapping(p, at, is_wanted(), unit_m, r);
            bitmaps = 0;
        } else if (r.is(at, "BM") && !projectors.empty())
            at = read_bitmap(projectors.back(), at, is_wanted(), bitmaps++, r);
        else
            throw r.error(at, "neither a mapping nor a bitmap", "the file is damaged, or of a newer kind");
    }
    return projectors;
}

} // namespace viewer
