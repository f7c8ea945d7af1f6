#include "tests/viewer_recording/killed_recording.h"

namespace viewer::test {
namespace {

TEST(KilledRecording, HasWholeFramesFromTheFirstOneOn) { kill_recordings(1); }

} // namespace
} // namespace viewer::test
