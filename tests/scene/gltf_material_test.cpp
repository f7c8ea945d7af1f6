// Materials and textures of glTF: every extension that is read, and what is counted where something is not.

#include "gi/core/error.h"
#include "gi/scene/shading/bsdf.h"
#include "tests/scene/gltf_builder.h"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

namespace gi::test {
namespace {

using nlohmann::json;

Material read_material(json const& material, Report& report)
{
    GltfBuilder b;
    b.append("materials", material);
    return b.parse(report).materials.at(0);
}
Material read_material(json const& material)
{
    Report report;
    return read_material(material, report);
}

std::vector<unsigned char> png(int width, int height, cv::Scalar bgr)
{
    std::vector<unsigned char> out;
    cv::imencode(".png", cv::Mat(height, width, CV_8UC3, bgr), out);
    return out;
}

TEST(GltfMaterial, DefaultsAreThoseOfGltf)
{
    Material const m = read_material(json::object());
    EXPECT_EQ(m.model, MaterialModel::metal_rough);
    EXPECT_EQ(m.base_color, vec3{1});
    EXPECT_EQ(m.metallic, 1);
    EXPECT_EQ(m.roughness, 1);
    EXPECT_EQ(m.specular, 1);
    EXPECT_EQ(m.ior, 1.5f);
    EXPECT_EQ(m.emission, vec3{0});
    EXPECT_EQ(m.alpha_mode, AlphaMode::opaque);
    EXPECT_EQ(m.alpha_cutoff, 0.5f);
    EXPECT_TRUE(m.thin);
    EXPECT_FALSE(m.double_sided);
}

/// Sec. 3.9.6: "a material with no properties specified".
TEST(GltfMaterial, MeshesWithoutOneHaveTheDefault)
{
    GltfBuilder b;
    b.add_triangle();
    b.add_triangle()["material"] = 0;
    b.add_triangle();
    b.append("materials", {{"name", "red"}});
    Scene const scene = b.parse();
    ASSERT_EQ(scene.materials.size(), 2u);
    EXPECT_EQ(scene.material_names[1], "default");
    EXPECT_EQ(scene.materials[1], read_material(json::object()));
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(scene.meshes[k].material, k == 1 ? 0 : 1);
    Report report;
    read_material(json::object(), report);
    EXPECT_TRUE(report.losses().empty());
}

TEST(GltfMaterial, EmissionIsFactorTimesStrength)
{
    Material const m =
        read_material({{"emissiveFactor", {1, 0.5, 0.25}},
                       {"doubleSided", true},
                       {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 40}}}}}});
    EXPECT_EQ(m.emission, (vec3{40, 20, 10}));
    EXPECT_TRUE(m.double_sided);
}

TEST(GltfMaterial, GlassWithAVolumeIsSolid)
{
    json material{{"extensions",
                   {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                    {"KHR_materials_ior", {{"ior", 1.33}}},
                    {"KHR_materials_specular", {{"specularFactor", 0.5}, {"specularColorFactor", {1, 0, 0.5}}}}}}};
    Material const sheet = read_material(material);
    EXPECT_TRUE(sheet.thin);
    EXPECT_EQ(sheet.transmission, 1);
    EXPECT_FLOAT_EQ(sheet.ior, 1.33f);
    EXPECT_EQ(sheet.specular, 0.5f);
    EXPECT_EQ(sheet.specular_color, (vec3{1, 0, 0.5f}));
    material["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", 0.1}};
    EXPECT_FALSE(read_material(material).thin);
    material["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", 0}};
    EXPECT_TRUE(read_material(material).thin);
}

TEST(GltfMaterial, ValuesOutOfRangeAreClampedAndCounted)
{
    Report report;
    Material const m = read_material({{"pbrMetallicRoughness", {{"roughnessFactor", 3}, {"metallicFactor", -1}}},
                                      {"extensions", {{"KHR_materials_ior", {{"ior", 0.5}}}}}},
                                     report);
    EXPECT_EQ(m.roughness, 1);
    EXPECT_EQ(m.metallic, 0);
    EXPECT_EQ(m.ior, 1);
    EXPECT_EQ(lost(report, "material values clamped"), 3u);
}

/// KHR_materials_ior: "the value 0 ... Fresnel term evaluated as 1".
TEST(GltfMaterial, AnIndexOfZeroReflectsEverything)
{
    Report report;
    Material const m = read_material({{"extensions", {{"KHR_materials_ior", {{"ior", 0}}}}}}, report);
    EXPECT_NEAR(make_bsdf(m).f0.x, 1, 1e-4);
    EXPECT_EQ(lost(report, "material values clamped"), 0u);
}

