#include "gi/scene/load/obj/obj_model.h"

#include "gi/core/text.h"
#include "gi/scene/load/assimp_import.h"
#include "gi/scene/load/obj/obj_text.h"

#include <array>
#include <charconv>
#include <optional>
#include <stdexcept>
#include <unordered_map>

namespace gi {
namespace {

class ObjParser {
public:
    ObjParser(std::string_view text, ObjMaterialsOfFile const& materials) : lines_(text), materials_(materials) {}

    ObjModel read()
    {
        while (lines_.next()) {
            std::string_view rest = lines_.line();
            std::string_view const word = take_word(rest);
            if (word == "v")
                add_vertex(rest);
            else if (word == "vt")
                add_uv(rest);
            else if (word == "vn")
                m_.normals.push_back(three_numbers(rest, "a normal"));
            else if (word == "f" || word == "fo")
                add_face(rest, ObjFace::Kind::polygon);
            else if (word == "l")
                add_face(rest, ObjFace::Kind::line);
            else if (word == "p")
                add_face(rest, ObjFace::Kind::point);
            else if (word == "g")
                begin_group(std::string(trimmed(rest)));
            else if (word == "o")
                begin_object(std::string(take_word(rest)));
            else if (word == "usemtl")
                use_material(std::string(trimmed(rest)));
            else if (word == "mtllib" && !trimmed(rest).empty())
                materials_.read(std::string(trimmed(rest)));
            else if (word == "s")
                is_smooth_ = trimmed(rest) != "off" && trimmed(rest) != "0";
            else if (!word.empty() && !word.starts_with('#') && word != "mtllib")
                ++m_.skipped[std::string(word.substr(0, 40))];
        }
        return std::move(m_);
    }

private:
    [[noreturn]] void fail(std::string const& problem) const { throw std::runtime_error(lines_.at(problem)); }

    vec3 three_numbers(std::string_view rest, char const* what) const
    {
        std::array<float, 3> n{};
        if (leading_numbers(rest, n) < n.size())
            fail(std::string(what) + " has three numbers" + comma_advice(rest));
        return {n[0], n[1], n[2]};
    }

    /// By how many numbers there are: x y z; x y z w; x y z and red, green, blue (and alpha); x y z w and red, green,
    /// blue, alpha. Programs that write seven mean an alpha.
    void add_vertex(std::string_view rest)
    {
        std::array<double, 8> n{};
        std::size_t const count = leading_numbers(rest, n);
        if (std::string const advice = comma_advice(rest); count < 3 || !advice.empty())
            fail("a vertex has three numbers" + advice);
        dvec3 position{n[0], n[1], n[2]};
        if (count == 4 || count == 8) {
            if (n[3] == 0) fail("the vertex lies at infinity");
            position /= n[3];
        }
        bool const has_color = count >= 6;
        std::size_t const first = count == 8 ? 4 : 3; // of the colour
        if (count >= 7 && n[count - 1] != 1) ++m_.alphas;
        if (has_color && m_.colors.empty()) m_.colors.resize(m_.positions.size(), vec3{1});
        if (m_.positions.empty()) m_.origin_m = near_origin(position);
        m_.positions.emplace_back(position - m_.origin_m);
        if (has_color)
            m_.colors.emplace_back(n[first], n[first + 1], n[first + 2]);
        else if (!m_.colors.empty())
            m_.colors.push_back(vec3{1});
    }

    void add_uv(std::string_view rest)
    {
        std::array<float, 3> n{};
        std::size_t const count = leading_numbers(rest, n);
        if (count == 0) fail("a texture coordinate has a number" + comma_advice(rest));
        for (float& x : n)
            if (!std::isfinite(x)) x = 0;
        m_.uvs.push_back({n[0], n[1], n[2]});
        if (count == 3) m_.uv_size = 3;
    }

    /// An index counts from 1, or backwards from the last one: -1. @return from 0; may be none of these
    std::int64_t take_index(std::string_view& word, std::size_t count) const
    {
        std::int64_t index = 0;
        auto const [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
        if (error != std::errc{} || index == 0)
            fail("'" + shortened(std::string(word), 40) + "' is no index, which counts from 1 or -1");
        word.remove_prefix(std::size_t(end - word.data()));
        std::int64_t const from_zero = index > 0 ? index - 1 : std::int64_t(count) + index;
        return from_zero >= 0 ? from_zero : kOutOfRange;
    }

    /// vertex, vertex/uv, vertex//normal, vertex/uv/normal
    ObjCorner corner(std::string_view word) const
    {
        ObjCorner c{take_index(word, m_.positions.size())};
        for (int part = 1; word.starts_with('/') && part < 3; ++part) {
            word.remove_prefix(1);
            if (word.empty() || word.starts_with('/')) continue;
            // some programs write vertex/normal where there are no texture coordinates
            bool const is_normal = part == 2 || (m_.uvs.empty() && !m_.normals.empty());
            if (is_normal)
                c.normal = take_index(word, m_.normals.size());
            else
                c.uv = take_index(word, m_.uvs.size());
        }
        if (!word.empty()) fail("'" + shortened(std::string(word), 40) + "' follows the corner of a face");
        return c;
    }

    void add_face(std::string_view rest, ObjFace::Kind kind)
    {
        std::size_t const before = m_.corners.size();
        for (std::string_view word; !(word = take_word(rest)).empty() && !word.starts_with('#');)
            m_.corners.push_back(corner(word));
        if (m_.corners.size() == before) return;
        if (kind == ObjFace::Kind::line && m_.corners.size() == before + 1) return m_.corners.pop_back();
        if (m_.meshes.empty()) begin_object(kObjDefaultName);
        m_.faces.push_back({m_.corners.size(), kind});
        if (kind == ObjFace::Kind::polygon && is_smooth_ && m_.corners.back().normal == ObjCorner::kNone)
            ++m_.flat_faces;
    }

    /// Faces of the same material and object follow.
    void begin_mesh(std::string const& name, std::size_t object)
    {
        m_.meshes.push_back({name, object, m_.faces.size(), material_});
    }

    void begin_new_object(std::string const& name)
    {
        object_of_.try_emplace(name, m_.objects.size());
        m_.objects.push_back(name);
        begin_mesh(name, m_.objects.size() - 1);
    }

    void begin_object(std::string const& name)
    {
        if (name.empty()) return;
        if (auto const known = object_of_.find(name); known != object_of_.end())
            begin_mesh(name, known->second);
        else
            begin_new_object(name);
    }

    /// A group is an object of its own, even if it was begun before.
    void begin_group(std::string const& name)
    {
        if (name.empty() || name == group_) return;
        group_ = name;
        begin_new_object(name);
    }

    void use_material(std::string const& name)
    {
        if (name.empty()) return;
        material_ = materials_.index_of(name);
        if (m_.meshes.empty() || m_.meshes.back().material == material_) return;
        if (m_.meshes.back().first_face == m_.faces.size())
            m_.meshes.back().material = material_;
        else
            begin_mesh(name, m_.meshes.back().object);
    }

    static constexpr std::int64_t kOutOfRange = -2; ///< not kNone

    ObjLines lines_;
    ObjMaterialsOfFile const& materials_;
    ObjModel m_;
    std::unordered_map<std::string, std::size_t> object_of_;
    std::string group_;
    unsigned material_ = 0;
    bool is_smooth_ = false;
};

} // namespace

ObjModel read_obj(std::string_view text, ObjMaterialsOfFile const& materials)
{
    return ObjParser(text, materials).read();
}

} // namespace gi
