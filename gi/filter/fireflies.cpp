#include "gi/filter/fireflies.h"

#include "gi/filter/filter_input.h"
#include "gi/filter/for_rows.h"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

constexpr int kFireflyReach = 3; // pixels to each side of a window
constexpr int kFireflyWindow = (2 * kFireflyReach + 1) * (2 * kFireflyReach + 1);
constexpr float kBrighter = 2;    // ratio of a pixel's light to that of the pixels that support it
constexpr float kSupport = 0.06f; // share of a window's pixels that must support a pixel
constexpr int kGiveReach = 10;    // pixels to each side that get the light of a firefly
constexpr int kFewest = 6;        // similar pixels that a window needs
constexpr float kUnseen = 0.5f;   // light below this share of the light around is not worth clamping
constexpr float kLikeNormals = 0.8f,
                kOffPlane2 = 0.04f; // of similar surfaces: normals, and (distance from the plane / distance)^2

/// Luminances of the light over the albedo and surfaces of a picture.
struct LitSurfaces {
    Layer const &l1, &l2, &albedo, &normal, &position;
    int width, height;
    std::vector<vec2> light; ///< direct, indirect; negative = no surface

    explicit LitSurfaces(Picture const& p)
        : l1(needed_layer(p, "L1")),
          l2(needed_layer(p, "L2")),
          albedo(needed_layer(p, "albedo")),
          normal(needed_layer(p, "normal")),
          position(needed_layer(p, "position")),
          width(p.width),
          height(p.height),
          light(p.pixels())
    {
        tbb::parallel_for(0, height, [&](int y) {
            for (std::size_t i = std::size_t(y) * std::size_t(width), end = i + std::size_t(width); i < end; ++i) {
                vec3 const a = rgb(albedo, i), e1 = over_albedo(rgb(l1, i), a), e2 = over_albedo(rgb(l2, i), a);
                bool const known =
                    rgb(normal, i) != vec3{0} && max_component(a) >= kDarkest && in_range(e1) && in_range(e2);
                light[i] = known ? glm::max(vec2{0}, vec2{luminance(e1), luminance(e2)}) : vec2{-1};
            }
        });
    }
    bool known(std::size_t i) const { return light[i].x >= 0; }
};

/// Offsets of a window's pixels, nearest first.
std::array<std::array<int, 2>, kFireflyWindow> const& nearest_first()
{
    static auto const offsets = [] {
        std::array<std::array<int, 2>, kFireflyWindow> all;
        for (int k = 0; k < kFireflyWindow; ++k)
            all[std::size_t(k)] = {k % (2 * kFireflyReach + 1) - kFireflyReach,
                                   k / (2 * kFireflyReach + 1) - kFireflyReach};
        std::stable_sort(all.begin(), all.end(),
                         [](auto a, auto b) { return a[0] * a[0] + a[1] * a[1] < b[0] * b[0] + b[1] * b[1]; });
        return all;
    }();
    return offsets;
}

/// A pixel's surface, to be looked for in the windows of its own and of the other picture.
struct LikeSurface {
    vec3 normal, position;

    LikeSurface(LitSurfaces const& in, std::size_t i) : normal(rgb(in.normal, i)), position(rgb(in.position, i)) {}
    bool is(LitSurfaces const& in, std::size_t j) const
    {
        vec3 const to = rgb(in.position, j) - position;
        float const off = glm::dot(normal, to);
        return glm::dot(normal, rgb(in.normal, j)) >= kLikeNormals && off * off <= kOffPlane2 * glm::dot(to, to);
    }
};

