// Damaged and hostile glTF: an InputError that says what is wrong, in bounded time and memory.

#include "gi/core/error.h"
#include "tests/scene/gltf_builder.h"

#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <random>
#include <sys/resource.h>
#include <unistd.h>

namespace gi::test {
namespace {

using nlohmann::json;
using Bytes = std::vector<unsigned char>;

/// The message of the InputError; "accepted" where there was none.
std::string refusal(Bytes const& bytes)
{
    Report report;
    try {
        parse_gltf(bytes.data(), bytes.size(), {}, "bad.glb", report);
    } catch (InputError const& e) {
        return e.what();
    }
    return "accepted";
}
std::string refusal(std::function<void(GltfBuilder&)> const& damage)
{
    GltfBuilder b;
    b.add_triangle();
    damage(b);
    return refusal(b.glb());
}
void expect_says(std::string const& message, std::string const& part)
{
    EXPECT_NE(message.find(part), std::string::npos) << message;
}

/// A file with most features, to be cut and garbled.
Bytes rich_file()
{
    GltfBuilder b;
    json& p = b.add_triangle();
    p["targets"] = {{{"POSITION", 0}}};
    p["material"] = 0;
    int const times = b.add_floats({0, 1, 2}, "SCALAR", 1);
    b.append("materials", {{"emissiveFactor", {1, 1, 1}}});
    b.append("animations", {{"samplers", {{{"input", times}, {"output", 0}}}},
                            {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}}});
    b.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}});
    b.root["nodes"][0]["camera"] = 0;
    return b.glb();
}

TEST(GltfDamage, TruncatedAnywhereIsRefused)
{
    Bytes const whole = rich_file();
    ASSERT_EQ(refusal(whole), "accepted");
    for (std::size_t n = 0; n < whole.size(); n += n < 64 ? 1 : 64)
        EXPECT_NE(refusal(Bytes(whole.begin(), whole.begin() + std::ptrdiff_t(n))), "accepted") << n;
}

TEST(GltfDamage, GarbageIsRefused)
{
    std::mt19937 random(1);
    for (int i = 0; i < 200; ++i) {
        Bytes bytes(random() % 300);
        for (auto& b : bytes) b = static_cast<unsigned char>(random());
        if (i % 2 == 1 && bytes.size() >= 4) std::memcpy(bytes.data(), "glTF", 4);
        EXPECT_NE(refusal(bytes), "accepted");
    }
}

TEST(GltfDamage, FlippedBytesNeverDoMoreThanAnInputError)
{
    Bytes const whole = rich_file();
    std::mt19937 random(2);
    for (int i = 0; i < 3000; ++i) {
        Bytes bytes = whole;
        for (int k = 0; k < 3; ++k) bytes[random() % bytes.size()] = static_cast<unsigned char>(random());
        EXPECT_NO_THROW(refusal(bytes));
    }
}

TEST(GltfDamage, CountsThatTheFileCannotHoldAreRefusedWithoutAllocating)
{
    rusage before{}, after{};
    getrusage(RUSAGE_SELF, &before);
    for (std::uint64_t const count : {4ull, 4000000000ull, 1ull << 40, 1ull << 62})
        expect_says(refusal([&](GltfBuilder& b) { b.root["accessors"][0]["count"] = count; }), "accessor");
    expect_says(refusal([&](GltfBuilder& b) {
                    b.root["accessors"][0].erase("bufferView");
                    b.root["accessors"][0]["count"] = 4000000000u;
                }),
                "accessor");
    getrusage(RUSAGE_SELF, &after);
    EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 64 * 1024); // KiB
}

TEST(GltfDamage, RangesOutsideTheirContainerAreRefused)
{
    expect_says(refusal([](GltfBuilder& b) { b.root["bufferViews"][0]["byteLength"] = 37; }), "buffer view 0");
    expect_says(refusal([](GltfBuilder& b) { b.root["bufferViews"][0]["byteOffset"] = std::uint64_t(-4); }),
                "buffer view 0");
    expect_says(refusal([](GltfBuilder& b) { b.root["bufferViews"][0]["buffer"] = 1; }), "buffer");
    expect_says(refusal([](GltfBuilder& b) { b.root["accessors"][0]["byteOffset"] = 4; }), "accessor 0");
    expect_says(refusal([](GltfBuilder& b) { b.root["accessors"][0]["bufferView"] = 9; }), "accessor 0");
    expect_says(refusal([](GltfBuilder& b) { b.root["buffers"] = {{{"byteLength", 1000}}}; }), "truncated");
    expect_says(refusal([](GltfBuilder& b) {
                    b.root["buffers"] = {{{"byteLength", 36}, {"uri", "x.bin"}}};
                }),
                "x.bin");
}