TEST(GltfMaterial, PhongComesFromExtras)
{
    Material const m =
        read_material({{"pbrMetallicRoughness", {{"baseColorFactor", {0.3, 0.2, 0.1, 1}}}},
                       {"extras", {{"lightwell_phong", {{"specular", {0.1, 0.2, 0.3}}, {"exponent", 32}}}}}});
    EXPECT_EQ(m.model, MaterialModel::phong);
    EXPECT_EQ(m.base_color, (vec3{0.3f, 0.2f, 0.1f}));
    EXPECT_EQ(m.phong_specular, (vec3{0.1f, 0.2f, 0.3f}));
    EXPECT_EQ(m.phong_exponent, 32);
}

TEST(GltfMaterial, OldAndUnlitMaterialsAreConvertedAndCounted)
{
    Report report;
    Material const old = read_material({{"extensions",
                                         {{"KHR_materials_pbrSpecularGlossiness",
                                           {{"diffuseFactor", {0.5, 0.25, 0, 0.75}},
                                            {"specularFactor", {0.04, 0.04, 0.04}},
                                            {"glossinessFactor", 0.75}}}}}},
                                       report);
    EXPECT_EQ(old.base_color, (vec3{0.5f, 0.25f, 0}));
    EXPECT_EQ(old.alpha, 0.75f);
    EXPECT_FLOAT_EQ(old.roughness, 0.25f);
    EXPECT_FLOAT_EQ(old.specular_color.x, 1);
    EXPECT_EQ(old.metallic, 0);
    EXPECT_EQ(lost(report, "specular-glossiness materials converted"), 1u);
    EXPECT_EQ(read_material({{"extensions", {{"KHR_materials_unlit", json::object()}}}}, report).specular, 0);
    EXPECT_EQ(lost(report, "unlit materials taken as diffuse"), 1u);
}

/// KHR_materials_unlit: the base colour alone, with its alpha; all other properties are ignored.
TEST(GltfMaterial, UnlitMaterialsAreTheirBaseColour)
{
    json const unlit = json::object();
    json material{{"pbrMetallicRoughness",
                   {{"baseColorFactor", {0.8, 0.3, 0.1, 0.7}}, {"metallicFactor", 1}, {"roughnessFactor", 0}}},
                  {"emissiveFactor", {0, 1, 0}},
                  {"alphaMode", "BLEND"},
                  {"doubleSided", true},
                  {"extensions",
                   {{"KHR_materials_unlit", unlit},
                    {"KHR_materials_emissive_strength", {{"emissiveStrength", 5}}},
                    {"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                    {"KHR_materials_ior", {{"ior", 0.5}}},
                    {"KHR_materials_volume", {{"thicknessFactor", 1}, {"attenuationDistance", 1}}},
                    {"KHR_materials_specular", {{"specularFactor", 1}}}}}};
    for (char const* map : {"normalTexture", "emissiveTexture", "occlusionTexture"})
        material[map] = {{"index", 9}};
    Report report;
    Material const m = read_material(material, report);
    EXPECT_EQ(m.base_color, (vec3{0.8f, 0.3f, 0.1f}));
    EXPECT_EQ(m.alpha, 0.7f);
    EXPECT_EQ(m.alpha_mode, AlphaMode::blend);
    EXPECT_TRUE(m.double_sided);
    EXPECT_EQ(m.emission, vec3{0});
    EXPECT_EQ(m.transmission, 0);
    EXPECT_EQ(m.metallic, 0);
    EXPECT_EQ(m.specular, 0);
    EXPECT_TRUE(m.unlit);
    EXPECT_TRUE(m.thin);
    EXPECT_EQ(m.normal_map.texture, -1);
    EXPECT_EQ(report.losses().size(), 1u);
    EXPECT_EQ(lost(report, "unlit materials taken as diffuse"), 1u);
}

/// Sec. 3.9.4: the cut-off is ignored but for masks.
TEST(GltfMaterial, CutOffsAreThoseOfMasks)
{
    Report report;
    EXPECT_EQ(read_material({{"alphaMode", "MASK"}}, report).alpha_cutoff, 0.5f);
    EXPECT_EQ(read_material({{"alphaMode", "MASK"}, {"alphaCutoff", 0.25}}, report).alpha_cutoff, 0.25f);
    read_material({{"alphaMode", "BLEND"}, {"alphaCutoff", -3}}, report);
    EXPECT_TRUE(report.losses().empty());
}

/// Two materials that use image 0 in several ways.
GltfBuilder textured()
{
    GltfBuilder b;
    int const view = b.add_view(png(4, 2, {10, 20, 30}));
    b.append("images", {{"bufferView", view}, {"mimeType", "image/png"}});
    b.append("samplers", {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}});
    b.append("textures", {{"source", 0}});
    b.append("textures", {{"source", 0}, {"sampler", 0}});
    b.append("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                           {"emissiveTexture", {{"index", 0}, {"texCoord", 1}}}});
    b.append("materials",
             {{"pbrMetallicRoughness",
               {{"baseColorTexture", {{"index", 1}}}, {"metallicRoughnessTexture", {{"index", 0}}}}}});
    return b;
}

TEST(GltfMaterial, TexturesAreLoadedOncePerUse)
{
    Scene const scene = textured().parse();
    EXPECT_EQ(scene.textures.texels.size(), 8u);   // one picture
    EXPECT_EQ(scene.textures.textures.size(), 3u); // sRGB, clamped sRGB, linear
    Material const &a = scene.materials[0], &b = scene.materials[1];
    EXPECT_EQ(a.base_color_map.texture, a.emissive_map.texture);
    EXPECT_EQ(a.emissive_map.uv_set, 1);
    Texture const& clamped = scene.textures.textures.at(std::size_t(b.base_color_map.texture));
    EXPECT_EQ(clamped.wrap_u, Wrap::clamp);
    EXPECT_EQ(clamped.wrap_v, Wrap::mirror);
    EXPECT_TRUE(clamped.nearest);
    EXPECT_TRUE(clamped.srgb);
    EXPECT_FALSE(scene.textures.textures.at(std::size_t(b.metallic_roughness_map.texture)).srgb);
    Rgba8 const texel = scene.textures.texels[clamped.first];
    EXPECT_EQ(std::vector<int>({texel.r, texel.g, texel.b, texel.a}), std::vector<int>({30, 20, 10, 255}));
    EXPECT_EQ(clamped.width, 4u);
    EXPECT_EQ(clamped.height, 2u);
}

TEST(GltfMaterial, TextureTransformsFollowTheExtension)
{
    GltfBuilder b = textured();
    b.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"] = {
        {"offset", {0.5, 0.25}}, {"rotation", 0.3}, {"scale", {2, 3}}, {"texCoord", 1}};
    TextureRef const t = b.parse().materials[0].base_color_map;
    // The matrix of the extension's text: translation * rotation * scale.
    float const c = std::cos(0.3f), s = std::sin(0.3f);
    EXPECT_NEAR(t.row_u.x, c * 2, 1e-6);
    EXPECT_NEAR(t.row_u.y, s * 3, 1e-6);
    EXPECT_NEAR(t.row_v.x, -s * 2, 1e-6);
    EXPECT_NEAR(t.row_v.y, c * 3, 1e-6);
    EXPECT_EQ(t.offset, (vec2{0.5f, 0.25f}));
    EXPECT_EQ(t.uv_set, 1);
}

