#pragma once
// Content of a PLY file as far as it makes surfaces. PLY fixes no names; these are in use:
//
// element vertex              x y z, nx ny nz, red green blue alpha (or diffuse_red, r, ...), and texture coordinates
//                             s t, u v, texture_u texture_v, texture_s texture_t, tx ty
// element face                list vertex_indices (or vertex_index), list texcoord (u v of each corner), texnumber,
//                             red green blue
// element tristrips           list vertex_indices: strips, which -1 ends and begins anew
// comment TextureFile NAME    pictures, counted from 0 by texnumber (VCGlib, MeshLab)
//
// Elements may stand in any order, and have further properties and lists, which are noted.

#include "gi/core/math.h"
#include "gi/scene/load/assimp_import.h"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gi {

struct PlyModel {
    struct Face {
        std::size_t corners_end;  ///< behind its last corner; the first one is the end of the face before
        std::int32_t texture = 0; ///< index into `textures`, if there is one
    };

    dvec3 origin_m{0}; ///< in the file, of all positions
    std::vector<vec3> positions;
    std::vector<vec3> normals;          ///< as many as positions, or none
    std::vector<vec2> uvs;              ///< likewise; v upwards
    std::vector<vec4> colors;           ///< likewise; 0..1, sRGB and alpha
    std::vector<std::uint32_t> corners; ///< of all faces: indices of vertices
    std::vector<vec2> corner_uvs;       ///< as many as corners, or none
    std::vector<vec4> face_colors;      ///< as many as faces, or none
    std::vector<Face> faces;
    std::vector<std::string> textures; ///< files
};

/// @param notes  what is not used @param name  of the file, for notes
/// @throws std::runtime_error it cannot be read
PlyModel read_ply(std::string_view file, ImportedFiles& notes, std::string const& name);

} // namespace gi
