#pragma once
// Depth of field, and motion blur of a camera that moves, from a layered hit buffer of the view (Yu 2012, sec. 7.2,
// after Lee, Eisemann and Seidel 2010 and McGuire, Enderton, Shirley and Luebke 2010): surfaces are shaded once, as
// the lens' centre sees them at the moment of the pass, and every pixel gathers from them by many rays, each through
// another point of the lens and at another moment of the exposure. What these meet is found exactly; what the layers
// lack, or show where the ray sees nothing of it, is shaded for the ray alone. The world stands still meanwhile.

#include "gi/methods/paths/screen_layers.h"
#include "gi/methods/paths/tracer.h"
#include "gi/scene/model/projection.h"

#include <functional>
#include <vector>

namespace gi {

/// The camera at the moments at which rays of a pass see it. @param camera_at  as in Moment
std::vector<Camera> cameras_during(std::function<Camera(double)> const& camera_at, std::uint64_t seed,
                                   std::uint32_t pass);

class LayeredLens {
public:
    /// What the lens rays of a pass have in common.
    struct View {
        CameraRays const& rays;             ///< at the moment of the pass; with a lens, or it moves
        std::span<CameraRays const> during; ///< at successive moments of the exposure; empty = it does not move
        int width, height;      ///< pixels
        PixelFilter filter;
        std::span<std::uint8_t const> hidden; ///< as in FrameView
        std::uint64_t seed;
        std::uint32_t pass;
    };
    /// What they may meet.
    struct Place {
        TriangleSoup const& soup;
        CutOuts const& cut_outs;
        WorldView world;
        ExactVisibility const& exact;
    };

    /// Draws the layers anew, and follows the lens rays of all pixels.
    void look(View const& view, Place const& place, float near_m, PassStop const& stop);
    /// Of all surfaces that lens rays met.
    std::span<PathStart const> starts() const { return starts_; }
    /// Means of the paths over a pixel's lens rays; of the first of them alone, what can have no mean (whether it met
    /// something, its place). @param samples  one per start
    PathSample gather(View const& view, WorldView const& world, std::size_t pixel,
                      std::span<PathSample const> samples) const;
    /// Lens rays of the pass; of these, those that met what no layer in their sight shows.
    std::uint64_t rays() const { return asked_; }
    std::uint64_t alone() const { return alone_; }

private:
    static constexpr std::uint32_t kBackground = 0xffffffffu;

    struct Alone {
        std::size_t at; ///< place in met_
        PathStart start;
    };

    void draw(View const& view, Place const& place, float near_m);
    void choose_numbers(View const& view);
    /// What lens and motion spread a point over.
    struct Blur {
        float area_px2 = 0, reach_px = 0;
    };
    Blur blur(View const& view, std::size_t tile, float depth_m) const;
    bool follow_all(View const& view, Place const& place, PassStop const& stop);
    std::size_t follow(View const& view, Place const& place, std::size_t first, std::size_t last,
                       std::vector<Alone>& alone);
    struct Found {
        std::uint32_t layer = kBackground;
        bool hidden = false; ///< from the lens' centre
        vec3 position{0};    ///< of the layer
    };
    Found layer_of(Place const& place, Hit const& hit, vec3 direction) const;
    Ray layer_ray(std::size_t texel) const;
    void make_starts(View const& view);
    int rays_of(View const& view, std::size_t pixel) const;
    Ray lens_ray(View const& view, std::size_t pixel, int k, int rays) const;

    ScreenLayers layers_;
    CameraRays eye_{}; ///< of the layers
    std::vector<Projection> during_; ///< of View::during, to pixels
    int most_rays_ = 0;
    vec2 at_{0.5f};                   ///< place in the pixel
    std::vector<Blur> blurs_;         ///< per tile of the layers: the largest
    std::vector<int> rays_of_;        ///< per tile: lens rays of its pixels
    std::vector<std::uint32_t> met_;  ///< per pixel and lens ray: the index of a start
    std::vector<std::uint32_t> slot_; ///< per layer: the same
    std::vector<PathStart> starts_;
    std::uint64_t asked_ = 0, alone_ = 0;
};

} // namespace gi