/// True if a window certainly supports the light. Most light is, by the first few pixels looked at.
bool is_supported(LitSurfaces const& in, std::size_t at, LikeSurface const& surface, vec2 light, bool itself)
{
    constexpr float kUnseenPart = kBrighter * kUnseen;
    constexpr int kEnough = std::max(1, int(kSupport * kFireflyWindow)) + 1;
    int const x = int(at % std::size_t(in.width)), y = int(at / std::size_t(in.width));
    int direct = light.x > 0 ? 0 : kEnough, indirect = light.y > 0 ? 0 : kEnough;
    for (std::size_t k = itself ? 0 : 1; k < kFireflyWindow; ++k) {
        if (direct >= kEnough && indirect >= kEnough) return true;
        auto const [dx, dy] = nearest_first()[k];
        int const u = x + dx, v = y + dy;
        if (u < 0 || v < 0 || u >= in.width || v >= in.height) continue;
        std::size_t const j = std::size_t(v) * std::size_t(in.width) + std::size_t(u);
        vec2 const there = in.light[j];
        if (there.x < 0) continue;
        float const unseen = kUnseenPart * (there.x + there.y);
        bool const a = std::max(kBrighter * there.x, unseen) >= light.x,
                   b = std::max(kBrighter * there.y, unseen) >= light.y;
        if (!((a && direct < kEnough) || (b && indirect < kEnough)) || !surface.is(in, j)) continue;
        direct += a;
        indirect += b;
    }
    return direct >= kEnough && indirect >= kEnough;
}

/// The pixels of a pixel's window that show a similar surface, itself included.
std::vector<std::size_t> similar_around(LitSurfaces const& in, std::size_t at)
{
    std::vector<std::size_t> around;
    LikeSurface const surface(in, at);
    int const x = int(at % std::size_t(in.width)), y = int(at / std::size_t(in.width));
    for (int v = std::max(0, y - kGiveReach); v <= std::min(in.height - 1, y + kGiveReach); ++v)
        for (int u = std::max(0, x - kGiveReach); u <= std::min(in.width - 1, x + kGiveReach); ++u) {
            std::size_t const j = std::size_t(v) * std::size_t(in.width) + std::size_t(u);
            if (j == at || (in.known(j) && surface.is(in, j))) around.push_back(j);
        }
    return around;
}

/// Light of the similar pixels of a window.
struct FireflyWindow {
    std::array<vec2, kFireflyWindow> light;
    int count = 0;

    /// @param at  pixel in the middle  @param itself  it counts too
    FireflyWindow(LitSurfaces const& in, std::size_t at, LikeSurface const& surface, bool itself)
    {
        int const x = int(at % std::size_t(in.width)), y = int(at / std::size_t(in.width));
        for (int v = std::max(0, y - kFireflyReach); v <= std::min(in.height - 1, y + kFireflyReach); ++v)
            for (int u = std::max(0, x - kFireflyReach); u <= std::min(in.width - 1, x + kFireflyReach); ++u) {
                std::size_t const j = std::size_t(v) * std::size_t(in.width) + std::size_t(u);
                if (!in.known(j) || (!itself && u == x && v == y) || !surface.is(in, j)) continue;
                light[std::size_t(count++)] = in.light[j];
            }
    }
    /// The largest supported values of direct and indirect light; infinite if the window says nothing.
    vec2 limit()
    {
        if (count < kFewest) return vec2{kLargest};
        int const rank = std::max(1, int(kSupport * float(count)));
        auto const largest = [&](auto const& value) {
            std::array<float, kFireflyWindow> values;
            for (int k = 0; k < count; ++k) values[std::size_t(k)] = value(light[std::size_t(k)]);
            std::nth_element(values.begin(), values.begin() + rank, values.begin() + count, std::greater<>());
            return values[std::size_t(rank)];
        };
        float const all = largest([](vec2 v) { return v.x + v.y; });
        if (!(all > 0)) return vec2{kLargest};
        vec2 const each{largest([](vec2 v) { return v.x; }), largest([](vec2 v) { return v.y; })};
        return kBrighter * glm::max(each, vec2{kUnseen * all});
    }
};

} // namespace

void FireflyCounts::add(FireflyCounts const& more)
{
    pixels += more.pixels;
    clamped += more.clamped;
    by_eye += more.by_eye;
    light += more.light;
    moved += more.moved;
}