TEST(GltfDamage, ReferencesToNothingAreRefused)
{
    auto const primitive = [](GltfBuilder& b) -> json& { return b.root["meshes"][0]["primitives"][0]; };
    expect_says(refusal([&](GltfBuilder& b) { primitive(b)["material"] = 3; }), "material 3");
    expect_says(refusal([&](GltfBuilder& b) { primitive(b)["attributes"]["POSITION"] = 3; }), "accessor 3");
    expect_says(refusal([&](GltfBuilder& b) {
                    primitive(b)["indices"] =
                        b.add_accessor(b.add_view(std::vector<std::uint16_t>{0, 1, 3}), kUshort, 3, "SCALAR");
                }),
                "index out of range");
    expect_says(refusal([](GltfBuilder& b) { b.root["nodes"][0]["mesh"] = 5; }), "mesh 5");
    expect_says(refusal([](GltfBuilder& b) { b.root["nodes"][0]["skin"] = 5; }), "skin 5");
    expect_says(refusal([](GltfBuilder& b) { b.root["nodes"][0]["camera"] = 5; }), "camera 5");
    expect_says(refusal([](GltfBuilder& b) { b.root["nodes"][0]["children"] = {5}; }), "node 5");
    expect_says(refusal([](GltfBuilder& b) { b.root["scenes"][0]["nodes"] = {5}; }), "node 5");
    expect_says(refusal([](GltfBuilder& b) { b.root["scene"] = 5; }), "scene 5");
}

TEST(GltfDamage, GraphsThatAreNoTreesAreRefused)
{
    expect_says(refusal([](GltfBuilder& b) { b.root["nodes"][0]["children"] = {0}; }), "loop");
    expect_says(refusal([](GltfBuilder& b) {
                    b.root["nodes"] = {{{"children", {1}}}, {{"children", {2}}}, {{"children", {1}}}};
                }),
                "two parents");
    expect_says(refusal([](GltfBuilder& b) {
                    b.root["nodes"] = {{{"mesh", 0}}, {{"children", {2}}}, {{"children", {1}}}};
                }),
                "loop");
}

TEST(GltfDamage, NestingAndNumbersBeyondLimitsAreRefused)
{
    auto const text = [](std::string const& s) { return refusal(Bytes(s.begin(), s.end())); };
    expect_says(text(R"({"asset":{"version":"2.0"},"extras":)" + std::string(100000, '[')), "nests");
    expect_says(text(R"({"asset":{"version":"2.0"},"nodes":[{"scale":[1e999,1,1]}]})"), "not valid JSON");
    expect_says(text(R"({"asset":{"version":"1.0"}})"), "not glTF 2");
    expect_says(text("{\n  \"asset\": {,"), "bad.glb:2:");
    expect_says(text("[]"), "not an object");
    expect_says(text(""), "empty");
}

TEST(GltfDamage, AccessorsOfTheWrongKindAreRefused)
{
    expect_says(refusal([](GltfBuilder& b) { b.root["accessors"][0]["type"] = "VEC2"; }), "components");
    expect_says(refusal([](GltfBuilder& b) {
                    b.root["meshes"][0]["primitives"][0]["indices"] = b.add_floats({0, 1, 2}, "SCALAR", 1);
                }),
                "unsigned integers");
    expect_says(
        refusal([](GltfBuilder& b) {
            b.root["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = b.add_floats({0, 0, 1}, "VEC3", 3);
        }),
        "NORMAL");
}

class GltfFolder : public testing::Test {
protected:
    GltfFolder() : folder_(std::filesystem::temp_directory_path() / ("lightwell_gltf_" + std::to_string(getpid())))
    {
        std::filesystem::create_directories(folder_ / "sub");
    }
    ~GltfFolder() override { std::filesystem::remove_all(folder_); }

    /// A .gltf in sub/ whose buffer is at the URI.
    std::filesystem::path write(std::string const& uri) const
    {
        GltfBuilder b;
        b.add_triangle();
        b.root["buffers"] = {{{"byteLength", b.binary.size()}, {"uri", uri}}};
        std::filesystem::path const file = folder_ / "sub" / "scene.GLTF";
        std::ofstream(file) << b.root.dump();
        std::ofstream(folder_ / "sub" / "my data.bin", std::ios::binary)
            .write(reinterpret_cast<char const*>(b.binary.data()), std::streamsize(b.binary.size()));
        std::filesystem::copy_file(folder_ / "sub" / "my data.bin", folder_ / "above.bin",
                                   std::filesystem::copy_options::overwrite_existing);
        return file;
    }

    std::filesystem::path folder_;
    Report report_;
};

TEST_F(GltfFolder, OtherFilesAreFoundBesideTheScene)
{
    for (char const* const uri : {"my%20data.bin", "my data.bin", "../above.bin"})
        EXPECT_EQ(load_scene(write(uri).string(), report_).meshes.size(), 1u) << uri;
}

TEST_F(GltfFolder, OtherFilesElsewhereOrMissingAreRefused)
{
    for (std::string const& uri :
         {std::string("missing.bin"), std::string("https://example.org/a.bin"), (folder_ / "above.bin").string()})
        EXPECT_THROW(load_scene(write(uri).string(), report_), InputError) << uri;
}

} // namespace
} // namespace gi::test
