// Any bytes as an OBJ file and, after a zero byte, its material library: a scene or a reported reason.
// Runs in this process, since mesh_fuzz starts a child per input.

#include "gi/core/error.h"
#include "gi/scene/load/assimp_convert.h"
#include "gi/scene/load/obj/obj_importer.h"
#include "gi/scene/model/world.h"

#include <algorithm>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/postprocess.h>
#include <memory>
#include <string_view>

namespace {

/// Two files in memory: every name that ends with .obj is the first, every other one the second.
class TwoFiles : public Assimp::IOSystem {
public:
    std::string_view obj, mtl;

    bool Exists(char const*) const override { return true; }
    char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(char const* name, char const*) override
    {
        std::string_view const text = std::string_view(name).ends_with(".obj") ? obj : mtl;
        return new Assimp::MemoryIOStream(reinterpret_cast<std::uint8_t const*>(text.data()), text.size());
    }
    void Close(Assimp::IOStream* stream) override { delete stream; }
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    static gi::ImportedFiles notes;
    static Assimp::Importer importer;
    static TwoFiles* files = nullptr;
    if (files == nullptr) {
        gi::ObjImporter::replace_in(importer, notes);
        importer.SetIOHandler(files = new TwoFiles); // the importer takes ownership
    }
    std::string_view const all(reinterpret_cast<char const*>(data), size);
    notes = {};
    files->obj = all.substr(0, all.find('\0'));
    files->mtl = all.substr(std::min(all.size(), files->obj.size() + 1));
    constexpr unsigned kSteps = aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_JoinIdenticalVertices;
    aiScene const* const scene = importer.ReadFile("none/a.obj", kSteps);
    if (scene == nullptr) return 0;
    gi::Report report;
    try {
        auto const model = std::make_shared<gi::Scene const>(gi::convert_assimp(*scene, "none/a.obj", report));
        gi::build_world(model, 0, report);
    } catch (gi::InputError const&) {
    }
    return 0;
}
