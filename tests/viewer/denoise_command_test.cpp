// `lightwell denoise`: what render --denoise would have made, from its file without a filter.

#include "gi/image_io/picture_file.h"
#include "tests/viewer/run_program.h"

namespace viewer::test {
namespace {

void expect_same(gi::Picture const& a, gi::Picture const& b)
{
    ASSERT_EQ(a.layers.size(), b.layers.size());
    for (gi::Layer const& l : a.layers) {
        ASSERT_NE(b.find(l.name), nullptr) << l.name;
        EXPECT_EQ(l.data, b.find(l.name)->data) << l.name;
    }
}

TEST(DenoiseCommand, IsWhatRenderMakes)
{
    TemporaryFolder const folder;
    for (std::string const filter : {"atrous", "wide"})
        for (std::string const more : {"", " --background transparent"}) {
            std::string const scene = "render cornell --size 48x32 --paths 4 --quiet" + more;
            run_well(scene + " --out noisy.exr", folder.path());
            run_well(scene + " --denoise " + filter + " --out wanted.exr --png wanted.png", folder.path());
            run_well("denoise noisy.exr --denoise " + filter + " --out got.exr --png got.png", folder.path());
            gi::Picture const got = gi::read_exr(folder / "got.exr"), wanted = gi::read_exr(folder / "wanted.exr");
            expect_same(got, wanted);
            EXPECT_EQ(got.metadata.at("denoise"), filter);
            EXPECT_EQ(got.metadata.at("seed"), wanted.metadata.at("seed"));
            expect_same(gi::read_picture(folder / "got.png"), gi::read_picture(folder / "wanted.png"));
        }
}

TEST(DenoiseCommand, RefusesWhatItCannotFilter)
{
    TemporaryFolder const folder;
    run_well("render cornell --size 24x16 --paths 2 --quiet --out noisy.exr", folder.path());
    run_well("render cornell --size 24x16 --paths 2 --quiet --aovs L0 --out bare.exr", folder.path());
    run_well("denoise noisy.exr --out smooth.exr", folder.path());
    for (auto const& [call, why] : {std::pair{"denoise smooth.exr --png a.png", "filtered already"},
                                    std::pair{"denoise bare.exr --png a.png", "no layer 'normal'"},
                                    std::pair{"denoise noisy.exr", "nothing to write"},
                                    std::pair{"denoise noisy.exr --denoise none --png a.png", "leaves a picture"},
                                    std::pair{"denoise noisy.exr --out noisy.exr", "noisy.exr"},
                                    std::pair{"denoise missing.exr --png a.png", "missing.exr"}}) {
        Outcome const o = run(call, folder.path());
        EXPECT_EQ(o.code, 2) << call;
        EXPECT_NE(o.err.find(why), std::string::npos) << call << ": " << o.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "a.png")) << call;
    }
}

} // namespace
} // namespace viewer::test
