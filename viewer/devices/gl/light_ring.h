#pragma once
// The newest pictures of light on the GPU (gi/surfaces/light_picture.h), of all views: what one does not show, an older one may.

#include "gi/surfaces/light_picture.h"
#include "viewer/devices/gl/gl_program.h"

#include <vector>

namespace viewer {

class LightRing {
public:
    static constexpr int kPictures = 3; ///< that a look-up asks

    /// Adds the light of a view's next picture; takes the place of the view's oldest one.
    /// @param origin  of the world
    void add(int view, gi::LightPicture const& light, gi::dvec3 origin);
    void clear() { entries_.clear(); }
    bool empty() const { return entries_.empty(); }
    /// Binds them to unit 2 and sets the uniforms of shaders/surface_light.glsl, the view's own newest first.
    void bind(GlProgram const& program, int view) const;

private:
    struct Entry {
        int view = 0, layer = 0;
        std::uint64_t number = 0; ///< counts pictures
        glm::vec3 eye{0};
        glm::mat3 texel_from_world{1};
        glm::vec2 at{0.5f};
    };
    std::vector<Entry> sorted_for(int view) const;

    GlObject texels_; ///< a layer for each
    int width_ = 0, height_ = 0, layers_ = 0;
    std::uint64_t count_ = 0;
    glm::vec3 mean_{0}; ///< of the light of the last dozen pictures, smoothed
    std::vector<Entry> entries_;
};

} // namespace viewer
