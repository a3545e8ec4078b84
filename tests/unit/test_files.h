#pragma once

// Files for tests: made ones in a temporary folder, and real ones where the machine has them.
#include <pellucid/error.h>
#include <pellucid/scene.h>

#include <unistd.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

namespace pellucid::test {

/// A folder of its own, removed with everything in it.
class TemporaryFolder {
public:
    TemporaryFolder() {
        static std::atomic<int> counter{0};
        path_ = std::filesystem::temp_directory_path() /
                ("pellucid-test-" + std::to_string(getpid()) + "-" + std::to_string(counter++));
        std::filesystem::create_directories(path_);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }

    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    const std::filesystem::path& path() const { return path_; }

    /// Writes a file into the folder; returns its path.
    std::string file(const std::string& name, std::string_view content) const {
        std::ofstream(path_ / name, std::ios::binary).write(content.data(), std::streamsize(content.size()));
        return (path_ / name).string();
    }

    std::size_t size() const { return std::size_t(std::distance(std::filesystem::directory_iterator(path_), {})); }

private:
    std::filesystem::path path_;
};

inline std::string content_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Folder named by an environment variable, else `otherwise`; empty if it does not exist.
inline std::filesystem::path folder_from(const char* variable, const char* otherwise = "") {
    const char* value = std::getenv(variable);
    const std::filesystem::path folder = value ? value : otherwise;
    return std::filesystem::is_directory(folder) ? folder : std::filesystem::path();
}
inline std::filesystem::path data_folder() { return folder_from("PELLUCID_TEST_DATA"); }
inline std::filesystem::path glmark2_folder() {
    return folder_from("PELLUCID_GLMARK2_MODELS", "/usr/share/glmark2/models");
}

/// Message of the Error that loading `source` ends with, empty if it loads.
inline std::string load_error(const std::string& source, const LoadOptions& options = {}) {
    try {
        load_scene(source, options);
        return {};
    } catch (const Error& error) {
        return error.what();
    }
}

/// Number of warnings that contain `text`.
inline std::size_t warnings_with(const Scene& scene, std::string_view text) {
    std::size_t count = 0;
    for (const std::string& warning : scene.warnings) count += warning.find(text) != warning.npos;
    return count;
}

/// What Scene promises, for every file.
inline std::string broken_promise(const Scene& scene) {
    for (const Mesh& mesh : scene.meshes) {
        if (mesh.triangles.empty()) return mesh.name + ": no triangles";
        if (mesh.normals.size() != mesh.positions.size()) return mesh.name + ": normals missing";
        for (const auto& texcoords : mesh.texcoords)
            if (!texcoords.empty() && texcoords.size() != mesh.positions.size()) return mesh.name + ": texcoords";
        if (!mesh.colors.empty() && mesh.colors.size() != mesh.positions.size()) return mesh.name + ": colors";
        for (const glm::vec3 p : mesh.positions)
            if (!std::isfinite(p.x + p.y + p.z)) return mesh.name + ": position not finite";
        for (const glm::vec3 n : mesh.normals)
            if (!(std::abs(glm::length(n) - 1.0f) < 1e-5f)) return mesh.name + ": normal not of unit length";
        for (const glm::uvec3 t : mesh.triangles)
            for (int k = 0; k < 3; ++k)
                if (t[k] >= mesh.positions.size()) return mesh.name + ": index out of range";
    }
    for (const Object& object : scene.objects) {
        if (object.mesh < 0 || std::size_t(object.mesh) >= scene.meshes.size()) return object.name + ": mesh";
        if (object.material < 0 || std::size_t(object.material) >= scene.materials.size())
            return object.name + ": material";
        if (!(std::abs(glm::determinant(object.world_from_object)) > 0.0f)) return object.name + ": singular";
    }
    if (scene.images.size() != scene.image_names.size()) return "image names";
    for (const Material& material : scene.materials)
        for (const Texture& texture : {material.base_color_texture, material.emission_texture,
                                       material.transmission_texture, material.metallic_roughness_texture})
            if (texture.image >= int(scene.images.size())) return material.name + ": image";
    for (const std::string& warning : scene.warnings)
        if (warning.empty() || warning.find('\n') != warning.npos) return "a warning is not one line";
    return {};
}

}  // namespace pellucid::test
