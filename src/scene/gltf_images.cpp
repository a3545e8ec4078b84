#include "scene/gltf_images.h"

#include <pellucid/error.h>

#include <fmt/format.h>

namespace pellucid {
namespace {

constexpr int kUnknown = -2;

}  // namespace

GltfImages::GltfImages(const GltfFile& gltf, Scene& scene, Warnings& warnings)
    : gltf_(gltf), scene_(scene), warnings_(warnings), index_(gltf.images.size(), kUnknown),
      warned_(gltf.images.size(), 0) {}

void GltfImages::warn(int gltf_image, const std::string& user, const std::string& problem) {
    if (warned_[std::size_t(gltf_image)]) return;
    warned_[std::size_t(gltf_image)] = 1;
    warnings_.add(fmt::format("{}: texture left out: {}", user, problem));
}

void GltfImages::expect(int gltf_image, const std::string& user) {
    if (gltf_image < 0 || std::size_t(gltf_image) >= gltf_.images.size()) {
        warnings_.add(fmt::format("{}: texture without an image left out", user));
        return;
    }
    const GltfImage& image = gltf_.images[std::size_t(gltf_image)];
    if (!image.problem.empty()) warn(gltf_image, user, image.problem);
}

std::optional<Image> GltfImages::decode(int gltf_image, const std::string& user) {
    expect(gltf_image, user);
    if (gltf_image < 0 || std::size_t(gltf_image) >= gltf_.images.size()) return std::nullopt;
    const GltfImage& image = gltf_.images[std::size_t(gltf_image)];
    if (!image.problem.empty()) return std::nullopt;
    try {
        return decode_image(image.bytes.data(), image.bytes.size(), image.name);
    } catch (const Error& error) {
        warn(gltf_image, user, error.what());
        return std::nullopt;
    }
}

int GltfImages::index(int gltf_image, const std::string& user) {
    if (gltf_image < 0 || std::size_t(gltf_image) >= gltf_.images.size()) {
        expect(gltf_image, user);
        return -1;
    }
    int& index = index_[std::size_t(gltf_image)];
    if (index != kUnknown) return index;
    std::optional<Image> image = decode(gltf_image, user);
    if (!image) return index = -1;
    scene_.images.push_back(std::move(*image));
    scene_.image_names.push_back(gltf_.images[std::size_t(gltf_image)].name);
    return index = static_cast<int>(scene_.images.size()) - 1;
}

}  // namespace pellucid
