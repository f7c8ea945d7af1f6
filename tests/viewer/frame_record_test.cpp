#include "viewer/offline/frame_record.h"

#include <gtest/gtest.h>

namespace viewer {
namespace {

TEST(FrameRecord, AFrameOfAnotherBuildIsSaidToBeThatWhateverElseItLacks)
{
    std::map<std::string, std::string> wanted;
    for (char const* key :
         {"version", "git", "level", "embree", "frame", "asked_method", "size", "seed", "filter", "denoise",
          "bounces", "stop", "reuse", "shutter", "layers", "numbers", "fingerprint", "motion"})
        wanted[key] = "a";
    gi::Picture there;
    there.metadata = wanted;
    EXPECT_EQ(difference(there, wanted), "");
    there.metadata["motion"] = "b";
    EXPECT_EQ(difference(there, wanted), "its motion blur differs");
    there.metadata["fingerprint"] = "b";
    EXPECT_EQ(difference(there, wanted), "its scene, camera or settings differ");
    there.metadata["asked_method"] = "b";
    EXPECT_EQ(difference(there, wanted), "its method is b, not a");
    there.metadata.erase("asked_method"); // as in frames of earlier versions
    EXPECT_EQ(difference(there, wanted), "it is not a frame of a sequence");
    there.metadata["git"] = "b";
    EXPECT_EQ(difference(there, wanted), "its git is b, not a");
    there.metadata.erase("frame");
    EXPECT_EQ(difference(there, wanted), "it is not a frame of a sequence");
}

} // namespace
} // namespace viewer
