#pragma once
// An X server for the tests of one suite, or a visible skip where there is none.

#include "gi/core/error.h"
#include "tests/support/xvfb.h"
#include "viewer/devices/gl/window.h"

#include <gtest/gtest.h>
#include <memory>

namespace viewer::test {

class OnXvfb : public ::testing::Test {
protected:
    static void SetUpTestSuite() { server = std::make_unique<gi::test::Xvfb>(800, 600); }
    static void TearDownTestSuite() { server.reset(); }
    void SetUp() override
    {
        if (!server->problem().empty()) GTEST_SKIP() << "SKIPPED: " << server->problem();
    }
    void TearDown() override
    {
        for (auto const& [what, loss] : report.losses())
            if (what.starts_with("OpenGL")) ADD_FAILURE() << what << ": " << loss.first;
    }

    static inline std::unique_ptr<gi::test::Xvfb> server;
    gi::Report report;
};

} // namespace viewer::test
