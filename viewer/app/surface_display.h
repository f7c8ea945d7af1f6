#pragma once
// Shows drawn surfaces: their picture is encoded, its outlines are smoothed, and it is stretched to the view's size. A
// software driver takes a third of the time if it encodes first.

#include "viewer/devices/gl/display_pass.h"
#include "viewer/devices/gl/outline_pass.h"

#include <map>

namespace viewer {

/// Belongs to the context that was current at its creation.
class SurfaceDisplay {
public:
    /// Drivers compile then, which takes long the first time.
    SurfaceDisplay();
    /// Returns smoothed().
    TextureTarget const& draw(int number, DisplayPass& pass, DrawTarget const& to, EyeView const& view,
                              DisplaySettings const& settings);
    /// The smoothed picture before it is stretched. Valid until the next one of this number.
    TextureTarget const& smoothed(int number, DisplayPass& pass, EyeView const& view,
                                  DisplaySettings const& settings);

private:
    struct Textures {
        TextureTarget encoded, smoothed;
    };
    std::map<int, Textures> textures_;
    OutlinePass outlines_;
};

} // namespace viewer
