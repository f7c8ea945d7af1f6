// Real OBJ files, and large scenes exported as such: what this program reads is what Assimp's importer reads.

#include "tests/scene/obj_assimp.h"
#include "tests/support/data.h"

#include <assimp/Exporter.hpp>
#include <set>
#include <unistd.h>

namespace gi::test {
namespace {

namespace fs = std::filesystem;

TEST(ObjFiles, EqualAssimp)
{
    fs::path const folder = shared_data() / "hard_meshes";
    LIGHTWELL_NEED_DATA(folder);
    // Assimp gives colours to other vertices, refuses small files, takes points without faces for a mesh, and
    // numbers of 39 digits for 0.
    std::set<std::string> const kOthers{"only_a_part_of_vertexcolors.obj",
                                        "empty.obj",
                                        "point_cloud.obj",
                                        "obj_wireframe.obj",
                                        "malformed.obj",
                                        "malformed2.obj",
                                        "Cray_right.obj"};
    int files = 0;
    for (auto const& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.path().extension() != ".obj" || kOthers.contains(entry.path().filename().string())) continue;
        ObjAgainstAssimp compared(entry.path());
        compared.expect_equal(AssimpFaces::triangles);
        if (entry.path().filename() != "testmixed.obj") // Assimp orders the vertices of lines otherwise
            compared.expect_equal(AssimpFaces::polygons);
        ++files;
    }
    EXPECT_GE(files, 20);
}

TEST(ObjFiles, ExportedSponzaEqualsAssimp)
{
    fs::path const sponza = shared_data() / "scenes/crytek_sponza/crytek_sponza.glb";
    LIGHTWELL_NEED_DATA(sponza);
    fs::path const folder = fs::temp_directory_path() / ("lightwell_obj_files_" + std::to_string(getpid()));
    fs::create_directory(folder);
    Assimp::Importer importer;
    Assimp::Exporter exporter;
    ASSERT_NE(importer.ReadFile(sponza.string(), 0), nullptr) << importer.GetErrorString();
    ASSERT_EQ(exporter.Export(importer.GetScene(), "obj", (folder / "sponza.obj").string()), aiReturn_SUCCESS);
    ObjAgainstAssimp(folder / "sponza.obj").expect_equal(AssimpFaces::triangles);
    fs::remove_all(folder);
}

} // namespace
} // namespace gi::test
