// Files that broke other programs: each becomes a picture by each method or is refused with an InputError, soon,
// and never anything else.

#include "gi/core/error.h"
#include "gi/light_paths/settings.h"
#include "gi/methods/registry.h"
#include "gi/methods/sh_grid/settings.h"
#include "gi/scene/load/load.h"
#include "tests/support/data.h"
#include "tests/support/processor_time.h"
#include "tests/support/scenes.h"

#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

namespace gi::test {
namespace {

namespace fs = std::filesystem;

#if defined(__SANITIZE_ADDRESS__)
constexpr double kSoon_s = 120; // no limit on memory holds there, and fresh pages are slow
#else
constexpr double kSoon_s = 5;
#endif

/// Fails when the step that ends here took more than kSoon_s of processor time.
class Soon {
public:
    void step_done(fs::path const& file, std::string_view step)
    {
        double const now_s = processor_s();
        EXPECT_LT(now_s - start_s_, kSoon_s) << file << ", " << step;
        start_s_ = now_s;
    }

private:
    double start_s_ = processor_s();
};

enum class Outcome { loaded, refused };

Outcome try_to_load(fs::path const& file)
{
    Soon soon;
    Report report;
    Outcome outcome = Outcome::loaded;
    try {
        auto const scene = std::make_shared<Scene>(load_scene(file.string(), report));
        for (Mesh const& mesh : scene->meshes)
            for (uvec3 const t : mesh.triangles)
                EXPECT_LT(std::max({t.x, t.y, t.z}), mesh.positions.size()) << file;
        set_environment(*scene, vec3{1});
        World const world = build_world(scene, std::nullopt, report);
        soon.step_done(file, "load");
        RenderSettings settings;
        settings.width = settings.height = 8;
        settings.paths = 2;
        settings.threads = 1;
        dvec3 const middle = world.bounds.empty() ? dvec3{0} : dvec3(world.bounds.center()) + world.origin;
        double const distance = std::max(3.0 * double(world.bounds.radius()), 1e-3);
        Camera const camera = look_at(middle + dvec3{0, 0, distance}, middle, 45);
        settings.of<ShGridSettings>().voxels = 32;
        settings.of<PhotonSettings>().paths = settings.of<PhotonSettings>().caustic_paths = 1000;
        settings.of<PhotonSettings>().impostors = 4;
        settings.of<PhotonSettings>().impostor_texels = 32;
        settings.of<PhotonSettings>().low_cells = settings.of<PhotonSettings>().middle_cells = settings.of<PhotonSettings>().high_cells =
            settings.of<PhotonSettings>().volume_cells = 16;
        for (char const* const name : {"reference", "sh_grid", "ispm", "lpv", "isllpm", "multi_image"}) {
            Picture const p = find_method(name).render(world, camera, settings, {}, {}, report).picture;
            for (float const v : p.find("color")->data) EXPECT_TRUE(std::isfinite(v)) << file << ", " << name;
            soon.step_done(file, name);
        }
    } catch (InputError const& e) {
        outcome = Outcome::refused;
        EXPECT_NE(std::string(e.what()).find(file.filename().string()), std::string::npos) << e.what();
        soon.step_done(file, "refusal");
    }
    return outcome;
}

bool is_scene(fs::path const& file)
{
    static std::set<std::string> const others{".json", ".bin", ".txt", ".md", ".png", ".jpg", ".mtl", ""};
    return !others.contains(file.extension().string());
}

TEST(HardMeshes, EachLoadsOrIsRefused)
{
    fs::path const folder = shared_data() / "hard_meshes";
    LIGHTWELL_NEED_DATA(folder);
    std::size_t loaded = 0, refused = 0;
    for (char const* const part : {"assimp", "draco", "manifold", "trimesh"})
        for (auto const& entry : fs::recursive_directory_iterator(folder / part))
            if (entry.is_regular_file() && is_scene(entry.path()))
                ++(try_to_load(entry.path()) == Outcome::loaded ? loaded : refused);
    EXPECT_GE(loaded, 25u);
    EXPECT_GE(refused, 10u);
}

TEST(HardMeshes, PartlyBrokenFilesKeepWhatIsWhole)
{
    fs::path const folder = shared_data() / "hard_meshes";
    LIGHTWELL_NEED_DATA(folder);
    for (char const* const file :
         {"manifold/Cray_right.obj", "manifold/openscad-nonmanifold-crash.obj", "manifold/self_intersectA.obj",
          "trimesh/wallhole.obj", "trimesh/nancolor.obj", "trimesh/soup.stl", "assimp/OBJ/number_formats.obj",
          "assimp/OBJ/box_longline.obj", "assimp/STL/sphereWithHole.stl",
          "assimp/PLY/cube_binary_header_with_RN_newline.ply"})
        EXPECT_EQ(try_to_load(folder / file), Outcome::loaded) << file;
}

TEST(HardMeshes, ContradictoryFilesAreRefused)
{
    fs::path const folder = shared_data() / "hard_meshes";
    LIGHTWELL_NEED_DATA(folder);
    for (char const* const file :
         {"assimp/glTF2/IndexOutOfRange/IndexOutOfRange.gltf",
          "assimp/glTF2/IndexOutOfRange/AllIndicesOutOfRange.gltf", "assimp/glTF2/MissingBin/BoxTextured.gltf",
          "assimp/glTF2/RecursiveNodes/RecursiveNodes.gltf", "assimp/invalid/empty.obj",
          "assimp/invalid/empty.ply", "assimp/invalid/OutOfMemory.off", "trimesh/empty.stl"})
        EXPECT_EQ(try_to_load(folder / file), Outcome::refused) << file;
}

/// Issues that the validator calls errors and that leave no doubt that data which are used are damaged. (Buffers
/// and cameras that nothing refers to are not looked at.)
std::set<std::string> const kDamage{"ACCESSOR_INDEX_OOB",
                                    "BUFFER_BYTE_LENGTH_MISMATCH",
                                    "BUFFER_VIEW_TOO_LONG",
                                    "GLB_CHUNK_TOO_BIG",
                                    "GLB_EMPTY_CHUNK",
                                    "GLB_INVALID_MAGIC",
                                    "GLB_INVALID_VERSION",
                                    "GLB_LENGTH_TOO_SMALL",
                                    "GLB_UNEXPECTED_END_OF_CHUNK_DATA",
                                    "GLB_UNEXPECTED_END_OF_CHUNK_HEADER",
                                    "GLB_UNEXPECTED_END_OF_HEADER",
                                    "GLB_UNEXPECTED_FIRST_CHUNK",
                                    "MESH_PRIMITIVES_UNEQUAL_TARGETS_COUNT",
                                    "MESH_PRIMITIVE_MORPH_TARGET_INVALID_ATTRIBUTE_COUNT",
                                    "MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT",
                                    "NODE_LOOP",
                                    "NODE_PARENT_OVERRIDE",
                                    "UNKNOWN_ASSET_MAJOR_VERSION"};

/// Valid files that are refused all the same, and why.
std::map<std::string, char const*> const kRefusedThoughValid{
    {"named_objects.gltf", "its buffer is not given"},
    {"unused_objects.gltf", "its buffer is not given"},
    {"non_relative_uri.gltf", "its data are elsewhere on the network"},
    {"unknown_type.gltf", "an accessor of a type from the future"},
    {"ignored_animated_transform.gltf", "without data all key times are zero"},
    {"animation/valid.gltf", "without data all key times are zero"},
};

TEST(HardMeshes, ValidatorModelsAreJudgedAsTheValidatorDoes)
{
    fs::path const folder = shared_data() / "hard_meshes" / "gltf_validator";
    LIGHTWELL_NEED_DATA(folder);
    std::size_t files = 0, damaged = 0, sound = 0;
    for (auto const& entry : fs::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file() || !is_scene(entry.path())) continue;
        ++files;
        Outcome const outcome = try_to_load(entry.path());
        fs::path const report = entry.path().string() + ".report.json";
        if (!fs::exists(report)) continue;
        nlohmann::json const j = nlohmann::json::parse(std::ifstream(report));
        std::string damage;
        for (auto const& m : j["issues"]["messages"])
            if (m["severity"] == 0 && kDamage.contains(m["code"])) damage = m["code"];
        if (!damage.empty()) {
            ++damaged;
            EXPECT_EQ(outcome, Outcome::refused) << entry.path() << " has " << damage;
        } else if (j["issues"]["numErrors"] == 0) {
            std::string const name = entry.path().filename(),
                              with_folder = (entry.path().parent_path().filename() / name).string();
            if (kRefusedThoughValid.contains(name) || kRefusedThoughValid.contains(with_folder)) continue;
            ++sound;
            EXPECT_EQ(outcome, Outcome::loaded) << entry.path() << " has no errors";
        }
    }
    EXPECT_GE(files, 260u);
    EXPECT_GE(damaged, 25u);
    EXPECT_GE(sound, 60u);
}

} // namespace
} // namespace gi::test
