#include "scene/gltf_images.h"

#include "core/file.h"
#include "core/image_module.h"
#include "core/parallel.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <exception>
#include <utility>

namespace pellucid {

GltfImages::GltfImages(const GltfFile& gltf, Scene& scene, Warnings& warnings)
    : gltf_(gltf), scene_(scene), warnings_(warnings), entries_(gltf.images.size()) {}

void GltfImages::decode(std::size_t gltf_image) {
    const GltfImage& from = gltf_.images[gltf_image];
    Entry& entry = entries_[gltf_image];
    entry.noted = true;
    entry.problem = from.problem;
    if (!entry.problem.empty()) return;
    try {
        const std::vector<std::byte> read = from.file.empty() ? std::vector<std::byte>() : read_file(from.file);
        const std::span<const std::byte> bytes = !from.file.empty()    ? read
                                                 : !from.bytes.empty() ? from.bytes
                                                                       : from.view;
        entry.image = decode_scene_image(bytes, from.name, gltf_.memory);
    } catch (const std::exception& error) {
        entry.problem = error.what();
    }
}

void GltfImages::decode_noted() {
    std::vector<std::size_t> noted;
    for (std::size_t i = 0; i < entries_.size(); ++i)
        if (entries_[i].noted) noted.push_back(i);
    for_each_parallel(noted.size(), [&](std::size_t i) { decode(noted[i]); });
    gltf_.memory.check();
    noting_ = false;
}

void GltfImages::expect(int gltf_image, const std::string& user) {
    if (noting_) return;
    if (gltf_image < 0 || std::size_t(gltf_image) >= entries_.size()) {
        warnings_.add(fmt::format("{}: texture without an image left out", user));
        return;
    }
    Entry& entry = entries_[std::size_t(gltf_image)];
    const std::string& problem = entry.problem.empty() ? gltf_.images[std::size_t(gltf_image)].problem : entry.problem;
    if (problem.empty() || entry.warned) return;
    entry.warned = true;
    warnings_.add(fmt::format("{}: texture left out: {}", user, problem));
}

bool GltfImages::have(int gltf_image, const std::string& user) {
    if (gltf_image >= 0 && std::size_t(gltf_image) < entries_.size()) {
        Entry& entry = entries_[std::size_t(gltf_image)];
        if (!noting_ && !entry.noted) decode(std::size_t(gltf_image));
        gltf_.memory.check();
        entry.noted = true;
        if (entry.image || entry.index >= 0) return true;
    }
    expect(gltf_image, user);
    return false;
}

int GltfImages::index(int gltf_image, const std::string& user) {
    if (!have(gltf_image, user)) return noting_ ? 0 : -1;
    Entry& entry = entries_[std::size_t(gltf_image)];
    if (entry.index < 0) {
        entry.index = add(std::move(*entry.image), gltf_.images[std::size_t(gltf_image)].name);
        entry.image.reset();
    }
    return entry.index;
}

const Image* GltfImages::decoded(int gltf_image, const std::string& user) {
    if (!have(gltf_image, user)) return nullptr;
    const Entry& entry = entries_[std::size_t(gltf_image)];
    return entry.index >= 0 ? &scene_.images[std::size_t(entry.index)] : &*entry.image;
}

int GltfImages::add(Image image, const std::string& name) {
    scene_.images.push_back(std::move(image));
    scene_.image_names.push_back(name);
    return static_cast<int>(scene_.images.size()) - 1;
}

}  // namespace pellucid
