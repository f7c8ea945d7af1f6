#pragma once
// Makes a map of features from pictures whose camera poses are known: features are followed from picture to
// picture, and each is triangulated from all its sightings as soon as it is lost.

#include "ar/camera/camera_model.h"
#include "ar/camera/pose.h"
#include "ar/features/feature_map.h"
#include "ar/features/flow.h"
#include "ar/features/point_grid.h"

namespace ar {

struct MapBuilderSettings {
    double key_m = 0.03, key_deg = 3;              ///< new features are looked for after this motion
    double sighting_m = 0.005, sighting_deg = 0.3; ///< between two sightings of a feature
    std::size_t sightings = 60;                    ///< at most, of a feature
    std::size_t fewest_sightings = 4;
    double least_parallax_deg = 2; ///< between the directions of a feature's sightings, the largest
    double most_rms_px = 1;        ///< of its reprojection
    int features = 1200;           ///< of a picture
};

struct MapBuilderCounts {
    std::size_t pictures = 0, key_pictures = 0, tracks = 0;
    std::size_t short_lived = 0, no_parallax = 0, bad_fit = 0,
                merged = 0; ///< tracks that became no point of their own
};

class MapBuilder {
public:
    explicit MapBuilder(CameraModel const& camera, MapBuilderSettings const& settings = {})
        : camera_(camera), settings_(settings)
    {
    }

    /// Pictures must follow each other as in a video. @param gray  CV_8UC1 of the camera's size
    void add(cv::Mat const& gray, gi::RigidPose const& world_from_camera);
    /// A picture without a known pose: features are lost.
    void skip();
    /// The map of all pictures so far; features that are still followed are lost, too.
    FeatureMap const& finish();
    MapBuilderCounts const& counts() const { return counts_; }

private:
    struct Sighted {
        gi::RigidPose world_from_camera;
        glm::dvec2 pixel;
    };
    struct Track {
        std::vector<Sighted> sightings;
        glm::dvec2 pixel{0};
        std::vector<Descriptor> descriptors;
    };

    bool has_moved(gi::RigidPose const& a, gi::RigidPose const& b, double m, double deg) const;
    void follow(cv::Mat const& gray, gi::RigidPose const& world_from_camera);
    void look(cv::Mat const& gray, gi::RigidPose const& world_from_camera);
    void end(Track const& track);
    std::optional<MapPoint> triangulated(Track const& track);
    void add_merged(MapPoint point, double distance_m);

    CameraModel camera_;
    MapBuilderSettings settings_;
    Flow flow_;
    std::vector<Track> tracks_;
    FeatureMap map_;
    PointGrid grid_; ///< of its points
    std::optional<gi::RigidPose> key_;
    MapBuilderCounts counts_;
};

} // namespace ar
