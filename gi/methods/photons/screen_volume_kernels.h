#pragma once
// Steps of the screen-space light gathering volume, as kernels for CPU and CUDA.

#include "gi/light_paths/photon.h"
#include "gi/methods/photons/sh_color.h"
#include "gi/methods/photons/splat_kernels.h"
#include "gi/raster/nearest_map.h"

namespace gi {

/// The part of a surface that a pixel shows.
struct ScreenSurface {
    static constexpr float kSameWay = 0.8f; ///< least cosine between normals of what counts as one surface

    vec3 position{0}; ///< m, at the pixel's centre
    float width = 0;  ///< of the pixel at this distance, across the view, m
    vec3 normal{0};   ///< unit, geometric, towards the eye
    float area = 0;   ///< m^2; 0 = nothing is seen

    /// Longest way over the surface within the pixel, about, m.
    GI_FN float length() const { return area / width; }
    /// True if a point belongs to this surface, in this pixel or next to it.
    /// @param normal_there  on the side asked for
    GI_FN bool holds(vec3 point, vec3 normal_there) const
    {
        if (!(area > 0) || !(glm::dot(normal, normal_there) > kSameWay)) return false;
        vec3 const way = point - position;
        return std::abs(glm::dot(way, normal)) <= width && glm::dot(way, way) <= square(2 * length());
    }
};

/// Item = pixel.
struct FindScreenSurfaces {
    PerspectiveGrid grid;
    WorldView world;
    View<NearestTexel const> seen;
    View<ScreenSurface> surfaces;

    GI_FN void operator()(std::size_t k) const
    {
        ScreenSurface out;
        NearestTexel const texel = seen[k];
        if (texel.primitive != kNoPrimitive && texel.key > 0) {
            auto const n = std::size_t(grid.width);
            vec3 const direction = grid.direction(std::uint32_t(k % n), std::uint32_t(k / n));
            float const depth = 1 / texel.key;
            // At one metre along the view:
            float const pixel =
                glm::length(glm::cross(grid.subpixels * grid.inverse[0], grid.subpixels * grid.inverse[1]));
            vec3 const normal = shading_detail::triangle_normal(world.surfaces[texel.primitive]);
            float const facing = glm::dot(normal, direction);
            constexpr float kGrazing = 0.01f; // of a surface seen more from the side a pixel knows too little
            if (std::abs(facing) > kGrazing * glm::length(direction)) {
                out.position = grid.eye + depth * direction;
                out.width = depth * std::sqrt(pixel);
                out.normal = facing > 0 ? -normal : normal;
                out.area = pixel * square(depth) / std::abs(facing);
            }
        }
        surfaces[k] = out;
    }
};

/// Light that arrives at a pixel's surface.
struct ScreenPhoton {
    vec3 flux;      ///< W
    vec3 direction; ///< unit, from which it comes
    GI_FN void add_to(ShColor& cell) const { cell.add_beam(flux, direction); }
};

/// Item = photon. Finds the pixel on whose surface it lies: that where it is seen, else a neighbour of that one,
/// as pixels at edges know one surface alone.
struct FindPhotonPixels {
    ScreenMap screen;
    View<ScreenSurface const> surfaces;
    View<Photon const> photons;
    View<ScreenPhoton> items;
    View<std::uint64_t> keys; ///< number of pixels = none: hidden, or beside the screen

    GI_FN void operator()(std::size_t k) const
    {
        Photon const& p = photons[k];
        items[k] = {p.flux, p.from};
        keys[k] = surfaces.size();
        glm::ivec2 const at = screen.pixel_of(p.position);
        if (at.x < 0 || !all_finite(p.flux)) return;
        float least = kInf;
        for (int n = 0; n < 9; ++n) {
            // The pixel itself first.
            glm::ivec2 const q = at + glm::ivec2{(n + 4) % 9 % 3 - 1, (n + 4) % 9 / 3 - 1};
            if (q.x < 0 || q.y < 0 || q.x >= screen.size.x || q.y >= screen.size.y) continue;
            std::size_t const pixel = std::size_t(q.y) * std::size_t(screen.size.x) + std::size_t(q.x);
            if (!surfaces[pixel].holds(p.position, p.normal)) continue;
            vec3 const way = p.position - surfaces[pixel].position;
            if (glm::dot(way, way) < least) {
                least = glm::dot(way, way);
                keys[k] = pixel;
            }
            if (n == 0) return;
        }
    }
};

/// Item = pixel. One step of gathering from the four neighbours.
struct GatherScreen {
    glm::ivec2 size;
    View<ScreenSurface const> surfaces;
    View<ShColor const> in;
    View<ShColor> out;

    GI_FN void operator()(std::size_t k) const
    {
        ScreenSurface const& here = surfaces[k];
        ShColor sum = in[k];
        auto const n = std::size_t(size.x);
        auto const x = int(k % n), y = int(k / n);
        if (here.area > 0) {
            if (x > 0) exchange(k, k - 1, sum);
            if (x + 1 < size.x) exchange(k, k + 1, sum);
            if (y > 0) exchange(k, k - n, sum);
            if (y + 1 < size.y) exchange(k, k + n, sum);
        }
        out[k] = sum;
    }

private:
    /// Adds what comes from a pixel and takes what goes there: in proportion to the difference of irradiances, by
    /// a factor that both share. So light is neither made nor lost, and what is even stays even.
    GI_FN void exchange(std::size_t k, std::size_t other, ShColor& sum) const
    {
        ScreenSurface const &a = surfaces[k], &b = surfaces[other];
        if (!joined(a, b)) return;
        constexpr float kShare = 0.2f; // all of five pixels the same
        float const by = kShare * glm::min(a.area, b.area);
        sum += (by / b.area) * in[other];
        sum += (-by / a.area) * in[k];
    }
    /// Alike from both sides.
    GI_FN bool joined(ScreenSurface const& a, ScreenSurface const& b) const
    {
        if (!(b.area > 0) || !(glm::dot(a.normal, b.normal) > ScreenSurface::kSameWay)) return false;
        vec3 const way = b.position - a.position;
        float const squared = glm::dot(way, way), most = 2 * glm::max(a.length(), b.length());
        float const across = glm::max(std::abs(glm::dot(way, a.normal)), std::abs(glm::dot(way, b.normal)));
        // What bends away by the angle that normals may differ is still one surface.
        constexpr float kBend = 0.6f;
        return squared <= square(most) && across <= kBend * std::sqrt(squared);
    }
};

} // namespace gi
