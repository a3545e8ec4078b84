// Wavefront OBJ ("Object Files (.obj)", Advanced Visualizer Manual, appendix B1).
#include "core/fail.h"
#include "core/srgb.h"
#include "scene/mesh_files/read_mesh_files.h"
#include "scene/mesh_files/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <unordered_map>

namespace pellucid {
namespace {

constexpr float kEncoded = 2.0f;  // alpha of a colour that is not decoded yet

/// Elements of one kind that faces refer to, and the greatest number by which they did.
struct References {
    const char* what;
    std::int64_t greatest = 0;
    std::size_t line = 0;  ///< of `greatest`
};

class ObjReader {
public:
    ObjReader(const std::filesystem::path& file, Warnings& warnings) : file_(file), warnings_(warnings) {}

    PolygonFile read(std::string_view text) {
        content_.first_number = 1;
        Lines lines(text);
        std::string buffer;
        for (std::string_view line; lines.next_joined(line, buffer);) {
            line_ = lines.number();
            read_line(line);
        }
        decode_colors();
        check_references();
        warn();
        return std::move(content_);
    }

private:
    [[noreturn]] void fail_here(const std::string& cause) const {
        fail(file_, fmt::format("line {}: {}", line_, cause));
    }

    void read_line(std::string_view line) {
        Words words(line);
        const std::string_view keyword = words.next();
        if (keyword.empty() || keyword.starts_with('#')) return;
        if (keyword == "v") return read_vertex(words);
        if (keyword == "vn") return read_normal(words);
        if (keyword == "vt") return read_texcoord(words);
        if (keyword == "f" || keyword == "fo") return read_face(words);  // fo: of version 2.11
        if (keyword == "l" || keyword == "p") return count_leftovers(keyword, words);
        if (keyword == "usemtl") return use_material(words.rest());
        if (keyword == "mtllib") return content_.libraries.emplace_back(words.rest()), void();
        static constexpr std::array<std::string_view, 7> kFreeForm = {"cstype", "curv", "curv2", "surf",
                                                                      "bmat",   "step", "vp"};
        if (std::find(kFreeForm.begin(), kFreeForm.end(), keyword) != kFreeForm.end()) {
            surfaces_ += keyword == "surf" || keyword == "curv" || keyword == "curv2";
            return;
        }
        // Groups, smoothing, display attributes, and the parameters of free-form curves.
        static constexpr std::array<std::string_view, 23> kWithoutEffect = {
            "o",      "g",      "s",          "mg",        "lod",   "bevel", "c_interp", "d_interp",
            "usemap", "maplib", "shadow_obj", "trace_obj", "deg",   "parm",  "end",      "trim",
            "hole",   "scrv",   "sp",         "con",       "ctech", "stech", "#"};
        if (std::find(kWithoutEffect.begin(), kWithoutEffect.end(), keyword) != kWithoutEffect.end()) return;
        if (unknown_++ == 0) first_unknown_ = fmt::format("line {} \"{}\"", line_, shortened(keyword));
    }

    /// Reads up to `most` numbers; returns how many there were.
    std::size_t numbers(Words& words, double* values, std::size_t most) {
        for (std::size_t count = 0; count < most; ++count) {
            const std::string_view word = words.next();
            if (word.empty() || word.starts_with('#')) return count;
            const std::optional<double> value = parse_real(word);
            if (!value) fail_here(fmt::format("\"{}\" is no number", shortened(word)));
            values[count] = *value;
        }
        return most;
    }

    void read_vertex(Words& words) {
        std::array<double, 8> v{};
        const std::size_t count = numbers(words, v.data(), v.size());
        if (count < 3)
            fail_here(fmt::format("a vertex has {} coordinate{} instead of 3", count, count == 1 ? "" : "s"));
        content_.positions.emplace_back(v[0], v[1], v[2]);
        // A fourth number is the weight of a rational curve, by which positions are not divided. Six and more are a
        // position and a colour, which programs store encoded for display.
        const bool colored = count == 6 || count == 7;
        if (!colored && content_.colors.empty()) return;
        content_.colors.resize(content_.positions.size() - 1, glm::vec4(1.0f));
        content_.colors.push_back(colored ? glm::vec4(v[3], v[4], v[5], kEncoded) : glm::vec4(1.0f));
    }

    /// Some programs write bytes, which one number above 1 shows.
    void decode_colors() {
        const bool bytes = std::any_of(content_.colors.begin(), content_.colors.end(), [](const glm::vec4& c) {
            return std::max({c.r, c.g, c.b}) > 1.0f;
        });
        for (glm::vec4& color : content_.colors) {
            if (color.a != kEncoded) continue;
            for (int k = 0; k < 3; ++k) color[k] = linear_from_srgb(bytes ? color[k] / 255.0f : color[k]);
            color.a = 1.0f;
        }
    }

    void read_normal(Words& words) {
        std::array<double, 3> n{};
        numbers(words, n.data(), n.size());
        const glm::vec3 normal(n[0], n[1], n[2]);
        // A zero normal is made anew later.
        content_.normals.push_back(std::isfinite(normal.x + normal.y + normal.z) ? normal : glm::vec3(0.0f));
    }

    void read_texcoord(Words& words) {
        std::array<double, 2> t{};
        numbers(words, t.data(), t.size());
        const glm::vec2 texcoord(t[0], t[1]);
        content_.texcoords.push_back(std::isfinite(texcoord.x + texcoord.y) ? texcoord : glm::vec2(0.0f));
    }

