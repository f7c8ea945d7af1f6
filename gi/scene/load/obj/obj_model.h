#pragma once
// Content of an OBJ file (Wavefront, appendix B1 of its Advanced Visualizer) as it is written: vertices, faces,
// and which of them belong together. Curves and surfaces are skipped, and counted.
//
// Faces of an object and a material that follow each other are a mesh. Indices count from 0 and are not checked,
// as a file may name vertices that come later.

#include "gi/core/math.h"

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace gi {

struct ObjCorner {
    static constexpr std::int64_t kNone = -1;

    std::int64_t vertex, uv = kNone, normal = kNone;
};

struct ObjFace {
    enum class Kind : std::uint8_t { polygon, line, point };

    std::size_t corners_end; ///< behind its last corner; the first one is the end of the face before
    Kind kind;
};

struct ObjMesh {
    std::string name;
    std::size_t object;
    std::size_t first_face;
    unsigned material;
};

struct ObjModel {
    dvec3 origin_m{0}; ///< in the file, of all positions
    std::vector<vec3> positions;
    std::vector<vec3> colors; ///< as many as positions, or none; white where a vertex has none
    std::vector<vec3> uvs;
    unsigned uv_size = 2; ///< 3 if one has three numbers
    std::vector<vec3> normals;
    std::vector<ObjCorner> corners;
    std::vector<ObjFace> faces;
    std::vector<std::string> objects;             ///< names
    std::vector<ObjMesh> meshes;                  ///< of rising first faces; may be empty
    std::map<std::string, std::uint64_t> skipped; ///< statements that are not read, by their first word
    std::uint64_t flat_faces = 0;                 ///< without normals in a smoothing group
    std::uint64_t alphas = 0;                     ///< vertices with one that is not 1
};

struct ObjMaterialsOfFile {
    std::function<unsigned(std::string const& name)> index_of; ///< of `usemtl`
    std::function<void(std::string const& file)> read;         ///< of `mtllib`
};

/// Objects without a name of their own.
inline constexpr char const* kObjDefaultName = "defaultobject";

/// @throws std::runtime_error a line cannot be understood
ObjModel read_obj(std::string_view text, ObjMaterialsOfFile const& materials);

} // namespace gi
