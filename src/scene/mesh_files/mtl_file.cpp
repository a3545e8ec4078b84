// Wavefront MTL (Alias|Wavefront, "MTL material format", 1995), with Pr, Pm, Ke and norm of "Extending the Wavefront MTL
// format for physically based rendering" (exocortex, 2016).
#include "scene/mesh_files/mtl_file.h"

#include "core/file.h"
#include "scene/mesh_files/text_file.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <system_error>

namespace pellucid {
namespace {

class MtlReader {
public:
    MtlReader(const std::filesystem::path& file, const FileScope& scope, Warnings& warnings)
        : file_(file), scope_(scope), warnings_(warnings) {}

    std::vector<MtlMaterial> read(std::string_view text) {
        Lines lines(text);
        std::string buffer;
        for (std::string_view line; lines.next_joined(line, buffer);) {
            line_ = lines.number();
            Words words(line);
            const std::string_view keyword = words.next();
            if (keyword == "newmtl") {
                materials_.emplace_back().name = words.rest();
            } else if (!keyword.empty() && !keyword.starts_with('#') && !materials_.empty()) {
                read_statement(lower_case(keyword), words, materials_.back());
            }
        }
        return std::move(materials_);
    }

private:
    void warn(const std::string& problem) {
        warnings_.add(fmt::format("{}: line {}: {}, left out", file_.filename().string(), line_, problem));
    }

    void read_statement(const std::string& keyword, Words& words, MtlMaterial& material) {
        if (keyword == "kd") return read_color(words, material.Kd);
        if (keyword == "ks") return read_color(words, material.Ks);
        if (keyword == "ke") return read_color(words, material.Ke);
        if (keyword == "tf") return read_color(words, material.Tf);
        if (keyword == "ns") return read_number(words, material.Ns);
        if (keyword == "ni") return read_number(words, material.Ni);
        if (keyword == "pr") return read_number(words, material.Pr);
        if (keyword == "pm") return read_number(words, material.Pm);
        if (keyword == "d") return read_dissolve(words, material);
        if (keyword == "tr") return read_transparency(words, material);
        if (keyword == "illum") {
            std::optional<float> number;
            read_number(words, number);
            if (number) material.illum = int(std::clamp(*number, 0.0f, 100.0f));
            return;
        }
        if (keyword == "map_kd") return read_texture(words, material.map_Kd, material);
        if (keyword == "map_d") return read_texture(words, material.map_d, material);
        if (keyword == "map_ke") return read_texture(words, material.map_Ke, material);
        if (keyword == "map_pr") return read_texture(words, material.map_Pr, material);
        if (keyword == "map_pm") return read_texture(words, material.map_Pm, material);
        if (keyword == "map_bump" || keyword == "bump") return read_texture(words, material.bump, material);
        if (keyword == "norm") return read_texture(words, material.normal, material);
        static constexpr std::array<std::string_view, 10> kUnused = {"map_ks", "map_ns", "map_tr", "disp",  "decal",
                                                                     "map_tf", "pc",     "ps",     "aniso", "map_ps"};
        if (std::find(kUnused.begin(), kUnused.end(), keyword) == kUnused.end()) return;
        if (const auto number = parse_real(Words(words.rest()).next()); number && *number == 0.0) return;  // none of it
        material.unused.push_back(keyword);
    }

    /// One number, or "-halo" and a number.
    void read_dissolve(Words& words, MtlMaterial& material) {
        std::string_view word = words.next();
        if (word == "-halo") {
            material.unused.emplace_back("d -halo");
            word = words.next();
        }
        Words number(word);
        read_number(number, material.d);
    }

    /// 1 - d. Where a file has both, d counts: some programs write the same number as both. A lone Tr of 1 is no
    /// material that nobody could see, but written by such a program.
    void read_transparency(Words& words, MtlMaterial& material) {
        std::optional<float> number;
        read_number(words, number);
        if (number && !material.d && *number < 1.0f) material.d = 1.0f - *number;
    }

    bool parse_number(std::string_view word, float& number) {
        const std::optional<double> value = parse_real(word);
        if (!value || !(std::abs(*value) < 1e30)) return false;
        number = float(*value);
        return true;
    }

