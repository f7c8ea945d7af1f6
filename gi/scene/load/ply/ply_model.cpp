#include "gi/scene/load/ply/ply_model.h"

#include "gi/core/text.h"
#include "gi/scene/load/obj/obj_text.h"
#include "gi/scene/load/ply/ply_values.h"

#include <algorithm>
#include <optional>
#include <span>
#include <stdexcept>

namespace gi {
namespace {

/// What a property means.
enum PlyRole : std::uint8_t {
    kX,
    kY,
    kZ,
    kNx,
    kNy,
    kNz,
    kU,
    kV,
    kRed,
    kGreen,
    kBlue,
    kAlpha,
    kPicture,
    kRoles, // one value
    kIndices,
    kCornerUvs, // lists
    kNothing
};
using PlyRow = std::array<double, kRoles>;

struct PlyRoleName {
    std::string_view name;
    PlyRole role;
};
/// Of vertices and faces.
constexpr PlyRoleName kColorRoles[]{{"red", kRed},
                                    {"green", kGreen},
                                    {"blue", kBlue},
                                    {"alpha", kAlpha},
                                    {"r", kRed},
                                    {"g", kGreen},
                                    {"b", kBlue},
                                    {"a", kAlpha},
                                    {"diffuse_red", kRed},
                                    {"diffuse_green", kGreen},
                                    {"diffuse_blue", kBlue},
                                    {"diffuse_alpha", kAlpha}};
constexpr PlyRoleName kVertexRoles[]{
    {"x", kX},          {"y", kY},         {"z", kZ},         {"nx", kNx},       {"ny", kNy},
    {"nz", kNz},        {"normal_x", kNx}, {"normal_y", kNy}, {"normal_z", kNz}, {"s", kU},
    {"t", kV},          {"u", kU},         {"v", kV},         {"texture_u", kU}, {"texture_v", kV},
    {"texture_s", kU},  {"texture_t", kV}, {"tx", kU},        {"ty", kV},        {"texcoord_u", kU},
    {"texcoord_v", kV}, {"s0", kU},        {"t0", kV},        {"u0", kU},        {"v0", kV}};
constexpr PlyRoleName kFaceRoles[]{{"vertex_indices", kIndices}, {"vertex_index", kIndices},
                                   {"vertex_indexes", kIndices}, {"texcoord", kCornerUvs},
                                   {"texcoords", kCornerUvs},    {"texture_coordinates", kCornerUvs},
                                   {"uv", kCornerUvs},           {"texnumber", kPicture},
                                   {"texture_number", kPicture}, {"tex_number", kPicture}};

/// The properties of an element with what they mean.
struct PlyTable {
    PlyElement const& element;
    std::vector<PlyRole> roles;        ///< of each property
    std::array<double, kRoles> unit{}; ///< what 1 is written as; 0 = there is no such property

    bool has(std::initializer_list<PlyRole> all) const
    {
        return std::ranges::all_of(all, [&](PlyRole r) { return unit[r] != 0; });
    }
    bool has_list(PlyRole r) const { return std::ranges::find(roles, r) != roles.end(); }
};

template <std::size_t n>
PlyRole role_of(PlyProperty const& p, PlyRoleName const (&names)[n])
{
    for (std::span<PlyRoleName const> const table :
         {std::span<PlyRoleName const>(names), std::span<PlyRoleName const>(kColorRoles)})
        for (PlyRoleName const& known : table)
            if (equals_caseless(p.name, known.name))
                return p.is_list == (known.role > kRoles) ? known.role : kNothing;
    return kNothing;
}

class PlyParser {
public:
    PlyParser(std::string_view file, ImportedFiles& notes, std::string const& name)
        : header_(read_ply_header(file)), values_(file, header_), notes_(notes), name_(name)
    {
    }

    PlyModel read()
    {
        for (std::string const& comment : header_.comments) {
            std::string_view rest = comment;
            if (equals_caseless(take_word(rest), "texturefile") && !trimmed(rest).empty())
                m_.textures.emplace_back(trimmed(rest));
        }
        for (std::string const& line : header_.unknown)
            notes_.lose("lines of headers of PLY that are not understood, skipped", 1, at(line));
        for (PlyElement const& element : header_.elements) read_element(element);
        if (values_.is_text())
            lose_values(values_.count_left());
        else
            notes_.lose("bytes of PLY behind those that its header names, skipped", values_.count_left(), name_);
        finish();
        return std::move(m_);
    }

private:
    void read_element(PlyElement const& e)
    {
        std::size_t least = 0; // bytes of a row
        for (PlyProperty const& p : e.properties) least += values_.least_bytes(p.is_list ? p.count_type : p.type);
        if (least > 0 && e.rows > (values_.bytes_left() + 1) / least)
            throw std::runtime_error("the file ends before the " + std::to_string(e.rows) +
                                     " rows of its element '" + shortened(e.name, 40) + "'");
        if (e.properties.empty()) return;
        if (equals_caseless(e.name, "vertex") || equals_caseless(e.name, "vertices"))
            read_vertices(table(e, kVertexRoles));
        else if (equals_caseless(e.name, "face") || equals_caseless(e.name, "faces"))
            read_faces(table(e, kFaceRoles), false);
        else if (equals_caseless(e.name, "tristrips") || equals_caseless(e.name, "tristrip"))
            read_faces(table(e, kFaceRoles), true);
        else {
            notes_.lose("elements of PLY that are no vertices, faces or strips, skipped", e.rows, at(e.name));
            PlyTable const none{e, std::vector(e.properties.size(), kNothing), {}};
            for (std::uint64_t row = 0; row < e.rows; ++row) read_row(none);
        }
    }

