#pragma once
// The newest pictures of light on the GPU (gi/surfaces/light_picture.h), of all views: what one does not show, an older one may.

#include "gi/surfaces/light_cells.h"
#include "viewer/devices/gl/gl_program.h"

#include <vector>

namespace viewer {

class LightRing {
public:
    static constexpr int kPictures = 3; ///< that a look-up asks

    /// Adds the light of a view's next picture; takes the place of the view's oldest one. Those of other lamps go.
    /// @param origin  of the world
    void add(int view, gi::LightPicture const& light, gi::dvec3 origin);
    void take(std::shared_ptr<gi::LightCellTable const> cells);
    void clear();
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
        glm::ivec2 size{};
        bool without_punctual = false;
    };
    std::vector<Entry> sorted_for(int view) const;
    void make_cells();

    GlObject texels_, slopes_;                ///< a layer for each
    std::uint64_t lamps_ = 0;                 ///< LightPicture::lamps of all entries
    int width_ = 0, height_ = 0, layers_ = 0; ///< of the textures; pictures may be smaller
    std::uint64_t count_ = 0;
    std::shared_ptr<gi::LightCellTable const> known_; ///< what no picture shows; null = nothing
    GlObject cells_;
    glm::vec3 mean_{0}; ///< of the light of the last dozen pictures, smoothed
    std::vector<Entry> entries_;
};

} // namespace viewer
