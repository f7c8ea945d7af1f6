// Textures of what a window no longer shows are freed: other eyes, another method's pictures, larger windows.

#include "tests/viewer_gl/surfaceless.h"
#include "viewer/app/presenter.h"

#include <epoxy/gl.h>
#include <glm/gtc/matrix_transform.hpp>

namespace viewer::test {
namespace {

using KeptTextures = Surfaceless;

std::shared_ptr<LiveFrame> frame_of(glm::ivec2 size, int views, bool compared)
{
    gi::Picture picture{size.x, size.y, {}, {}};
    picture.add("color", 3);
    for (float& d : picture.add("depth", 1).data) d = 2;
    auto frame = std::make_shared<LiveFrame>();
    for (int k = 0; k < views; ++k) {
        ViewCommand view{"window", {}, size.x, size.y, -1};
        view.camera.yfov_rad = glm::radians(60.0);
        frame->command.views.push_back(view);
        frame->result.views.push_back({picture, {}, {}, {}});
        if (compared) frame->result.views.back().compared = picture;
    }
    return frame;
}

std::size_t texels_of_all_textures()
{
    std::size_t texels = 0;
    for (GLuint name = 1; name < 1000; ++name) {
        if (glIsTexture(name) == GL_FALSE) continue;
        GLint width = 0, height = 0;
        glGetTextureLevelParameteriv(name, 0, GL_TEXTURE_WIDTH, &width);
        glGetTextureLevelParameteriv(name, 0, GL_TEXTURE_HEIGHT, &height);
        texels += std::size_t(width) * std::size_t(height);
    }
    return texels;
}

class Shown {
public:
    /// @param turned  since the frame: it is drawn reprojected
    std::size_t texels_after(glm::ivec2 size, int views, bool compared, bool turned)
    {
        auto const frame = frame_of(size, views, compared);
        std::vector<Pane> const panes{
            {{0, 0}, size, views > 1 ? StereoMode::side_by_side : StereoMode::off, 0, views > 1 ? 1 : -1}};
        presenter_.take(frame, panes);
        TextureTarget const window(TextureTarget::Format::bytes, size);
        PresentSettings settings;
        if (compared) settings.comparison = Comparison::split;
        std::vector<gi::Camera> now;
        for (ViewCommand const& v : frame->command.views) {
            now.push_back(v.camera);
            if (turned) now.back().world_from_camera = glm::rotate(gi::dmat4(1), 0.05, gi::dvec3{0, 1, 0});
        }
        presenter_.draw(window.target(), {0, 0}, panes, settings, now);
        return texels_of_all_textures();
    }

private:
    Presenter presenter_{{}};
};

TEST_F(KeptTextures, AreThoseOfWhatIsShown)
{
    glm::ivec2 const large{320, 240}, small{64, 48};
    Shown window;
    std::size_t const first = window.texels_after(small, 1, false, false);
    EXPECT_GT(window.texels_after(large, 2, true, true), 8 * std::size_t(large.x * large.y))
        << "four pictures, and as many turned ones";
    EXPECT_EQ(window.texels_after(small, 1, false, false), first);
}

} // namespace
} // namespace viewer::test
