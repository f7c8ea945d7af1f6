#pragma once
// Screen-space light gathering volume (Fei and Wang): caustic photons in the pixels of the camera, as spherical
// harmonics of degree 1 by the direction from which they come, spread over neighbouring pixels.
//
// A pixel holds its photons' flux F = sum F_p, W, and V = sum F_p w_p (a ShColor). With A the area of the surface
// that it shows and m this surface's normal, the irradiance of a normal n is
//   E(n) = F / A * (1/4 + n . V/F / 2) / (1/4 + m . V/F / 2),
// the ratio of two convolutions with the cosine to degree 1. So sum A E(m) is the flux of the photons, for all
// pixels together and after any number of steps of gathering.
//
// Unlike the paper, which projects a neighbour's harmonics to the direction from it to the pixel, whole vectors
// are exchanged: light that lies on a surface does not travel along it.
//
// Memory: 80 bytes a pixel, 128 while gathering.

#include "gi/core/progress.h"
#include "gi/methods/photons/screen_volume_kernels.h"
#include "gi/raster/cut_outs.h"
#include "gi/render/frame_renderer.h"

#include <optional>
#include <span>

namespace gi {

struct ScreenVolumeSettings {
    int gathers = 8; ///< steps; light of a pixel then lies about sqrt(0.4 gathers) pixels around it
};

/// Light at the pixels of a screen, for kernels.
struct ScreenVolumeView {
    ScreenMap screen;
    View<ScreenSurface const> surfaces;
    View<ShColor const> light;

    /// W/m^2. @param normal  unit, on the side that is seen
    GI_FN vec3 irradiance(glm::ivec2 pixel, vec3 normal) const
    {
        std::size_t const k = std::size_t(pixel.y) * std::size_t(screen.size.x) + std::size_t(pixel.x);
        ScreenSurface const& surface = surfaces[k];
        if (!(surface.area > 0)) return vec3{0};
        ShColor const& l = light[k];
        vec3 const flux = l.integral(), least = glm::max(flux * 0.05f, vec3{1e-30f});
        auto const facing = [&](vec3 n) { return 0.25f * flux + (0.5f / ShColor::kY1) * l.along(n); };
        return glm::max(flux, vec3{0}) / surface.area * glm::max(facing(normal), vec3{0}) /
               glm::max(facing(surface.normal), least);
    }
    /// Between the pixels around a point that show its surface; false if none does.
    GI_FN bool irradiance_at(vec3 position, vec3 geometric_normal, vec3 normal, vec3& out) const
    {
        out = vec3{0};
        vec3 const p = screen.to * (position - screen.origin);
        if (!(p.z > 0)) return false;
        vec2 const at = vec2(p) / p.z - 0.5f, low = glm::floor(at), part = at - low;
        if (!(at.x > -1 && at.y > -1 && at.x < float(screen.size.x) && at.y < float(screen.size.y))) return false;
        float weights = 0;
        for (int k = 0; k < 4; ++k) {
            glm::ivec2 const q = glm::ivec2(low) + glm::ivec2{k & 1, k >> 1};
            if (q.x < 0 || q.y < 0 || q.x >= screen.size.x || q.y >= screen.size.y) continue;
            std::size_t const pixel = std::size_t(q.y) * std::size_t(screen.size.x) + std::size_t(q.x);
            if (!surfaces[pixel].holds(position, geometric_normal)) continue;
            float const weight =
                ((k & 1) != 0 ? part.x : 1 - part.x) * ((k >> 1) != 0 ? part.y : 1 - part.y) + 1e-6f;
            out += weight * irradiance(q, normal);
            weights += weight;
        }
        if (!(weights > 0)) return false;
        out /= weights;
        return true;
    }
};

class ScreenVolume {
public:
    explicit ScreenVolume(ScreenVolumeSettings const& settings) : settings_(settings) {}

    /// Draws what a perspective camera sees; what is seen through a lens is that of its centre.
    /// @param seed  of the random decisions about partial coverage
    void place(World const& world, TriangleSoup const& soup, CutOuts const& cut_outs, FrameView const& view,
               std::uint32_t seed = 0);
    /// Replaces the light. To be called after place(). Throws Interrupted, and is then to be called again.
    void update(std::span<Photon const> photons, BuildStop const& stop = BuildStop(nullptr));

    ScreenVolumeView view() const { return {screen_, surfaces_, light_}; }
    bool empty() const { return surfaces_.empty(); }
    dvec3 injected_w() const { return injected_w_; }
    dvec3 lost_w() const { return lost_w_; } ///< of photons that the camera does not see

private:
    ScreenVolumeSettings settings_;
    ScreenMap screen_{};
    std::vector<ScreenSurface> surfaces_;
    std::vector<ShColor> light_;
    dvec3 injected_w_{0}, lost_w_{0};
};

} // namespace gi
