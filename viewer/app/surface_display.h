#pragma once
// Shows drawn surfaces: the picture of each eye is encoded, and its outlines are smoothed, before both are composed at the
// view's size. A software driver takes a third of the time if it encodes first.

#include "viewer/devices/gl/display_pass.h"
#include "viewer/devices/gl/outline_pass.h"

#include <map>
#include <utility>

namespace viewer {

/// Belongs to the context that was current at its creation.
class SurfaceDisplay {
public:
    using Key = std::pair<std::size_t, int>; ///< place of a pane, and view
    /// Drivers compile then, which takes long the first time.
    SurfaceDisplay();
    /// One eye's picture, encoded; smoothed if it is drawn. Valid until the next one of this key.
    /// @param settings  their stereo mode is not read
    TextureTarget const& encoded(Key key, DisplayPass& pass, EyeView const& eye, DisplaySettings settings);
    /// Frees the textures of other keys.
    template <class Keys>
    void keep(Keys const& keys)
    {
        std::erase_if(textures_, [&](auto const& t) { return !keys.contains(t.first); });
    }
    /// Shows encoded pictures of both eyes, stretched where they are smaller. @param right  not read if stereo is off
    static void compose(DisplayPass& pass, DrawTarget const& to, TextureTarget const& left,
                        TextureTarget const& right, DisplaySettings settings);

private:
    struct Textures {
        TextureTarget encoded, smoothed;
    };
    std::map<Key, Textures> textures_;
    OutlinePass outlines_;
};

} // namespace viewer
