#include "ar/markers/apriltag.h"

#include <apriltag/apriltag.h>
#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h10.h>
#include <apriltag/tag36h11.h>
#include <map>
#include <memory>

namespace ar {
namespace {

/// Below it are patterns that are no tags (apriltag's own demonstration has them from 20 to 30 on).
constexpr float kLeastMargin = 20;

struct Family {
    apriltag_family_t* (*make)();
    void (*destroy)(apriltag_family_t*);
    int corrected; ///< wrong bits that still leave no doubt which tag it is
};

std::map<std::string, Family> const& families()
{
    static std::map<std::string, Family> const all{
        {"DICT_APRILTAG_16h5", {tag16h5_create, tag16h5_destroy, 0}},
        {"DICT_APRILTAG_25h9", {tag25h9_create, tag25h9_destroy, 2}},
        {"DICT_APRILTAG_36h10", {tag36h10_create, tag36h10_destroy, 2}},
        {"DICT_APRILTAG_36h11", {tag36h11_create, tag36h11_destroy, 2}},
    };
    return all;
}

/// A detector with the table of all codes, which takes milliseconds to make.
class Detector {
public:
    explicit Detector(Family const& family) : family_(family.make(), family.destroy)
    {
        apriltag_detector_add_family_bits(detector_.get(), family_.get(), family.corrected);
        detector_->nthreads = 1;
    }
    apriltag_detector_t* get() const { return detector_.get(); }

private:
    std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)> family_;
    std::unique_ptr<apriltag_detector_t, void (*)(apriltag_detector_t*)> detector_{apriltag_detector_create(),
                                                                                   apriltag_detector_destroy};
};

/// One for each thread: it works on memory of its own.
Detector& detector_for(std::string const& dictionary)
{
    thread_local std::map<std::string, Detector> detectors;
    return detectors.try_emplace(dictionary, families().at(dictionary)).first->second;
}

} // namespace

bool is_apriltag(std::string const& dictionary) { return families().contains(dictionary); }

FoundMarkers find_apriltags(cv::Mat const& gray, std::string const& dictionary, int step)
{
    CV_Assert(gray.type() == CV_8UC1);
    apriltag_detector_t* const detector = detector_for(dictionary).get();
    detector->quad_decimate = float(step);
    image_u8_t picture{gray.cols, gray.rows, int(gray.step), gray.data};
    std::unique_ptr<zarray_t, void (*)(zarray_t*)> const detections(apriltag_detector_detect(detector, &picture),
                                                                    apriltag_detections_destroy);
    FoundMarkers found;
    for (int i = 0; i < zarray_size(detections.get()); ++i) {
        apriltag_detection_t* d = nullptr;
        zarray_get(detections.get(), i, &d);
        if (d->decision_margin < kLeastMargin) {
            ++found.rejected;
            continue;
        }
        FoundMarker m{d->id, {}};
        // Theirs begin at the lower left and go the other way round; (0, 0) is the edge of the first pixel.
        for (std::size_t k = 0; k < 4; ++k)
            m.corners[k] = {float(d->p[3 - k][0] - 0.5), float(d->p[3 - k][1] - 0.5)};
        found.markers.push_back(m);
    }
    return found;
}

} // namespace ar
