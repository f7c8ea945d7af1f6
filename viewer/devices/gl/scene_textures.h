#pragma once
// The textures of a scene on the GPU, with mip maps; colours are decoded from sRGB by texture units.

#include "gi/scene/model/texture.h"
#include "viewer/devices/gl/gl_object.h"

#include <vector>

namespace viewer {

class SceneTextures {
public:
    /// Of another scene: nothing is there yet.
    void begin(std::size_t textures) { textures_ = std::vector<GlObject>(textures); }
    /// Uploads a texture unless it is there. Returns false if it was.
    bool upload(gi::TexturePool const& pool, std::size_t texture);
    unsigned id(std::size_t texture) const { return textures_[texture].id(); }

private:
    std::vector<GlObject> textures_;
};

} // namespace viewer