    void lose_values(std::size_t count)
    {
        if (count > 0)
            notes_.lose("values of PLY that its header does not name, skipped", count,
                        at("line " + std::to_string(values_.line())));
    }

    std::string at(std::string const& what) const { return name_ + ": " + shortened(what, 60); }

    template <std::size_t n>
    PlyTable table(PlyElement const& e, PlyRoleName const (&names)[n])
    {
        PlyTable t{e, {}, {}};
        for (PlyProperty const& p : e.properties) {
            PlyRole role = role_of(p, names);
            bool const is_taken = role < kRoles ? t.unit[role] != 0 : role != kNothing && t.has_list(role);
            if (is_taken) role = kNothing;
            bool const is_color = role >= kRed && role <= kAlpha;
            if (role < kRoles) t.unit[role] = is_color ? largest_of(p.type) : 1;
            if (role == kNothing)
                notes_.lose("properties of PLY that are not used", e.rows, at(e.name + "." + p.name));
            t.roles.push_back(role);
        }
        return t;
    }

    /// Reads a row: single values, and the lists of indices and texture coordinates.
    void read_row(PlyTable const& t)
    {
        indices_.clear();
        row_uvs_.clear();
        values_.begin_row();
        for (std::size_t i = 0; i < t.roles.size(); ++i) {
            PlyProperty const& p = t.element.properties[i];
            if (!p.is_list) {
                double const value = values_.take(p.type);
                if (t.roles[i] >= kRoles) continue;
                double const unit = t.unit[t.roles[i]];
                row_[t.roles[i]] = value / unit;
                if (unit > kMostOfByte) most_of_wide_ = std::max(most_of_wide_, value);
                continue;
            }
            double const count = values_.take(p.count_type);
            if (!(count >= 0) || count > double((values_.bytes_left() + 1) / values_.least_bytes(p.type)))
                throw std::runtime_error("a list of its element '" + shortened(t.element.name, 40) +
                                         "' is longer than the file, or has no length");
            for (std::size_t k = 0; k < std::size_t(count); ++k) {
                double const value = values_.take(p.type);
                if (t.roles[i] == kIndices) indices_.push_back(value);
                if (t.roles[i] == kCornerUvs) row_uvs_.push_back(float(value));
            }
        }
        lose_values(values_.end_row());
    }

    vec4 color(PlyTable const& t) const
    {
        return {row_[kRed], row_[kGreen], row_[kBlue], t.has({kAlpha}) ? row_[kAlpha] : 1.0};
    }

    /// Colours of wide integers, none of which exceeds 255, are bytes that a program wrote as e.g. `int`.
    void divide_by_255(PlyTable const& t, std::span<vec4> colors)
    {
        if (most_of_wide_ <= 0 || most_of_wide_ > kMostOfByte || colors.empty()) return;
        for (int channel = 0; channel < 4; ++channel) {
            double const unit = t.unit[std::size_t(kRed + channel)];
            if (unit <= kMostOfByte) continue;
            for (vec4& c : colors) c[channel] = float(double(c[channel]) * (unit / kMostOfByte));
        }
        notes_.lose("colours of integers of more than 8 bits that stay within 255, divided by 255", colors.size(),
                    at(t.element.name));
    }

    void read_vertices(PlyTable const& t)
    {
        most_of_wide_ = 0;
        if (!t.has({kX, kY, kZ})) throw std::runtime_error("its vertices have no x, y and z");
        if (!m_.positions.empty()) throw std::runtime_error("it has two elements of vertices");
        for (std::uint64_t row = 0; row < t.element.rows; ++row) {
            read_row(t);
            dvec3 const position{row_[kX], row_[kY], row_[kZ]};
            if (row == 0) m_.origin_m = near_origin(position);
            m_.positions.emplace_back(position - m_.origin_m);
            if (t.has({kNx, kNy, kNz})) m_.normals.emplace_back(row_[kNx], row_[kNy], row_[kNz]);
            if (t.has({kU, kV})) m_.uvs.emplace_back(row_[kU], row_[kV]);
            if (t.has({kRed, kGreen, kBlue})) m_.colors.push_back(color(t));
        }
        divide_by_255(t, m_.colors);
    }

