#include "viewer/devices/gl/fill_texture.h"

#include <epoxy/gl.h>

namespace viewer {

void fill_texture(GlObject const& texture, cv::Mat const& picture, unsigned format, unsigned type)
{
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    if (picture.step % picture.elemSize() == 0) {
        glPixelStorei(GL_UNPACK_ROW_LENGTH, GLint(picture.step / picture.elemSize()));
        glTextureSubImage2D(texture.id(), 0, 0, 0, picture.cols, picture.rows, format, type, picture.data);
    } else {
        glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
        for (int y = 0; y < picture.rows; ++y)
            glTextureSubImage2D(texture.id(), 0, 0, y, picture.cols, 1, format, type, picture.ptr(y));
    }
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

} // namespace viewer