    /// Index from 0 for a number from 1, or for one below 0 that counts back from the last element so far.
    std::uint32_t reference(std::int64_t number, std::size_t count, References& references) {
        const bool exists = number > 0 ? number < std::int64_t(kNoIndex) : number < 0 && -std::int64_t(count) <= number;
        if (!exists)
            fail_here(fmt::format("face refers to a {} that does not exist: {} of {}", references.what, number, count));
        if (number < 0) return std::uint32_t(std::int64_t(count) + number);
        if (number > references.greatest) references.greatest = number, references.line = line_;
        return std::uint32_t(number - 1);
    }

    /// "v", "v/t", "v//n" or "v/t/n".
    PolygonCorner read_corner(std::string_view word) {
        PolygonCorner corner;
        std::array<std::string_view, 3> parts;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t end = k < 2 ? std::min(word.find('/'), word.size()) : word.size();
            parts[k] = word.substr(0, end);
            word.remove_prefix(std::min(end + 1, word.size()));
        }
        std::array<std::int64_t, 3> numbers{};
        for (std::size_t k = 0; k < 3; ++k) {
            if (parts[k].empty() && k > 0) continue;
            const std::optional<std::int64_t> number = parse_integer(parts[k]);
            if (!number) fail_here(fmt::format("\"{}\" is no corner of a face", shortened(parts[k])));
            numbers[k] = *number;
        }
        corner.position = reference(numbers[0], content_.positions.size(), vertices_);
        // Texture coordinates that do not exist are left out: without a texture nothing is lost.
        const auto texcoords = std::int64_t(content_.texcoords.size());
        if (numbers[1] > 0 && numbers[1] < std::int64_t(kNoIndex)) corner.texcoord = std::uint32_t(numbers[1] - 1);
        if (numbers[1] < 0 && -texcoords <= numbers[1]) corner.texcoord = std::uint32_t(texcoords + numbers[1]);
        // Some programs write references to normals without the normals.
        if (!parts[2].empty() && !(numbers[2] < 0 && content_.normals.empty()))
            corner.normal = reference(numbers[2], content_.normals.size(), normals_);
        return corner;
    }

    void read_face(Words& words) {
        const std::size_t begin = content_.corners.size();
        for (std::string_view word = words.next(); !word.empty() && !word.starts_with('#'); word = words.next())
            content_.corners.push_back(read_corner(word));
        if (content_.corners.size() >= kNoIndex) fail_here("more than 2^32 corners");
        if (content_.corners.size() > begin) content_.end_polygon(material_);
    }

    void count_leftovers(std::string_view keyword, Words& words) {
        std::uint64_t count = 0;
        for (std::string_view word = words.next(); !word.empty(); word = words.next()) ++count;
        (keyword == "p" ? content_.points : content_.lines) += keyword == "p" ? count : std::uint64_t(count > 1);
    }

    void use_material(std::string_view name) {
        if (name.empty()) return void(material_ = kNoIndex);
        const auto [known, added] =
            numbers_by_name_.try_emplace(std::string(name), std::uint32_t(content_.material_names.size()));
        if (added) content_.material_names.emplace_back(name);
        material_ = known->second;
    }

    void check_references() {
        if (content_.normals.empty()) {
            normals_.greatest = 0;
            for (PolygonCorner& corner : content_.corners) corner.normal = kNoIndex;
        }
        for (const auto& [references, count] :
             {std::pair(vertices_, content_.positions.size()), std::pair(normals_, content_.normals.size())})
            if (references.greatest > std::int64_t(count))
                fail(file_, fmt::format("line {}: face refers to {} {}, there are {}", references.line, references.what,
                                        references.greatest, count));
        for (PolygonCorner& corner : content_.corners) {
            if (corner.texcoord == kNoIndex || corner.texcoord < content_.texcoords.size()) continue;
            corner.texcoord = kNoIndex;
            ++lost_texcoords_;
        }
        if (!content_.colors.empty()) content_.colors.resize(content_.positions.size(), glm::vec4(1.0f));
        if (!content_.material_names.empty()) content_.materials.resize(content_.ends.size(), kNoIndex);
    }

    void warn() {
        const std::string name = file_.filename().string();
        if (surfaces_ > 0) warnings_.add(fmt::format("{}: {} free-form curves and surfaces left out", name, surfaces_));
        if (lost_texcoords_ > 0 && !content_.texcoords.empty())
            warnings_.add(
                fmt::format("{}: {} references to texture coordinates that do not exist", name, lost_texcoords_));
        if (unknown_ > 0)
            warnings_.add(fmt::format("{}: {} line{} not understood, left out; the first is {}", name, unknown_,
                                      unknown_ == 1 ? "" : "s", first_unknown_));
    }

    const std::filesystem::path& file_;
    Warnings& warnings_;
    PolygonFile content_;
    References vertices_{.what = "vertex"}, normals_{.what = "normal"};
    std::unordered_map<std::string, std::uint32_t> numbers_by_name_;
    std::uint32_t material_ = kNoIndex;
    std::size_t line_ = 0, unknown_ = 0, surfaces_ = 0, lost_texcoords_ = 0;
    std::string first_unknown_;
};

}  // namespace

PolygonFile read_obj(const std::filesystem::path& file, std::vector<std::byte> bytes, Warnings& warnings) {
    make_utf8(bytes);
    return ObjReader(file, warnings).read(as_text(bytes));
}

}  // namespace pellucid
