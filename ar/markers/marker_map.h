#pragma once
// The markers of the world: single markers, ChArUco boards and grids of markers, with their poses.
// The world is in metres, right-handed, y up. A "thing" is one of these; its own frame has x to the right and y
// upward as printed, and z out of the paper towards the viewer. Its origin is
//   of a marker           the middle of its black square,
//   of a board or a grid  its lower left corner: of the squares (board), of the markers' black squares (grid).
// Lying flat on a table, printed top away from the viewer, is rotation_deg: [-90, 0, 0].

#include "ar/camera/pose.h"

#include <array>
#include <string>
#include <vector>

namespace ar {

inline constexpr int kMostSquares = 200; ///< along a side of a board or grid

struct Marker {
    std::string dictionary; ///< as OpenCV names it: DICT_4X4_50, DICT_APRILTAG_36h11, ...
    int id = 0;
    double side_m = 0; ///< of the black square with its border
    gi::RigidPose world_from_marker;

    friend bool operator==(Marker const&, Marker const&) = default;
};

/// A chessboard with markers in its white squares, numbered row by row from the top left.
struct CharucoBoard {
    int squares_x = 0, squares_y = 0;
    double square_m = 0, marker_m = 0;
    std::string dictionary;
    int first_id = 0;
    /// False: the upper left square is black. True: it is white if squares_y is even, as before OpenCV 4.6.
    bool legacy_pattern = false;
    gi::RigidPose world_from_board;

    friend bool operator==(CharucoBoard const&, CharucoBoard const&) = default;
};

/// Markers in rows and columns, numbered row by row from the top left.
struct MarkerGrid {
    int markers_x = 0, markers_y = 0;
    double marker_m = 0, gap_m = 0; ///< side of a marker; white between two
    std::string dictionary;
    int first_id = 0;
    gi::RigidPose world_from_grid;

    friend bool operator==(MarkerGrid const&, MarkerGrid const&) = default;
};

struct MarkerMap {
    std::vector<Marker> markers;
    std::vector<CharucoBoard> boards;
    std::vector<MarkerGrid> grids;

    friend bool operator==(MarkerMap const&, MarkerMap const&) = default;
};

/// Number of things. They are numbered as in SightedPoint::marker: first markers, then boards, then grids.
int count_of(MarkerMap const& map);
/// "marker 7 of DICT_4X4_50", "board 1 (7 x 5 squares)", "grid 1 (2 x 3 markers)".
std::string describe(MarkerMap const& map, int thing);
gi::RigidPose world_from_thing(MarkerMap const& map, int thing);

/// All names of dictionaries.
std::vector<std::string> const& dictionary_names();
/// Number of identifiers in a dictionary, which run from 0; 0: no such dictionary.
int dictionary_size(std::string const& name);

/// A single marker, or one marker of a board or grid.
struct PlacedMarker {
    int thing = 0; ///< number within the map
    std::string dictionary;
    int id = 0;
    /// Corners of the black square in the frame of the thing (marker, board or grid): upper left, upper right,
    /// lower right, lower left as printed.
    std::array<glm::dvec3, 4> corners_m;
};
std::vector<PlacedMarker> placed_markers(MarkerMap const& map);

int marker_count(CharucoBoard const& board);
/// The inner corners of a board in its frame, row by row from the top left: (squares_x - 1) x (squares_y - 1).
std::vector<glm::dvec3> inner_corners(CharucoBoard const& board);
/// True if the square in this column and row, from the upper left, is black.
bool is_black(CharucoBoard const& board, int column, int row);

/// @throws gi::InputError unknown dictionary, an identifier not in it, a repeated identifier, lengths that are
/// not positive and finite, markers larger than their squares, invalid rotations; `where` begins the message
void check(MarkerMap const& map, std::string const& where);

} // namespace ar
