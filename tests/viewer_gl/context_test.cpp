#include "tests/viewer_gl/surfaceless.h"

#include <epoxy/gl.h>
#include <thread>

namespace viewer::test {
namespace {

using Context = Surfaceless;

TEST_F(Context, IsOpenGl45Core)
{
    GLint major = 0, minor = 0, profile = 0;
    glGetIntegerv(GL_MAJOR_VERSION, &major);
    glGetIntegerv(GL_MINOR_VERSION, &minor);
    glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
    EXPECT_GE(10 * major + minor, 45);
    EXPECT_EQ(profile, GL_CONTEXT_CORE_PROFILE_BIT);
    EXPECT_NE(gl->egl().display, nullptr);
    EXPECT_NE(gl->egl().context, nullptr);
    EXPECT_EQ(gl->glx().display, nullptr);
    RecordProperty("context", gl->description());
}

TEST_F(Context, CountsErrorsInTheReport)
{
    expected_errors = 2;
    glEnable(0xBADC0DE);
    glBindTexture(GL_TEXTURE_2D, 12345);
    EXPECT_EQ(gl->errors(), 2u);
    auto const losses = report.losses();
    ASSERT_TRUE(losses.contains("OpenGL errors"));
    EXPECT_EQ(losses.at("OpenGL errors").count, 2u);
    EXPECT_FALSE(losses.at("OpenGL errors").first.empty());
    while (glGetError() != GL_NO_ERROR) {
    }
}

TEST_F(Context, TwoLiveSideBySide)
{
    gi::Report other_report;
    {
        GlContext const other = GlContext::surfaceless(other_report);
        EXPECT_NE(other.egl().context, gl->egl().context);
        glClear(GL_COLOR_BUFFER_BIT << 20); // invalid, in the other one
        EXPECT_EQ(other.errors(), 1u);
    }
    gl->make_current();
    EXPECT_NE(glGetString(GL_VERSION), nullptr);
}

TEST_F(Context, MovesToAnotherThread)
{
    std::string refused;
    std::thread([&] {
        try {
            gl->make_current();
        } catch (gi::InputError const& e) {
            refused = e.what();
        }
    }).join();
    EXPECT_NE(refused.find("another thread"), std::string::npos);
    gl->release();
    bool drew = false;
    std::thread([&] {
        gl->make_current();
        drew = glGetString(GL_VERSION) != nullptr;
        gl->release();
    }).join();
    EXPECT_TRUE(drew);
    gl->make_current();
}

} // namespace
} // namespace viewer::test