std::vector<Firefly> find_fireflies(FireflyView const& view, FireflyCounts& total)
{
    LitSurfaces const own(*view.picture);
    std::optional<LitSurfaces> other;
    if (view.other) other.emplace(*view.other);
    std::vector<std::vector<Firefly>> rows(std::size_t(own.height));
    std::vector<FireflyCounts> counts(rows.size()); // summed in order, so that sums do not depend on threads
    for_rows(own.height, view.stop, [&](int y) {
        FireflyCounts& count = counts[std::size_t(y)];
        for (std::size_t i = std::size_t(y) * std::size_t(own.width), end = i + std::size_t(own.width); i < end;
             ++i) {
            if (!own.known(i)) continue;
            ++count.pixels;
            vec2 const here = own.light[i];
            float const bright = luminance(rgb(own.l1, i)) + luminance(rgb(own.l2, i));
            count.light += double(bright);
            if (!view.from.empty() && view.from[i] != kOwnLight) continue;
            LikeSurface const surface(own, i);
            vec2 around{kLargest}, there{kLargest};
            if (!is_supported(own, i, surface, here, false))
                around = FireflyWindow(own, i, surface, false).limit();
            if (other && view.same[i] != kOwnLight && !is_supported(*other, view.same[i], surface, here, true))
                there = FireflyWindow(*other, view.same[i], surface, true).limit();
            vec2 const limit = glm::min(around, there);
            if (here.x <= limit.x && here.y <= limit.y) continue;
            Firefly const f{std::uint32_t(i), here.x > limit.x ? limit.x / here.x : 1,
                            here.y > limit.y ? limit.y / here.y : 1};
            rows[std::size_t(y)].push_back(f);
            ++count.clamped;
            count.by_eye += here.x <= around.x && here.y <= around.y;
            count.moved +=
                double((1 - f.direct) * luminance(rgb(own.l1, i)) + (1 - f.indirect) * luminance(rgb(own.l2, i)));
        }
    });
    std::vector<Firefly> found;
    for (std::size_t y = 0; y < rows.size(); ++y) {
        found.insert(found.end(), rows[y].begin(), rows[y].end());
        total.add(counts[y]);
    }
    return found;
}

void clamp_fireflies(Picture& picture, std::span<Firefly const> fireflies)
{
    Layer const& l0 = needed_layer(picture, "L0");
    Layer &l1 = needed_layer(picture, "L1"), &l2 = needed_layer(picture, "L2"),
          &color = needed_layer(picture, "color");
    Layer *const variance1 = picture.find("variance_direct"), *const variance2 = picture.find("variance_indirect"),
                 *const variance = picture.find("variance");
    LitSurfaces const surfaces(picture);
    // Before anything changes, as windows overlap.
    std::vector<std::array<vec3, 2>> excess;
    for (Firefly const& f : fireflies) {
        vec3 const a = rgb(surfaces.albedo, f.pixel);
        excess.push_back({(1 - f.direct) * over_albedo(rgb(l1, f.pixel), a),
                          (1 - f.indirect) * over_albedo(rgb(l2, f.pixel), a)});
    }
    for (Firefly const& f : fireflies) {
        for (std::size_t c = 0; c < 3; ++c) {
            std::size_t const k = 3 * f.pixel + c;
            float const before = color.data[k];
            l1.data[k] *= f.direct;
            l2.data[k] *= f.indirect;
            color.data[k] = l0.data[k] + l1.data[k] + l2.data[k];
            if (variance && before > 0) variance->data[k] *= square(color.data[k] / before);
        }
        // A value below 0 says that it is not known.
        if (variance1) variance1->data[f.pixel] *= square(f.direct);
        if (variance2) variance2->data[f.pixel] *= square(f.indirect);
    }
    for (std::size_t k = 0; k < fireflies.size(); ++k) {
        std::vector<std::size_t> const around = similar_around(surfaces, fireflies[k].pixel);
        float const share = 1 / float(around.size());
        for (std::size_t const j : around)
            for (std::size_t c = 0; c < 3; ++c) {
                float const a = rgb(surfaces.albedo, j)[int(c)];
                if (a < kDarkest) continue;
                float const e1 = share * excess[k][0][int(c)] * a, e2 = share * excess[k][1][int(c)] * a;
                l1.data[3 * j + c] += e1;
                l2.data[3 * j + c] += e2;
                color.data[3 * j + c] += e1 + e2;
            }
    }
}

} // namespace gi