TEST(GltfMaterial, TexturesThatCannotBeReadAreCountedAndLeftOut)
{
    GltfBuilder b = textured();
    b.append("images", {{"uri", "data:image/png;base64,AAAA"}});
    b.append("images", {{"uri", "elsewhere.png"}});
    b.append("textures", {{"source", 1}});
    b.append("textures", {{"source", 2}});
    b.append("textures", {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}});
    b.root["extensionsUsed"] = {"KHR_texture_basisu"};
    for (int i = 2; i < 5; ++i) b.append("materials", {{"normalTexture", {{"index", i}}}});
    Report report;
    Scene const scene = b.parse(report);
    for (std::size_t i = 2; i < 5; ++i) EXPECT_EQ(scene.materials[i].normal_map.texture, -1);
    EXPECT_EQ(lost(report, "textures that could not be read"), 2u);
    EXPECT_EQ(lost(report, "textures without an image"), 1u);
    EXPECT_EQ(lost(report, "glTF extensions ignored"), 1u);
}

TEST(GltfMaterial, ATextureTooLargeForMemoryIsNotDecoded)
{
    std::vector<unsigned char> bytes = png(4, 4, {0, 0, 0});
    for (std::size_t const at : {16u, 20u}) bytes[at + 1] = 1; // 65540 x 65540
    TexturePool pool;
    try {
        add_texture(pool, bytes.data(), bytes.size(), true, "large");
        FAIL();
    } catch (InputError const& e) {
        EXPECT_NE(std::string(e.what()).find("16384"), std::string::npos) << e.what();
    }
}

TEST(GltfMaterial, UnknownExtensionsAreCountedOrRefused)
{
    GltfBuilder b;
    b.add_triangle();
    b.root["extensionsUsed"] = {"EXT_unheard_of"};
    Report report;
    b.parse(report);
    EXPECT_EQ(lost(report, "glTF extensions ignored"), 1u);
    b.root["extensionsRequired"] = {"EXT_unheard_of"};
    EXPECT_THROW(b.parse(), InputError);
}

} // namespace
} // namespace gi::test
