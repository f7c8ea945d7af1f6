#pragma once
// Compares what this program reads from an OBJ file with what Assimp's own importer reads.

#include "gi/scene/load/assimp_reader.h"

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/version.h>
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>

namespace gi::test {

/// True for 5.N with N < minor.
inline bool is_assimp_before(unsigned minor) { return aiGetVersionMajor() == 5 && aiGetVersionMinor() < minor; }

class ObjAgainstAssimp {
public:
    explicit ObjAgainstAssimp(std::filesystem::path const& file) : file_(file)
    {
        importer_.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    }

    /// Nodes, meshes and materials; numbers but for the last digit of a float, as Assimp adds 15 decimals loosely.
    void expect_equal(AssimpFaces faces)
    {
        SCOPED_TRACE(file_.string());
        constexpr unsigned kTriangles = aiProcess_Triangulate | aiProcess_SortByPType;
        ASSERT_EQ(reader_.read(file_, faces), "");
        aiScene const* const theirs =
            importer_.ReadFile(file_.string(), faces == AssimpFaces::polygons ? 0 : kTriangles);
        ASSERT_NE(theirs, nullptr) << importer_.GetErrorString();
        compare(*reader_.scene().mRootNode, *theirs->mRootNode);
        compare(reader_.scene(), *theirs);
    }

private:
    static void compare(aiNode const& ours, aiNode const& theirs)
    {
        EXPECT_STREQ(ours.mName.C_Str(), theirs.mName.C_Str());
        EXPECT_EQ(std::vector(ours.mMeshes, ours.mMeshes + ours.mNumMeshes),
                  std::vector(theirs.mMeshes, theirs.mMeshes + theirs.mNumMeshes));
        ASSERT_EQ(ours.mNumChildren, theirs.mNumChildren);
        for (unsigned c = 0; c < ours.mNumChildren; ++c) compare(*ours.mChildren[c], *theirs.mChildren[c]);
    }

    void compare(aiScene const& ours, aiScene const& theirs) const
    {
        ASSERT_EQ(ours.mNumMeshes, theirs.mNumMeshes);
        for (unsigned m = 0; m < ours.mNumMeshes; ++m) compare(*ours.mMeshes[m], *theirs.mMeshes[m]);
        ASSERT_EQ(ours.mNumMaterials, theirs.mNumMaterials);
        for (unsigned m = 0; m < ours.mNumMaterials; ++m) compare(*ours.mMaterials[m], *theirs.mMaterials[m]);
    }

    void compare(aiMesh const& ours, aiMesh const& theirs) const
    {
        SCOPED_TRACE(std::string("mesh ") + theirs.mName.C_Str());
        if (is_assimp_before(3)) { // later versions name a mesh after its group
            EXPECT_STREQ(ours.mName.C_Str(), theirs.mName.C_Str());
        }
        EXPECT_EQ(ours.mMaterialIndex, theirs.mMaterialIndex);
        EXPECT_EQ(ours.mPrimitiveTypes, theirs.mPrimitiveTypes);
        EXPECT_EQ(ours.mNumUVComponents[0], theirs.mNumUVComponents[0]);
        ASSERT_EQ(ours.mNumVertices, theirs.mNumVertices);
        ASSERT_EQ(ours.mNumFaces, theirs.mNumFaces);
        for (unsigned f = 0; f < ours.mNumFaces; ++f)
            ASSERT_EQ(corners_of(ours.mFaces[f]), corners_of(theirs.mFaces[f])) << f;
        std::vector<aiVector3D> places; // Assimp's are not counted from an origin
        for (unsigned v = 0; v < ours.mNumVertices; ++v) {
            aiVector3D const& p = ours.mVertices[v];
            vec3 const place(dvec3(p.x, p.y, p.z) + reader_.files().origin_m);
            places.emplace_back(place.x, place.y, place.z);
        }
        compare(places.data(), theirs.mVertices, ours.mNumVertices);
        compare(ours.mNormals, theirs.mNormals, ours.mNumVertices);
        compare(ours.mTextureCoords[0], theirs.mTextureCoords[0], ours.mNumVertices);
        compare(ours.mColors[0], theirs.mColors[0], ours.mNumVertices);
    }

    static std::vector<unsigned> corners_of(aiFace const& f) { return {f.mIndices, f.mIndices + f.mNumIndices}; }

    template <class Vector>
    static void compare(Vector const* ours, Vector const* theirs, unsigned n)
    {
        ASSERT_EQ(ours == nullptr, theirs == nullptr);
        for (unsigned i = 0; ours != nullptr && i < n; ++i)
            for (unsigned k = 0; k < sizeof(Vector) / sizeof(float); ++k) expect_near(ours[i][k], theirs[i][k]);
    }

    static void expect_near(float ours, float theirs)
    {
        if (std::isnan(ours) && std::isnan(theirs)) return;
        ASSERT_NEAR(ours, theirs, 3e-7f * std::abs(theirs) + 1e-15f);
    }

    /// Each property that ours has, and numbers of maps.
    static void compare(aiMaterial const& ours, aiMaterial const& theirs)
    {
        for (unsigned i = 0; i < ours.mNumProperties; ++i) {
            aiMaterialProperty const& p = *ours.mProperties[i];
            SCOPED_TRACE(p.mKey.C_Str());
            aiMaterialProperty const* q = nullptr;
            ASSERT_EQ(aiGetMaterialProperty(&theirs, p.mKey.C_Str(), p.mSemantic, p.mIndex, &q), AI_SUCCESS);
            ASSERT_EQ(p.mType, q->mType);
            ASSERT_EQ(p.mDataLength, q->mDataLength);
            if (p.mType != aiPTI_Float)
                EXPECT_EQ(std::memcmp(p.mData, q->mData, p.mDataLength), 0);
            else
                for (unsigned k = 0; k < p.mDataLength; k += sizeof(float)) {
                    float a = 0, b = 0;
                    std::memcpy(&a, p.mData + k, sizeof a);
                    std::memcpy(&b, q->mData + k, sizeof b);
                    expect_near(a, b);
                }
        }
        for (int type = aiTextureType_NONE; type <= AI_TEXTURE_TYPE_MAX; ++type)
            EXPECT_EQ(ours.GetTextureCount(aiTextureType(type)), theirs.GetTextureCount(aiTextureType(type)))
                << type;
    }

    std::filesystem::path file_;
    AssimpReader reader_;
    Assimp::Importer importer_;
};

} // namespace gi::test
