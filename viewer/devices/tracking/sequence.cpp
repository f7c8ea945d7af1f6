#include "viewer/devices/tracking/sequence.h"

namespace viewer {

Arrival Sequence::note(std::uint64_t frame, TrackerCounts& counts)
{
    std::uint64_t const ahead = frame - newest_, back = newest_ - frame; // one of them wraps
    if (started_ && ahead == 0) {
        ++counts.duplicate;
        return Arrival::duplicate;
    }
    if (started_ && back < kWindow) {
        if (seen_[frame % kWindow]) {
            ++counts.duplicate;
            return Arrival::duplicate;
        }
        seen_[frame % kWindow] = true;
        ++counts.out_of_order;
        if (frame - first_ <= newest_ - first_ && counts.lost > 0) --counts.lost; // it had been counted as lost
        return Arrival::late;
    }
    if (started_ && ahead <= kWindow) {
        for (std::uint64_t f = newest_ + 1; f != frame; ++f) seen_[f % kWindow] = false;
        counts.lost += ahead - 1;
        newest_ = frame;
        seen_[frame % kWindow] = true;
        return Arrival::in_order;
    }
    bool const restarted = started_;
    started_ = true;
    newest_ = frame;
    first_ = frame;
    seen_.reset();
    seen_[frame % kWindow] = true;
    if (!restarted) return Arrival::in_order;
    ++counts.restarts;
    return Arrival::restarted;
}

} // namespace viewer
