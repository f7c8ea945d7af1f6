#pragma once
// Interleaved sampling (Keller and Heidrich 2001; Wald et al. 2002): in a pass one pixel of n x n takes indirect
// light, so that a frame holds its time. Pictures of many passes need no more; in a frame of one pass each pixel
// takes the indirect light of those around that had their turn and show a surface like its own.

#include "gi/render/path_sample.h"

#include <chrono>
#include <span>

namespace gi {

inline constexpr int kMostInterleaving = 4; ///< that is chosen for frames

struct Interleaving {
    std::uint32_t n = 1; ///< 1 = every pixel takes indirect light in every pass

    static constexpr std::uint32_t kStride = 17; ///< a prime above every interleaving: all turns come

    /// How many pixels this one takes indirect light for in this pass: 0, or n^2.
    std::uint32_t share(std::uint32_t pixel, std::uint32_t width, std::uint32_t pass) const
    {
        std::uint32_t const all = n * n, own = pixel % width % n + pixel / width % n * n;
        return own == turn(pass) ? all : 0;
    }
    /// Which of n x n pixels takes indirect light in this pass: its column plus n times its row.
    std::uint32_t turn(std::uint32_t pass) const
    {
        std::uint32_t const all = n * n;
        return (all - pass % all * kStride % all) % all;
    }
};

/// Gives L2 of pixels that have taken it n^2-fold (IndirectTurn::taken) to those around that wait, over the
/// albedo, by distance in the picture and likeness of surfaces: less noise, and a blur of n pixels.
/// @param samples  of the pass, in rows of `width`
void spread_indirect(std::span<PathSample> samples, int width, Interleaving const& interleaving,
                     std::uint32_t pass);

/// n for the next frame, from what the last one took. Costs of a path rise as they are fewer: a step at a time.
/// @param frame_s, indirect_s  of the last frame, had it had one pass, and what of it went into indirect light
int next_interleaving(int n, double budget_s, double frame_s, double indirect_s);

/// Chooses n pass by pass, so that frames hold their time. Where that is long, the first passes of the first frame
/// are the ones that step down to n = 1.
class FrameInterleaving {
public:
    /// @param n  of the first pass  @param budget_s  of a frame; 0 = n is for all
    FrameInterleaving(int n, double budget_s) : n_(n), budget_s_(budget_s) {}

    int n() const { return n_; }
    void frame_begins();
    /// @param indirect  share of its time that indirect light took, 0..1
    void pass_ended(double indirect);
    void frame_ended();

private:
    using Clock = std::chrono::steady_clock;
    double seconds_since(Clock::time_point t) const
    {
        return std::chrono::duration<double>(Clock::now() - t).count();
    }

    int n_;
    double budget_s_, besides_s_ = 0; ///< of the last frame, beside its passes
    double passes_s_ = 0;             ///< of this frame
    Clock::time_point frame_{}, pass_{};
};

} // namespace gi
