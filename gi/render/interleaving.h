#pragma once
// Interleaved sampling (Keller and Heidrich 2001; Wald et al. 2002): a pass computes indirect light for one pixel
// in each n x n block only, so that a frame keeps within its budget. Over many passes every pixel gets its turn,
// which is all that pictures need; in a frame of a single pass, the other pixels take indirect light from those
// neighbours that computed it and show a similar surface.

#include "gi/render/path_sample.h"

#include <chrono>
#include <span>

namespace gi {

inline constexpr int kMostInterleaving = 4; ///< largest n chosen automatically for frames

struct Interleaving {
    std::uint32_t n = 1; ///< 1 = every pixel computes indirect light in every pass

    /// A prime above every n, so that each pixel of a block gets its turn.
    static constexpr std::uint32_t kStride = 17;

    /// Returns the number of pixels for which this one computes indirect light in this pass: 0 or n^2.
    GI_FN std::uint32_t share(std::uint32_t pixel, std::uint32_t width, std::uint32_t pass) const
    {
        std::uint32_t const all = n * n, own = pixel % width % n + pixel / width % n * n;
        return own == turn(pass) ? all : 0;
    }
    /// Returns the pixel of each n x n block that computes indirect light in this pass:
    /// its column plus n times its row.
    GI_FN std::uint32_t turn(std::uint32_t pass) const
    {
        std::uint32_t const all = n * n;
        return (all - pass % all * kStride % all) % all;
    }
};

/// Distributes L2 from pixels that computed it with weight n^2 (IndirectTurn::taken) to the waiting pixels around
/// them, as light over albedo, weighted by distance in the picture and similarity of the surfaces: less noise,
/// and a blur of n pixels.
/// @param samples  of the pass, row by row
void spread_indirect(std::span<PathSample> samples, int width, Interleaving const& interleaving,
                     std::uint32_t pass);

/// Chooses n for the next frame from the time of the last one. Changes n by one step at a time, because fewer
/// paths cost more each.
/// @param frame_s, indirect_s  time of the last frame if it had had one pass,
///   and the part of it spent on indirect light
int next_interleaving(int n, double budget_s, double frame_s, double indirect_s);

/// Chooses n pass by pass, so that frames keep within their budget. If the budget is long, n falls to 1 within
/// the first passes of the first frame.
class FrameInterleaving {
public:
    /// @param n  of the first pass  @param budget_s  of a frame; 0 = keep n for all frames
    FrameInterleaving(int n, double budget_s) : n_(n), budget_s_(budget_s) {}

    int n() const { return n_; }
    void frame_begins();
    /// @param indirect  fraction of the pass's time spent on indirect light, 0..1
    void pass_ended(double indirect);
    void frame_ended();

private:
    using Clock = std::chrono::steady_clock;
    double seconds_since(Clock::time_point t) const
    {
        return std::chrono::duration<double>(Clock::now() - t).count();
    }

    int n_;
    double budget_s_, besides_s_ = 0; ///< time of the last frame outside its passes
    double passes_s_ = 0;             ///< of this frame
    Clock::time_point frame_{}, pass_{};
};

} // namespace gi
