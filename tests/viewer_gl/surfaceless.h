#pragma once
// A context without a window for tests, or a visible skip where EGL has none.

#include "gi/core/error.h"
#include "viewer/devices/gl/context.h"

#include <gtest/gtest.h>
#include <optional>

namespace viewer::test {

class Surfaceless : public ::testing::Test {
protected:
    void SetUp() override
    {
        try {
            gl.emplace(GlContext::surfaceless(report));
        } catch (gi::InputError const& e) {
            GTEST_SKIP() << "SKIPPED: " << e.what();
        }
    }
    void TearDown() override
    {
        if (!gl) return;
        EXPECT_EQ(gl->errors(), expected_errors);
        for (auto const& [what, loss] : report.losses())
            if (expected_errors == 0) ADD_FAILURE() << what << ": " << loss.first;
        gl.reset();
    }

    gi::Report report;
    std::optional<GlContext> gl;
    std::uint64_t expected_errors = 0;
};

} // namespace viewer::test
