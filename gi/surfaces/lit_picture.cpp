#include "gi/surfaces/lit_picture.h"

#include "gi/filter/filter_input.h"

#include <tbb/combinable.h>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

void put(Layer& layer, std::size_t pixel, vec3 v)
{
    for (std::size_t c = 0; c < 3; ++c) layer.data[3 * pixel + c] = v[int(c)];
}

} // namespace

Picture lit_picture(SeenSurfaces const& seen, int width, int height, KeptLight const& light,
                    std::span<std::uint8_t const> hidden, LitCounts& counts, CameraRays const* before, vec2 margin)
{
    Picture picture{width, height, {}, {}};
    picture.add("color", 3);
    picture.add("depth", 1);
    float* const color = picture.find("color")->data.data();
    float* const depth = picture.find("depth")->data.data();
    Layer* const motion = before ? &picture.add("motion", 3) : nullptr;
    if (motion) std::ranges::fill(motion->data, std::numeric_limits<float>::quiet_NaN());
    std::optional<Projection> const project_before = before ? std::optional<Projection>(*before) : std::nullopt;
    vec2 const of_light{light.width(), light.height()}, smaller = of_light / (vec2{width, height} - 2.0f * margin);
    tbb::combinable<LitCounts> sums;
    tbb::parallel_for(0, height, [&](int y) {
        thread_local std::vector<SeenSurface> row;
        row.assign(std::size_t(width), {});
        seen.row(y, row);
        LitCounts& local = sums.local();
        for (int x = 0; x < width; ++x) {
            std::size_t const i = std::size_t(y) * std::size_t(width) + std::size_t(x);
            if (!hidden.empty() && hidden[i] != 0) continue;
            SeenSurface const& s = row[std::size_t(x)];
            vec3 radiance = s.emitted + s.direct;
            vec2 const place = vec2{float(x), float(y)} + seen.at();
            if (s.depth > 0) {
                vec2 const at = glm::clamp(smaller * (place - margin), vec2{0.5f}, of_light - 0.5f);
                FoundLight const found = light.find(s.position, s.normal, at);
                radiance += s.albedo * (found.direct + found.indirect);
                ++local.surfaces;
                local.unlike += found.likeness < KeptLight::kUnlike;
            }
            for (std::size_t c = 0; c < 3; ++c) color[3 * i + c] = radiance[int(c)];
            depth[i] = s.depth;
            if (!motion) continue;
            bool const is_surface = s.depth > 0;
            vec3 const was = (*project_before)(
                is_surface ? s.position - s.moved : before->origin + seen.camera().through(place).direction);
            if (was.z > 0) put(*motion, i, {was.x - place.x, was.y - place.y, is_surface ? was.z : 0});
        }
    });
    sums.combine_each([&](LitCounts const& c) {
        counts.surfaces += c.surfaces;
        counts.unlike += c.unlike;
    });
    return picture;
}

Picture mirror_picture(SeenSurfaces const& seen, PixelBox const& part, int width, int height,
                       KeptLight const& light, Picture const& of_light)
{
    Picture picture{width, height, {}, {}};
    Layer const &from = *of_light.find("color"), &light_depth = *of_light.find(seen_depth_of(of_light));
    picture.add("color", 3);
    picture.add("depth", 1);
    std::vector<float>&color = picture.find("color")->data,
    &depth = picture.find("depth")->data; // after all are added
    vec2 const smaller = vec2{light.width(), light.height()} / vec2{width, height};
    tbb::parallel_for(0, height, [&](int y) {
        thread_local std::vector<SeenSurface> row;
        row.assign(std::size_t(part.high.x - part.low.x), {});
        bool const shows = y >= part.low.y && y < part.high.y;
        if (shows) seen.row_of_mirrors(y - part.low.y, row);
        for (int x = 0; x < width; ++x) {
            std::size_t const i = std::size_t(y) * std::size_t(width) + std::size_t(x);
            bool const in_part = shows && x >= part.low.x && x < part.high.x;
            vec2 const place = smaller * (vec2{float(x), float(y)} + seen.at());
            std::size_t const j = std::size_t(place.y * float(of_light.height) / float(light.height())) *
                                      std::size_t(of_light.width) +
                                  std::size_t(place.x * float(of_light.width) / float(light.width()));
            vec3 radiance = rgb(from, j);
            depth[i] = in_part ? seen.depth(x - part.low.x, y - part.low.y) : light_depth.data[j];
            if (SeenSurface const& s = row[in_part ? std::size_t(x - part.low.x) : 0]; in_part && s.in_mirror) {
                radiance = s.emitted + s.direct;
                if (s.depth > 0) {
                    FoundLight const found =
                        light.find(s.position, s.normal,
                                   glm::clamp(place, vec2{0.5f}, vec2{light.width(), light.height()} - 0.5f));
                    radiance += s.albedo * (found.direct + found.indirect);
                }
                depth[i] = s.depth;
            }
            for (std::size_t c = 0; c < 3; ++c) color[3 * i + c] = radiance[int(c)];
        }
    });
    return picture;
}

