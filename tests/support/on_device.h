#pragma once
// One test body, run on the host and on the device. The device instance says visibly where it cannot run.

#include "gi/kernel/device.h"

#include <gtest/gtest.h>

/// Declares SuiteHost.name and SuiteDevice.name, which call check<Space>().
#define LIGHTWELL_TEST_BOTH(suite, name, check)                                                                   \
    TEST(suite##Host, name) { check<gi::Space::host>(); }                                                         \
    TEST(suite##Device, name)                                                                                     \
    {                                                                                                             \
        if (!gi::device_present())                                                                                \
            GTEST_SKIP() << "SKIPPED: no CUDA device (run scripts/gpu-check where there is one)";                 \
        check<gi::Space::device>();                                                                               \
    }                                                                                                             \
    static_assert(true)
