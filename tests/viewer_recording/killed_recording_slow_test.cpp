// What had been recorded up to a second before is there.

#include "tests/viewer_recording/killed_recording.h"

namespace viewer::test {
namespace {

TEST(KilledRecordingSlow, LosesLessThanItsLastSecond)
{
    double const most_s = kill_recordings(6);
    EXPECT_LT(most_s, 1);
    std::printf("24 kills, at most %.1f ms of frames lost\n", 1e3 * most_s);
}

} // namespace
} // namespace viewer::test