MirrorLayers describe_mirrored(SeenSurfaces const& seen, CameraRays const& now, CameraRays const& before,
                               dvec3 origin, Picture& picture)
{
    MirrorLayers was;
    Layer *const albedo = picture.find("albedo"), *const normal = picture.find("normal"),
                 *const position = picture.find("position"), *const depth = picture.find("depth"),
                 *const motion = picture.find("motion");
    if (!albedo || !normal || !position || !depth || !motion) return was;
    Projection const project_now(now), project_before(before);
    std::vector<MirrorLayers> rows(std::size_t(picture.height));
    tbb::parallel_for(0, picture.height, [&](int y) {
        thread_local std::vector<SeenSurface> row;
        row.assign(std::size_t(picture.width), {});
        seen.row_of_mirrors(y, row);
        MirrorLayers& kept = rows[std::size_t(y)];
        for (int x = 0; x < picture.width; ++x) {
            SeenSurface const& s = row[std::size_t(x)];
            std::size_t const i = std::size_t(y) * std::size_t(picture.width) + std::size_t(x);
            if (!s.in_mirror || !(depth->data[i] > 0)) continue;
            kept.pixels.push_back(std::uint32_t(i));
            kept.layers.push_back({rgb(*albedo, i), rgb(*normal, i), rgb(*position, i)});
            kept.depths.push_back(depth->data[i]);
            if (s.is_image) kept.images.push_back({std::uint32_t(i), s.is_reflected, rgb(*position, i)});
            put(*albedo, i, s.albedo);
            put(*normal, i, s.normal);
            put(*position, i, vec3(dvec3(s.position) + origin));
            depth->data[i] = s.depth;
            vec3 const from = project_now(s.position), at = project_before(s.position - s.moved);
            bool const known = s.depth > 0 && at.z > 0;
            put(*motion, i,
                known ? vec3{at.x - from.x, at.y - from.y, at.z} : vec3{std::numeric_limits<float>::quiet_NaN()});
        }
    });
    for (MirrorLayers const& r : rows) {
        was.pixels.insert(was.pixels.end(), r.pixels.begin(), r.pixels.end());
        was.layers.insert(was.layers.end(), r.layers.begin(), r.layers.end());
        was.depths.insert(was.depths.end(), r.depths.begin(), r.depths.end());
        was.images.insert(was.images.end(), r.images.begin(), r.images.end());
    }
    return was;
}

void describe_mirrors(MirrorLayers const& was, Picture& picture)
{
    if (was.pixels.empty()) return;
    Layer seen = *picture.find("depth");
    seen.name = "seen_depth";
    for (std::size_t k = 0; k < was.pixels.size(); ++k) {
        std::size_t const i = was.pixels[k];
        put(*picture.find("albedo"), i, was.layers[k][0]);
        put(*picture.find("normal"), i, was.layers[k][1]);
        put(*picture.find("position"), i, was.layers[k][2]);
        picture.find("depth")->data[i] = was.depths[k];
    }
    picture.layers.push_back(std::move(seen));
}

} // namespace gi
