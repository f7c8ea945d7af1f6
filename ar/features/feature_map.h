#pragma once
// A map of features: points of the real place whose positions are known, with what they look like, so that a
// camera can be found without markers. World: metres, y up, as everywhere in ar.
//
// File, text: the line "lightwell features 1"; then a line for each point
//   x y z sigma_m DESCRIPTOR...    metres; 1 to 6 descriptors of 64 hexadecimal digits
// Empty lines and lines that begin with # are ignored.

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace ar {

/// ORB (Rublee et al. 2011), 256 bits.
using Descriptor = std::array<std::uint8_t, 32>;
int hamming(Descriptor const& a, Descriptor const& b);

inline constexpr std::size_t kMostDescriptors = 6; ///< of a point: from several distances and directions

struct MapPoint {
    glm::dvec3 world_m{0};
    double sigma_m = 0; ///< largest standard deviation of the position
    std::vector<Descriptor> descriptors;
};

struct FeatureMap {
    std::vector<MapPoint> points;
};

/// Descriptors of a whole map that cv::BFMatcher can match (its indices have 18 bits).
inline constexpr std::size_t kMostDescriptorsOfMap = (std::size_t(1) << 18) - 1;
/// @param name  of the map, for the message. @throws gi::InputError more descriptors than can be matched
void check_size(FeatureMap const& map, std::string const& name);

/// @throws gi::InputError with file:line:column: another kind of file, wrong columns,
///   no numbers, no points; as check_size
FeatureMap parse_feature_map(std::string_view text, std::string const& file);
/// @throws gi::InputError, also for files that cannot be read or above 1 GiB
FeatureMap read_feature_map(std::filesystem::path const& file);
std::string format_feature_map(FeatureMap const& map);

/// Features of a picture.
struct PictureFeatures {
    std::vector<glm::dvec2> pixels; ///< centres are integers
    std::vector<double> sigma_px;   ///< more for those found in reduced pictures
    std::vector<Descriptor> descriptors;
};
/// ORB features, spread over the picture: the strongest of each of 12 x 9 cells. @param gray  CV_8UC1
/// @param most  number, about
PictureFeatures find_features(cv::Mat const& gray, int most = 1200);

} // namespace ar
