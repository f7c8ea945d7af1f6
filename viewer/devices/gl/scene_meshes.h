#pragma once
// A scene on the GPU: its triangles, sorted by material, and its materials with their textures. What moves is uploaded
// for every frame; all else once, a little at a time, so that nobody waits for a large scene.

#include "viewer/devices/gl/scene_textures.h"
#include "viewer/devices/gl/surface_order.h"

#include <array>
#include <future>
#include <thread>

namespace viewer {

/// How the fragments of a material are drawn: one shader for each.
struct SurfaceKind {
    unsigned maps = 0;   ///< bits of the maps that it has, in the order of Material
    bool mirror = false; ///< may show other surfaces
    bool emits = false;
    bool moves = false;
    gi::AlphaMode alpha = gi::AlphaMode::opaque;

    auto operator<=>(SurfaceKind const&) const = default;
};

/// Triangles of one material.
struct SurfaceBatch {
    SurfaceKind kind;
    SurfacePart const* part = nullptr;
};

class SceneMeshes {
public:
    /// Of this scene from now on; what is on the GPU already stays. Moving vertices are uploaded at once.
    void take(std::shared_ptr<gi::ShownScene const> scene);
    /// Moves what can move, until the next take(); light stays with the surfaces that it was found on.
    void move(gi::ShownScene::Moved const& now);
    /// Uploads for about so long. Returns true when all is there. @param most_s  0 = one step
    bool upload(double most_s);

    gi::ShownScene const& scene() const { return *scene_; }
    bool has_colors() const { return !scene_->world->colors.empty(); }
    bool has_alphas() const { return !scene_->world->alphas.empty(); }
    std::size_t meshes() const { return meshes_.size(); }
    std::vector<SurfaceBatch> const& batches(std::size_t mesh) const { return meshes_[mesh].batches; }
    void bind_mesh(std::size_t mesh) const;
    /// Draws triangles of the bound mesh.
    static void draw(SurfaceRange range);
    void bind_material(std::uint32_t material) const; ///< to block 0, and its maps to units 5 to 11
    /// Of what can move, where its light was found.
    gi::Bounds const& moved_bounds() const { return moved_bounds_; }
    /// Of what never moves; and of what can, where it is now. m, from the world's origin.
    gi::Bounds const& still_bounds() const { return still_bounds_; }
    gi::Bounds const& moving_bounds() const { return moving_bounds_; }
    bool moves(std::size_t mesh) const { return meshes_[mesh].moves; }
    std::uint64_t moves_so_far() const { return moves_so_far_; } ///< counts changes of moving_bounds
    unsigned environment() const { return environment_.id(); }   ///< 0 = none

private:
    struct Mesh {
        std::uint32_t first_vertex = 0, vertices = 0; ///< in the world
        bool moves = false;
        GlObject array, indices, positions, normals, tangents, uv0, uv1, colors, alphas;
        GlObject lit_positions, lit_normals; ///< of what moves: where its light was found
        SurfaceOrder order;                  ///< its triangles are on the GPU alone
        std::vector<SurfaceBatch> batches;
    };
    bool is_made() const { return made_ == meshes_.size() && !orders_.valid(); }
    void order();
    void make(Mesh& mesh);
    bool upload_order(double most_s);
    void upload_moved();
    void upload_materials();
    void upload_environment();

    std::shared_ptr<gi::ShownScene const> scene_;
    std::shared_ptr<gi::ShownScene::Moved const> moved_; ///< on the GPU
    gi::Bounds moved_bounds_, still_bounds_, moving_bounds_;
    std::vector<gi::vec3> now_; ///< positions of what can move
    std::uint64_t moves_so_far_ = 0;
    std::shared_ptr<std::vector<gi::Material> const> materials_; ///< on the GPU
    std::shared_ptr<gi::EnvironmentMap const> map_;              ///< on the GPU
    std::vector<Mesh> meshes_;                                   ///< what never moves, and what can
    std::size_t made_ = 0;                                       ///< meshes on the GPU
    SceneTextures textures_;
    std::vector<std::size_t> missing_; ///< textures
    std::future<std::vector<SurfaceOrder>> orders_; ///< of the meshes, in the making
    std::jthread ordering_;                         ///< makes them
    GlObject blocks_, environment_;
    std::ptrdiff_t block_step_ = 0; ///< bytes
};

} // namespace viewer
