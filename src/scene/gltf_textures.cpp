// Textures of glTF 2.0 (Khronos Group, glTF 2.0 Specification, 2021, section 3.8) and of the extensions that give them
// other images: EXT_texture_webp, EXT_texture_avif, MSFT_texture_dds, KHR_texture_basisu.
#include "scene/gltf_textures.h"

#include "core/fail.h"
#include "scene/gltf_properties.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

/// Which sets a mesh holds: 0 and 1 if that is enough, else the first two that are asked for.
TexcoordSets chosen_sets(const std::vector<int>& asked) {
    TexcoordSets sets = {0, 1};
    if (std::all_of(asked.begin(), asked.end(), [](int set) { return set < 2; })) return sets;
    for (std::size_t i = 0; i < sets.size() && i < asked.size(); ++i) sets[i] = asked[i];
    if (asked.size() == 1) sets[1] = asked[0] == 0 ? 1 : 0;
    return sets;
}

}  // namespace

GltfTextures::GltfTextures(const GltfFile& gltf, Scene& scene, Warnings& warnings)
    : gltf_(gltf), images_(gltf, scene, warnings), warnings_(warnings), asked_sets_(gltf.model.materials.size()),
      sets_(gltf.model.materials.size(), TexcoordSets{0, 1}) {}

void GltfTextures::begin(std::size_t material, const std::string& user) {
    material_ = material;
    user_ = user;
    lacks_basis_ = false;
}

void GltfTextures::begin_again() {
    images_.decode_noted();
    basis_textures_.clear();
    std::transform(asked_sets_.begin(), asked_sets_.end(), sets_.begin(), chosen_sets);
}

int GltfTextures::image_of(int texture_index) {
    if (texture_index < 0 || std::size_t(texture_index) >= gltf_.model.textures.size()) return -1;
    const tinygltf::Texture& texture = gltf_.model.textures[std::size_t(texture_index)];
    const auto source = [&](const char* extension) {
        return int(std::clamp(GltfProperties(texture.extensions, extension).number("source", -1.0), -1.0, 1e9));
    };
    const auto readable = [&](int image) {
        if (image < 0) return false;
        return std::size_t(image) >= gltf_.images.size() || !gltf_.images[std::size_t(image)].is_ktx2();
    };
    for (const int image :
         {source("EXT_texture_webp"), texture.source, source("EXT_texture_avif"), source("MSFT_texture_dds")})
        if (readable(image)) return image;
    if (texture.source < 0 && source("KHR_texture_basisu") < 0) return -1;
    basis_textures_.insert(texture_index);
    lacks_basis_ = true;
    return kBasis;
}

void GltfTextures::expect(int texture_index) {
    const int image = image_of(texture_index);
    if (image != kBasis) images_.expect(image, user_);
}

/// Which of Mesh::texcoords a set of the file is; -1 if the mesh cannot hold it.
int GltfTextures::slot_of(int texcoord_set) {
    if (images_.noting()) {
        std::vector<int>& asked = asked_sets_[material_];
        if (std::find(asked.begin(), asked.end(), texcoord_set) == asked.end()) asked.push_back(texcoord_set);
        return 0;
    }
    const TexcoordSets& sets = sets_[material_];
    for (std::size_t slot = 0; slot < sets.size(); ++slot)
        if (sets[slot] == texcoord_set) return int(slot);
    return -1;
}

Texture GltfTextures::texture(const tinygltf::TextureInfo& info, const char* what) {
    Texture texture = reference(info, what);
    if (info.index < 0 || texture.texcoord_set < 0) return {};
    const int image = image_of(info.index);
    texture.image = image == kBasis ? -1 : images_.index(image, user_);
    return texture.image < 0 ? Texture() : texture;
}

Texture GltfTextures::reference(const tinygltf::TextureInfo& info, const char* what) {
    Texture texture;
    if (info.index < 0) return texture;
    if (std::size_t(info.index) >= gltf_.model.textures.size())
        fail(gltf_.path, fmt::format("{}: there is no texture {}", user_, info.index));
    const GltfProperties transform(info.extensions, "KHR_texture_transform");
    constexpr double kMostSets = 1e6;
    const int set = int(std::clamp(transform.number("texCoord", info.texCoord), -1.0, kMostSets));
    texture.texcoord_set = set < 0 ? -1 : slot_of(set);
    if (texture.texcoord_set < 0)
        warnings_.add(
            fmt::format("{}: {} texture left out: a material may use two sets of texture coordinates, this "
                        "is set {}",
                        user_, what, set));
    read_sampler(gltf_.model.textures[std::size_t(info.index)].sampler, texture);
    if (transform.present()) texture.uv_from_texcoord = uv_transform(info.extensions);
    return texture;
}

void GltfTextures::read_sampler(int index, Texture& texture) const {
    if (index < 0 || std::size_t(index) >= gltf_.model.samplers.size()) return;
    const tinygltf::Sampler& sampler = gltf_.model.samplers[std::size_t(index)];
    const auto wrap = [](int mode) {
        if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::kClamp;
        return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::kMirror : Wrap::kRepeat;
    };
    texture.wrap_u = wrap(sampler.wrapS);
    texture.wrap_v = wrap(sampler.wrapT);
    texture.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
}

/// translation * rotation * scale; the rotation is counter-clockwise with v running downwards.
glm::mat3 GltfTextures::uv_transform(const tinygltf::ExtensionMap& extensions) {
    constexpr double kFar = 1e6;
    const GltfProperties transform(extensions, "KHR_texture_transform");
    const auto limited = [&](double value) {
        if (value >= -kFar && value <= kFar) return float(value);
        const double used = value > kFar ? kFar : -kFar;
        warnings_.add(fmt::format("{}: KHR_texture_transform {} is out of range, {} used", user_, value, used));
        return float(used);
    };
    const auto value = [&](const char* key, int k, double otherwise) {
        return limited(transform.number(key, k, otherwise));
    };
    const float angle = limited(transform.number("rotation", 0.0));
    const float c = std::cos(angle), s = std::sin(angle);
    const glm::mat3 translation(1, 0, 0, 0, 1, 0, value("offset", 0, 0.0), value("offset", 1, 0.0), 1);
    const glm::mat3 rotation(c, -s, 0, s, c, 0, 0, 0, 1);
    const glm::mat3 scale(value("scale", 0, 1.0), 0, 0, 0, value("scale", 1, 1.0), 0, 0, 0, 1);
    return translation * rotation * scale;
}

void GltfTextures::warn_about_leftovers() {
    if (basis_textures_.empty()) return;
    warnings_.add(
        fmt::format("{}: {} texture{} left out: KTX2 images (KHR_texture_basisu) are not decoded; export the "
                    "file with PNG or JPEG images",
                    gltf_.path.filename().string(), basis_textures_.size(), basis_textures_.size() == 1 ? "" : "s"));
}

}  // namespace pellucid