    void read_faces(PlyTable const& t, bool are_strips)
    {
        if (!t.has_list(kIndices))
            throw std::runtime_error("its element '" + shortened(t.element.name, 40) +
                                     "' has no list vertex_indices");
        most_of_wide_ = 0;
        std::size_t const first_face = m_.faces.size();
        for (std::uint64_t row = 0; row < t.element.rows; ++row) {
            read_row(t);
            face_ = {0, t.has({kPicture}) ? picture(row_[kPicture]) : 0};
            face_color_ = t.has({kRed, kGreen, kBlue}) ? std::optional(color(t)) : std::nullopt;
            bool const has_uvs = row_uvs_.size() == 2 * indices_.size();
            if (!has_uvs && !row_uvs_.empty())
                notes_.lose("texture coordinates of faces that are not two for each corner, skipped", 1,
                            at(t.element.name + " " + std::to_string(row)));
            if (!has_uvs) row_uvs_.clear();
            if (are_strips) {
                add_strips();
            } else {
                for (std::size_t c = 0; c < indices_.size(); ++c) add_corner(c);
                end_face(indices_.size());
            }
        }
        if (!m_.face_colors.empty() && t.has({kRed, kGreen, kBlue}))
            divide_by_255(t, std::span(m_.face_colors).subspan(first_face));
    }

    static std::int32_t picture(double number) { return number >= 0 && number < 1e9 ? std::int32_t(number) : -1; }

    /// Strips of triangles, whose winding alternates. An index of -1 ends one.
    void add_strips()
    {
        std::size_t first = 0;
        for (std::size_t i = 0; i < indices_.size(); ++i) {
            if (indices_[i] < 0 || indices_[i] == double(UINT32_MAX)) {
                first = i + 1;
                continue;
            }
            if (i < first + 2) continue;
            std::size_t const turned = (i - first) % 2; // the second one and every other one after it
            std::array<std::size_t, 3> const c{i - 2 + turned, i - 1 - turned, i};
            double const a = indices_[c[0]], b = indices_[c[1]], d = indices_[c[2]];
            if (a == b || b == d || d == a) continue; // stitches strips together
            for (std::size_t const corner : c) add_corner(corner);
            end_face(3);
        }
    }

    void add_corner(std::size_t c)
    {
        double const index = indices_[c];
        if (!(index >= 0 && index < double(UINT32_MAX)))
            throw std::runtime_error("a face has a vertex that the file has not");
        m_.corners.push_back(std::uint32_t(index));
        if (!row_uvs_.empty() && m_.corner_uvs.empty()) m_.corner_uvs.resize(m_.corners.size() - 1);
        if (!row_uvs_.empty())
            m_.corner_uvs.emplace_back(row_uvs_[2 * c], row_uvs_[2 * c + 1]);
        else if (!m_.corner_uvs.empty())
            m_.corner_uvs.emplace_back(0);
    }

    void end_face(std::size_t corners)
    {
        if (corners == 0) return;
        if (face_color_ && m_.face_colors.empty()) m_.face_colors.resize(m_.faces.size(), vec4{1});
        if (face_color_ || !m_.face_colors.empty()) m_.face_colors.push_back(face_color_.value_or(vec4{1}));
        if (corners < 3) notes_.lose("points and lines skipped", 1, name_);
        face_.corners_end = m_.corners.size();
        m_.faces.push_back(face_);
    }

    /// What needs all elements, as faces may come before the vertices.
    void finish()
    {
        for (std::uint32_t const c : m_.corners)
            if (c >= m_.positions.size()) throw std::runtime_error("a face has a vertex that the file has not");
        if (m_.faces.empty()) throw std::runtime_error("it has no faces: points alone cannot be seen");
        if (!m_.face_colors.empty() && !m_.colors.empty()) {
            notes_.lose("colours of faces whose vertices have colours, skipped", m_.face_colors.size(), name_);
            m_.face_colors.clear();
        }
        bool const has_uvs = !m_.uvs.empty() || !m_.corner_uvs.empty();
        if (!has_uvs && !m_.textures.empty()) {
            notes_.lose("textures of PLY without texture coordinates, skipped", m_.textures.size(),
                        at(m_.textures[0]));
            m_.textures.clear();
        }
        for (PlyModel::Face& face : m_.faces) {
            bool const is_known = face.texture >= 0 && std::size_t(face.texture) < m_.textures.size();
            if (is_known) continue;
            if (!m_.textures.empty()) notes_.lose("faces of PLY whose texnumber has no TextureFile", 1, name_);
            face.texture = -1;
        }
    }

    static constexpr double kMostOfByte = 255;

    PlyHeader header_;
    PlyValues values_;
    ImportedFiles& notes_;
    std::string const& name_;
    PlyModel m_;
    PlyRow row_{};                   ///< of the row that is read
    std::vector<double> indices_;    ///< likewise
    std::vector<float> row_uvs_;     ///< likewise
    PlyModel::Face face_{};          ///< likewise
    std::optional<vec4> face_color_; ///< likewise
    double most_of_wide_ = 0;        ///< largest colour of integers of more than 8 bits, of an element
};

} // namespace

PlyModel read_ply(std::string_view file, ImportedFiles& notes, std::string const& name)
{
    return PlyParser(file, notes, name).read();
}

} // namespace gi