    void read_number(Words& words, std::optional<float>& number) {
        float value = 0.0f;
        const std::string_view word = words.next();
        if (parse_number(word, value)) {
            number = value;
        } else {
            warn(fmt::format("\"{}\" is no number", shortened(word)));
        }
    }

    /// "r g b", or "r" for grey. CIE XYZ becomes Rec.709.
    void read_color(Words& words, std::optional<glm::vec3>& color) {
        std::string_view word = words.next();
        if (word == "spectral") return warn("a spectral curve");
        const bool xyz = word == "xyz";
        if (xyz) word = words.next();
        glm::vec3 value(0.0f);
        for (int k = 0; k < 3; ++k, word = words.next()) {
            if (k > 0 && (word.empty() || word.starts_with('#'))) {
                value[k] = value[0];
            } else if (!parse_number(word, value[k])) {
                return warn(fmt::format("\"{}\" is no number", shortened(word)));
            }
        }
        // ITU-R BT.709, with D65 white.
        if (xyz)
            value = {3.2404542f * value.x - 1.5371385f * value.y - 0.4985314f * value.z,
                     -0.9692660f * value.x + 1.8760108f * value.y + 0.0415560f * value.z,
                     0.0556434f * value.x - 0.2040259f * value.y + 1.0572252f * value.z};
        color = glm::max(value, glm::vec3(0.0f));
    }

    /// Options, and the name of a file, which may have blanks.
    void read_texture(Words& words, MtlTexture& texture, MtlMaterial& material) {
        texture = {};
        std::string_view left = words.rest();
        while (left.starts_with('-')) {
            Words options(left);
            const std::string_view option = options.next();
            std::array<float, 3> values = {0.0f, 0.0f, 0.0f};
            std::size_t count = 0;
            const bool vector = option == "-s" || option == "-o" || option == "-t";
            if (vector || option == "-mm") {
                for (Words ahead(options.rest());
                     count < (vector ? 3u : 2u) && parse_number(ahead.next(), values[count]); ++count)
                    options.next();
            } else {
                const std::string_view value = options.next();
                if (option == "-clamp") texture.clamp = value == "on";
                if (option == "-bm") parse_number(value, texture.bump);
            }
            if (option == "-s" && count > 0) texture.scale = {values[0], count > 1 ? values[1] : 1.0f};
            if (option == "-o" && count > 0) texture.offset = {values[0], values[1]};
            if (option == "-t" || option == "-mm" || option == "-imfchan") material.unused.emplace_back(option);
            left = options.rest();
        }
        texture.name = left;
        try {
            texture.file = find_beside(file_.parent_path(), left, scope_);
        } catch (const Error&) {
            texture.problem = kOutsideScope;
        }
    }

    const std::filesystem::path& file_;
    const FileScope& scope_;
    Warnings& warnings_;
    std::vector<MtlMaterial> materials_;
    std::size_t line_ = 0;
};

}  // namespace

std::vector<MtlMaterial> read_mtl(const std::filesystem::path& file, const FileScope& scope, Warnings& warnings) {
    std::vector<std::byte> bytes = read_file(file);
    make_utf8(bytes);
    return MtlReader(file, scope, warnings).read(as_text(bytes));
}

std::filesystem::path find_beside(const std::filesystem::path& folder, std::string_view name, const FileScope& scope) {
    std::string clean(name);
    if (clean.size() > 1 && clean.front() == '"' && clean.back() == '"') clean = clean.substr(1, clean.size() - 2);
    std::replace(clean.begin(), clean.end(), '\\', '/');
    std::error_code error;
    const std::filesystem::path file = folder / clean;
    if (clean.empty()) return {};
    const bool exists = std::filesystem::is_regular_file(file, error);
    if (exists && scope.contains(file)) return file;
    const std::string wanted = lower_case(file.filename().string());
    for (const std::filesystem::path& place : {file.parent_path(), folder}) {
        if (!scope.contains(place)) continue;
        std::filesystem::directory_iterator entries(place.empty() ? "." : place, error);
        for (const auto& entry : entries)
            if (lower_case(entry.path().filename().string()) == wanted && entry.is_regular_file(error) &&
                scope.contains(entry.path()))
                return entry.path();
    }
    if (exists) scope.check(file);
    return {};
}

}  // namespace pellucid
